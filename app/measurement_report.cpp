// SPDX-License-Identifier: MIT
#include "app/measurement_report.h"

#include "app/file_io.h"
#include "renderer/core/csv.h"
#include "renderer/core/error.h"
#include "renderer/measure/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra {
namespace {

using Pointer = Json::json_pointer;

constexpr size_t largestDocument = size_t{1} << 30; // bytes

// What is at a path such as "/error/rmse"; null if there is nothing.
const Json& at(const Json& json, const char* path) {
    static const Json nothing;
    const Pointer pointer(path);
    return json.contains(pointer) ? json[pointer] : nothing;
}

double numberAt(const Json& json, const char* path) {
    const Json& value = at(json, path);
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

// As it was written; the names of choices without their quotes, and nothing for what is not known.
std::string plain(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_null() || (value.is_number_float() && !std::isfinite(value.get<double>()))) return {};
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string parameterText(const Json& result) {
    std::string text;
    for (const auto& [name, value] : result["parameters"].items())
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, plain(value));
    return text;
}

// "pcf kernel 9, shape box"
std::string rowText(const Json& result) {
    const std::string parameters = parameterText(result);
    return parameters.empty() ? plain(result["technique"])
                              : fmt::format("{} {}", plain(result["technique"]), parameters);
}

// --- the table -----------------------------------------------------------------------------------------------------

struct Column {
    const char* title;
    const char* path;
    const char* format; // of its number
    double scale = 1;
};

constexpr Column columns[] = {
    {"ms", "/ms/median", "{:.2f}"},
    {"p95", "/ms/p95", "{:.2f}"},
    {"cost", "/cost/median", "{:.2f}"},
    {"map", "/stages/ShadowMap", "{:.2f}"},
    {"prefilter", "/stages/Prefilter", "{:.2f}"},
    {"resolve", "/stages/Resolve", "{:.2f}"},
    {"MiB", "/bytes", "{:.1f}", 1.0 / (1 << 20)},
    {"RMSE", "/error/rmse", "{:.4f}"},
    {"penumbra", "/error/penumbra_rmse", "{:.4f}"},
    {"bias", "/error/bias", "{:+.4f}"},
    {"p99", "/error/p99", "{:.4f}"},
};

std::string cell(const Json& result, const Column& column) {
    const double value = numberAt(result, column.path);
    return std::isnan(value) ? "-" : fmt::format(fmt::runtime(column.format), value * column.scale);
}

std::string aligned(const std::vector<std::vector<std::string>>& rows, size_t leftColumns) {
    std::vector<size_t> widths(rows[0].size());
    for (const auto& row : rows)
        for (size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (size_t c = 0; c < row.size(); ++c)
            line += c < leftColumns ? fmt::format("{:<{}}  ", row[c], widths[c])
                                    : fmt::format("{:>{}}  ", row[c], widths[c]);
        line.erase(line.find_last_not_of(' ') + 1);
        text += line;
        text += '\n';
    }
    return text;
}

std::string heading(const Json& document) {
    const Json& results = document["results"];
    std::string text = fmt::format("{} {}x{}", plain(document["scene"]), plain(at(document, "/size/0")),
                                   plain(at(document, "/size/1")));
    if (const Json& budget = at(document, "/budget"); budget.is_object())
        text += fmt::format(", {} settings tried in {} view{}", plain(at(budget, "/tried")),
                            at(budget, "/views").size(), at(budget, "/views").size() == 1 ? "" : "s");
    else
        text += fmt::format(", {} frames", plain(at(document, "/frames")));
    if (const Json& repeat = at(document, "/repeat"); repeat != 1) text += fmt::format(", {} times", plain(repeat));
    if (const Json& path = at(document, "/view/path"); path.is_string()) text += fmt::format(", along {}", plain(path));
    if (const Json& motion = at(document, "/view/motion"); motion.is_string())
        text += fmt::format(", {}", plain(motion));
    const auto known =
        std::find_if(results.begin(), results.end(), [](const Json& result) { return result["error"].is_object(); });
    if (known == results.end()) return text + "\n";
    const Json& error = (*known)["error"];
    text += fmt::format("; truth by {} {}", plain(error["samples"]),
                        error["against"] == "ray" ? "rays a pixel" : "shadow maps");
    if (const double se = numberAt(error, "/standard_error"); !std::isnan(se))
        text += fmt::format(", standard error {:.4f} in penumbrae", se);
    if (const double bias = numberAt(error, "/map_bias"); !std::isnan(bias))
        text += fmt::format("; shadow maps as such differ from it by {:.4f}", bias);
    return text + "\n";
}

// Rows that no measurement here can tell apart by their cost.
std::string ties(const Json& results) {
    std::string names;
    for (const Json& result : results)
        if (at(result, "/cost_over_first/differs") == false)
            names += fmt::format("{}{}", names.empty() ? "" : "; ", rowText(result));
    if (names.empty()) return {};
    return fmt::format("No difference in cost from the first row beyond the noise: {}\n", names);
}

// How long what is no longer there is still seen.
std::string ghosts(const Json& results) {
    std::string text;
    for (const Json& result : results)
        if (const Json& ghost = at(result, "/ghost"); ghost.is_object()) {
            const std::string halfLife = plain(at(ghost, "/half_life"));
            text +=
                fmt::format("{}: penumbra RMSE at most {:.4f} after the event, {:.4f} in the end; frames to half of "
                            "the way: {}",
                            rowText(result), numberAt(ghost, "/peak"), numberAt(ghost, "/settled"),
                            halfLife.empty() ? "–" : halfLife);
            if (const Json& flicker = at(result, "/error/flicker"); flicker.is_number())
                text += fmt::format("; flicker {:.4f}", flicker.get<double>());
            text += "\n";
        }
    return text;
}

// --- comma-separated values ----------------------------------------------------------------------------------------

void flatten(const Json& json, const std::string& name, Json& row) {
    if (json.is_object())
        for (const auto& [key, value] : json.items()) flatten(value, name.empty() ? key : name + "." + key, row);
    else if (!json.is_array())
        row[name] = json;
}

// --- joining -------------------------------------------------------------------------------------------------------

[[noreturn]] void refuse(const std::string& file, const std::string& what) {
    throw InputError(fmt::format("--merge: {}: {}", file, what));
}

Json readDocument(const std::string& file) {
    Json document;
    try {
        document = Json::parse(readFile(file, largestDocument));
    } catch (const Json::exception& error) {
        refuse(file, error.what());
    } catch (const InputError& error) {
        throw InputError(fmt::format("--merge: {}", error.what()));
    }
    static constexpr const char* texts[] = {"program", "version", "scene"};
    if (!document.is_object() || at(document, "/program") != "penumbra" || !at(document, "/results").is_array())
        refuse(file, "is not what 'penumbra measure --json' writes");
    for (const char* key : texts)
        if (!document.contains(key) || !document[key].is_string())
            refuse(file, fmt::format("'{}': a text was expected", key));
    if (!at(document, "/view/hash").is_string()) refuse(file, "'view.hash': a text was expected");
    for (const Json& result : document["results"]) {
        const bool good = result.is_object() && at(result, "/row").is_number_unsigned() &&
                          at(result, "/technique").is_string() && at(result, "/parameters").is_object() &&
                          result.contains("error");
        if (!good) refuse(file, "'results': objects with row, technique, parameters and error were expected");
    }
    return document;
}

// What parts of one measurement have in common.
constexpr const char* common[] = {"/version", "/metric", "/scene", "/size", "/view/hash", "/frames", "/repeat"};

} // namespace

