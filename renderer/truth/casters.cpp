// SPDX-License-Identifier: MIT
#include "renderer/truth/casters.h"

#include "renderer/core/error.h"
#include "renderer/core/hash.h"
#include "renderer/scene/posing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

int wrapped(int i, int size, Wrap wrap) {
    if (wrap == Wrap::ClampToEdge) return std::clamp(i, 0, size - 1);
    const int period = wrap == Wrap::Repeat ? size : 2 * size;
    const int within = ((i % period) + period) % period;
    return within < size ? within : 2 * size - 1 - within;
}

// The texture's alpha on its finest level, as shaders/shadow_map.glsl reads it: magnified, linearly or not at all.
float alphaAt(const TextureImage& image, glm::vec2 uv) {
    // Far outside, a float no longer tells texels apart.
    constexpr float farthest = 1 << 20;
    const glm::vec2 texels = glm::clamp(uv, -farthest, farthest) * glm::vec2(image.width, image.height);
    const auto texel = [&](int x, int y) {
        const int i = wrapped(x, image.width, image.wrapU), j = wrapped(y, image.height, image.wrapV);
        return static_cast<float>(
            image.rgba[4 * (static_cast<size_t>(j) * static_cast<size_t>(image.width) + static_cast<size_t>(i)) + 3]);
    };
    if (image.magnifyNearest)
        return texel(static_cast<int>(std::floor(texels.x)), static_cast<int>(std::floor(texels.y))) / 255;
    const glm::vec2 corner = glm::floor(texels - 0.5f), f = texels - 0.5f - corner;
    const int x = static_cast<int>(corner.x), y = static_cast<int>(corner.y);
    return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), f.x), glm::mix(texel(x, y + 1), texel(x + 1, y + 1), f.x),
                    f.y) /
           255;
}

[[noreturn]] void fail(RTCError error) {
    throw InputError(fmt::format("the scene cannot be ray traced: {}",
                                 error == RTC_ERROR_OUT_OF_MEMORY     ? "out of memory"
                                 : error == RTC_ERROR_UNSUPPORTED_CPU ? "Embree does not know this processor"
                                                                      : "Embree failed"));
}

// Positive if the ray of a lane goes the way that Embree's normal of what it hits points.
float towardsFront(const RTCFilterFunctionNArguments& arguments, unsigned lane) {
    const unsigned n = arguments.N;
    return RTCRayN_dir_x(arguments.ray, n, lane) * RTCHitN_Ng_x(arguments.hit, n, lane) +
           RTCRayN_dir_y(arguments.ray, n, lane) * RTCHitN_Ng_y(arguments.hit, n, lane) +
           RTCRayN_dir_z(arguments.ray, n, lane) * RTCHitN_Ng_z(arguments.hit, n, lane);
}

} // namespace

// Of the lanes that are about to hit a triangle with one face that casts, those that meet its back go on: the light,
// where they are heading, must be before the front.
void Casters::passThroughBacks(const RTCFilterFunctionNArguments* arguments) {
    const unsigned n = arguments->N;
    for (unsigned lane = 0; lane < n; ++lane)
        if (towardsFront(*arguments, lane) <= 0) arguments->valid[lane] = 0;
}

// Of the lanes that are about to hit a masked triangle, those whose point of it does not exist go on.
void Casters::passThroughHoles(const RTCFilterFunctionNArguments* arguments) {
    const Masked& masked = *static_cast<const Masked*>(arguments->geometryUserPtr);
    const Scene& scene = *masked.scene;
    const Primitive& primitive = *masked.primitive;
    const unsigned n = arguments->N;
    const float least = leastAlpha(*masked.material);
    for (unsigned lane = 0; lane < n; ++lane) {
        if (arguments->valid[lane] != -1) continue;
        if (masked.front != 0 && masked.front * towardsFront(*arguments, lane) <= 0) {
            arguments->valid[lane] = 0;
            continue;
        }
        const float u = RTCHitN_u(arguments->hit, n, lane), v = RTCHitN_v(arguments->hit, n, lane), w = 1 - u - v;
        const uint32_t* corner =
            scene.indices.data() + primitive.firstIndex + 3 * size_t(RTCHitN_primID(arguments->hit, n, lane));
        const auto interpolated = [&](auto&& of) {
            return w * of(primitive.firstVertex + corner[0]) + u * of(primitive.firstVertex + corner[1]) +
                   v * of(primitive.firstVertex + corner[2]);
        };
        float alpha = 1;
        if (masked.material->texture >= 0)
            alpha = alphaAt(scene.textures[static_cast<size_t>(masked.material->texture)],
                            interpolated([&](size_t vertex) { return scene.uvs[vertex]; }));
        if (!scene.colours.empty())
            alpha *= interpolated([&](size_t vertex) { return static_cast<float>(scene.colours[vertex].a) / 65535; });
        if (alpha < least) arguments->valid[lane] = 0;
    }
}

