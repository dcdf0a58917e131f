// SPDX-License-Identifier: MIT
#include "app/command_line.h"

#include "app/file_io.h"
#include "app/preset.h"
#include "renderer/core/paths.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace penumbra {
namespace {

// --- values --------------------------------------------------------------------------------------------------------

[[noreturn]] void refuse(std::string_view name, std::string_view text, std::string_view expected) {
    throw InputError(fmt::format("{}: '{}' is not {}", name, text, expected));
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> pieces;
    for (size_t end; (end = text.find(separator)) != std::string_view::npos; text.remove_prefix(end + 1))
        pieces.push_back(text.substr(0, end));
    pieces.push_back(text);
    return pieces;
}

template <class Number> std::optional<Number> parseNumber(std::string_view text) {
    Number number{};
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || stopped != end) return std::nullopt;
    return number;
}

// A whole number in [min, max].
long long integerOption(std::string_view name, std::string_view text, long long min, long long max) {
    const std::optional<long long> value = parseNumber<long long>(text);
    if (!value || *value < min || *value > max) refuse(name, text, fmt::format("a whole number in {}..{}", min, max));
    return *value;
}

bool contains(Range range, double value) { return value >= range.min && value <= range.max; } // false for NaN

// Numbers with commas between them, as many as `least` to `most`.
std::vector<float> numbers(std::string_view name, std::string_view text, size_t least, size_t most,
                           std::string_view expected) {
    std::vector<float> values;
    for (const std::string_view piece : split(text, ',')) {
        const std::optional<float> value = parseNumber<float>(piece);
        if (!value || !std::isfinite(*value)) refuse(name, text, expected);
        values.push_back(*value);
    }
    if (values.size() < least || values.size() > most) refuse(name, text, expected);
    return values;
}

double realOption(std::string_view name, const std::optional<std::string>& text, Range range, double fallback) {
    if (!text) return fallback;
    const std::optional<double> value = parseNumber<double>(*text);
    if (!value || !contains(range, *value))
        refuse(name, *text, fmt::format("a number in {:g}..{:g}", range.min, range.max));
    return *value;
}

// The index of the text among `names`.
size_t nameOption(std::string_view option, std::string_view text, std::span<const std::string_view> names) {
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end())
        throw InputError(
            fmt::format("{}: '{}' is not one of {}{}", option, text, fmt::join(names, ", "), suggestion(text, names)));
    return static_cast<size_t>(found - names.begin());
}

// --- the options: name, value, help and where they go, once --------------------------------------------------------

struct ValueOption {
    const char* name;
    const char* value;
    const char* help;
    std::optional<std::string> Options::*member;
};

constexpr ValueOption commonOptions[] = {
    {"--technique", "ID", "shadow technique; 'penumbra list' names them", &Options::technique},
    {"--like", "PICTURE", "everything as in a .png or .exr of ours; other options override it", &Options::like},
    {"--preset", "NAME|FILE", "technique and parameters from a preset", &Options::preset},
    {"--view", "NAME",
     "a camera and a light of assets/views.json, for a budget several: NAME,NAME; other options override it",
     &Options::view},
    {"--size", "WxH", "size of the picture in pixels", &Options::size},
    {"--seed", "N", "start of the random sequences", &Options::seed},
    {"--camera", "X,Y,Z,TX,TY,TZ[,FOV]", "eye and target in metres, vertical field of view in degrees",
     &Options::camera},
    {"--light", "X,Y,Z,TX,TY,TZ", "centre of the light and the point that it faces, in metres", &Options::light},
    {"--light-shape", "SHAPE", "rectangle, disk or directional", &Options::lightShape},
    {"--light-size", "W[,H]",
     "full width and height or a disk's diameter in metres; a directional light's angular diameter in degrees",
     &Options::lightSize},
    {"--ground", "on|off", "a plane below the scene; without this, where the scene has no floor", &Options::ground},
    {"--scene-name", "NAME", "which of the file's scenes; without this, the one it starts with", &Options::sceneName},
    {"--variant", "NAME", "which of the file's material variants", &Options::variant},
    {"--clip", "NAME", "which of the scene's animations; without this, the first", &Options::clip},
    {"--time", "T", "time of the animation in seconds", &Options::time},
    {"--show", "lit|shadow", "the lit picture, or the shadows alone: white is lit", &Options::show},
    {"--exposure", "STOPS", "brightness of the picture", &Options::exposure},
    {"--ambient", "FRACTION", "light from everywhere, relative to the light's", &Options::ambient},
    {"--texture-limit", "MIB", "most memory that textures may take", &Options::textureLimit},
};

