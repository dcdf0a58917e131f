// SPDX-License-Identifier: MIT
// KHR_draco_mesh_compression: the triangles and attributes of one primitive, decompressed.
#pragma once

#include "renderer/scene/gltf_file.h"

#include <memory>

namespace penumbra {

class DracoMesh {
public:
    // Throws InputError, also if the bytes claim more triangles or points than they could hold.
    DracoMesh(const GltfFile& file, std::span<const uint8_t> bytes, const std::string& place);
    ~DracoMesh();
    DracoMesh(DracoMesh&&) noexcept;

    size_t vertexCount() const;
    std::vector<uint32_t> indices(const std::string& place) const; // of a triangle list
    // Components of an attribute and its values, `components` a vertex; integers as they are, or scaled where
    // normalised. Throws InputError if there is no such attribute.
    size_t components(uint32_t uniqueId, const std::string& place) const;
    std::vector<float> floats(uint32_t uniqueId, bool normalised, const std::string& place) const;

private:
    struct Decoded;
    const GltfFile* file_;
    std::unique_ptr<Decoded> decoded_;
};

} // namespace penumbra
