// SPDX-License-Identifier: MIT
#include "renderer/session.h"

#include "renderer/core/paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

size_t indexOf(std::string_view id) {
    const Card* card = &findCard(id);
    const auto cards = catalogue();
    return static_cast<size_t>(std::find(cards.begin(), cards.end(), card) - cards.begin());
}

bool isSceneFile(const fs::path& file) { return file.extension() == ".glb" || file.extension() == ".gltf"; }

fs::path builtInScene(std::string_view name) {
    for (const char* ending : {".glb", ".gltf"}) {
        const fs::path file = assetFolder() / "scenes" / (std::string(name) + ending);
        if (std::error_code none; fs::is_regular_file(file, none)) return file;
    }
    return {};
}

} // namespace

TechniqueShelf::TechniqueShelf(std::string_view chosen) {
    for (const Card* card : catalogue()) techniques_.push_back(makeTechnique(*card));
    choose(chosen);
}

void TechniqueShelf::choose(std::string_view id) { chosen_ = indexOf(id); }

const Card& TechniqueShelf::card() const { return *catalogue()[chosen_]; }

ParameterSet& TechniqueShelf::parametersOf(std::string_view id) const { return techniques_[indexOf(id)]->parameters(); }

void TechniqueShelf::take(const ParameterSet& values) {
    chosen_ = indexOf(values.owner());
    parameters().copyValuesFrom(values);
}

void TechniqueShelf::assign(std::string_view assignment) const {
    const size_t equals = assignment.find('=');
    if (equals == std::string_view::npos)
        throw InputError(fmt::format("'{}' is not NAME=VALUE, such as kernel=9", assignment));
    const std::string_view name = assignment.substr(0, equals);
    const size_t dot = name.find('.');
    const bool qualified = dot != std::string_view::npos;
    const ParameterSet& set = qualified ? parametersOf(name.substr(0, dot)) : parameters();
    set.at(qualified ? name.substr(dot + 1) : name).setText(assignment.substr(equals + 1));
}

TruthKey Session::truthKey() const {
    return {scene, camera, light.shape, light.position, light.target, light.size, clip, time, ground, seed, size};
}

const TruthImage* Session::currentTruth() const { return truth && truth->key == truthKey() ? truth.get() : nullptr; }

OpenedScene::OpenedScene(std::shared_ptr<const Scene> opened) : scene(std::move(opened)) {
    Pose pose;
    evaluatePose(*scene, 0, 0, pose);
    camera = defaultCamera(*scene, pose);
    light = defaultLight(*scene, pose);
    ground = wantsGround(*scene, pose);
}

void Session::setScene(OpenedScene opened) {
    scene = std::move(opened.scene);
    camera = opened.camera;
    light = opened.light;
    furtherLights = std::move(opened.furtherLights);
    ground = opened.ground;
    clip = 0;
    time = 0;
    frame = 0;
}

std::span<const std::string_view> againstNames() {
    static constexpr std::string_view names[] = {"nothing", "truth", "technique"};
    return names;
}

std::span<const std::string_view> compareAsNames() {
    static constexpr std::string_view names[] = {"wipe", "flip", "side-by-side", "error"};
    return names;
}

std::span<const std::string_view> showNames() {
    static constexpr std::string_view names[] = {"lit", "shadow"};
    return names;
}

void changeShape(AreaLight& light, LightShape shape) {
    const bool wasAngle = light.shape == LightShape::Directional;
    const bool isAngle = shape == LightShape::Directional;
    light.shape = shape;
    if (wasAngle == isAngle) return;
    const float distance = glm::length(light.target - light.position);
    if (isAngle) {
        const float degrees = glm::degrees(2 * std::atan2(0.5f * light.size.x, distance));
        light.size = glm::vec2(std::clamp(degrees, float(limits::lightDegrees.min), float(limits::lightDegrees.max)));
    } else {
        const float metres = 2 * distance * std::tan(glm::radians(0.5f * light.size.x));
        light.size = glm::vec2(std::clamp(metres, float(limits::lightMetres.min), float(limits::lightMetres.max)));
    }
}

std::vector<std::string> builtInScenes() {
    std::vector<std::string> names;
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(assetFolder() / "scenes", none))
        if (isSceneFile(entry.path())) names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return name == "courtyard"; });
    return names;
}

fs::path findScene(std::string_view nameOrFile) {
    if (nameOrFile.find('/') == std::string_view::npos)
        if (fs::path file = builtInScene(nameOrFile); !file.empty()) return file;

    const fs::path file(nameOrFile);
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (fs::is_directory(status))
        throw InputError(fmt::format("{}: is a directory; a .gltf or .glb file was expected", nameOrFile));
    if (fs::exists(status)) return file;
    if (isSceneFile(file) || nameOrFile.find('/') != std::string_view::npos)
        throw InputError(fmt::format("{}: {}; a .gltf or .glb file was expected", nameOrFile,
                                     error ? error.message() : "No such file or directory"));
    const std::vector<std::string> names = builtInScenes();
    const std::vector<std::string_view> views(names.begin(), names.end());
    throw InputError(fmt::format("there is no scene or file '{}'{}", nameOrFile, suggestion(nameOrFile, views)));
}

} // namespace penumbra