constexpr ValueOption captureOptions[] = {
    {"-o,--output", "FILE", "the picture to write: .png, .exr, .pfm or .npy", &Options::output},
    {"--buffer", "LABEL[.CHANNEL]", "write this buffer instead of the picture; 'shadow' is the shadow image",
     &Options::buffer},
    {"--truth", "alone|wipe|side-by-side|error[:GAIN]",
     "trace the truth and show it alone or beside the technique, or the error, GAIN 1..100 times as strong",
     &Options::truth},
};

constexpr ValueOption measureOptions[] = {
    {"--techniques", "ID,ID...|all", "what is measured; without this --technique, or all", &Options::techniques},
    {"--path", "FILE|orbit|walk",
     "move the camera: along lines of T,X,Y,Z,TX,TY,TZ[,FOV], around the target or forwards", &Options::path},
    {"--motion", "EVENT",
     "after a rest: camera-pan, camera-jump, caster-moves, caster-stops, light-moves or light-grows; every frame has a "
     "truth of its own",
     &Options::motion},
    {"--error", "truth|irradiance",
     "what errors are of: ψ in the picture against the truth, or the light's power on all surfaces that face it, "
     "against percentage-closer filtering with the same kernel",
     &Options::error},
    {"--against", "ray|samples", "the truth: traced rays, or shadow maps from many points of the light",
     &Options::against},
    {"--shard", "I/N", "only the I-th of N parts of the combinations, for N machines", &Options::shard},
    {"--budget-ms", "X", "search the free parameters for the least error at a cost of at most X ms",
     &Options::budgetMs},
    {"--budget-rmse", "Y", "search the free parameters for the least cost at an error of at most Y",
     &Options::budgetRmse},
    {"--free", "NAME[=FROM:TO],...", "parameters that a search for a budget may turn, NAME as with --set",
     &Options::free},
};

struct ListOption {
    const char* name;
    const char* value;
    const char* help;
    std::vector<std::string> Options::*member;
    bool several; // values after one name
};

constexpr ListOption setOption = {"--set", "NAME=VALUE",
                                  "a parameter: TECHNIQUE.PARAMETER=VALUE, or PARAMETER=VALUE of the chosen technique; "
                                  "may be given several times",
                                  &Options::assignments, false};
constexpr ListOption furtherLightOption = {
    "--further-light", "X,Y,Z,TX,TY,TZ",
    "another light like the first and half as bright, at a place of its own; up to three. ψ and errors are of the "
    "first",
    &Options::furtherLights, false};
constexpr ListOption measureLists[] = {
    {"--sweep", "NAME=VALUES",
     "a row for each of FROM:TO:STEPS, FROM:TO:STEPS:log or V1,V2,V3 of a parameter; several make every combination",
     &Options::sweeps, false},
    {"--merge", "FILE...", "join what was measured, as JSON, in parts", &Options::merged, true},
};

struct CountOption {
    const char* name;
    const char* help;
    int min, max;
    std::optional<int> Options::*member;
};

constexpr CountOption frameOption = {"--frames", "number of frames; the last one is the result", 1, 1000000,
                                     &Options::frames};
constexpr CountOption measureCounts[] = {
    {"--repeat", "how often all frames are measured", 1, 10000, &Options::repeat},
    {"--samples", "of the truth: rays a pixel, or shadow maps", 1, 65536, &Options::samples},
};
constexpr CountOption textureOptions[] = {
    {"--layer", "layer of the buffer, from 0", 0, 2047, &Options::layer},
    {"--level", "mip level of the buffer, from 0", 0, 14, &Options::level},
};

void addValueOption(CLI::App& app, const ValueOption& option, Options& options) {
    app.add_option_function<std::string>(
           option.name, [&options, member = option.member](const std::string& text) { options.*member = text; },
           option.help)
        ->type_name(option.value);
}

