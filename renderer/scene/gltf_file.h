// SPDX-License-Identifier: MIT
// The outer shell of a glTF file: its JSON, and the bytes of its buffers and images, all checked before they are used.
#pragma once

#include "renderer/scene/scene.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
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
    // The same of bytes that were read already; `file` names them, and what they refer to lies beside it.
    GltfFile(const std::filesystem::path& file, std::vector<uint8_t> bytes,
             std::span<const std::string_view> knownExtensions);

    const std::filesystem::path& path() const { return file_; }
    const nlohmann::json& document() const { return json_; }
    // CRC-32 of the file's bytes followed by those of the files that it named, in the order in which they were read.
    uint32_t checksum() const { return checksum_; }

    // Whether the bytes of every buffer and buffer view are there, also of those that nothing uses: a file with a hole
    // is better refused than half shown. Throws InputError, as all that follows does.
    void checkBytes();
    // The bytes of a buffer or buffer view, decompressed where EXT_meshopt_compression is used. Checked against the
    // real bytes; `user` says on whose behalf ("accessor 3").
    std::span<const uint8_t> buffer(size_t index, const std::string& user);
    std::span<const uint8_t> bufferView(size_t index, const std::string& user);
    // A decoded PNG, JPEG or WebP; nothing if it is in one of the formats that are known but not read.
    std::optional<TextureImage> image(size_t index);

    // A member of an object that counts or refers to something.
    size_t unsignedMember(const nlohmann::json& object, const char* name, size_t otherwise,
                          const std::string& place) const;

    [[noreturn]] void refuse(const std::string& place, const std::string& expectation) const;

private:
    void readBinary();
    void parse(std::string_view text);
    void checkRoot(std::span<const std::string_view> knownExtensions) const;
    const nlohmann::json& element(const char* collection, size_t index, const std::string& user) const;
    std::span<const uint8_t> bytesOfView(const nlohmann::json& description, const std::string& place);
    std::vector<uint8_t> decodeMeshopt(const nlohmann::json& compressed, size_t byteLength, const std::string& place);
    std::vector<uint8_t> resolve(const std::string& uri, const std::string& place);
    std::vector<uint8_t> readBelowFolder(const std::string& uri, const std::string& place);
    void addToChecksum(std::span<const uint8_t> bytes);

    struct Bytes {
        bool loaded = false;
        std::vector<uint8_t> owned;
        std::span<const uint8_t> bytes; // of `owned`, or of the binary chunk
    };
    std::filesystem::path file_;
    std::vector<uint8_t> fileBytes_;
    nlohmann::json json_;
    uint32_t checksum_ = 0;
    std::span<const uint8_t> binaryChunk_;
    bool hasBinaryChunk_ = false;
    std::vector<Bytes> buffers_, decodedViews_;
    size_t decodedBytes_ = 0;
};

// The object of an extension in an object's "extensions", or null.
const nlohmann::json* findExtension(const nlohmann::json& object, const char* name);

// Text for one line: control characters become spaces.
std::string oneLine(std::string_view text);

} // namespace penumbra
