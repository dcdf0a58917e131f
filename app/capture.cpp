// SPDX-License-Identifier: MIT
#include "app/capture.h"

#include "app/command_line.h"
#include "app/file_io.h"
#include "app/headless.h"
#include "app/image_file.h"
#include "app/progress_line.h"
#include "app/truth_cache.h"
#include "renderer/inspect/inspector.h"
#include "renderer/measure/yardstick.h"
#include "renderer/renderer.h"

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
    if (!channel.names.empty()) look.map = ColourMap::Flags;
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

Picture bufferPicture(Renderer& renderer, const Shot& shot, PictureFormat format) {
    const Selection selection = select(renderer, shot.buffer);
    const ImageSpec& spec = renderer.flow().spec(selection.image);
    checkRange("--layer", shot.layer, spec.extent.layers, selection);
    checkRange("--level", shot.level, spec.extent.levels, selection);
    if (format != PictureFormat::Png) return rawPicture(renderer, selection, shot.layer, shot.level);
    if (!selection.channel && spec.channels.size() != 1)
        throw InputError(fmt::format("--buffer: a .png shows one channel of '{}'; its channels are {}", selection.name,
                                     fmt::join(channelNames(spec), ", ")));
    return viewedPicture(renderer, selection, shot.layer, shot.level);
}

// Without --buffer: what the window shows, or for files of floats the light before it is made a display's.
Picture framePicture(const Renderer& renderer, PictureFormat format) {
    if (format == PictureFormat::Png) return rawPicture(renderer, {"display", renderer.display(), std::nullopt}, 0, 0);
    const std::string_view linear = renderer.flow().find("lit") ? "lit" : "shadow";
    return rawPicture(renderer, select(renderer, linear), 0, 0);
}

void renderFrames(Renderer& renderer, Session& session, const Shot& shot) {
    const double end = session.time;
    for (int i = 0; i < shot.frames; ++i) {
        // Without history nothing is left of a frame but what moved since the one before.
        if (i == 1 && renderer.flow().pasts().empty()) i = std::max(i, shot.frames - 2);
        session.frame = static_cast<uint32_t>(i);
        session.time = std::max(end - (shot.frames - 1 - i) * session.timeStep, 0.0);
        renderer.render(session);
        if (i == 0 && !shot.buffer.empty()) select(renderer, shot.buffer); // before the other frames take their time
    }
}

// Beside the frame that was drawn last, which is drawn again.
void showTruth(Renderer& renderer, Session& session) {
    ProgressLine line;
    TruthFiles cache;
    const Truth truth = traceTruth(readTruthInput(renderer, session), {.cache = &cache}, &line.progress());
    session.truth = imageOf(truth, session.truthKey());
    renderer.render(session);
}

void printResult(const Options& options, const Picture& picture, const Json& facts) {
    if (!options.json) {
        fmt::print("{}: {}x{} {}\n", *options.output, picture.width, picture.height, fmt::join(picture.channels, " "));
        return;
    }
    Json json = {{"file", *options.output},
                 {"width", picture.width},
                 {"height", picture.height},
                 {"channels", picture.channels}};
    json.update(facts);
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

} // namespace

void capture(const Options& options) {
    const PictureFormat format = pictureFormat(*options.output); // an unknown ending is refused
    checkWritable(*options.output);
    Shot shot;
    Session session = makeSession(options, shot);
    if (shot.panels) fmt::print(stderr, "note: the window's panels are left out\n");
    shot.panels = false;

    const HeadlessContext context;
    Renderer renderer;
    const Json facts = factsOf(session, shot, renderer.driver());
    if (options.like)
        if (const std::string doubt = PictureFacts(*options.like).doubtAboutDriver(renderer.driver()); !doubt.empty())
            fmt::print(stderr, "note: {}\n", doubt);
    renderer.inspect({.images = !shot.buffer.empty()});
    if (shot.buffer == "shadow") session.display.show = Show::Shadow; // nothing needs to be lit
    renderFrames(renderer, session, shot);
    if (session.comparison.against == Against::Truth && shot.buffer.empty()) showTruth(renderer, session);
    const Picture picture =
        shot.buffer.empty() ? framePicture(renderer, format) : bufferPicture(renderer, shot, format);
    writePicture(*options.output, picture, facts);
    for (const std::string& message : context.messages()) fmt::print(stderr, "note: OpenGL: {}\n", message);
    printResult(options, picture, facts);
}

} // namespace penumbra
