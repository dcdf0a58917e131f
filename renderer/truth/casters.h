// SPDX-License-Identifier: MIT
// The triangles of a posed scene as a ray tracer has them.
#pragma once

#include "renderer/core/progress.h"
#include "renderer/scene/scene.h"
#include "renderer/truth/embree.h"
#include "renderer/truth/shafts.h"

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace penumbra {

class Casters {
public:
    // Poses every visible triangle and builds the hierarchy over them on `threads` threads. Throws Cancelled.
    Casters(std::shared_ptr<const Scene> scene, const Pose& pose, int threads, Progress* progress);
    ~Casters();
    Casters(const Casters&) = delete;
    Casters& operator=(const Casters&) = delete;

    // What casts is what the scene shows: both faces of triangles of two-sided materials and of closed surfaces, else
    // the front; points of masked materials that do not exist let rays pass. Rays go from a surface to the light.
    void occluded(const int* valid, RTCRay16& rays) const { occluded16(scene_, valid, rays); }

    // Built when it is asked for first: a first picture needs none.
    const Shafts& shafts() const;

    // Whether it was built from this scene and pose.
    bool isOf(const std::shared_ptr<const Scene>& scene, const Pose& pose) const {
        return source_ == scene && pose_ == pose;
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
    static void passThroughBacks(const RTCFilterFunctionNArguments* arguments);
    static void passThroughHoles(const RTCFilterFunctionNArguments* arguments);
    std::vector<Shafts::Triangle> triangles() const;
    void attach(const uint32_t* indices, size_t triangles, size_t firstVertex, size_t vertices,
                RTCFilterFunctionN filter, Masked* masked = nullptr);

    std::shared_ptr<const Scene> source_;
    Pose pose_;
    std::vector<glm::vec3> positions_; // world; opaque primitives, then masked ones, then one of padding
    std::vector<uint32_t> indices_;    // of the opaque triangles with two faces that cast
    std::vector<uint32_t> oneSided_;   // and of those with one, which Embree's normal is of
    std::vector<Masked> masked_;
    mutable std::once_flag shaftsOnce_;
    mutable std::optional<Shafts> shafts_;
    uint64_t hash_ = 0;
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
};

} // namespace penumbra
