// SPDX-License-Identifier: MIT
#include "app/capture.h"

#include "app/command_line.h"
#include "app/file_io.h"
#include "app/headless.h"
#include "app/preset.h"
#include "renderer/inspect/inspector.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra {
namespace {

// What of the frame is written: an image, or one channel of it.
struct Selection {
    std::string name; // as asked for
    Image image;
    std::optional<size_t> channel;
};

std::vector<std::string_view> labels(const Flow& flow) {
    std::vector<std::string_view> names{"shadow"};
    for (const Flow::ImageNode& image : flow.images()) names.push_back(flow.label(image.label));
    for (const auto& [label, image] : flow.aliases()) names.push_back(flow.label(label));
    std::sort(names.begin() + 1, names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

std::optional<Image> findImage(const Renderer& renderer, std::string_view label) {
    return label == "shadow" ? renderer.shadow() : renderer.flow().find(label);
}

std::vector<std::string_view> channelNames(const ImageSpec& spec) {
    std::vector<std::string_view> names;
    for (const Channel& channel : spec.channels) names.push_back(channel.name);
    return names;
}

// "scene.normal", or "scene.normal.shading-x" for one channel of it. Throws InputError.
Selection select(const Renderer& renderer, std::string_view name) {
    if (const auto image = findImage(renderer, name)) return {std::string(name), *image, std::nullopt};
    const size_t dot = name.rfind('.');
    const auto image = dot == std::string_view::npos ? std::nullopt : findImage(renderer, name.substr(0, dot));
    if (!image) {
        const std::vector<std::string_view> names = labels(renderer.flow());
        throw InputError(fmt::format("--buffer: there is no '{}'{}; the buffers are {}", name, suggestion(name, names),
                                     fmt::join(names, ", ")));
    }
    const std::vector<std::string_view> names = channelNames(renderer.flow().spec(*image));
    const std::string_view wanted = name.substr(dot + 1);
    const auto found = std::find(names.begin(), names.end(), wanted);
    if (found == names.end())
        throw InputError(fmt::format("--buffer: '{}' has no channel '{}'{}; its channels are {}", name.substr(0, dot),
                                     wanted, suggestion(wanted, names), fmt::join(names, ", ")));
    return {std::string(name), *image, static_cast<size_t>(found - names.begin())};
}

// Programs that show pictures know colours by these names.
std::string fileName(std::string_view channel) {
    if (channel == "red") return "R";
    if (channel == "green") return "G";
    if (channel == "blue") return "B";
    return std::string(channel);
}

void checkRange(std::string_view option, int value, int count, const Selection& selection) {
    if (value >= count)
        throw InputError(fmt::format("{}: {} is not in 0..{} of '{}'", option, value, count - 1, selection.name));
}

// The channels that mean something, or the one asked for, as they are.
Picture rawPicture(const Renderer& renderer, const Selection& selection, int layer, int level) {
    const ImageSpec& spec = renderer.flow().spec(selection.image);
    const Renderer::Pixels pixels = renderer.read(selection.image, layer, level);
    const size_t first = selection.channel.value_or(0), stride = static_cast<size_t>(pixels.channels);
    const size_t count = selection.channel ? 1 : spec.channels.size();
    Picture picture{pixels.width, pixels.height};
    for (size_t c = first; c < first + count; ++c) picture.channels.push_back(fileName(spec.channels[c].name));
    picture.values.reserve(pixels.values.size() / stride * count);
    for (size_t texel = 0; texel < pixels.values.size(); texel += stride)
        for (size_t c = first; c < first + count; ++c) picture.values.push_back(pixels.values[texel + c]);
    return picture;
}

// One channel as colours over its stated range, or that of the finite values that are there.
Picture viewedPicture(Renderer& renderer, const Selection& selection, int layer, int level) {
    const std::span<const Channel> channels = renderer.flow().spec(selection.image).channels;
    const Source source{renderer.runner().texture(renderer.flow(), selection.image), channels, layer, level};
    Inspector inspector(renderer.programs());
    Look look{.channel = static_cast<int>(selection.channel.value_or(0))};
    Statistics statistics;
    for (int turn = 0; turn < Inspector::turns(source); ++turn)
        inspector.measure(source, look.channel, look.range, turn, statistics);
    const Channel& channel = channels[static_cast<size_t>(look.channel)];
    if (channel.min < channel.max) {
        look.range = {channel.min, channel.max};
    } else {
        look.range = nonEmpty(statistics.extremes().value_or(ValueRange{0, 0}));
        const std::string_view unit = unitName(channel.unit);
        fmt::print(stderr, "note: black is {:g} and white is {:g}{}{} in the picture of '{}'\n", look.range.min,
                   look.range.max, unit.empty() ? "" : " ", unit, selection.name);
    }
    if (const int64_t bad = statistics.count(Mark::NaN) + statistics.count(Mark::Infinite); bad > 0)
        fmt::print(stderr, "note: {} pixels are not finite: NaN is magenta, infinite is cyan\n", bad);
    return inspector.picture(source, look, {}, source.size());
}

Picture bufferPicture(Renderer& renderer, const Selection& selection, const Options& options) {
    const ImageSpec& spec = renderer.flow().spec(selection.image);
    checkRange("--layer", options.layer, spec.extent.layers, selection);
    checkRange("--level", options.level, spec.extent.levels, selection);
    if (pictureFormat(*options.output) != PictureFormat::Png)
        return rawPicture(renderer, selection, options.layer, options.level);
    if (!selection.channel && spec.channels.size() != 1)
        throw InputError(fmt::format("--buffer: a .png shows one channel of '{}'; its channels are {}", selection.name,
                                     fmt::join(channelNames(spec), ", ")));
    return viewedPicture(renderer, selection, options.layer, options.level);
}

// Without --buffer: what the window shows, or for files of floats the light before it is made a display's.
Picture framePicture(const Renderer& renderer, const Options& options) {
    if (pictureFormat(*options.output) == PictureFormat::Png) return displayPicture(renderer);
    const std::string_view linear = renderer.flow().find("lit") ? "lit" : "shadow";
    return rawPicture(renderer, select(renderer, linear), 0, 0);
}

void renderFrames(Renderer& renderer, Session& session, const Options& options) {
    const double start = session.time;
    for (int i = 0; i < options.frames; ++i) {
        session.frame = static_cast<uint32_t>(i);
        session.time = start + i * session.timeStep;
        renderer.render(session);
        if (i == 0 && options.buffer) select(renderer, *options.buffer); // before the other frames take their time
    }
}

void printResult(const Options& options, const Picture& picture, const Facts& facts) {
    if (!options.json) {
        fmt::print("{}: {}x{} {}\n", *options.output, picture.width, picture.height, fmt::join(picture.channels, " "));
        return;
    }
    nlohmann::ordered_json json = {{"file", *options.output},
                                   {"width", picture.width},
                                   {"height", picture.height},
                                   {"channels", picture.channels}};
    for (const auto& [key, text] : facts) json[key] = text;
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

} // namespace

Facts factsOf(const Session& session, const std::string& driver) {
    const auto point = [](glm::vec3 p) { return fmt::format("{},{},{}", p.x, p.y, p.z); };
    const Camera& camera = session.camera;
    const AreaLight& light = session.light;
    const bool square = light.shape != LightShape::Rectangle;
    return {
        {"Software", "Penumbra " PENUMBRA_VERSION},
        {"scene", session.scene->name},
        {"technique", std::string(session.techniques.card().id)},
        {"parameters", presetOf(session.techniques)["parameters"].dump()},
        {"camera", fmt::format("{},{},{}", point(camera.eye), point(camera.target), camera.fovY)},
        {"light", fmt::format("{},{}", point(light.position), point(light.target))},
        {"light-shape", std::string(lightShapeNames()[static_cast<size_t>(light.shape)])},
        {"light-size", square ? fmt::format("{}", light.size.x) : fmt::format("{},{}", light.size.x, light.size.y)},
        {"ground", session.ground ? "on" : "off"},
        {"time", fmt::format("{}", session.time)},
        {"seed", fmt::format("{}", session.seed)},
        {"size", fmt::format("{}x{}", session.size.x, session.size.y)},
        {"driver", driver},
    };
}

Picture displayPicture(const Renderer& renderer) {
    return rawPicture(renderer, {"display", renderer.display(), std::nullopt}, 0, 0);
}

void capture(const Options& options) {
    pictureFormat(*options.output); // an unknown ending is refused
    checkWritable(*options.output);
    Session session = makeSession(options);
    if (options.buffer == "shadow") session.display.show = Show::Shadow; // nothing needs to be lit

    const HeadlessContext context;
    Renderer renderer;
    renderFrames(renderer, session, options);
    const Picture picture = options.buffer ? bufferPicture(renderer, select(renderer, *options.buffer), options)
                                           : framePicture(renderer, options);
    Facts facts = factsOf(session, renderer.driver());
    facts.push_back({"frames", fmt::format("{}", options.frames)});
    if (options.buffer) facts.push_back({"buffer", *options.buffer});
    writePicture(*options.output, picture, facts);
    for (const std::string& message : context.messages()) fmt::print(stderr, "note: OpenGL: {}\n", message);
    printResult(options, picture, facts);
}

} // namespace penumbra
