// SPDX-License-Identifier: MIT
// A scene as plain data, as glTF describes it: metres, right-handed, +Y up. Nothing here knows OpenGL.
#pragma once

#include "renderer/core/progress.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/light.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_precision.hpp>

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
    bool unlit = false; // shows its base colour as it is, in light and in shadow
    glm::vec3 emissive{0};
};
// The least alpha of texture times vertex colour with which a point of a masked material exists.
float leastAlpha(const Material& material);

// Four joints that pull on a vertex, as indices into Skin::joints, and how strongly; a second set follows for vertices
// of up to eight. The weights of a vertex are not negative and sum to 1.
struct Influences {
    glm::u16vec4 joints{0};
    glm::vec4 weights{0};
};

// What a morph target of weight 1 adds to a vertex.
struct MorphDelta {
    glm::vec3 position{0}, normal{0};
};

// A run of triangles of one material in the shared vertex streams. Strips and fans are already triangles.
struct Primitive {
    uint32_t firstIndex = 0, indexCount = 0; // indices are relative to firstVertex
    uint32_t firstVertex = 0, vertexCount = 0;
    int material = 0;
    bool closed = false;      // a closed surface without holes in its material, see closed_surface.h
    bool shadesItself = true; // false: no light that it faces is hidden by another part of it
    Bounds bounds;            // model space, without morph targets
    std::vector<Bounds>
        parts; // that hold it more closely, if it is rigid; see part_bounds.h. Empty: only `bounds` does

    uint32_t influenceSets = 0;  // 0: no skin, 1: up to four joints a vertex, 2: up to eight
    uint32_t firstInfluence = 0; // of Scene::influences: set s of vertex v is at firstInfluence + s·vertexCount + v
    uint32_t morphTargets = 0;
    uint32_t firstDelta = 0; // of Scene::morphDeltas: target t of vertex v is at firstDelta + t·vertexCount + v
    std::vector<Bounds> morphBounds; // of the position deltas of each target
    // The vertices that a joint pulls on, in the mesh's space without morph targets.
    struct JointBounds {
        uint32_t joint;
        Bounds bounds;
    };
    std::vector<JointBounds> jointBounds;
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
};

struct Skin {
    std::string name;
    std::vector<int> joints;              // nodes
    std::vector<glm::mat4> jointFromMesh; // inverse bind matrices, one per joint
    uint32_t firstMatrix = 0;             // of Pose::worldFromMesh
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
    int skin = -1;                   // its mesh is then placed by the joints alone
    uint32_t firstWeight = 0;        // of Scene::restWeights and Pose::morphWeights, one per morph target of its mesh
};

struct AnimationChannel {
    enum class Path { Translation, Rotation, Scale, Weights };
    enum class Interpolation { Step, Linear, CubicSpline };
    int node = 0;
    Path path = Path::Translation;
    Interpolation interpolation = Interpolation::Linear;
    uint32_t width = 3;        // numbers a value: 3, 4 of a rotation (quaternion xyzw), as many as there are weights
    std::vector<float> times;  // seconds, increasing
    std::vector<float> values; // `width` a time; cubic spline: in-tangent, value, out-tangent for each time
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
    std::string name;                  // for people and file names: "courtyard"
    std::string description;           // what the file says of itself, in a line (asset.extras.description), or empty
    std::filesystem::path file;        // empty for scenes made in memory
    uint32_t checksum = 0;             // CRC-32 of the file and of those that it names
    std::vector<glm::vec3> positions;  // one per vertex
    std::vector<glm::vec3> normals;    // one per vertex; zero: flat, the triangle's own
    std::vector<glm::vec2> uvs;        // one per vertex
    std::vector<glm::u16vec4> colours; // linear, 65535 is 1; one per vertex, or empty where no mesh has any
    std::vector<Influences> influences;
    std::vector<MorphDelta> morphDeltas;
    std::vector<uint32_t> indices;
    std::vector<Mesh> meshes;
    std::vector<Skin> skins;
    std::vector<float> restWeights;  // of all morph targets of all nodes
    std::vector<Material> materials; // never empty
    std::vector<TextureImage> textures;
    std::vector<Node> nodes; // parents come before their children
    std::vector<Animation> animations;
    std::vector<NamedCamera> cameras;
    std::vector<NamedLight> lights;
    std::vector<std::string> notes; // what was left out or repaired, one line each, for people

    // What the file offers to choose from, and what was chosen.
    std::vector<std::string> sceneNames, variantNames;
    int chosenScene = 0;
    int chosenVariant = -1; // −1: the materials that meshes have without a variant

    uint64_t triangleCount() const; // as drawn: over all visible nodes
    // The clip of that name. Throws InputError with the names that there are.
    size_t findClip(std::string_view name) const;
    float duration(size_t clip) const {
        return clip < animations.size() ? animations[clip].duration : 0;
    } // [s]; 0: still
};

// One moment of a scene.
struct Pose {
    std::vector<glm::mat4> worldFromNode; // one per node
    std::vector<glm::mat4> worldFromMesh; // one per joint of every skin, as that joint alone places the mesh
    std::vector<float> morphWeights;      // as Scene::restWeights
    bool operator==(const Pose&) const = default;
};
// The pose at `seconds` of a clip that repeats. A clip that is not there: the scene at rest.
void evaluatePose(const Scene& scene, size_t clip, double seconds, Pose& pose);

Bounds worldBounds(const Scene& scene, const Pose& pose);

// What to take of a file that offers several scenes, or variants of its materials (KHR_materials_variants), by name.
struct ImportChoice {
    std::string scene;   // empty: the file's default scene
    std::string variant; // empty: none
};

// Reads .gltf (with files beside or below it, or embedded base64) and .glb. Reads only files below the scene's own
// folder and never the network. Throws InputError naming file, place and expectation; Cancelled if that was asked for.
// Lines and points, unknown optional extensions and the like are left out with a note.
Scene importGltf(const std::filesystem::path& file, const ImportChoice& choice = {}, Progress* progress = nullptr);
// The same of bytes that were read already; `file` names them, and what they refer to lies beside it.
Scene importGltf(const std::filesystem::path& file, std::vector<uint8_t> bytes);

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
