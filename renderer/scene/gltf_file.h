// SPDX-License-Identifier: MIT
// The outer shell of a glTF file: its JSON, and the bytes of its buffers and images, all checked before they are used.
#pragma once

#include "renderer/scene/scene.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

class GltfFile {
public:
    // Reads the JSON of a .gltf or .glb (told apart by the first bytes) and checks what every file must have: version
    // 2, collections that are arrays of objects, only required extensions out of `knownExtensions`. Throws InputError.
    GltfFile(const std::filesystem::path& file, std::span<const std::string_view> knownExtensions);

    const std::filesystem::path& path() const { return file_; }
    const nlohmann::json& document() const { return json_; }

    // The bytes of a buffer, buffer view or image. Checked against the real bytes. Throws InputError; `user` says on
    // whose behalf ("accessor 3").
    std::span<const uint8_t> buffer(size_t index, const std::string& user);
    std::span<const uint8_t> bufferView(size_t index, const std::string& user);
    TextureImage image(size_t index);

    [[noreturn]] void refuse(const std::string& place, const std::string& expectation) const;

private:
    void readBinary(std::span<const uint8_t> bytes);
    void parse(std::string_view text);
    void checkRoot(std::span<const std::string_view> knownExtensions) const;
    const nlohmann::json& element(const char* collection, size_t index, const std::string& user) const;
    size_t unsignedMember(const nlohmann::json& object, const char* name, size_t otherwise,
                          const std::string& place) const;
    std::vector<uint8_t> resolve(const std::string& uri, const std::string& place) const;
    std::vector<uint8_t> readBelowFolder(const std::string& uri, const std::string& place) const;

    struct Buffer {
        bool loaded = false;
        std::vector<uint8_t> bytes;
    };
    std::filesystem::path file_;
    nlohmann::json json_;
    std::vector<uint8_t> binaryChunk_;
    bool hasBinaryChunk_ = false;
    std::vector<Buffer> buffers_;
};

// Text for one line: control characters become spaces.
std::string oneLine(std::string_view text);

} // namespace penumbra
