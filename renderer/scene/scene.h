// SPDX-License-Identifier: MIT
// A scene as plain data, as glTF describes it: metres, right-handed, +Y up. Nothing here knows OpenGL.
#pragma once

#include "renderer/scene/camera.h"
#include "renderer/scene/light.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra {

struct Bounds {
    glm::vec3 min{1e30f}, max{-1e30f};
    bool empty() const { return min.x > max.x; }
    void add(glm::vec3 p) { min = glm::min(min, p), max = glm::max(max, p); }
    void add(const Bounds& b) {
        if (!b.empty()) add(b.min), add(b.max);
    }
    glm::vec3 centre() const { return 0.5f * (min + max); }
    glm::vec3 extent() const { return max - min; }
    float diagonal() const { return empty() ? 0.0f : glm::length(max - min); }
};
Bounds transformed(const Bounds& bounds, const glm::mat4& matrix); // box around the eight moved corners

enum class Wrap { Repeat, MirroredRepeat, ClampToEdge };

// A decoded picture. 8-bit sRGB colour, linear alpha, top row first as in the file; glTF's v runs downwards.
struct TextureImage {
    std::string name;
    int width = 1, height = 1;
    std::vector<uint8_t> rgba; // 4·width·height
    Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
    bool magnifyNearest = false;
};

struct Material {
    std::string name;
    glm::vec4 baseColour{1}; // linear
    int texture = -1;        // of Scene::textures, multiplied by baseColour
    bool masked = false;     // fragments with alpha below the cutoff do not exist, in the view and in shadow maps
    float alphaCutoff = 0.5f;
    bool doubleSided = false;
    glm::vec3 emissive{0};
};

// A run of triangles of one material in the shared vertex streams. Strips and fans are already triangles.
struct Primitive {
    uint32_t firstIndex = 0, indexCount = 0; // indices are relative to firstVertex
    uint32_t firstVertex = 0, vertexCount = 0;
    int material = 0;
    Bounds bounds; // model space
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
};

struct Node {
    std::string name;
    int parent = -1;
    int mesh = -1;
    bool visible = true; // reachable from the chosen glTF scene
    glm::vec3 translation{0};
    glm::quat rotation{1, 0, 0, 0}; // w, x, y, z
    glm::vec3 scale{1};
    std::optional<glm::mat4> matrix; // instead of translation, rotation, scale
};

struct AnimationChannel {
    enum class Path { Translation, Rotation, Scale };
    enum class Interpolation { Step, Linear, CubicSpline };
    int node = 0;
    Path path = Path::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times; // seconds, increasing
    std::vector<glm::vec4>
        values; // xyz, or quaternion xyzw; cubic spline: in-tangent, value, out-tangent for each time
};

struct Animation {
    std::string name;
    float duration = 0;                     // seconds
    std::vector<AnimationChannel> channels; // sorted by node
};

struct NamedCamera {
    std::string name;
    int node = -1;
    float fovY = 45;      // degrees; of a perspective camera
    float halfHeight = 0; // orthographic: half the height that it frames [m]; 0: perspective
};

struct NamedLight {
    std::string name;
    int node = -1; // looks down −Z of the node
    glm::vec3 colour{1};
    bool everywhere = false; // a glTF point light, which has no direction of its own
    glm::vec2 size{0};       // as AreaLight::size; 0: not stated by the file
    LightShape shape = LightShape::Rectangle;
};

struct Scene {
    std::string name;                          // for people and file names: "courtyard"
    std::filesystem::path file;                // empty for scenes made in memory
    std::vector<glm::vec3> positions, normals; // one per vertex
    std::vector<glm::vec2> uvs;
    std::vector<uint32_t> indices;
    std::vector<Mesh> meshes;
    std::vector<Material> materials; // never empty
    std::vector<TextureImage> textures;
    std::vector<Node> nodes; // parents come before their children
    std::vector<Animation> animations;
    std::vector<NamedCamera> cameras;
    std::vector<NamedLight> lights;
    std::vector<std::string> notes; // what was left out or repaired, one line each, for people

    uint64_t triangleCount() const; // as drawn: over all visible nodes
};

// The matrices of one moment.
struct Pose {
    std::vector<glm::mat4> worldFromNode; // one per node
    bool operator==(const Pose&) const = default;
};
// The pose at `seconds`, clip 0 playing and repeating; scenes without animations have one pose.
void evaluatePose(const Scene& scene, double seconds, Pose& pose);

Bounds worldBounds(const Scene& scene, const Pose& pose);

// Reads .gltf (with files beside or below it, or embedded base64) and .glb. Reads only files below the scene's own
// folder and never the network. Throws InputError naming file, place and expectation. Lines and points, unknown
// optional extensions and the like are left out with a note.
Scene importGltf(const std::filesystem::path& file);

// A camera or light of the scene as it stands at the moment. An orthographic camera becomes a perspective one that
// frames the same at the scene's centre. A light keeps its direction; one without a stated size gets a twentieth of the
// scene's diagonal (directional: 2°).
Camera sceneCamera(const Scene& scene, const Pose& pose, const NamedCamera& camera);
AreaLight sceneLight(const Scene& scene, const Pose& pose, const NamedLight& light);

// The scene's first camera and light, or sensible ones from its bounds, at any scale.
Camera defaultCamera(const Scene& scene, const Pose& pose);
AreaLight defaultLight(const Scene& scene, const Pose& pose);

// The plane that a scene without a floor may be given: under its bounds, reaching far enough to catch the shadow of
// the light. It receives and does not cast.
struct Ground {
    float height = 0;    // world y [m]
    glm::vec2 centre{0}; // world x, z [m]
    float halfSize = 0;  // [m]
};
Ground groundBelow(const Scene& scene, const Pose& pose);
// Whether nothing of the scene lies below most of it, so that its shadow would fall into nothing.
bool wantsGround(const Scene& scene, const Pose& pose);

} // namespace penumbra
