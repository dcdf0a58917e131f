// SPDX-License-Identifier: MIT
#include "renderer/scene/gltf_file.h"

#include "renderer/core/error.h"

#include <fmt/format.h>
#include <stb_image.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace penumbra {

using json = nlohmann::json;

namespace {

constexpr int largestImage = 16384;             // texels along an edge
constexpr size_t deepestNesting = 200;          // of JSON; readers recurse on it
constexpr size_t largestFile = size_t{1} << 32; // bytes
constexpr uint32_t glbMagic = 0x46546C67, jsonChunk = 0x4E4F534A, binChunk = 0x004E4942;

std::vector<uint8_t> readFile(const std::filesystem::path& file, const std::string& place) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw InputError(place + (std::filesystem::exists(file, error) ? ": not a file" : ": no such file"));
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(place + ": cannot be opened");
    std::vector<uint8_t> bytes;
    // Grows with what is read, never by what the file system claims.
    std::array<char, 1 << 16> block;
    while (stream.read(block.data(), block.size()) || stream.gcount() > 0) {
        bytes.insert(bytes.end(), block.data(), block.data() + stream.gcount());
        if (bytes.size() > largestFile) throw InputError(place + ": has more than 4 GiB");
    }
    if (stream.bad()) throw InputError(place + ": cannot be read");
    return bytes;
}

uint32_t littleEndian32(std::span<const uint8_t> bytes, size_t offset) {
    return uint32_t(bytes[offset]) | uint32_t(bytes[offset + 1]) << 8 | uint32_t(bytes[offset + 2]) << 16 |
           uint32_t(bytes[offset + 3]) << 24;
}

// How deeply arrays and objects of a JSON text nest.
size_t nestingOf(std::string_view text) {
    size_t depth = 0, deepest = 0;
    bool quoted = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '[' || c == '{') {
            deepest = std::max(deepest, ++depth);
        } else if ((c == ']' || c == '}') && depth > 0) {
            --depth;
        }
    }
    return deepest;
}

std::optional<std::string> percentDecoded(std::string_view text) {
    const auto digit = [](char c) {
        const std::string_view digits = "0123456789abcdef";
        return digits.find(char(std::tolower(static_cast<unsigned char>(c))));
    };
    std::string result;
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            result += text[i];
            continue;
        }
        if (i + 2 >= text.size()) return std::nullopt;
        const size_t high = digit(text[i + 1]), low = digit(text[i + 2]);
        if (high == std::string_view::npos || low == std::string_view::npos) return std::nullopt;
        result += char(16 * high + low);
        i += 2;
    }
    return result;
}

std::optional<std::vector<uint8_t>> base64Decoded(std::string_view text) {
    static constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    std::vector<uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const size_t value = alphabet.find(c);
        if (value == std::string_view::npos) return std::nullopt;
        bits = bits << 6 | uint32_t(value);
        held += 6;
        if (held >= 8) {
            held -= 8;
            bytes.push_back(uint8_t(bits >> held));
        }
    }
    return bytes;
}

// "http", "data", "c" ... or nothing for a relative reference (RFC 3986, 4.1).
std::string_view schemeOf(std::string_view uri) {
    const size_t colon = uri.find(':');
    if (colon == std::string_view::npos || uri.find_first_of("/?#") < colon) return {};
    return uri.substr(0, colon);
}

} // namespace