void addCountOption(CLI::App& app, const CountOption& option, Options& options) {
    app.add_option_function<std::string>(
           option.name,
           [&options, option](const std::string& text) {
               options.*option.member = static_cast<int>(integerOption(option.name, text, option.min, option.max));
           },
           option.help)
        ->type_name("N");
}

void addListOption(CLI::App& app, const ListOption& option, Options& options) {
    app.add_option(option.name, options.*option.member, option.help)
        ->type_name(option.value)
        ->allow_extra_args(option.several);
}

void addCommonOptions(CLI::App& app, Options& options) {
    app.add_option_function<std::string>(
           "SCENE", [&options](const std::string& text) { options.scene = text; },
           "a .gltf or .glb file, or the name of a built-in scene")
        ->type_name("");
    for (const ValueOption& option : commonOptions) addValueOption(app, option, options);
    addCountOption(app, frameOption, options);
    addListOption(app, setOption, options);
    addListOption(app, furtherLightOption, options);
    app.add_flag("--play", options.play, "let time run, 1/60 s a frame");
    app.add_flag("--json", options.json, "print results as JSON");
    app.allow_extras(); // so that we can name the nearest option ourselves
}

void refuseExtras(const CLI::App& app) {
    const std::vector<std::string> extras = app.remaining();
    if (extras.empty()) return;
    const std::string given = extras[0].substr(0, extras[0].find('='));
    if (!given.starts_with('-')) throw InputError(fmt::format("unexpected argument '{}'", given));
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    const std::vector<std::string_view> views(names.begin(), names.end());
    throw InputError(fmt::format("unknown option '{}'{}", given, suggestion(given, views)));
}

// --- what the options mean for a session ---------------------------------------------------------------------------

glm::ivec2 parseSize(std::string_view text) {
    const std::vector<std::string_view> pieces = split(text, 'x');
    std::vector<int> sides;
    for (const std::string_view piece : pieces)
        if (const std::optional<int> side = parseNumber<int>(piece); side && contains(limits::pixels, *side))
            sides.push_back(*side);
    if (pieces.size() != 2 || sides.size() != 2)
        refuse("--size", text,
               fmt::format("WIDTHxHEIGHT in pixels, each in {:g}..{:g}", limits::pixels.min, limits::pixels.max));
    return {sides[0], sides[1]};
}

// Two points and perhaps a seventh number.
std::vector<float> parseLook(std::string_view name, std::string_view text, bool withAngle) {
    const std::string expected = withAngle ? "X,Y,Z,TX,TY,TZ or X,Y,Z,TX,TY,TZ,FOV" : "X,Y,Z,TX,TY,TZ";
    std::vector<float> values = numbers(name, text, 6, withAngle ? 7 : 6, expected);
    if (!std::all_of(values.begin(), values.begin() + 6, [](float v) { return contains(limits::coordinate, v); }))
        refuse(name, text, fmt::format("{} within {:g} m", expected, limits::coordinate.max));
    if (std::equal(values.begin(), values.begin() + 3, values.begin() + 3))
        refuse(name, text, fmt::format("{} of two different points", expected));
    return values;
}

void placeCamera(Camera& camera, std::string_view text) {
    const std::vector<float> v = parseLook("--camera", text, true);
    camera.eye = {v[0], v[1], v[2]};
    camera.target = {v[3], v[4], v[5]};
    camera.up = {0, 1, 0};
    if (v.size() < 7) return;
    if (!contains(limits::fovY, v[6]))
        refuse("--camera", text,
               fmt::format("a view with FOV in {:g}..{:g} degrees", limits::fovY.min, limits::fovY.max));
    camera.fovY = v[6];
}

void sizeLight(AreaLight& light, std::string_view text) {
    const bool angle = light.shape == LightShape::Directional;
    const Range range = angle ? limits::lightDegrees : limits::lightMetres;
    const bool rectangle = light.shape == LightShape::Rectangle;
    const std::string expected = fmt::format("{}, {:g}..{:g} {}", rectangle ? "W or W,H" : "one diameter", range.min,
                                             range.max, angle ? "degrees" : "m");
    const std::vector<float> v = numbers("--light-size", text, 1, rectangle ? 2 : 1, expected);
    for (const float side : v)
        if (!contains(range, side)) refuse("--light-size", text, expected);
    light.size = {v.front(), v.back()};
}

