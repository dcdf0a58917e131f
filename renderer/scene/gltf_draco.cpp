// SPDX-License-Identifier: MIT
#include "renderer/scene/gltf_draco.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <optional>

namespace penumbra {
namespace {

// What regular connectivity shrinks to is far above this; it keeps a claim in the header from being believed.
constexpr uint64_t mostElementsPerByte = 256;

// The numbers that the head of a Draco stream claims ("Draco Bitstream Specification" 2.2, sections 4 and 5), of which
// the decoder allocates before it has seen the rest: faces, and points or vertices.
std::optional<uint64_t> largestClaim(std::span<const uint8_t> bytes) {
    constexpr size_t head = 11; // "DRACO", version, encoder type and method, flags
    if (bytes.size() < head) return std::nullopt;
    const bool edgebreaker = bytes[8] == 1;
    const bool hasMetadata = bytes[10] & 0x80;
    if (bytes[5] != 2 || bytes[6] != 2 || hasMetadata) return std::nullopt;
    size_t at = head + (edgebreaker ? 1 : 0); // the kind of traversal comes first
    uint64_t largest = 0;
    for (int number = 0; number < 2; ++number) {
        uint64_t value = 0;
        for (int shift = 0;; shift += 7) { // LEB128
            if (at >= bytes.size() || shift > 28) return std::nullopt;
            value |= uint64_t(bytes[at] & 0x7f) << shift;
            if (!(bytes[at++] & 0x80)) break;
        }
        largest = std::max(largest, value);
    }
    return largest;
}

double largestInteger(draco::DataType type) {
    switch (type) {
    case draco::DT_INT8: return 127;
    case draco::DT_UINT8: return 255;
    case draco::DT_INT16: return 32767;
    case draco::DT_UINT16: return 65535;
    case draco::DT_INT32: return 2147483647;
    case draco::DT_UINT32: return 4294967295;
    default: return 1;
    }
}

} // namespace

struct DracoMesh::Decoded {
    std::unique_ptr<draco::Mesh> mesh;

    const draco::PointAttribute& attribute(uint32_t uniqueId, const GltfFile& file, const std::string& place) const {
        const draco::PointAttribute* found = mesh->GetAttributeByUniqueId(uniqueId);
        if (!found) file.refuse(place, fmt::format("refers to Draco attribute {}, which is not there", uniqueId));
        return *found;
    }
};

DracoMesh::DracoMesh(const GltfFile& file, std::span<const uint8_t> bytes, const std::string& place)
    : file_(&file)
    , decoded_(std::make_unique<Decoded>()) {
    const std::optional<uint64_t> claim = largestClaim(bytes);
    if (!claim) file.refuse(place, "cannot be decompressed; expected a Draco 2.2 mesh without metadata");
    if (*claim / mostElementsPerByte > bytes.size())
        file.refuse(place, fmt::format("claims {} triangles or points in {} bytes of Draco", *claim, bytes.size()));
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok())
        file.refuse(place, fmt::format("cannot be decompressed by Draco: {}", result.status().error_msg_string()));
    decoded_->mesh = std::move(result).value();
}

DracoMesh::~DracoMesh() = default;
DracoMesh::DracoMesh(DracoMesh&&) noexcept = default;

size_t DracoMesh::vertexCount() const { return decoded_->mesh->num_points(); }

std::vector<uint32_t> DracoMesh::indices(const std::string& place) const {
    const draco::Mesh& mesh = *decoded_->mesh;
    std::vector<uint32_t> indices;
    indices.reserve(size_t(3) * mesh.num_faces());
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
        for (const draco::PointIndex& point : mesh.face(f)) {
            if (point.value() >= mesh.num_points()) // the decoder of sequential meshes does not look
                file_->refuse(place,
                              fmt::format("has an index {} of {} Draco points", point.value(), mesh.num_points()));
            indices.push_back(point.value());
        }
    return indices;
}

size_t DracoMesh::components(uint32_t uniqueId, const std::string& place) const {
    return size_t(decoded_->attribute(uniqueId, *file_, place).num_components());
}

std::vector<float> DracoMesh::floats(uint32_t uniqueId, bool normalised, const std::string& place) const {
    const draco::PointAttribute& attribute = decoded_->attribute(uniqueId, *file_, place);
    const auto components = size_t(attribute.num_components());
    const float scale = normalised && !attribute.normalized() ? float(1 / largestInteger(attribute.data_type())) : 1.0f;
    std::vector<float> values(vertexCount() * components);
    for (size_t i = 0; i < vertexCount(); ++i) {
        const draco::AttributeValueIndex at = attribute.mapped_index(draco::PointIndex(uint32_t(i)));
        if (at.value() >= attribute.size() || !attribute.ConvertValue(at, int8_t(components), &values[i * components]))
            file_->refuse(place, "has a Draco attribute with values that are not there");
    }
    for (float& value : values) value *= scale;
    return values;
}

} // namespace penumbra