Json readsJson(const Technique& technique) {
    const std::optional<TextureReads> reads = technique.readsPerPixel();
    return reads ? Json{{"least", reads->least}, {"most", reads->most}} : Json();
}

std::string readsText(const Json& reads) {
    if (!reads.is_object()) return {};
    const std::string least = plain(at(reads, "/least")), most = plain(at(reads, "/most"));
    return least == most ? least : least + "-" + most;
}

void markFront(Json& document) {
    std::vector<TradeOff> points;
    for (const Json& result : document["results"])
        points.push_back({numberAt(result, "/cost/median"), numberAt(result, "/error/rmse")});
    const std::vector<bool> front = tradeOffFront(points);
    for (size_t i = 0; i < front.size(); ++i) document["results"][i]["front"] = static_cast<bool>(front[i]);
}

namespace {

// What a search came to, as a setting and the options that choose it.
std::string proposalText(const Json& document) {
    const Json& budget = at(document, "/budget");
    if (!budget.is_object()) return {};
    const bool cost = budget["bound"] == "cost";
    const std::string wanted = cost ? fmt::format("a cost of at most {:g} ms", numberAt(budget, "/limit"))
                                    : fmt::format("an RMSE of at most {:g}", numberAt(budget, "/limit"));
    if (!budget["proposal"].is_number_unsigned()) {
        const char* path = cost ? "/cost/median" : "/error/rmse";
        double least = std::numeric_limits<double>::infinity();
        for (const Json& result : document["results"])
            if (const double value = numberAt(result, path); value < least) least = value;
        return fmt::format("Nothing that was tried keeps {}; the least was {:.4g}{}.\n", wanted, least,
                           cost ? " ms" : "");
    }
    const Json& result = document["results"][budget["proposal"].get<size_t>()];
    std::string text = fmt::format("Proposal for {}: {}, cost {:.2f} ms ({:.2f} to {:.2f}), RMSE {:.4f}{}\n ", wanted,
                                   rowText(result), numberAt(result, "/cost/median"), numberAt(result, "/cost/low"),
                                   numberAt(result, "/cost/high"), numberAt(result, "/error/rmse"),
                                   budget["certain"] == false ? "; the noise of its cost reaches above that" : "");
    text += fmt::format(" --technique {}", plain(result["technique"]));
    for (const auto& [name, value] : result["parameters"].items())
        text += fmt::format(" --set {}={}", name, plain(value));
    return text + "\n";
}

} // namespace

