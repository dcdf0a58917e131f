// SPDX-License-Identifier: MIT
// `penumbra measure`, used as from a shell.
#include "tests/app/program.h"
#include "tests/catch.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

using namespace penumbra;
using namespace penumbra::test;
using nlohmann::json;

namespace {

// Small and quick; `more` overrides.
std::vector<std::string> command(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"measure", "two-boxes", "--size", "48x32", "--set", "map-size=256"};
    const auto fallback = [&](const char* option, const char* value) {
        if (std::find(more.begin(), more.end(), option) == more.end())
            arguments.insert(arguments.end(), {option, value});
    };
    fallback("--frames", "6");
    fallback("--samples", "128");
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

std::string measured(const std::vector<std::string>& more) {
    const Result result = runProgram(command(more));
    INFO(result.errors);
    REQUIRE(result.exitCode == 0);
    CHECK_FALSE(contains(result.errors, "OpenGL"));
    return result.output;
}

json measuredJson(std::vector<std::string> more) {
    more.push_back("--json");
    return json::parse(measured(more));
}

// What must not depend on the machine and the moment.
json errorsIn(const json& document) {
    json errors = json::array();
    for (const json& result : document.at("results")) {
        json frames = result.at("frames");
        for (json& frame : frames) frame.erase("ms"), frame.erase("cost");
        errors.push_back(
            {result.at("row"), result.at("technique"), result.at("parameters"), result.at("error"), frames});
    }
    return errors;
}

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

void requireRefused(const std::vector<std::string>& arguments, const std::vector<std::string>& pieces) {
    const Result result = runProgram(arguments);
    INFO(result.errors);
    CHECK(result.exitCode == 2);
    CHECK(result.output.empty());
    CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
    for (const std::string& piece : pieces) {
        INFO("expected: " << piece);
        CHECK(contains(result.errors, piece));
    }
}

} // namespace

TEST_CASE("a measurement tells times, errors, and which view it is of") {
    const json document = measuredJson({"--techniques", "none,hard,pcss"});
    CHECK(document.at("program") == "penumbra");
    CHECK(document.at("version") == PENUMBRA_VERSION);
    CHECK(document.at("scene") == "two-boxes");
    CHECK(document.at("size") == json{48, 32});
    CHECK_FALSE(document.at("driver").get<std::string>().empty());
    for (const char* key : {"camera", "light", "time", "seed", "hash"}) CHECK(document.at("view").contains(key));

    const json& results = document.at("results");
    REQUIRE(results.size() == 3);
    for (const json& result : results) {
        INFO(result.dump());
        CHECK(result.at("parameters").is_object());
        CHECK(result.at("bytes") > 0);
        const json& error = result.at("error");
        CHECK(error.at("against") == "ray");
        CHECK(error.at("samples") == 128);
        CHECK(error.at("standard_error") > 0);
        for (const char* key : {"rmse", "mean_abs", "bias", "p95", "p99", "max", "penumbra_rmse", "map_bias", "flicker",
                                "leak", "false_shadow", "noise", "wide", "narrow"})
            CHECK(std::isfinite(error.at(key).get<double>()));
        CHECK(error.at("pixels") > error.at("penumbra_pixels"));
        CHECK(error.at("penumbra_pixels") > 0);
        CHECK(error.at("cut_by_horizon") >= 0);
        const double shares = error.at("leak").get<double>() + error.at("false_shadow").get<double>() +
                              error.at("noise").get<double>() + error.at("wide").get<double>() +
                              error.at("narrow").get<double>();
        CHECK(shares == Approx(1));
        CHECK(result.at("frames").empty());
        if (result.contains("trouble")) { // the machine was too busy to be measured
            CHECK(result.at("ms").is_null());
            continue;
        }
        const json& ms = result.at("ms");
        CHECK(ms.at("min") <= ms.at("median"));
        CHECK(ms.at("median") <= ms.at("p95"));
        const json& cost = result.at("cost");
        CHECK(cost.at("low") <= cost.at("median"));
        CHECK(cost.at("median") <= cost.at("high"));
        double stages = 0, passes = 0;
        for (const auto& [stage, time] : result.at("stages").items()) stages += time.get<double>();
        for (const json& pass : result.at("passes")) passes += pass.at("ms").get<double>();
        CHECK(stages == Approx(ms.at("median").get<double>()).epsilon(0.3)); // medians of parts
        CHECK(passes == Approx(stages).epsilon(0.3));
    }
    CHECK(results[0].at("technique") == "none");
    CHECK(results[0].at("error").at("bias") < 0); // it is all lit
    CHECK(results[0].at("error").at("rmse") > results[2].at("error").at("rmse"));
}