std::string oneLine(std::string_view text) {
    std::string line;
    for (const char c : text) {
        const bool blank = static_cast<unsigned char>(c) <= ' ' || c == 0x7f;
        if (!blank)
            line += c;
        else if (!line.empty() && line.back() != ' ')
            line += ' ';
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

GltfFile::GltfFile(const std::filesystem::path& file, std::span<const std::string_view> knownExtensions) : file_(file) {
    const std::vector<uint8_t> bytes = readFile(file, oneLine(file.string()));
    if (bytes.empty()) refuse("file", "is empty; expected glTF 2.0");
    if (bytes.size() >= 4 && littleEndian32(bytes, 0) == glbMagic)
        readBinary(bytes);
    else if (file.extension() == ".glb")
        refuse("header", "expected a binary glTF file, which starts with 'glTF'");
    else
        parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    checkRoot(knownExtensions);
    buffers_.resize(json_.contains("buffers") ? json_["buffers"].size() : 0);
}

// glTF 2.0 specification, 4.4: a header of three words (magic, version, length), then chunks of (length, type, data).
void GltfFile::readBinary(std::span<const uint8_t> bytes) {
    if (bytes.size() < 12) refuse("header", "ends early; expected 12 bytes");
    if (const uint32_t version = littleEndian32(bytes, 4); version != 2)
        refuse("header", fmt::format("has version {}; expected 2", version));
    const size_t length = littleEndian32(bytes, 8);
    if (length > bytes.size())
        refuse("header", fmt::format("states {} bytes but the file has {}; it was cut short", length, bytes.size()));

    size_t offset = 12;
    for (int chunk = 0; offset < length; ++chunk) {
        const std::string place = fmt::format("chunk {}", chunk);
        if (length - offset < 8) refuse(place, "ends early; expected 8 bytes of length and type");
        const size_t size = littleEndian32(bytes, offset);
        const uint32_t type = littleEndian32(bytes, offset + 4);
        offset += 8;
        if (size > length - offset)
            refuse(place, fmt::format("states {} bytes but {} are left", size, length - offset));
        const std::span<const uint8_t> data = bytes.subspan(offset, size);
        if (chunk == 0) {
            if (type != jsonChunk) refuse(place, "expected the JSON chunk first");
            parse({reinterpret_cast<const char*>(data.data()), data.size()});
        } else if (type == binChunk && chunk == 1) {
            binaryChunk_.assign(data.begin(), data.end());
            hasBinaryChunk_ = true;
        }
        offset += size;
    }
    if (json_.is_null()) refuse("header", "has no chunks; expected a JSON chunk");
}

void GltfFile::parse(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3); // byte order mark
    if (nestingOf(text) > deepestNesting) refuse("JSON", fmt::format("nests deeper than {} levels", deepestNesting));
    try {
        json_ = json::parse(text);
    } catch (const json::parse_error& error) {
        const size_t at = std::min(error.byte, text.size());
        const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n');
        refuse(fmt::format("line {}", line), "is not valid JSON");
    } catch (const json::exception& error) { // a number out of range
        refuse("JSON", error.what());
    }
}

void GltfFile::checkRoot(std::span<const std::string_view> knownExtensions) const {
    if (!json_.is_object()) refuse("JSON", "expected an object");
    const json asset = json_.value("asset", json());
    const json version = asset.is_object() ? asset.value("version", json()) : json();
    if (!version.is_string()) refuse("asset.version", "is missing; expected glTF 2.0");
    if (!version.get<std::string>().starts_with("2."))
        refuse("asset.version", fmt::format("is {}; expected 2.0", version.get<std::string>()));

    for (const char* collection : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images",
                                   "materials", "meshes", "nodes", "samplers", "scenes", "skins", "textures"}) {
        const auto found = json_.find(collection);
        if (found == json_.end()) continue;
        if (!found->is_array() || !std::all_of(found->begin(), found->end(), [](auto& e) { return e.is_object(); }))
            refuse(collection, "expected an array of objects");
    }

    constexpr std::pair<const char*, const char*> lists[] = {{"meshes", "primitives"},   {"nodes", "children"},
                                                             {"scenes", "nodes"},        {"animations", "channels"},
                                                             {"animations", "samplers"}, {"skins", "joints"}};
    for (const auto& [collection, list] : lists)
        if (const auto found = json_.find(collection); found != json_.end())
            for (const json& owner : *found)
                if (owner.contains(list) && !owner[list].is_array())
                    refuse(fmt::format("{}.{}", collection, list), "expected an array");

    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        const auto found = json_.find(list);
        if (found == json_.end()) continue;
        if (!found->is_array() || !std::all_of(found->begin(), found->end(), [](auto& e) { return e.is_string(); }))
            refuse(list, "expected an array of names");
    }
    for (const json& name : json_.value("extensionsRequired", json::array())) {
        const std::string text = name.get<std::string>();
        if (std::find(knownExtensions.begin(), knownExtensions.end(), text) == knownExtensions.end())
            refuse("extensionsRequired", text + " cannot be read; export the scene without it");
    }
}

const json& GltfFile::element(const char* collection, size_t index, const std::string& user) const {
    const auto found = json_.find(collection);
    const size_t count = found == json_.end() ? 0 : found->size();
    if (index >= count) refuse(user, fmt::format("refers to {}[{}] of {}", collection, index, count));
    return (*found)[index];
}

size_t GltfFile::unsignedMember(const json& object, const char* name, size_t otherwise,
                                const std::string& place) const {
    const auto found = object.find(name);
    if (found == object.end()) return otherwise;
    const double value = found->is_number() ? found->get<double>() : -1;
    if (value < 0 || value > 9e15 || value != double(uint64_t(value)))
        refuse(place, fmt::format("{} is {}; expected a whole number of at least 0", name, found->dump()));
    return size_t(value);
}

std::span<const uint8_t> GltfFile::buffer(size_t index, const std::string& user) {
    const json& description = element("buffers", index, user);
    Buffer& buffer = buffers_[index];
    if (buffer.loaded) return buffer.bytes;

    const std::string place = fmt::format("buffer {}", index);
    const auto uri = description.find("uri");
    if (uri != description.end()) {
        if (!uri->is_string()) refuse(place, "has a uri that is not text");
        buffer.bytes = resolve(uri->get<std::string>(), place);
    } else if (index == 0 && hasBinaryChunk_) {
        buffer.bytes = std::move(binaryChunk_);
    } else {
        refuse(place, "has neither a uri nor a binary chunk");
    }
    const size_t stated = unsignedMember(description, "byteLength", 0, place);
    if (stated == 0 || stated > buffer.bytes.size())
        refuse(place, fmt::format("byteLength is {} but {} bytes are there", stated, buffer.bytes.size()));
    buffer.bytes.resize(stated);
    buffer.loaded = true;
    return buffer.bytes;
}

