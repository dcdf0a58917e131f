// SPDX-License-Identifier: MIT
#include "tests/catch.h"

#include "ui/timings_panel.h"

#include <sstream>

using namespace penumbra;

namespace {

// A flow of five passes; its labels are numbered 0, 1, 2 ... in their order.
Flow sampleFlow() {
    static constexpr Channel channels[] = {{"value", "", "anything"}};
    Flow flow;
    flow.begin();
    const auto pass = [&](Stage stage, std::string_view name, int size, Format format) {
        flow.pass({.instance = {}, .owner = "sample"}, {.stage = stage,
                                                        .name = name,
                                                        .work = Compute{name},
                                                        .writes = {{name, format, {size, size / 2}, channels}}});
    };
    pass(Stage::Scene, "scene", 8, Format::R32F);
    pass(Stage::ShadowMap, "map", 64, Format::RG16F);
    pass(Stage::Prefilter, "blur", 64, Format::RG16F);
    pass(Stage::Resolve, "resolve", 8, Format::R32F);
    pass(Stage::Display, "display", 8, Format::RGBA8);
    return flow;
}

TimedFrame timed(const Flow& flow, uint64_t number, std::initializer_list<double> milliseconds) {
    TimedFrame frame{number};
    size_t i = 0;
    for (const double ms : milliseconds) {
        const Flow::PassNode& pass = flow.passes()[i++];
        frame.passes.push_back({pass.stage, pass.label, ms});
        frame.milliseconds += ms;
    }
    return frame;
}

std::vector<std::vector<std::string>> rowsOf(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        std::vector<std::string> fields{""};
        bool quoted = false;
        for (const char c : line) {
            if (c == '"')
                quoted = !quoted;
            else if (c == ',' && !quoted)
                fields.emplace_back();
            else
                fields.back() += c;
        }
        rows.push_back(fields);
    }
    return rows;
}

} // namespace

TEST_CASE("quantiles are those of the last 120 values") {
    Recent recent;
    CHECK(recent.quantile(0.5) == 0);
    recent.add(5);
    CHECK(recent.quantile(0.5) == 5);
    CHECK(recent.quantile(0.95) == 5);
    recent.add(7);
    CHECK(recent.quantile(0.5) == 6);
    CHECK(recent.ago(0) == 7);
    CHECK(recent.ago(1) == 5);
    for (int i = 0; i < 200; ++i) recent.add(i % 2 ? 1000 + i : -i);
    for (int i = 101; i-- > 0;) recent.add(i); // 100 ... 0
    CHECK(recent.count() == 120);
    CHECK(recent.quantile(0.5, 101) == 50);
    CHECK(recent.quantile(0.95, 101) == Approx(95));
    CHECK(recent.quantile(0, 101) == 0);
    CHECK(recent.quantile(1, 101) == 100);
    CHECK(recent.quantile(0.25, 3) == 0.5); // of 2, 1, 0
    for (int i = 0; i < 120; ++i) recent.add(i < 113 ? 1 : 100);
    CHECK(recent.quantile(0.5) == 1); // a few slow frames show in the 95th percentile alone
    CHECK(recent.quantile(0.95) == 100);
    for (int i = 0; i < 119; ++i) recent.add(2);
    CHECK(recent.ago(119) == 100);
    recent.add(2);
    CHECK(recent.quantile(1) == 2);
}

TEST_CASE("stages are sums, the cost is that of the shadows, and each frame counts once") {
    const Flow flow = sampleFlow();
    TimingsPanel panel;
    const std::vector<uint32_t> work{1};
    CHECK(panel.frameMedian() == 0);
    for (uint64_t i = 1; i <= 3; ++i)
        for (int twice = 0; twice < 2; ++twice)
            panel.add(timed(flow, i, {1, 2.0 * static_cast<double>(i), 3, 4, 5}), i, work);
    CHECK(panel.frameMedian() == 17);
    CHECK(panel.costMedian() == 11);

    SECTION("other work has numbers of its own, once its frames have been timed") {
        const std::vector<uint32_t> other{2};
        panel.add(timed(flow, 4, {100, 100, 100, 100, 100}), 6, other); // a late frame of the old work
        CHECK(panel.frameMedian() == 0);
        panel.add(timed(flow, 6, {1, 1, 1, 1, 1}), 8, other);
        CHECK(panel.frameMedian() == 5);
        CHECK(panel.costMedian() == 3);
    }
    SECTION("the table holds everything") {
        const auto rows = rowsOf(panel.csv(flow, "sample", "a \"driver\", 4.5", "clock"));
        REQUIRE(rows.size() == 1 + 2 + 5 + 5 + 5);
        CHECK(rows[0] == std::vector<std::string>{"technique", "kind", "stage", "name", "median_ms", "p95_ms", "width",
                                                  "height", "layers", "levels", "samples", "format", "bytes", "frames",
                                                  "method", "driver"});
        for (const auto& row : rows) CHECK(row.size() == rows[0].size());
        for (size_t i = 1; i < rows.size(); ++i) {
            CHECK(rows[i][0] == "sample");
            CHECK(rows[i][13] == "3");
            CHECK(rows[i][14] == "clock");
            CHECK(rows[i][15] == "a driver, 4.5"); // the reader above drops quotes
        }
        const auto find = [&](const std::string& kind, const std::string& name) {
            for (const auto& row : rows)
                if (row[1] == kind && row[3] == name) return row;
            return std::vector<std::string>(16);
        };
        CHECK(find("frame", "frame")[4] == "17");
        CHECK(find("cost", "cost")[4] == "11");
        CHECK(find("cost", "cost")[5] == "12.8");
        CHECK(find("stage", "ShadowMap")[4] == "4");
        CHECK(find("pass", "sample.map")[2] == "ShadowMap");
        CHECK(find("pass", "sample.map")[4] == "4");
        CHECK(find("pass", "sample.map")[5] == "5.8");
        const auto image = find("image", "sample.map");
        CHECK(image[2] == "ShadowMap");
        CHECK(image[6] == "64");
        CHECK(image[7] == "32");
        CHECK(image[11] == "RG16F");
        CHECK(image[12] == std::to_string(64 * 32 * 4));
    }
}