TEST_CASE("the same command gives the same errors, to the last digit") {
    const std::vector<std::string> arguments{"--techniques", "hard,pcss,light-sampling", "--set", "samples=16"};
    CHECK(errorsIn(measuredJson(arguments)) == errorsIn(measuredJson(arguments)));
}

TEST_CASE("the error of the irradiance ranks bounds by what they know, against filtering of the same kernel") {
    const Result run = runProgram({"measure", "overlapping-occluders", "--error", "irradiance", "--techniques",
                                   "none,pcf,vsm,msm-hamburger,msm-hausdorff,msm-trigonometric,msm-six", "--set",
                                   "map-size=128", "--set", "format=32f", "--set", "pcf.shape=gaussian", "--sweep",
                                   "pcf.kernel=9", "--json"}); // bounds on equal terms
    INFO(run.errors);
    REQUIRE(run.exitCode == 0);
    CHECK_FALSE(contains(run.errors, "OpenGL"));
    const json document = json::parse(run.output);
    CHECK(document.at("metric") == "irradiance");
    std::map<std::string, json> errors;
    for (const json& result : document.at("results")) errors[result.at("technique")] = result.at("error");
    REQUIRE(errors.size() == 7);
    for (const auto& [technique, error] : errors) {
        INFO(technique << " " << error.dump());
        CHECK(error.at("layers") > 1);
        CHECK(error.at("last_layer") == 0);
        CHECK(std::abs(error.at("bias").get<double>()) <= error.at("mean_abs").get<double>());
    }
    // What is not shadowed at all is wrong by all that is shadowed; the reference itself by nothing.
    CHECK(errors["none"].at("shadowed") > 0.01);
    CHECK(errors["none"].at("mean_abs").get<double>() == Approx(errors["none"].at("shadowed").get<double>()));
    CHECK(errors["pcf"].at("mean_abs") == 0);
    for (const char* technique : {"msm-hamburger", "msm-hausdorff", "msm-trigonometric", "msm-six"}) {
        INFO(technique);
        CHECK(errors[technique].at("mean_abs") < errors["vsm"].at("mean_abs"));
    }

    // As they are set at first, formats, biases and all, four moments in 8 bytes a texel beat two in 8.
    const Result usual = runProgram({"measure", "over-stairs", "--error", "irradiance", "--techniques",
                                     "vsm,msm-hamburger,msm-hausdorff", "--set", "map-size=256", "--json"});
    REQUIRE(usual.exitCode == 0);
    std::map<std::string, double> mean;
    const json usually = json::parse(usual.output);
    for (const json& result : usually.at("results"))
        mean[result.at("technique")] = result.at("error").at("mean_abs");
    CHECK(mean.at("msm-hamburger") < mean.at("vsm"));
    CHECK(mean.at("msm-hausdorff") < mean.at("vsm"));

    requireRefused({"measure", "--error", "irradiation"}, {"--error", "irradiation", "irradiance"});
    requireRefused({"measure", "--error", "irradiance", "--against", "ray"}, {"--error irradiance", "--against"});
}

