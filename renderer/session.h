// SPDX-License-Identifier: MIT
// Everything that decides a picture. The command line fills one, the panels edit one, the renderer draws one.
#pragma once

#include "renderer/core/technique.h"
#include "renderer/scene/scene.h"

#include <memory>
#include <vector>

namespace penumbra {

// What the values of a session may be, both ends included.
struct Range {
    double min, max;
};
namespace limits {
inline constexpr Range pixels{1, 16384};        // of each side of the picture
inline constexpr Range coordinate{-1e6, 1e6};   // of eyes, targets and lights [m]
inline constexpr Range fovY{1, 170};            // [degrees]
inline constexpr Range lightMetres{1e-6, 1e5};  // width, height or diameter of a light
inline constexpr Range lightDegrees{1e-3, 120}; // angular diameter of a directional light
inline constexpr Range seconds{0, 1e7};         // of the animation
inline constexpr Range exposure{-20, 20};       // [stops]
inline constexpr Range ambient{0, 100};
inline constexpr Range brightness{0, 1e6}; // of a light: its intensity, and its colour in each channel
inline constexpr Range textureMebibytes{1, 1 << 20};
} // namespace limits

enum class Show { Lit, Shadow };
std::span<const std::string_view> showNames(); // "lit", "shadow"

struct DisplaySettings {
    Show show = Show::Lit;
    float exposure = 0;    // stops
    float ambient = 0.25f; // light from everywhere, relative to the area light's irradiance
};

// One instance of every technique of the catalogue, so that switching to and fro loses no value; one is chosen.
class TechniqueShelf {
public:
    explicit TechniqueShelf(std::string_view chosen = "pcss"); // soft shadows at once
    void choose(std::string_view id);                          // throws InputError
    const Card& card() const;
    Technique& technique() const { return *techniques_[chosen_]; }
    ParameterSet& parameters() const { return technique().parameters(); }
    ParameterSet& parametersOf(std::string_view id) const; // throws InputError

    // Chooses the technique that these values belong to and gives its parameters them.
    void take(const ParameterSet& values);

    // "pcf.kernel=9" or, for the chosen technique, "kernel=9". Throws InputError.
    void assign(std::string_view assignment) const;

private:
    std::vector<std::unique_ptr<Technique>> techniques_; // in the order of the catalogue
    size_t chosen_ = 0;
};

// A scene and what it starts with, which takes a while to find for a large one.
struct OpenedScene {
    std::shared_ptr<const Scene> scene;
    Camera camera;
    AreaLight light;
    std::vector<FurtherLight> furtherLights = {};
    bool ground;
    explicit OpenedScene(std::shared_ptr<const Scene> opened);
};

// What the picture sets beside the technique, which is A: the truth or technique B.
enum class Against { Nothing, Truth, Technique };
enum class CompareAs { Wipe, Flip, SideBySide, Error };
std::span<const std::string_view> againstNames();   // "nothing", "truth", "technique"
std::span<const std::string_view> compareAsNames(); // "wipe", "flip", "side-by-side", "error"
struct Comparison {
    Against against = Against::Nothing;
    CompareAs as = CompareAs::Wipe;
    float line = 0.5f;      // of the wipe: share of the picture's width, A is left of it
    bool exchanged = false; // A and B have changed places
    float gain = 1;         // of the error map: ±1 / gain has the strongest colours
    // Two whole pictures beside each other, also while one of them is still missing.
    bool sideBySide() const { return against != Against::Nothing && as == CompareAs::SideBySide; }
    bool operator==(const Comparison&) const = default;
};

// All that decides ψ*: equal keys, equal truths.
struct TruthKey {
    std::shared_ptr<const Scene> scene;
    Camera camera;
    LightShape shape;
    glm::vec3 position, target; // of the light
    glm::vec2 lightSize;
    size_t clip;
    double time;
    bool ground;
    uint32_t seed;
    glm::ivec2 size;
    bool operator==(const TruthKey&) const = default;
};

// ψ* as an image; measure/yardstick.h makes it.
struct TruthImage {
    TruthKey key; // of what it is the truth
    // Two floats a pixel, row 0 below: ψ*, and 1 where errors are counted.
    std::shared_ptr<const std::vector<float>> texels;
};

struct Session {
    std::shared_ptr<const Scene> scene;
    Camera camera;
    AreaLight light; // that is studied: ψ, the truth and errors are of it alone
    // They light the picture too, with shadows of their own by the same technique; at most mostFurtherLights.
    std::vector<FurtherLight> furtherLights;
    bool ground = false; // the extra plane below the scene
    TechniqueShelf techniques;
    DisplaySettings display;
    Comparison comparison;
    TechniqueShelf rival{"hard"};            // technique B: to begin with, what soft shadows improve on
    std::shared_ptr<const TruthImage> truth; // if it is wanted and there is one
    size_t clip = 0;                         // of the scene's animations
    double time = 0;                         // of the clip [s]
    double timeStep = 0;                     // how far it moves from frame to frame [s]; 0: a still scene
    uint32_t frame = 0;                      // frames since the last reset
    uint32_t seed = 0;
    bool progressive = false; // techniques may spread long work over frames: for a window that must stay alive
    glm::ivec2 size{1280, 720};
    uint64_t textureLimit = uint64_t{4} << 30; // bytes

    TruthKey truthKey() const;
    // The truth of the picture as it is now; null if there is none.
    const TruthImage* currentTruth() const;
    // Whether the picture shows something beside the technique.
    bool comparing() const {
        return comparison.against == Against::Technique ||
               (comparison.against == Against::Truth && currentTruth() != nullptr);
    }

    // Takes a scene and the camera, light and ground that suit it.
    void setScene(OpenedScene opened);
    void setScene(std::shared_ptr<const Scene> newScene) { setScene(OpenedScene(std::move(newScene))); }
};

// Gives a light another shape. Between metres and degrees its size is converted so that the target sees it as large.
void changeShape(AreaLight& light, LightShape shape);

// The scenes of assets/scenes by name, "courtyard" first.
std::vector<std::string> builtInScenes();
// SCENE of the command line: a file, or the name of a built-in scene. Throws InputError.
std::filesystem::path findScene(std::string_view nameOrFile);

} // namespace penumbra
