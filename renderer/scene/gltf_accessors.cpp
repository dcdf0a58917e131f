// SPDX-License-Identifier: MIT
#include "renderer/scene/gltf_accessors.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace penumbra {
namespace {

constexpr size_t mostZeros = size_t{1} << 24; // elements that accessors without bytes of their own bring in all

template <class T> T loadAs(const uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

// glTF 2.0 specification, 3.11: integers that stand for [0, 1] or [-1, 1].
float componentAt(const uint8_t* bytes, int type, bool normalised) {
    const auto scaled = [normalised](float value, float largest) {
        return normalised ? std::max(value / largest, -1.0f) : value;
    };
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return scaled(loadAs<int8_t>(bytes), 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return scaled(*bytes, 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return scaled(loadAs<int16_t>(bytes), 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return scaled(loadAs<uint16_t>(bytes), 65535);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return scaled(float(loadAs<uint32_t>(bytes)), 4294967295.0f);
    default: return loadAs<float>(bytes);
    }
}

uint32_t integerAt(const uint8_t* bytes, int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return *bytes;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return loadAs<uint16_t>(bytes);
    default: return loadAs<uint32_t>(bytes);
    }
}

bool isUnsigned(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

std::string accessorPlace(int index, const std::string& user) { return fmt::format("accessor {}, {}", index, user); }

} // namespace

bool usableNumber(float value) { return std::abs(value) <= largestNumber; }

void GltfAccessors::checkAll() {
    for (size_t i = 0; i < model_.accessors.size(); ++i)
        if (model_.accessors[i].bufferView >= 0) elements(int(i), fmt::format("accessor {}", i));
}

size_t GltfAccessors::count(int index, const std::string& user) const {
    if (index < 0 || size_t(index) >= model_.accessors.size())
        file_.refuse(user, fmt::format("refers to accessor {} of {}", index, model_.accessors.size()));
    return model_.accessors[size_t(index)].count;
}

GltfAccessors::Elements GltfAccessors::view(int bufferView, size_t byteOffset, size_t count, size_t components,
                                            int componentType, const std::string& place) {
    Elements e;
    e.count = count;
    e.components = components;
    e.componentType = componentType;
    const bool known = componentType >= TINYGLTF_COMPONENT_TYPE_BYTE &&
                       componentType <= TINYGLTF_COMPONENT_TYPE_FLOAT && componentType != TINYGLTF_COMPONENT_TYPE_INT;
    if (!known) file_.refuse(place, fmt::format("has component type {}, which glTF does not know", componentType));
    e.componentSize = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(componentType)));
    const size_t size = e.componentSize * components;
    if (bufferView < 0 || size_t(bufferView) >= model_.bufferViews.size())
        file_.refuse(place, fmt::format("refers to bufferView {} of {}", bufferView, model_.bufferViews.size()));
    const auto& description = model_.bufferViews[size_t(bufferView)];
    e.stride = description.byteStride == 0 ? size : description.byteStride;
    if (e.stride < size)
        file_.refuse(place, fmt::format("has elements of {} bytes but a byteStride of {}", size, e.stride));
    e.bytes = file_.bufferView(size_t(bufferView), place);
    const size_t available = e.bytes.size();
    if (byteOffset > available || size > available - byteOffset ||
        count - 1 > (available - byteOffset - size) / e.stride)
        file_.refuse(place, fmt::format("has {} elements of {} bytes from byte {} on, more than the {} bytes of "
                                        "bufferView {}",
                                        count, size, byteOffset, available, bufferView));
    e.bytes = e.bytes.subspan(byteOffset);
    return e;
}

GltfAccessors::Elements GltfAccessors::elements(int index, const std::string& place) {
    if (count(index, place) == 0) file_.refuse(place, "has a count of 0; expected at least 1");
    const tinygltf::Accessor& accessor = model_.accessors[size_t(index)];
    const auto components = size_t(tinygltf::GetNumComponentsInType(uint32_t(accessor.type)));
    Elements e;
    if (accessor.bufferView >= 0) {
        e = view(accessor.bufferView, accessor.byteOffset, accessor.count, components, accessor.componentType, place);
    } else {
        if (accessor.count > mostZeros - zeros_)
            file_.refuse(place, fmt::format("has {} elements and no bufferView", accessor.count));
        zeros_ += accessor.count;
        e.count = accessor.count;
        e.components = components;
        e.componentType = accessor.componentType;
    }
    e.normalised = accessor.normalized;
    return e;
}

std::vector<float> GltfAccessors::floats(int index, std::initializer_list<size_t> allowedComponents,
                                         const std::string& user) {
    const std::string place = accessorPlace(index, user);
    const Elements e = elements(index, place);
    if (std::find(allowedComponents.begin(), allowedComponents.end(), e.components) == allowedComponents.end())
        file_.refuse(place, fmt::format("has {} components; expected {}", e.components, *allowedComponents.begin()));
    std::vector<float> values(e.count * e.components, 0.0f);
    const auto copy = [&](const Elements& from, size_t i, size_t to) {
        for (size_t c = 0; c < e.components; ++c)
            values[to * e.components + c] = componentAt(from.bytes.data() + i * from.stride + c * from.componentSize,
                                                        from.componentType, e.normalised);
    };
    if (!e.bytes.empty())
        for (size_t i = 0; i < e.count; ++i) copy(e, i, i);

    const auto& sparse = model_.accessors[size_t(index)].sparse;
    if (sparse.isSparse) {
        if (sparse.count < 1 || size_t(sparse.count) > e.count || int64_t(sparse.indices.byteOffset) < 0 ||
            int64_t(sparse.values.byteOffset) < 0 || !isUnsigned(sparse.indices.componentType))
            file_.refuse(place, "has a sparse part with an impossible count, offset or type");
        const auto sparseCount = size_t(sparse.count);
        const Elements at = view(sparse.indices.bufferView, size_t(sparse.indices.byteOffset), sparseCount, 1,
                                 sparse.indices.componentType, place);
        const Elements with = view(sparse.values.bufferView, size_t(sparse.values.byteOffset), sparseCount,
                                   e.components, e.componentType, place);
        for (size_t i = 0; i < sparseCount; ++i) {
            const uint32_t target = integerAt(at.bytes.data() + i * at.stride, at.componentType);
            if (target >= e.count)
                file_.refuse(place, fmt::format("has a sparse index {} of {} elements", target, e.count));
            copy(with, i, target);
        }
    }
    const auto bad = std::find_if_not(values.begin(), values.end(), usableNumber);
    if (bad != values.end())
        file_.refuse(place, fmt::format("element {} is {}; expected a number of at most {}",
                                        size_t(bad - values.begin()) / e.components, *bad, largestNumber));
    return values;
}

std::vector<uint32_t> GltfAccessors::indices(int index, size_t limit, const std::string& user) {
    const std::string place = accessorPlace(index, user);
    const Elements e = elements(index, place);
    if (e.components != 1 || !isUnsigned(e.componentType) || e.bytes.empty())
        file_.refuse(place, "expected indices: unsigned integers with a bufferView");
    std::vector<uint32_t> indices(e.count);
    for (size_t i = 0; i < e.count; ++i) {
        indices[i] = integerAt(e.bytes.data() + i * e.stride, e.componentType);
        if (indices[i] >= limit)
            file_.refuse(place,
                         fmt::format("index {} is {}; expected less than the {} vertices", i, indices[i], limit));
    }
    return indices;
}

} // namespace penumbra