TEST_CASE("sweeps make rows, and parts of them join to the whole") {
    const std::vector<std::string> sweep{"--techniques",     "hard,pcf", "--sweep",
                                         "pcf.kernel=3:7:3", "--sweep",  "shape=box,gaussian"};
    const json whole = measuredJson(sweep);
    REQUIRE(whole.at("results").size() == 7); // hard, and 3 x 2 of pcf
    CHECK(whole.at("results")[0].at("technique") == "hard");
    CHECK(whole.at("results")[4].at("parameters").at("kernel") == 5);
    CHECK(whole.at("results")[4].at("parameters").at("shape") == "gaussian");

    const TemporaryFolder folder;
    std::vector<std::string> merge{"measure", "--json", "--merge"};
    for (const std::string part : {"1", "2"}) {
        std::vector<std::string> arguments = sweep;
        arguments.insert(arguments.end(), {"--shard", part + "/2", "--json"});
        const std::string file = folder / (part + ".json");
        writeAll(file, measured(arguments));
        merge.push_back(file);
    }
    const Result merged = runProgram(merge);
    INFO(merged.errors);
    REQUIRE(merged.exitCode == 0);
    const json joined = json::parse(merged.output);
    CHECK(errorsIn(joined) == errorsIn(whole));
    CHECK(joined.at("view") == whole.at("view"));

    // As a table and as values with commas too.
    merge[1] = "--csv";
    CHECK(linesOf(runProgram(merge).output).size() == 8);
    merge.erase(merge.begin() + 1);
    CHECK(contains(runProgram(merge).output, "penumbra"));

    // But not a part with itself, or with one of something else.
    const std::string first = folder / "1.json", other = folder / "other.json";
    requireRefused({"measure", "--merge", first, first}, {first, "as well"});
    const json original = json::parse(readAll(first));
    const auto refuse = [&](const json& changed, const std::string& reason) {
        writeAll(other, changed.dump());
        requireRefused({"measure", "--merge", folder / "2.json", other}, {other, reason});
    };
    json changed = original;
    changed["version"] = "0.0.1";
    refuse(changed, "version");
    changed = original;
    changed["scene"] = "courtyard";
    refuse(changed, "scene");
    changed = original;
    changed["view"]["hash"] = "0";
    refuse(changed, "view/hash");
    changed = original;
    changed["results"][0]["error"]["against"] = "samples";
    refuse(changed, "another truth");
    refuse(json::array(), "penumbra measure --json");
    refuse(json{{"program", "penumbra"}}, "penumbra measure --json");
    changed = original;
    changed["results"][0] = 7;
    refuse(changed, "results");
    writeAll(other, readAll(first).substr(0, 100));
    requireRefused({"measure", "--merge", other}, {other, "parse error"});
    requireRefused({"measure", "--merge", folder / "none.json"}, {"none.json", "No such file"});
}

TEST_CASE("tables and values with commas have a row for each combination") {
    const std::string table = measured({"--techniques", "none,pcf", "--sweep", "kernel=3,5"});
    for (const char* word : {"technique", "RMSE", "penumbra", "bias", "p99", "MiB", "kernel 3", "kernel 5", "none"})
        CHECK(contains(table, word));
    const std::vector<std::string> lines =
        linesOf(measured({"--techniques", "none,pcf", "--sweep", "kernel=3,5", "--csv"}));
    REQUIRE(lines.size() == 4);
    CHECK(lines[0].starts_with("row,technique,parameters."));
    CHECK(contains(lines[0], "parameters.kernel"));
    CHECK(contains(lines[0], "error.rmse"));
    CHECK(lines[1].starts_with("0,none,,,"));
    CHECK(lines[2].starts_with("1,pcf,256,3,"));
    for (const std::string& line : lines)
        CHECK(std::count(line.begin(), line.end(), ',') == std::count(lines[0].begin(), lines[0].end(), ','));
}

TEST_CASE("along a path and in motion every frame has a truth of its own") {
    const json orbit = measuredJson({"--techniques", "hard", "--path", "orbit", "--frames", "3"});
    const json& frames = orbit.at("results")[0].at("frames");
    REQUIRE(frames.size() == 3);
    CHECK(frames[0].at("rmse") != frames[2].at("rmse"));
    CHECK(frames[2].at("seconds").get<double>() == Approx(2.0 / 60));
    CHECK(orbit.at("results")[0].at("error").at("flicker").is_null());

    const TemporaryFolder folder;
    writeAll(folder / "path.csv", "0,3,2,4,0,0.5,0\n0.05,3.2,2,4,0,0.5,0\n");
    const std::vector<std::string> lines =
        linesOf(measured({"--techniques", "hard,none", "--path", folder / "path.csv", "--frames", "3", "--csv"}));
    CHECK(lines.size() == 7); // 2 x 3 and the titles
    CHECK(contains(lines[0], "frame,seconds,ms,cost"));

    const Result moving = runProgram({"measure", "moving-caster", "--play", "--techniques", "hard", "--frames", "3",
                                      "--size", "48x32", "--samples", "128", "--json"});
    INFO(moving.errors);
    REQUIRE(moving.exitCode == 0);
    CHECK(json::parse(moving.output).at("results")[0].at("frames").size() == 3);
}

