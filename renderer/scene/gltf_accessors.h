// SPDX-License-Identifier: MIT
// The numbers of a glTF file: accessors, sparse or not, of any component type, checked against the bytes that are
// there.
#pragma once

#include "renderer/scene/gltf_file.h"

#include <initializer_list>

namespace tinygltf {
class Model;
}

namespace penumbra {

// [m]; beyond it products of coordinates leave the range of float.
inline constexpr float largestNumber = 1e9f;
bool usableNumber(float value); // NaN and infinity are not

class GltfAccessors {
public:
    GltfAccessors(GltfFile& file, const tinygltf::Model& model) : file_(file), model_(model) {}

    // Whether the bytes of every accessor are there, as GltfFile::checkBytes. Throws InputError, as all that follows
    // does; `user` says on whose behalf.
    void checkAll();
    size_t count(int index, const std::string& user) const; // as stated
    // All components of all elements, sparse ones replaced, normalised ones scaled. They are usable numbers.
    std::vector<float> floats(int index, std::initializer_list<size_t> allowedComponents, const std::string& user);
    // Unsigned integers below `limit`.
    std::vector<uint32_t> indices(int index, size_t limit, const std::string& user);

private:
    // Where elements lie. Without bytes: all are zero.
    struct Elements {
        std::span<const uint8_t> bytes;
        size_t count = 0, stride = 0, components = 0, componentSize = 0;
        int componentType = 0;
        bool normalised = false;
    };
    Elements view(int bufferView, size_t byteOffset, size_t count, size_t components, int componentType,
                  const std::string& place);
    Elements elements(int index, const std::string& place);

    GltfFile& file_;
    const tinygltf::Model& model_;
    size_t zeros_ = 0; // elements read so far that have no bytes
};

} // namespace penumbra