Casters::LightExtent::LightExtent(const AreaLight& light) : directional(light.shape == LightShape::Directional) {
    const glm::mat4 worldFromLight = glm::inverse(lightFromWorld(light));
    const glm::vec2 half = halfSize(light);
    for (size_t i = 0; i < 4; ++i) {
        const glm::vec2 s = half * glm::vec2(i & 1 ? 1 : -1, i & 2 ? 1 : -1);
        corners[i] =
            directional ? glm::mat3(worldFromLight) * glm::vec3(s, 1) : glm::vec3(worldFromLight * glm::vec4(s, 0, 1));
    }
}

Casters::LightExtent::Side Casters::LightExtent::sideOf(glm::vec3 a, glm::vec3 b, glm::vec3 c) const {
    const glm::dvec3 from = a, normal = glm::cross(glm::dvec3(b) - from, glm::dvec3(c) - from);
    const auto isBefore = [&](glm::vec3 corner) {
        return glm::dot(normal, directional ? glm::dvec3(corner) : glm::dvec3(corner) - from) > 0;
    };
    const auto count = std::count_if(corners.begin(), corners.end(), isBefore);
    return count == 0 ? Side::Behind : count == 4 ? Side::Before : Side::Both;
}

bool Casters::LightExtent::isWithin(const Bounds& bounds) const {
    if (directional) return false;
    Bounds own;
    for (const glm::vec3& corner : corners) own.add(corner);
    return glm::all(glm::lessThanEqual(own.min, bounds.max)) && glm::all(glm::greaterThanEqual(own.max, bounds.min));
}

// Of a triangle with one face that casts, the side on which the whole light lies says once and for all whether it does.
// Of a closed surface, whoever looks at a light outside meets as many fronts as backs on the way: the fronts that the
// light sees are enough.
void Casters::addOpaque(const Primitive& primitive, int front, bool closed, const std::vector<glm::vec3>& posed) {
    using Side = LightExtent::Side;
    Bounds bounds;
    for (const glm::vec3& p : posed) bounds.add(p);
    const bool enclosed = closed && extent_.isWithin(bounds), bothCast = enclosed || (front == 0 && !closed);
    const uint32_t first = static_cast<uint32_t>(positions_.size());
    const uint32_t* corner = source_->indices.data() + primitive.firstIndex;
    for (uint32_t i = 0; i < primitive.indexCount; i += 3, corner += 3) {
        const uint32_t a = corner[0], b = corner[front < 0 ? 2 : 1], c = corner[front < 0 ? 1 : 2];
        const Side side = bothCast ? Side::Before : extent_.sideOf(posed[a], posed[b], posed[c]);
        if (side == Side::Behind) continue;
        std::vector<uint32_t>& indices = side == Side::Before || closed ? indices_ : oneSided_;
        for (const uint32_t vertex : {a, b, c}) indices.push_back(first + vertex);
    }
}