namespace {

std::string irradianceTable(const Json& document) {
    static constexpr Column figures[] = {{"error %", "/error/mean_abs", "{:.3f}", 100},
                                         {"bias %", "/error/bias", "{:+.3f}", 100},
                                         {"above %", "/error/above", "{:.3f}", 100},
                                         {"shadowed %", "/error/shadowed", "{:.2f}", 100}};
    std::vector<std::vector<std::string>> rows{{"technique", "parameters"}};
    for (const Column& column : figures) rows[0].push_back(column.title);
    std::string troubles, seen;
    for (const Json& result : document["results"]) {
        rows.push_back({plain(result["technique"]), parameterText(result)});
        for (const Column& column : figures) rows.back().push_back(cell(result, column));
        if (const Json& trouble = at(result, "/trouble"); trouble.is_string())
            troubles += fmt::format("{}: {}\n", rowText(result), plain(trouble));
        if (const Json& error = at(result, "/error"); error.is_object() && seen.empty()) {
            seen = fmt::format(", {} texels of surfaces in {} layers", plain(at(error, "/surfaces")),
                               plain(at(error, "/layers")));
            if (const double last = numberAt(error, "/last_layer"); last > 0)
                seen += fmt::format(", {:.2g} % of them in the last one; what is behind is not counted", 100 * last);
        }
    }
    return fmt::format("{}: a light from a direction{}\n\n", plain(document["scene"]), seen) + aligned(rows, 2) +
           "\nError is the mean of |ψ − F| over all surfaces that face the light, F by percentage-closer filtering "
           "with "
           "the same Gaussian;\nbias is that of ψ − F, above that of its positive part, which no bound has but for its "
           "biases; shadowed is that of F.\nPeters and Klein 2015, section 3.2, in scenes of their own: 2.19 % for "
           "four "
           "moments, 1.93 % for trigonometric ones.\n" +
           troubles;
}

} // namespace

