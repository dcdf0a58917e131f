// SPDX-License-Identifier: MIT
#include "renderer/scene/gltf_file.h"

#include "renderer/core/error.h"

#include <fmt/format.h>
#include <meshoptimizer.h>
#include <stb_image.h>
#include <webp/decode.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace penumbra {

using json = nlohmann::json;

namespace {

constexpr int largestImage = 16384;             // texels along an edge
constexpr size_t mostJpegScans = 100;           // each of a few bytes is a walk through all blocks
constexpr size_t deepestNesting = 200;          // of JSON; readers recurse on it
constexpr size_t largestFile = size_t{1} << 32; // bytes
constexpr uint32_t glbMagic = 0x46546C67, jsonChunk = 0x4E4F534A, binChunk = 0x004E4942;

std::vector<uint8_t> readFile(const std::filesystem::path& file, const std::string& place) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw InputError(place + (std::filesystem::exists(file, error) ? ": not a file" : ": no such file"));
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(place + ": cannot be opened");
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) throw InputError(place + ": cannot be read");
    if (size > largestFile) throw InputError(place + ": has more than 4 GiB");
    std::vector<uint8_t> bytes(size);
    stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size));
    if (stream.bad() || std::uintmax_t(stream.gcount()) != size) throw InputError(place + ": cannot be read");
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

const json* findExtension(const json& object, const char* name) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object()) return nullptr;
    const auto found = extensions->find(name);
    return found != extensions->end() && found->is_object() ? &*found : nullptr;
}

GltfFile::GltfFile(const std::filesystem::path& file, std::span<const std::string_view> knownExtensions)
    : GltfFile(file, readFile(file, oneLine(file.string())), knownExtensions) {}

GltfFile::GltfFile(const std::filesystem::path& file, std::vector<uint8_t> bytes,
                   std::span<const std::string_view> knownExtensions)
    : file_(file)
    , fileBytes_(std::move(bytes)) {
    addToChecksum(fileBytes_);
    if (fileBytes_.empty()) refuse("file", "is empty; expected glTF 2.0");
    if (fileBytes_.size() >= 4 && littleEndian32(fileBytes_, 0) == glbMagic)
        readBinary();
    else if (file.extension() == ".glb")
        refuse("header", "expected a binary glTF file, which starts with 'glTF'");
    else
        parse({reinterpret_cast<const char*>(fileBytes_.data()), fileBytes_.size()});
    if (!hasBinaryChunk_) fileBytes_ = {};
    checkRoot(knownExtensions);
    const auto count = [&](const char* name) { return json_.contains(name) ? json_[name].size() : 0; };
    buffers_.resize(count("buffers"));
    decodedViews_.resize(count("bufferViews"));
}

