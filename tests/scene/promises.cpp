// SPDX-License-Identifier: MIT
#include "tests/scene/promises.h"

#include "renderer/core/error.h"
#include "renderer/scene/posing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::test {
namespace {

template <int N> bool finite(const glm::vec<N, float>& v) {
    for (int i = 0; i < N; ++i)
        if (!std::isfinite(v[i])) return false;
    return true;
}
bool finite(const glm::mat4& m) { return finite(m[0]) && finite(m[1]) && finite(m[2]) && finite(m[3]); }
bool finite(const Bounds& b) { return b.empty() || (finite(b.min) && finite(b.max) && std::isfinite(b.diagonal())); }

// Of a list with `size` elements; in 64 bits, so that no sum wraps around.
bool isInside(uint64_t first, uint64_t count, size_t size) { return first + count <= size; }

void checkPrimitive(const Scene& scene, const Primitive& p) {
    ensure(p.indexCount > 0 && p.indexCount % 3 == 0, "indices are whole triangles");
    ensure(isInside(p.firstIndex, p.indexCount, scene.indices.size()), "indices are there");
    ensure(isInside(p.firstVertex, p.vertexCount, scene.positions.size()), "vertices are there");
    ensure(p.material >= 0 && size_t(p.material) < scene.materials.size(), "materials are there");
    ensure(p.influenceSets <= 2, "at most eight joints pull on a vertex");
    ensure(isInside(p.firstInfluence, uint64_t(p.influenceSets) * p.vertexCount, scene.influences.size()),
           "influences are there");
    ensure(isInside(p.firstDelta, uint64_t(p.morphTargets) * p.vertexCount, scene.morphDeltas.size()),
           "morph targets are there");
    ensure(p.morphBounds.size() == p.morphTargets, "morph targets have bounds");
    ensure(finite(p.bounds) && !p.bounds.empty(), "primitives have bounds");
    for (uint32_t i = 0; i < p.indexCount; ++i)
        ensure(scene.indices[p.firstIndex + i] < p.vertexCount, "indices are those of the primitive's vertices");
    for (size_t v = 0; v < p.vertexCount && p.influenceSets > 0; ++v) {
        float sum = 0;
        for (uint32_t s = 0; s < p.influenceSets; ++s) {
            const glm::vec4 w = scene.influences[p.firstInfluence + size_t(s) * p.vertexCount + v].weights;
            ensure(glm::all(glm::greaterThanEqual(w, glm::vec4(0))), "weights of joints are not negative");
            sum += w.x + w.y + w.z + w.w;
        }
        ensure(std::abs(sum - 1) < 1e-5f, "weights of joints sum to 1");
    }
}

void checkData(const Scene& scene) {
    ensure(!scene.materials.empty(), "there is a material");
    ensure(scene.normals.size() == scene.positions.size(), "vertices have normals");
    ensure(scene.uvs.size() == scene.positions.size(), "vertices have texture coordinates");
    ensure(scene.colours.empty() || scene.colours.size() == scene.positions.size(),
           "all vertices or none have colours");
    for (const glm::vec3& position : scene.positions) ensure(finite(position), "positions are finite");
    for (const glm::vec2& uv : scene.uvs) ensure(finite(uv), "texture coordinates are finite");
    for (const glm::vec3& normal : scene.normals)
        ensure(normal == glm::vec3(0) || std::abs(glm::length(normal) - 1) < 1e-3f, "normals are unit vectors or zero");
    for (const MorphDelta& delta : scene.morphDeltas)
        ensure(finite(delta.position) && finite(delta.normal), "morph targets are finite");
    for (const Material& m : scene.materials) {
        ensure(m.texture >= -1 && m.texture < int(scene.textures.size()), "textures are there");
        ensure(finite(m.baseColour) && finite(m.emissive) && std::isfinite(m.alphaCutoff), "materials are finite");
    }
    for (const TextureImage& image : scene.textures)
        ensure(image.width > 0 && image.height > 0 &&
                   image.rgba.size() == size_t(4) * size_t(image.width) * size_t(image.height),
               "pictures have all of their texels");
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& primitive : mesh.primitives) checkPrimitive(scene, primitive);
    for (const Skin& skin : scene.skins) {
        ensure(skin.jointFromMesh.size() == skin.joints.size(), "joints have matrices");
        for (const int joint : skin.joints)
            ensure(joint >= 0 && size_t(joint) < scene.nodes.size(), "joints are nodes");
    }
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        ensure(node.parent < int(i), "parents come before their children");
        ensure(node.mesh < int(scene.meshes.size()) && node.skin < int(scene.skins.size()),
               "meshes and skins are there");
        if (node.mesh < 0) continue;
        for (const Primitive& primitive : scene.meshes[size_t(node.mesh)].primitives) {
            ensure(isInside(node.firstWeight, primitive.morphTargets, scene.restWeights.size()), "weights are there");
            if (node.skin < 0) continue;
            for (const Primitive::JointBounds& pulled : primitive.jointBounds)
                ensure(pulled.joint < scene.skins[size_t(node.skin)].joints.size(), "joints are of the skin");
        }
    }
    for (const Animation& animation : scene.animations)
        for (const AnimationChannel& channel : animation.channels) {
            const bool cubic = channel.interpolation == AnimationChannel::Interpolation::CubicSpline;
            ensure(!channel.times.empty() && std::is_sorted(channel.times.begin(), channel.times.end()),
                   "times increase");
            ensure(channel.values.size() == channel.times.size() * channel.width * (cubic ? 3 : 1),
                   "channels have a value for each time");
        }
    for (const std::string& note : scene.notes) ensure(note.find('\n') == std::string::npos, "a note is one line");
}

