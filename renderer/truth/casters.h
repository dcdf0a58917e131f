// SPDX-License-Identifier: MIT
// The triangles of a posed scene as a ray tracer has them.
#pragma once

#include "renderer/core/progress.h"
#include "renderer/scene/light.h"
#include "renderer/scene/scene.h"
#include "renderer/truth/embree.h"
#include "renderer/truth/shafts.h"

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace penumbra {

class Casters {
public:
    // Poses what is visible and builds the hierarchy, on `threads` threads, over the triangles that can hide `light`.
    // Throws Cancelled.
    Casters(std::shared_ptr<const Scene> scene, const Pose& pose, const AreaLight& light, int threads,
            Progress* progress);
    ~Casters();
    Casters(const Casters&) = delete;
    Casters& operator=(const Casters&) = delete;

    // What casts is what the scene shows: both faces of triangles of two-sided materials and of closed surfaces, else
    // the front; points of masked materials that do not exist let rays pass. Rays go from a surface to the light.
    void occluded(const int* valid, RTCRay8& rays) const { occluded8(scene_, valid, rays); }

    // Built when it is asked for first: a first picture needs none.
    const Shafts& shafts() const;

    // Whether it was built from this scene and pose, for this light.
    bool isOf(const std::shared_ptr<const Scene>& scene, const Pose& pose, const AreaLight& light) const {
        return source_ == scene && pose_ == pose && extent_ == LightExtent(light);
    }
    uint64_t hash() const { return hash_; } // of everything that decides what is occluded

private:
    // One primitive of a masked material, as a node draws it.
    struct Masked {
        const Scene* scene;
        const Primitive* primitive;
        const Material* material;
        uint32_t firstVertex; // of positions_
        float front;          // 1 or −1: Embree's normal is of the only face that casts, or of the other; 0: both do
    };
    // What of the light decides which triangles can hide it.
    struct LightExtent {
        explicit LightExtent(const AreaLight& light);
        bool directional;
        std::array<glm::vec3, 4> corners; // world [m]; of a directional light, directions
        bool operator==(const LightExtent&) const = default;
        // Whether some of the light, or all of it, is before the front of a triangle.
        enum class Side { Behind, Both, Before };
        Side sideOf(glm::vec3 a, glm::vec3 b, glm::vec3 c) const;
        bool isWithin(const Bounds& bounds) const;
    };
    void addOpaque(const Primitive& primitive, int front, bool closed, const std::vector<glm::vec3>& posed);
    static void passThroughBacks(const RTCFilterFunctionNArguments* arguments);
    static void passThroughHoles(const RTCFilterFunctionNArguments* arguments);
    std::vector<Shafts::Triangle> triangles() const;
    void attach(const uint32_t* indices, size_t triangles, size_t firstVertex, size_t vertices,
                RTCFilterFunctionN filter, Masked* masked = nullptr);

    std::shared_ptr<const Scene> source_;
    Pose pose_;
    LightExtent extent_;
    std::vector<glm::vec3> positions_; // world; opaque primitives, then masked ones, then one of padding
    std::vector<uint32_t> indices_;    // of the opaque triangles that cast from wherever they are met
    std::vector<uint32_t> oneSided_;   // and of those that cast from one side, which Embree's normal is of
    std::vector<Masked> masked_;
    mutable std::once_flag shaftsOnce_;
    mutable std::optional<Shafts> shafts_;
    uint64_t hash_ = 0;
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
};

} // namespace penumbra