Casters::Casters(std::shared_ptr<const Scene> scene, const Pose& pose, const AreaLight& light, int threads,
                 Progress* progress)
    : source_(std::move(scene))
    , pose_(pose)
    , extent_(light) {
    Hash hash;
    std::vector<glm::vec3> posed;
    const auto drawn = [&](bool masked, auto&& take) {
        for (size_t n = 0; n < source_->nodes.size(); ++n) {
            const Node& node = source_->nodes[n];
            if (node.mesh < 0 || !node.visible) continue;
            for (const Primitive& primitive : source_->meshes[static_cast<size_t>(node.mesh)].primitives) {
                const Material& material = source_->materials[static_cast<size_t>(primitive.material)];
                if (primitive.indexCount == 0 || (material.masked && leastAlpha(material) > 0) != masked) continue;
                if (progress) progress->report("posing", 0);
                posedPositions(*source_, pose_, n, primitive, posed);
                // Embree's normal is (B − A) × (C − A), as glTF's front is seen unless a mirror shows it.
                const int front = isMirrored(*source_, pose_, n, primitive) ? -1 : 1;
                const bool oneSided = !material.doubleSided && !primitive.closed;
                take(primitive, material, oneSided || primitive.closed ? front : 0);
                positions_.insert(positions_.end(), posed.begin(), posed.end());
            }
        }
    };
    drawn(false, [&](const Primitive& primitive, const Material&, int front) {
        addOpaque(primitive, front, primitive.closed, posed);
    });
    const size_t opaqueVertices = positions_.size();
    drawn(true, [&](const Primitive& primitive, const Material& material, int front) {
        masked_.push_back({source_.get(), &primitive, &material, static_cast<uint32_t>(positions_.size()),
                           static_cast<float>(front)});
        hash.add(front);
        hash.addBytes(source_->indices.data() + primitive.firstIndex, primitive.indexCount * sizeof(uint32_t));
        hash.addBytes(source_->uvs.data() + primitive.firstVertex, primitive.vertexCount * sizeof(glm::vec2));
        if (!source_->colours.empty())
            for (uint32_t v = 0; v < primitive.vertexCount; ++v)
                hash.add(source_->colours[primitive.firstVertex + v].a);
        hash.add(leastAlpha(material));
        hash.add(material.texture);
    });
    if (!masked_.empty())
        for (const TextureImage& image : source_->textures) {
            hash.add(image.width), hash.add(image.height);
            hash.add(image.wrapU), hash.add(image.wrapV), hash.add(image.magnifyNearest);
            hash.add(image.rgba);
        }
    hash.add(positions_);
    hash.add(indices_);
    hash.add(oneSided_);
    hash_ = hash.value();
    positions_.push_back(glm::vec3(0)); // Embree reads the last vertex as 16 bytes

    device_ = rtcNewDevice(fmt::format("threads={}", threads).c_str());
    if (!device_) fail(rtcGetDeviceError(nullptr));
    scene_ = rtcNewScene(device_);
    // No ray may slip through the edge between two triangles.
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
    if (!indices_.empty()) attach(indices_.data(), indices_.size() / 3, 0, opaqueVertices, nullptr);
    if (!oneSided_.empty()) attach(oneSided_.data(), oneSided_.size() / 3, 0, opaqueVertices, passThroughBacks);
    for (Masked& masked : masked_)
        attach(source_->indices.data() + masked.primitive->firstIndex, masked.primitive->indexCount / 3,
               masked.firstVertex, masked.primitive->vertexCount, passThroughHoles, &masked);
    if (progress)
        rtcSetSceneProgressMonitorFunction(
            scene_, [](void* told, double) { return !static_cast<Progress*>(told)->cancelled(); }, progress);
    rtcCommitScene(scene_);
    const RTCError error = rtcGetDeviceError(device_);
    rtcSetSceneProgressMonitorFunction(scene_, nullptr, nullptr);
    if (error == RTC_ERROR_NONE) return;
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
    if (error == RTC_ERROR_CANCELLED) throw Cancelled{};
    fail(error);
}

const Shafts& Casters::shafts() const {
    std::call_once(shaftsOnce_, [&] { shafts_.emplace(positions_, triangles()); });
    return *shafts_;
}

std::vector<Shafts::Triangle> Casters::triangles() const {
    std::vector<Shafts::Triangle> all;
    const auto add = [&](const uint32_t* indices, size_t count, uint32_t firstVertex) {
        for (size_t i = 0; i < count; i += 3)
            all.push_back({firstVertex + indices[i], firstVertex + indices[i + 1], firstVertex + indices[i + 2]});
    };
    add(indices_.data(), indices_.size(), 0);
    add(oneSided_.data(), oneSided_.size(), 0);
    for (const Masked& masked : masked_)
        add(source_->indices.data() + masked.primitive->firstIndex, masked.primitive->indexCount, masked.firstVertex);
    return all;
}

void Casters::attach(const uint32_t* indices, size_t triangles, size_t firstVertex, size_t vertices,
                     RTCFilterFunctionN filter, Masked* masked) {
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions_.data() + firstVertex,
                               0, sizeof(glm::vec3), vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices, 0, 3 * sizeof(uint32_t),
                               triangles);
    rtcSetGeometryUserData(geometry, masked);
    if (filter) rtcSetGeometryOccludedFilterFunction(geometry, filter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
}

Casters::~Casters() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

} // namespace penumbra