void checkMoment(const Scene& scene, size_t clip, double seconds) {
    Pose pose;
    evaluatePose(scene, clip, seconds, pose);
    for (const glm::mat4& matrix : pose.worldFromNode) ensure(finite(matrix), "nodes have finite matrices");
    for (const glm::mat4& matrix : pose.worldFromMesh) ensure(finite(matrix), "joints have finite matrices");
    for (const float weight : pose.morphWeights) ensure(std::isfinite(weight), "weights of targets are finite");
    std::vector<glm::vec3> positionsWorld;
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        if (scene.nodes[n].mesh < 0 || !scene.nodes[n].visible) continue;
        for (const Primitive& primitive : scene.meshes[size_t(scene.nodes[n].mesh)].primitives) {
            ensure(finite(posedBounds(scene, pose, n, primitive)), "posed bounds are finite");
            posedPositions(scene, pose, n, primitive, positionsWorld);
            for (const glm::vec3& position : positionsWorld) ensure(finite(position), "posed vertices are finite");
        }
    }
    ensure(finite(worldBounds(scene, pose)), "the bounds are finite");

    const auto checkCamera = [](const Camera& camera) {
        ensure(std::isfinite(glm::distance(camera.eye, camera.target)), "cameras stand somewhere");
        ensure(camera.eye != camera.target, "cameras look somewhere");
        ensure(finite(makeView(camera, {640, 360}, 0.1f, 100).clipFromWorld), "cameras have a finite matrix");
    };
    const auto checkLight = [](const AreaLight& light) {
        ensure(std::isfinite(glm::distance(light.position, light.target)), "lights stand somewhere");
        ensure(light.position != light.target, "lights shine somewhere");
        ensure(light.size.x > 0 && light.size.y > 0 && finite(light.size), "lights have a size");
        ensure(finite(lightFromWorld(light)), "lights have a finite matrix");
    };
    checkCamera(defaultCamera(scene, pose));
    checkLight(defaultLight(scene, pose));
    for (const NamedCamera& camera : scene.cameras) checkCamera(sceneCamera(scene, pose, camera));
    for (const NamedLight& light : scene.lights) checkLight(sceneLight(scene, pose, light));
    const Ground ground = groundBelow(scene, pose);
    ensure(std::isfinite(ground.height) && finite(ground.centre), "the ground lies somewhere");
    ensure(ground.halfSize > 0 && std::isfinite(ground.halfSize), "the ground has a size");
    wantsGround(scene, pose);
}

} // namespace

void checkPromises(const Scene& scene) {
    checkData(scene);
    checkMoment(scene, scene.animations.size(), 0); // at rest
    constexpr size_t mostClips = 8;                 // a hostile file may have thousands
    for (size_t clip = 0; clip < std::min(scene.animations.size(), mostClips); ++clip)
        for (const double share : {0.0, 0.37, 0.999, 1000.3})
            checkMoment(scene, clip, share * double(scene.animations[clip].duration));
}

} // namespace penumbra::test