std::span<const uint8_t> GltfFile::bufferView(size_t index, const std::string& user) {
    const json& description = element("bufferViews", index, user);
    const std::string place = fmt::format("bufferView {}", index);
    const size_t none = std::numeric_limits<size_t>::max();
    const std::span<const uint8_t> bytes = buffer(unsignedMember(description, "buffer", none, place), place);
    const size_t offset = unsignedMember(description, "byteOffset", 0, place);
    const size_t length = unsignedMember(description, "byteLength", 0, place);
    if (length == 0) refuse(place, "byteLength is 0 or missing");
    if (offset > bytes.size() || length > bytes.size() - offset)
        refuse(place, fmt::format("ends at byte {} of a buffer of {}", offset + length, bytes.size()));
    return bytes.subspan(offset, length);
}

TextureImage GltfFile::image(size_t index) {
    const json& description = element("images", index, "texture");
    std::string place = fmt::format("image {}", index);
    std::vector<uint8_t> owned;
    std::span<const uint8_t> bytes;
    if (const auto uri = description.find("uri"); uri != description.end()) {
        if (!uri->is_string()) refuse(place, "has a uri that is not text");
        const std::string text = uri->get<std::string>();
        owned = resolve(text, place);
        bytes = owned;
        if (schemeOf(text).empty()) place += fmt::format(" '{}'", text);
    } else {
        const size_t none = std::numeric_limits<size_t>::max();
        bytes = bufferView(unsignedMember(description, "bufferView", none, place), place);
    }
    if (bytes.size() > size_t(std::numeric_limits<int>::max())) refuse(place, "has more than 2 GiB");

    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(bytes.data(), int(bytes.size()), &width, &height, &channels))
        refuse(place, fmt::format("cannot be decoded ({}); expected PNG or JPEG", stbi_failure_reason()));
    if (width < 1 || height < 1 || width > largestImage || height > largestImage)
        refuse(place,
               fmt::format("has {}x{} texels; expected at most {}x{}", width, height, largestImage, largestImage));
    const std::unique_ptr<stbi_uc, void (*)(void*)> texels(
        stbi_load_from_memory(bytes.data(), int(bytes.size()), &width, &height, &channels, 4), stbi_image_free);
    if (!texels) refuse(place, fmt::format("cannot be decoded ({}); expected PNG or JPEG", stbi_failure_reason()));

    TextureImage result;
    if (const json name = description.value("name", json()); name.is_string()) result.name = name.get<std::string>();
    result.width = width;
    result.height = height;
    result.rgba.assign(texels.get(), texels.get() + size_t(4) * size_t(width) * size_t(height));
    return result;
}

std::vector<uint8_t> GltfFile::resolve(const std::string& uri, const std::string& place) const {
    const std::string_view scheme = schemeOf(uri);
    if (scheme.empty()) return readBelowFolder(uri, place);
    if (scheme != "data") refuse(place, fmt::format("uri '{}' is not a file beside the scene", uri.substr(0, 100)));
    const size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
        refuse(place, "has a data uri that is not base64");
    std::optional<std::vector<uint8_t>> bytes = base64Decoded(std::string_view(uri).substr(comma + 1));
    if (!bytes) refuse(place, "has a data uri that is not base64");
    return std::move(*bytes);
}

// A scene is often somebody else's: it may name only files that lie below its own folder, links followed.
std::vector<uint8_t> GltfFile::readBelowFolder(const std::string& uri, const std::string& place) const {
    namespace fs = std::filesystem;
    const std::string namedPlace = fmt::format("{} '{}'", place, uri);
    const std::optional<std::string> decoded = percentDecoded(uri);
    if (!decoded || decoded->empty() || decoded->find('\0') != std::string::npos)
        refuse(namedPlace, "expected the name of a file");
    std::error_code error;
    const fs::path folder = fs::weakly_canonical(fs::absolute(file_).parent_path(), error);
    const fs::path target = error ? fs::path() : fs::weakly_canonical(folder / *decoded, error);
    const auto [folderEnd, targetEnd] = std::mismatch(folder.begin(), folder.end(), target.begin(), target.end());
    if (error || folderEnd != folder.end())
        refuse(namedPlace, "lies outside the scene's folder; expected a file below it");
    return readFile(target, oneLine(fmt::format("{}: {}", file_.string(), namedPlace)));
}

void GltfFile::refuse(const std::string& place, const std::string& expectation) const {
    throw InputError(oneLine(fmt::format("{}: {}: {}", file_.string(), place, expectation)));
}

} // namespace penumbra