TEST_CASE("shadow maps can be the truth, and differ from rays by no more than their resolution") {
    const json document = measuredJson({"--techniques", "light-sampling", "--against", "samples", "--samples", "64"});
    const json& error = document.at("results")[0].at("error");
    CHECK(error.at("against") == "samples");
    CHECK(error.at("samples") == 64);
    CHECK(error.at("standard_error").is_null());
    CHECK(error.at("rmse") < 0.05);
}

TEST_CASE("a setting that cannot be drawn has a reason instead of figures, and the others are measured") {
    const json document =
        measuredJson({"--techniques", "hard", "--sweep", "hard.map-size=256,8192", "--texture-limit", "64"});
    const json& results = document.at("results");
    REQUIRE(results.size() == 2);
    CHECK(results[0].at("error").is_object());
    CHECK(results[1].at("error").is_null());
    CHECK(results[1].at("ms").is_null());
    CHECK(contains(results[1].at("trouble").get<std::string>(), "limit"));
}

TEST_CASE("views of the project fix camera and light") {
    const Result result = runProgram({"measure", "--view", "courtyard", "--techniques", "none", "--size", "32x24",
                                      "--frames", "1", "--samples", "128", "--json"});
    INFO(result.errors);
    REQUIRE(result.exitCode == 0);
    const json document = json::parse(result.output);
    CHECK(document.at("scene") == "courtyard");
    CHECK(document.at("view").at("name") == "courtyard");
    CHECK(document.at("view").at("camera").at("eye") == json{7.4, 4.6, 8.6});
}

TEST_CASE("techniques tell how many texels a pixel reads, and how many maps and passes they take") {
    const json document = measuredJson({"--techniques", "none,pcf,pcss,light-sampling", "--set", "pcf.kernel=5",
                                        "--set", "samples=3", "--set", "search-taps=8", "--set", "filter-taps=20"});
    const json& results = document.at("results");
    const auto reads = [](int least, int most) { return json{{"least", least}, {"most", most}}; };
    CHECK(results[0].at("reads") == reads(0, 0));
    CHECK(results[1].at("reads") == reads(36, 36));
    CHECK(results[2].at("reads") == reads(8, 28));
    CHECK(results[3].at("reads") == reads(3, 3));
    CHECK(results[0].at("maps") == 0);
    CHECK(results[3].at("maps") == 3);
    CHECK(results[0].at("pass_count") == 1);
    CHECK(results[1].at("pass_count") == 2);
    CHECK(results[3].at("pass_count") == 7); // three maps with a count of each, and the mean
}

TEST_CASE("the best within a budget is searched for, and everything that was tried is told") {
    const std::vector<std::string> question{"measure", "two-boxes",    "--size",   "48x32",  "--samples",
                                            "128",     "--techniques", "hard,pcf", "--free", "kernel=1:9"};
    const auto answer = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = question;
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Result result = runProgram(arguments);
        INFO(result.errors);
        REQUIRE(result.exitCode == 0);
        return result.output;
    };
    const json document = json::parse(answer({"--budget-ms", "100000", "--json"}));
    const json &budget = document.at("budget"), &results = document.at("results");
    CHECK(budget.at("bound") == "cost");
    CHECK(budget.at("tried") == results.size());
    REQUIRE(results.size() == 6); // hard, and kernels of 1, 3, 5, 7 and 9
    const json& best = results[budget.at("proposal").get<size_t>()];
    CHECK(best.at("proposal") == true);
    // Time enough: nothing that was tried is closer by more than nobody sees.
    for (const json& result : results) {
        CHECK(best.at("error").at("rmse").get<double>() <= 1.011 * result.at("error").at("rmse").get<double>());
        CHECK(result.at("proposal") == (result.at("row") == budget.at("proposal")));
    }
    CHECK(best.at("cost").at("median") <= 100000);
    const double rmse = best.at("error").at("rmse");
    const std::string table = answer({"--budget-rmse", std::to_string(1.02 * rmse)});
    CHECK(contains(table, "Proposal for an RMSE of at most"));
    CHECK(contains(table, "--technique "));
    CHECK(contains(answer({"--budget-rmse", "0.000001", "--csv"}), ",proposal"));
    CHECK(contains(answer({"--budget-rmse", "0.000001"}), "Nothing that was tried keeps"));
}