void stand(AreaLight& light, std::string_view option, std::string_view place) {
    const std::vector<float> v = parseLook(option, place, false);
    light.position = {v[0], v[1], v[2]};
    light.target = {v[3], v[4], v[5]};
}

void placeLight(AreaLight& light, const Options& options) {
    if (options.light) stand(light, "--light", *options.light);
    if (options.lightShape)
        changeShape(light,
                    static_cast<LightShape>(nameOption("--light-shape", *options.lightShape, lightShapeNames())));
    if (options.lightSize) sizeLight(light, *options.lightSize);
}

void adjustDisplay(DisplaySettings& display, const Options& options) {
    if (options.show) display.show = static_cast<Show>(nameOption("--show", *options.show, showNames()));
    display.exposure =
        static_cast<float>(realOption("--exposure", options.exposure, limits::exposure, display.exposure));
    display.ambient = static_cast<float>(realOption("--ambient", options.ambient, limits::ambient, display.ambient));
}

// alone|wipe|side-by-side|error[:GAIN]
void compareWithTruth(Comparison& comparison, std::string_view text) {
    static constexpr std::string_view names[] = {"wipe", "alone", "side-by-side", "error"};
    static constexpr CompareAs ways[] = {CompareAs::Wipe, CompareAs::Flip, CompareAs::SideBySide, CompareAs::Error};
    const size_t colon = text.find(':');
    const size_t way = nameOption("--truth", text.substr(0, colon), names);
    comparison = {.against = Against::Truth, .as = ways[way], .exchanged = ways[way] == CompareAs::Flip};
    if (colon == std::string_view::npos) return;
    const std::optional<float> gain = parseNumber<float>(text.substr(colon + 1));
    if (comparison.as != CompareAs::Error || !gain || !contains(Range{1, 100}, *gain))
        refuse("--truth", text, "alone, wipe, side-by-side, error or error:GAIN with a gain of 1..100");
    comparison.gain = *gain;
}

// A listing needs a scene only if one was named.
std::shared_ptr<const Scene> openScene(const Options& options, const std::optional<PictureFacts>& like) {
    auto scene = std::make_shared<Scene>();
    if (!options.scene && !like && options.verb == Verb::List) {
        scene->materials.emplace_back();
        return scene;
    }
    const std::vector<std::string> builtIn = builtInScenes();
    if (!options.scene && !like && builtIn.empty())
        throw InputError("there are no built-in scenes; name a .gltf or .glb file");
    const bool fromPicture = like && !options.scene;
    ImportChoice choice = fromPicture ? like->choice() : ImportChoice();
    if (options.sceneName) choice.scene = *options.sceneName;
    if (options.variant) choice.variant = *options.variant;
    *scene = importGltf(fromPicture ? like->scene() : findScene(options.scene ? *options.scene : builtIn[0]), choice);
    for (const std::string& note : scene->notes) fmt::print(stderr, "note: {}\n", note);
    if (fromPicture)
        if (const std::string doubt = like->doubtAboutScene(*scene); !doubt.empty())
            fmt::print(stderr, "note: {}\n", doubt);
    return scene;
}

// A view's own scene, and every option that it tells and the command line does not.
Options withView(const Options& given) {
    Options options = given;
    if (!given.view) return options;
    const std::filesystem::path file = assetFolder() / "views.json";
    try {
        const auto views = nlohmann::json::parse(readFile(file, 1 << 20));
        std::vector<std::string_view> names;
        for (auto view = views.begin(); view != views.end(); ++view) names.push_back(view.key());
        nameOption("--view", *given.view, names);
        const auto& view = views[*given.view];
        for (const auto& [key, value] : view.items()) {
            if (key == "scene") {
                if (!given.scene) options.scene = value.get<std::string>();
                continue;
            }
            const auto option = std::find_if(std::begin(commonOptions), std::end(commonOptions),
                                             [&](const ValueOption& o) { return o.name == "--" + key; });
            if (option == std::end(commonOptions)) throw InputError(fmt::format("'{}' is no option", key));
            if (!(options.*option->member)) options.*option->member = value.get<std::string>();
        }
    } catch (const nlohmann::json::exception& error) {
        throw InputError(fmt::format("{}: {}", file.string(), error.what()));
    }
    return options;
}

std::string oneLine(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

} // namespace