std::string measurementTable(const Json& document) {
    if (at(document, "/metric") == "irradiance") return irradianceTable(document);
    std::vector<std::vector<std::string>> rows{{"", "technique", "parameters"}};
    for (const Column& column : columns) rows[0].push_back(column.title);
    rows[0].push_back("reads");
    std::string troubles;
    for (const Json& result : document["results"]) {
        rows.push_back({at(result, "/front") == true ? "*" : "", plain(result["technique"]), parameterText(result)});
        for (const Column& column : columns) rows.back().push_back(cell(result, column));
        const std::string reads = readsText(at(result, "/reads"));
        rows.back().push_back(reads.empty() ? "-" : reads);
        if (const Json& trouble = at(result, "/trouble"); trouble.is_string())
            troubles += fmt::format("{}: {}\n", rowText(result), plain(trouble));
    }
    return heading(document) + "\n" + aligned(rows, 3) + "\n" +
           "* on the trade-off front: nobody is both faster (cost = map + prefilter + resolve) and closer (RMSE).\n" +
           "Times are medians in milliseconds; bias is positive where shadows are too dark; reads are texels of shadow "
           "maps a "
           "pixel.\n" +
           ties(document["results"]) + ghosts(document["results"]) + troubles + proposalText(document);
}

std::string measurementCsv(const Json& document) {
    std::vector<Json> rows;
    for (const Json& result : document["results"]) {
        const Json& frames = at(result, "/frames");
        Json head = {{"row", result["row"]}, {"technique", result["technique"]}};
        flatten(result["parameters"], "parameters", head);
        if (frames.is_array() && !frames.empty()) {
            for (const Json& frame : frames) {
                rows.push_back(head);
                flatten(frame, "", rows.back());
            }
            continue;
        }
        rows.push_back(head);
        for (const char* key :
             {"ms", "cost", "stages", "bytes", "maps", "pass_count", "reads", "error", "front", "proposal", "trouble"})
            if (result.contains(key)) flatten(result[key], key, rows.back());
    }
    // Parameters of any row are columns of all.
    Json titles = Json::object();
    for (const char* group : {"row", "technique", "parameters.", ""})
        for (const Json& row : rows)
            for (const auto& [key, value] : row.items())
                if (key.starts_with(group)) titles[key] = true;
    std::string text;
    const auto addLine = [&](auto&& valueOf) {
        std::string line;
        for (const auto& [title, unused] : titles.items()) {
            if (!line.empty()) line += ',';
            line += csvField(valueOf(title));
        }
        text += line;
        text += '\n';
    };
    addLine([](const std::string& title) { return title; });
    for (const Json& row : rows)
        addLine([&](const std::string& title) { return row.contains(title) ? plain(row[title]) : std::string(); });
    return text;
}

Json mergeMeasurements(const std::vector<std::string>& files) {
    Json merged;
    std::vector<std::pair<Json, std::string>> results; // and the file
    for (const std::string& file : files) {
        Json document = readDocument(file);
        if (merged.is_null()) {
            merged = document;
        } else {
            for (const char* path : common)
                if (at(document, path) != at(merged, path))
                    refuse(file, fmt::format("its {} is {}, not {} as in {}", path + 1, plain(at(document, path)),
                                             plain(at(merged, path)), files[0]));
            merged["complete"] = at(merged, "/complete") == true && at(document, "/complete") == true;
            if (at(document, "/driver") != at(merged, "/driver"))
                fmt::print(stderr, "note: {} was measured on another driver than {}: their times do not compare\n",
                           file, files[0]);
        }
        for (Json& result : document["results"]) {
            result.erase("cost_over_first"); // of another row than the first of all
            for (const auto& [other, from] : results) {
                if (other["technique"] == result["technique"] && other["parameters"] == result["parameters"])
                    refuse(file, fmt::format("{} {} is in {} as well", plain(result["technique"]),
                                             parameterText(result), from));
                const Json &theirs = at(other, "/error/against"), &ours = at(result, "/error/against");
                if (!theirs.is_null() && !ours.is_null() && theirs != ours)
                    refuse(file, fmt::format("its errors are against another truth ({}) than those of {}", plain(ours),
                                             from));
            }
            results.emplace_back(std::move(result), file);
        }
    }
    std::stable_sort(results.begin(), results.end(),
                     [](const auto& a, const auto& b) { return a.first["row"] < b.first["row"]; });
    merged["results"] = Json::array();
    for (auto& [result, file] : results) merged["results"].push_back(std::move(result));
    markFront(merged);
    return merged;
}

} // namespace penumbra