// glTF 2.0 specification, 4.4: a header of three words (magic, version, length), then chunks of (length, type, data).
void GltfFile::readBinary() {
    const std::span<const uint8_t> bytes = fileBytes_;
    if (bytes.size() < 12) refuse("header", "ends early; expected 12 bytes");
    if (const uint32_t version = littleEndian32(bytes, 4); version != 2)
        refuse("header", fmt::format("has version {}; expected 2", version));
    const size_t length = littleEndian32(bytes, 8);
    if (length > bytes.size())
        refuse("header", fmt::format("states {} bytes but the file has {}; it was cut short", length, bytes.size()));

    size_t offset = 12;
    for (int chunk = 0; offset < length; ++chunk) {
        const std::string place = fmt::format("chunk {}", chunk);
        if (length - offset < 8)
            refuse(place, fmt::format("has no room in the {} bytes that the header states", length));
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
            binaryChunk_ = data;
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
    } catch (const json::exception& error) { // a number out of range: "[json.exception...] number overflow parsing '…'"
        const std::string_view reason = error.what();
        refuse("JSON", std::string(reason.substr(reason.find("] ") + 2)));
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

void GltfFile::checkBytes() {
    for (size_t i = 0; i < buffers_.size(); ++i) {
        // Without bytes of its own, or for readers that cannot decompress: such a buffer is for nobody here to read.
        const json& description = json_["buffers"][i];
        const bool hasBytes = description.contains("uri") || (i == 0 && hasBinaryChunk_);
        if (hasBytes && !findExtension(description, "EXT_meshopt_compression")) buffer(i, "file");
    }
    for (size_t i = 0; i < decodedViews_.size(); ++i) bufferView(i, "file");
}

std::span<const uint8_t> GltfFile::buffer(size_t index, const std::string& user) {
    const json& description = element("buffers", index, user);
    Bytes& buffer = buffers_[index];
    if (buffer.loaded) return buffer.bytes;

    const std::string place = fmt::format("buffer {}", index);
    const auto uri = description.find("uri");
    if (uri != description.end()) {
        if (!uri->is_string()) refuse(place, "has a uri that is not text");
        buffer.owned = resolve(uri->get_ref<const std::string&>(), place);
        buffer.bytes = buffer.owned;
    } else if (index == 0 && hasBinaryChunk_) {
        buffer.bytes = binaryChunk_;
    } else {
        refuse(place, "has neither a uri nor a binary chunk");
    }
    const size_t stated = unsignedMember(description, "byteLength", 0, place);
    if (stated == 0 || stated > buffer.bytes.size())
        refuse(place, fmt::format("byteLength is {} but {} bytes are there", stated, buffer.bytes.size()));
    buffer.bytes = buffer.bytes.first(stated);
    buffer.loaded = true;
    return buffer.bytes;
}

// The bytes that an object with "buffer", "byteOffset" and "byteLength" means.
std::span<const uint8_t> GltfFile::bytesOfView(const json& description, const std::string& place) {
    const size_t none = std::numeric_limits<size_t>::max();
    const std::span<const uint8_t> bytes = buffer(unsignedMember(description, "buffer", none, place), place);
    const size_t offset = unsignedMember(description, "byteOffset", 0, place);
    const size_t length = unsignedMember(description, "byteLength", 0, place);
    if (length == 0) refuse(place, "byteLength is 0 or missing");
    if (offset > bytes.size() || length > bytes.size() - offset)
        refuse(place, fmt::format("ends at byte {} of a buffer of {}", offset + length, bytes.size()));
    return bytes.subspan(offset, length);
}

std::span<const uint8_t> GltfFile::bufferView(size_t index, const std::string& user) {
    const json& description = element("bufferViews", index, user);
    const std::string place = fmt::format("bufferView {}", index);
    const json* compressed = findExtension(description, "EXT_meshopt_compression");
    if (!compressed) return bytesOfView(description, place);
    Bytes& decoded = decodedViews_[index];
    if (!decoded.loaded) {
        decoded.owned = decodeMeshopt(*compressed, unsignedMember(description, "byteLength", 0, place), place);
        decoded.bytes = decoded.owned;
        decoded.loaded = true;
    }
    return decoded.bytes;
}

// EXT_meshopt_compression. What comes out is claimed by the file; the three codecs cannot shrink it further than to a
// 64th, a byte a triangle and a byte an index, so that no more is allocated than its bytes can hold.
std::vector<uint8_t> GltfFile::decodeMeshopt(const json& compressed, size_t byteLength, const std::string& place) {
    const std::span<const uint8_t> bytes = bytesOfView(compressed, place);
    const size_t count = unsignedMember(compressed, "count", 0, place);
    const size_t stride = unsignedMember(compressed, "byteStride", 0, place);
    const auto text = [&](const char* name) {
        const json value = compressed.value(name, json("NONE"));
        if (!value.is_string()) refuse(place, fmt::format("EXT_meshopt_compression has a {} that is not text", name));
        return value.get<std::string>();
    };
    const std::string mode = text("mode"), filter = text("filter");
    const bool attributes = mode == "ATTRIBUTES", triangles = mode == "TRIANGLES";
    if (!attributes && !triangles && mode != "INDICES")
        refuse(place, fmt::format("mode is '{}'; expected ATTRIBUTES, TRIANGLES or INDICES", mode));
    const bool strideFits = attributes ? stride % 4 == 0 && stride > 0 && stride <= 256 : stride == 2 || stride == 4;
    if (!strideFits || (triangles && count % 3 != 0))
        refuse(place, fmt::format("{} of {} elements of {} bytes are not possible", mode, count, stride));
    const size_t most = attributes ? bytes.size() * 64 / stride : bytes.size() * (triangles ? 3 : 1);
    if (count == 0 || count > most || count * stride != byteLength)
        refuse(place, fmt::format("states {} bytes, {} elements of {} bytes, which {} compressed bytes cannot hold",
                                  byteLength, count, stride, bytes.size()));
    decodedBytes_ += byteLength;
    if (decodedBytes_ > largestFile) refuse(place, "brings the decompressed bytes to more than 4 GiB");
    std::vector<uint8_t> decoded(byteLength);
    const int failed =
        attributes  ? meshopt_decodeVertexBuffer(decoded.data(), count, stride, bytes.data(), bytes.size())
        : triangles ? meshopt_decodeIndexBuffer(decoded.data(), count, stride, bytes.data(), bytes.size())
                    : meshopt_decodeIndexSequence(decoded.data(), count, stride, bytes.data(), bytes.size());
    if (failed) refuse(place, fmt::format("cannot be decompressed by EXT_meshopt_compression ({})", mode));
    if (filter == "NONE") return decoded;
    const bool octahedral = filter == "OCTAHEDRAL", quaternion = filter == "QUATERNION";
    if ((!octahedral && !quaternion && filter != "EXPONENTIAL") || !attributes || (octahedral && stride > 8) ||
        (quaternion && stride != 8))
        refuse(place, fmt::format("filter '{}' is not possible for {} of {} bytes", filter, mode, stride));
    if (octahedral && stride != 4 && stride != 8)
        refuse(place, fmt::format("filter OCTAHEDRAL has a byteStride of {}; expected 4 or 8", stride));
    if (octahedral)
        meshopt_decodeFilterOct(decoded.data(), count, stride);
    else if (quaternion)
        meshopt_decodeFilterQuat(decoded.data(), count, stride);
    else
        meshopt_decodeFilterExp(decoded.data(), count, stride);
    return decoded;
}

namespace {

bool startsWith(std::span<const uint8_t> bytes, size_t offset, std::string_view text) {
    return bytes.size() >= offset + text.size() &&
           std::memcmp(text.data(), bytes.data() + offset, text.size()) == 0; // text is signed, bytes are not
}

bool isPng(std::span<const uint8_t> bytes) { return startsWith(bytes, 0, "\x89PNG\r\n\x1a\n"); }

bool isJpeg(std::span<const uint8_t> bytes) { return startsWith(bytes, 0, "\xFF\xD8\xFF"); }

bool isWebp(std::span<const uint8_t> bytes) { return startsWith(bytes, 0, "RIFF") && startsWith(bytes, 8, "WEBP"); }

// Formats that glTF's extensions know and nothing here reads.
bool isUnreadFormat(std::span<const uint8_t> bytes) {
    return startsWith(bytes, 0, "\xABKTX 20\xBB") || startsWith(bytes, 4, "ftypavif") || startsWith(bytes, 0, "DDS ");
}

// stb_image allocates what a chunk claims to hold before it looks whether that is there.
bool pngChunksFit(std::span<const uint8_t> bytes) {
    for (size_t at = 8; at + 8 <= bytes.size();) { // length, type, data, checksum of four bytes
        if (startsWith(bytes, at + 4, "IEND")) return true;
        const size_t length =
            size_t{bytes[at]} << 24 | size_t{bytes[at + 1]} << 16 | size_t{bytes[at + 2]} << 8 | size_t{bytes[at + 3]};
        if (length > bytes.size() - at - 8) return false;
        at += 12 + length;
    }
    return true; // without an end, which is for stb_image to judge
}

size_t jpegScans(std::span<const uint8_t> bytes) {
    constexpr uint8_t startOfScan[] = {0xFF, 0xDA};
    size_t count = 0;
    for (auto at = bytes.begin();; ++at, ++count) {
        at = std::search(at, bytes.end(), std::begin(startOfScan), std::end(startOfScan));
        if (at == bytes.end()) return count;
    }
}

// No more than these fit into so many bytes.
size_t mostTexels(std::span<const uint8_t> bytes) {
    if (isJpeg(bytes)) return 512 * bytes.size();                              // a bit for the mean of a block of 64
    const size_t deflated = 8 * 1032 * bytes.size();                           // PNG: of a bit each
    return isWebp(bytes) ? std::max(deflated, size_t{4096} * 4096) : deflated; // one colour needs next to nothing
}

// stb_image knows more formats than glTF and is careless in some: it sees only those two.
bool pictureSize(std::span<const uint8_t> bytes, int& width, int& height) {
    if (isWebp(bytes)) return WebPGetInfo(bytes.data(), bytes.size(), &width, &height) != 0;
    if (!isJpeg(bytes) && !(isPng(bytes) && pngChunksFit(bytes))) return false;
    int channels = 0;
    return stbi_info_from_memory(bytes.data(), int(bytes.size()), &width, &height, &channels) != 0;
}

// 4·width·height bytes; false if the picture is broken. Sixteen bits a channel become eight.
bool decodePicture(std::span<const uint8_t> bytes, int width, int height, std::vector<uint8_t>& rgba) {
    const size_t size = size_t(4) * size_t(width) * size_t(height);
    if (isWebp(bytes)) {
        rgba.resize(size);
        return WebPDecodeRGBAInto(bytes.data(), bytes.size(), rgba.data(), size, 4 * width) != nullptr;
    }
    int channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> texels(
        stbi_load_from_memory(bytes.data(), int(bytes.size()), &width, &height, &channels, 4), stbi_image_free);
    if (texels) rgba.assign(texels.get(), texels.get() + size);
    return texels != nullptr;
}

} // namespace

std::optional<TextureImage> GltfFile::image(size_t index) {
    const json& description = element("images", index, "texture");
    std::string place = fmt::format("image {}", index);
    std::vector<uint8_t> owned;
    std::span<const uint8_t> bytes;
    if (const auto uri = description.find("uri"); uri != description.end()) {
        if (!uri->is_string()) refuse(place, "has a uri that is not text");
        const std::string& text = uri->get_ref<const std::string&>();
        owned = resolve(text, place);
        bytes = owned;
        if (schemeOf(text).empty()) place += fmt::format(" '{}'", text);
    } else {
        const size_t none = std::numeric_limits<size_t>::max();
        bytes = bufferView(unsignedMember(description, "bufferView", none, place), place);
    }
    if (bytes.size() > size_t(std::numeric_limits<int>::max())) refuse(place, "has more than 2 GiB");
    if (isUnreadFormat(bytes)) return std::nullopt;

    TextureImage result;
    const char* undecodable = "cannot be decoded; expected PNG, JPEG or WebP";
    if (!pictureSize(bytes, result.width, result.height)) refuse(place, undecodable);
    if (result.width < 1 || result.height < 1 || result.width > largestImage || result.height > largestImage)
        refuse(place, fmt::format("has {}x{} texels; expected at most {}x{}", result.width, result.height, largestImage,
                                  largestImage));
    if (size_t(result.width) * size_t(result.height) > mostTexels(bytes))
        refuse(place, fmt::format("states {}x{} texels, which {} bytes cannot hold", result.width, result.height,
                                  bytes.size()));
    if (isJpeg(bytes) && jpegScans(bytes) > mostJpegScans)
        refuse(place, fmt::format("has more than {} scans; expected a JPEG of fewer", mostJpegScans));
    if (!decodePicture(bytes, result.width, result.height, result.rgba)) refuse(place, undecodable);
    if (const json name = description.value("name", json()); name.is_string()) result.name = name.get<std::string>();
    return result;
}

std::vector<uint8_t> GltfFile::resolve(const std::string& uri, const std::string& place) {
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
std::vector<uint8_t> GltfFile::readBelowFolder(const std::string& uri, const std::string& place) {
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
    std::vector<uint8_t> bytes = readFile(target, oneLine(fmt::format("{}: {}", file_.string(), namedPlace)));
    addToChecksum(bytes);
    return bytes;
}

void GltfFile::addToChecksum(std::span<const uint8_t> bytes) {
    checksum_ = static_cast<uint32_t>(::crc32_z(checksum_, bytes.data(), bytes.size()));
}

void GltfFile::refuse(const std::string& place, const std::string& expectation) const {
    throw InputError(oneLine(fmt::format("{}: {}: {}", file_.string(), place, expectation)));
}

} // namespace penumbra