TEST_CASE("bad input to measure is refused in one line") {
    requireRefused(command({"--budget-ms", "3"}), {"--budget-ms", "--free NAME"});
    const auto budget = [](std::vector<std::string> more) {
        more.insert(more.begin(), {"measure", "two-boxes", "--technique", "pcf"});
        return more;
    };
    requireRefused(budget({"--free", "kernel"}), {"--free", "--budget-rmse"});
    requireRefused(budget({"--free", "kernel", "--budget-ms", "0"}), {"--budget-ms", "'0'", "above 0"});
    requireRefused(budget({"--free", "kernel", "--budget-ms", "1", "--budget-rmse", "1"}), {"one of them"});
    requireRefused(budget({"--free", "kernel", "--budget-ms", "1", "--sweep", "kernel=3,5"}), {"--sweep"});
    requireRefused(budget({"--free", "kernal", "--budget-ms", "1"}), {"did you mean 'kernel'?"});
    requireRefused(budget({"--free", "kernel=1:99", "--budget-ms", "1"}), {"1..63 texels"});
    requireRefused(budget({"--free", "pcss.filter-taps", "--budget-ms", "1"}), {"no technique that is measured"});
    requireRefused(command({"--techniques", "pcg"}), {"'pcg'", "did you mean 'pcf'?"});
    requireRefused(command({"--techniques", "pcf,"}), {"''"});
    requireRefused(command({"--technique", "pcf", "--set", "kernal=3"}), {"'kernal'", "did you mean 'kernel'?"});
    requireRefused(command({"--technique", "pcf", "--sweep", "kernel=3,99"}), {"1..63 texels, odd"});
    requireRefused(command({"--technique", "pcf", "--sweep", "kernel=1:2"}), {"--sweep", "FROM:TO:STEPS"});
    requireRefused(command({"--against", "rays"}), {"--against", "did you mean 'ray'?"});
    requireRefused(command({"--against", "samples", "--samples", "9999"}), {"samples", "9999", "1..4096"});
    requireRefused(command({"--samples", "0"}), {"--samples", "1..65536"});
    requireRefused(command({"--repeat", "0"}), {"--repeat"});
    for (const char* shard : {"0/2", "3/2", "1", "1/", "/2", "a/b", "1/2/3", "-1/2"})
        requireRefused(command({"--shard", shard}), {"--shard", shard});
    requireRefused(command({"--motion", "caster-moves"}), {"--motion", "nothing moves in two-boxes"});
    requireRefused(command({"--path", "orbits"}), {"--path", "orbits", "No such file"});
    requireRefused(command({"--view", "courtyart"}), {"--view", "did you mean 'courtyard'?"});
    requireRefused(command({"--json", "--csv"}), {"--json", "--csv"});
    requireRefused(command({"--preset", "pcf/gaussian-9x8"}), {"did you mean 'pcf/gaussian-9x9'?"});
    requireRefused(command({"--swep", "kernel=3"}), {"did you mean '--sweep'?"});
    const TemporaryFolder folder;
    writeAll(folder / "path.csv", "0,3,2,4,0,0.5,0\nnext\n");
    requireRefused(command({"--path", folder / "path.csv"}), {"path.csv", "line 2"});
    writeAll(folder / "path.csv", "0,3,2,4,0,0.5,0\n0.1,3,2,5,0,0.5,0\n");
    requireRefused(command({"--path", folder / "path.csv", "--frames", "100"}), {"--frames", "7 frames"});
}

TEST_CASE("an interrupted measurement keeps what is done") {
    const TemporaryFolder folder;
    const std::string output = folder / "output", errors = folder / "errors";
    // Far too many frames; the interrupt comes when measuring has begun. What a shell starts in the background is deaf
    // to it unless told otherwise.
    const std::string line = "env --default-signal=INT '" PENUMBRA_PROGRAM
                             "' measure two-boxes --size 48x32 --samples 128 "
                             "--techniques none,hard --frames 1000000 --json > '" +
                             output + "' 2> '" + errors + "' & until grep -q measuring '" + errors +
                             "' || ! kill -0 $!; do sleep 0.1; done; sleep 2; kill -INT $!; wait $!";
    std::system(line.c_str());
    INFO(readAll(errors));
    CHECK(contains(readAll(errors), "interrupted; 2 of 2 rows are kept"));
    const json document = json::parse(readAll(output));
    CHECK(document.at("complete") == false);
    REQUIRE(document.at("results").size() == 2);
    for (const json& result : document.at("results")) CHECK(result.at("error").at("rmse").get<double>() >= 0);
}