std::optional<Options> parseCommandLine(int argc, const char* const* argv) {
    Options options;
    CLI::App app("Penumbra: tune real-time shadows. Without a verb it opens a window.", "penumbra");
    app.set_version_flag("--version", "penumbra " PENUMBRA_VERSION);
    addCommonOptions(app, options);
    CLI::App* captureVerb = app.add_subcommand("capture", "render without a window and write a picture or a buffer");
    addCommonOptions(*captureVerb, options);
    for (const ValueOption& option : captureOptions) addValueOption(*captureVerb, option, options);
    for (const CountOption& option : textureOptions) addCountOption(*captureVerb, option, options);
    CLI::App* measureVerb =
        app.add_subcommand("measure", "cost and error of techniques and sweeps of their parameters");
    addCommonOptions(*measureVerb, options);
    for (const ValueOption& option : measureOptions) addValueOption(*measureVerb, option, options);
    for (const CountOption& option : measureCounts) addCountOption(*measureVerb, option, options);
    for (const ListOption& option : measureLists) addListOption(*measureVerb, option, options);
    measureVerb->add_flag("--csv", options.csv, "print results as comma-separated values");
    CLI::App* listVerb = app.add_subcommand("list", "techniques, parameters, buffers, scenes and presets");
    addCommonOptions(*listVerb, options);
    for (CLI::App* verb : {captureVerb, measureVerb, listVerb}) verb->group("Verbs");
    app.require_subcommand(0, 1);

    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& wish) { // --help, --version
        app.exit(wish);
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        throw InputError(oneLine(error.what()));
    }
    refuseExtras(app);
    if (captureVerb->parsed()) options.verb = Verb::Capture;
    if (measureVerb->parsed()) options.verb = Verb::Measure;
    if (listVerb->parsed()) options.verb = Verb::List;
    for (const CLI::App* verb : app.get_subcommands()) refuseExtras(*verb);
    if (options.verb == Verb::Capture && !options.output)
        throw InputError("capture: -o FILE was expected, the picture to write");
    return options;
}

Session makeSession(const Options& given, Shot& shot) {
    const Options options = withView(given);
    std::optional<PictureFacts> like;
    if (options.like) like.emplace(*options.like);
    Session session;
    session.setScene(openScene(options, like));
    if (like) shot = like->restore(session);
    if (options.frames) shot.frames = *options.frames;
    if (options.buffer) shot.buffer = *options.buffer;
    if (options.layer) shot.layer = *options.layer;
    if (options.level) shot.level = *options.level;
    if (options.preset) loadPreset(findPreset(*options.preset), session.techniques);
    if (options.technique) session.techniques.choose(*options.technique);
    for (const std::string& assignment : options.assignments) session.techniques.assign(assignment);

    if (options.camera) placeCamera(session.camera, *options.camera);
    placeLight(session.light, options);
    if (options.furtherLights.size() > mostFurtherLights)
        throw InputError(fmt::format("--further-light: at most {} were expected", mostFurtherLights));
    if (!options.furtherLights.empty()) session.furtherLights.clear();
    for (const std::string& place : options.furtherLights) {
        FurtherLight further{session.light};
        further.light.intensity *= furtherLightShare;
        stand(further.light, "--further-light", place);
        session.furtherLights.push_back(further);
    }
    static constexpr std::string_view switches[] = {"off", "on"};
    if (options.ground) session.ground = nameOption("--ground", *options.ground, switches) == 1;
    if (options.size) session.size = parseSize(*options.size);
    adjustDisplay(session.display, options);
    if (options.truth) compareWithTruth(session.comparison, *options.truth);
    if (options.clip) session.clip = session.scene->findClip(*options.clip);
    if (options.play) session.timeStep = 1.0 / 60;
    if (options.time || !like)
        session.time = realOption("--time", options.time, limits::seconds, 0) + (shot.frames - 1) * session.timeStep;
    if (options.seed) {
        constexpr uint32_t largest = std::numeric_limits<uint32_t>::max();
        session.seed = static_cast<uint32_t>(integerOption("--seed", *options.seed, 0, largest));
    }
    if (options.textureLimit)
        session.textureLimit =
            static_cast<uint64_t>(integerOption("--texture-limit", *options.textureLimit, limits::textureMebibytes.min,
                                                limits::textureMebibytes.max))
            << 20;
    return session;
}

} // namespace penumbra
