// SPDX-License-Identifier: MIT
#include "app/image_file.h"

#include "app/file_io.h"
#include "renderer/core/error.h"

#include <fmt/format.h>
#include <png.h>
#include <tinyexr.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numeric>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "PFM and NPY are written as the floats lie in memory");

constexpr std::string_view factsName = "penumbra"; // of the text chunk; before a dot, of the attributes

std::string textOf(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

void appendFloats(std::string& bytes, const float* values, size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof(float));
}

// --- PNG: libpng leaves by longjmp on errors, so no frame between setjmp and it may own anything -------------------

struct PngJob {
    int width, height, colourType;
    std::vector<png_bytep> rows;
    std::vector<png_text> texts;
    std::string bytes;
    std::string error;
};

void pngError(png_structp png, png_const_charp message) {
    static_cast<PngJob*>(png_get_error_ptr(png))->error = message;
    png_longjmp(png, 1);
}
void pngWarning(png_structp, png_const_charp) {}
void pngWrite(png_structp png, png_bytep data, size_t size) {
    static_cast<PngJob*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<const char*>(data), size);
}
void pngFlush(png_structp) {}

bool runPngJob(PngJob& job) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, pngError, pngWarning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, &job, pngWrite, pngFlush);
    png_set_IHDR(png, info, static_cast<png_uint_32>(job.width), static_cast<png_uint_32>(job.height), 8,
                 job.colourType, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_text(png, info, job.texts.data(), static_cast<int>(job.texts.size()));
    png_set_rows(png, info, job.rows.data());
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&png, &info);
    return true;
}

std::string encodePng(const fs::path& file, const Picture& picture, const Json& facts) {
    const size_t channels = picture.channels.size();
    ensure(channels == 1 || channels == 3 || channels == 4, "a PNG is grey, RGB or RGBA");
    std::vector<png_byte> texels(picture.values.size());
    std::transform(picture.values.begin(), picture.values.end(), texels.begin(), [](float value) {
        return static_cast<png_byte>(std::lround(255 * std::clamp(std::isnan(value) ? 0.0f : value, 0.0f, 1.0f)));
    });
    PngJob job{picture.width, picture.height,
               channels == 1   ? PNG_COLOR_TYPE_GRAY
               : channels == 3 ? PNG_COLOR_TYPE_RGB
                               : PNG_COLOR_TYPE_RGB_ALPHA};
    for (int y = 0; y < picture.height; ++y)
        job.rows.push_back(texels.data() + static_cast<size_t>(y) * static_cast<size_t>(picture.width) * channels);
    std::string key(factsName), text;
    if (!facts.is_null()) {
        text = textOf(facts);
        png_text chunk = {};
        chunk.compression = PNG_ITXT_COMPRESSION_NONE; // UTF-8
        chunk.key = key.data();                        // libpng copies both
        chunk.text = text.data();
        chunk.itxt_length = text.size();
        job.texts.push_back(chunk);
    }
    if (!runPngJob(job)) throw std::runtime_error(fmt::format("{}: libpng: {}", file.string(), job.error));
    return std::move(job.bytes);
}

struct PngTextJob {
    std::ifstream stream;
    std::string text; // of the chunk of facts
    std::string error;
};

void pngTextError(png_structp png, png_const_charp message) {
    static_cast<PngTextJob*>(png_get_error_ptr(png))->error = message;
    png_longjmp(png, 1);
}
void pngRead(png_structp png, png_bytep data, size_t size) {
    auto& stream = static_cast<PngTextJob*>(png_get_io_ptr(png))->stream;
    stream.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(size));
    if (static_cast<size_t>(stream.gcount()) != size) png_error(png, "the file ends early");
}

// Reads up to the first pixels.
bool runPngTextJob(PngTextJob& job) {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, pngTextError, pngWarning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_read_struct(&png, &info, nullptr);
        return false;
    }
    png_set_read_fn(png, &job, pngRead);
    png_read_info(png, info);
    png_textp texts = nullptr;
    int count = 0;
    png_get_text(png, info, &texts, &count);
    for (int i = 0; i < count; ++i)
        if (factsName == texts[i].key) job.text = texts[i].text;
    png_destroy_read_struct(&png, &info, nullptr);
    return true;
}

Json pngFacts(const fs::path& file) {
    PngTextJob job{std::ifstream(file, std::ios::binary), {}, {}};
    if (!job.stream) throw InputError(fmt::format("{}: cannot be opened", file.string()));
    if (!runPngTextJob(job)) throw InputError(fmt::format("{}: cannot be read as a PNG: {}", file.string(), job.error));
    return job.text.empty() ? Json() : parseJson(job.text);
}

// --- OpenEXR -------------------------------------------------------------------------------------------------------

std::string encodeExr(const fs::path& file, const Picture& picture, const Json& facts) {
    const size_t channels = picture.channels.size();
    const size_t texels = static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height);
    std::vector<size_t> order(channels); // OpenEXR wants its channels sorted by name
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return picture.channels[a] < picture.channels[b]; });

    std::vector<std::vector<float>> planes(channels, std::vector<float>(texels));
    std::vector<unsigned char*> planePointers;
    std::vector<EXRChannelInfo> infos(channels);
    for (size_t i = 0; i < channels; ++i) {
        for (size_t t = 0; t < texels; ++t) planes[i][t] = picture.values[t * channels + order[i]];
        planePointers.push_back(reinterpret_cast<unsigned char*>(planes[i].data()));
        const std::string& name = picture.channels[order[i]];
        name.copy(infos[i].name, sizeof(infos[i].name) - 1);
    }
    std::vector<EXRAttribute> attributes;
    std::vector<std::string> texts; // that the attributes point into
    if (!facts.is_null()) {
        texts.reserve(facts.size());
        for (const auto& [key, fact] : facts.items()) {
            std::string& text = texts.emplace_back(textOf(fact));
            EXRAttribute attribute = {};
            const std::string name = fmt::format("{}.{}", factsName, key);
            name.copy(attribute.name, sizeof(attribute.name) - 1);
            std::strcpy(attribute.type, "string");
            attribute.value = reinterpret_cast<unsigned char*>(text.data()); // only read
            attribute.size = static_cast<int>(text.size());
            attributes.push_back(attribute);
        }
    }
    std::vector<int> pixelTypes(channels, TINYEXR_PIXELTYPE_FLOAT);

    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = static_cast<int>(channels);
    header.channels = infos.data();
    header.pixel_types = header.requested_pixel_types = pixelTypes.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    header.num_custom_attributes = static_cast<int>(attributes.size());
    header.custom_attributes = attributes.data();
    EXRImage image;
    InitEXRImage(&image);
    image.width = picture.width;
    image.height = picture.height;
    image.num_channels = static_cast<int>(channels);
    image.images = planePointers.data();

    unsigned char* memory = nullptr;
    const char* error = nullptr;
    const size_t size = SaveEXRImageToMemory(&image, &header, &memory, &error);
    if (size == 0) {
        const std::string reason = error ? error : "no reason given";
        FreeEXRErrorMessage(error);
        throw std::runtime_error(fmt::format("{}: tinyexr: {}", file.string(), reason));
    }
    std::string bytes(reinterpret_cast<const char*>(memory), size);
    free(memory);
    return bytes;
}

Json exrFacts(const fs::path& file) {
    EXRVersion version;
    EXRHeader header;
    InitEXRHeader(&header);
    const char* error = nullptr;
    if (ParseEXRVersionFromFile(&version, file.c_str()) != TINYEXR_SUCCESS ||
        ParseEXRHeaderFromFile(&header, &version, file.c_str(), &error) != TINYEXR_SUCCESS) {
        const std::string reason = error ? fmt::format(": {}", error) : "";
        FreeEXRErrorMessage(error);
        throw InputError(fmt::format("{}: cannot be read as an OpenEXR file{}", file.string(), reason));
    }
    std::vector<std::pair<std::string, std::string>> texts;
    const std::string front = fmt::format("{}.", factsName);
    for (int i = 0; i < header.num_custom_attributes; ++i) {
        const EXRAttribute& attribute = header.custom_attributes[i];
        if (const std::string_view name = attribute.name; name.starts_with(front))
            texts.emplace_back(name.substr(front.size()), std::string(reinterpret_cast<char*>(attribute.value),
                                                                      static_cast<size_t>(attribute.size)));
    }
    FreeEXRHeader(&header);
    Json facts;
    for (const auto& [key, text] : texts) facts[key] = parseJson(text);
    return facts;
}

// --- PFM and NPY ---------------------------------------------------------------------------------------------------

std::string encodePfm(const fs::path& file, const Picture& picture) {
    const size_t channels = picture.channels.size();
    if (channels != 1 && channels != 3)
        throw InputError(
            fmt::format("{}: a .pfm holds 1 or 3 channels, not {} ({}); choose one of them, or .exr or .npy",
                        file.string(), channels, fmt::join(picture.channels, ", ")));
    const size_t row = static_cast<size_t>(picture.width) * channels;
    // The sign of the scale says little-endian; rows go from the bottom up.
    std::string bytes = fmt::format("{}\n{} {}\n-1.0\n", channels == 1 ? "Pf" : "PF", picture.width, picture.height);
    for (size_t y = static_cast<size_t>(picture.height); y-- > 0;)
        appendFloats(bytes, picture.values.data() + y * row, row);
    return bytes;
}

// NumPy's format version 1.0: magic, length of the header, a Python dictionary padded so that the data begin at a
// multiple of 64 bytes.
std::string encodeNpy(const Picture& picture) {
    const std::string channels =
        picture.channels.size() == 1 ? std::string() : fmt::format(", {}", picture.channels.size());
    std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}{}), }}",
                                     picture.height, picture.width, channels);
    constexpr size_t preamble = 10;
    header.append(63 - (preamble + header.size()) % 64, ' ');
    header += '\n';
    std::string bytes("\x93NUMPY\x01\x00", 8);
    bytes += static_cast<char>(header.size() & 0xff);
    bytes += static_cast<char>(header.size() >> 8);
    bytes += header;
    appendFloats(bytes, picture.values.data(), picture.values.size());
    return bytes;
}

std::string encode(const fs::path& file, const Picture& picture, const Json& facts) {
    switch (pictureFormat(file)) {
    case PictureFormat::Png: return encodePng(file, picture, facts);
    case PictureFormat::Exr: return encodeExr(file, picture, facts);
    case PictureFormat::Pfm: return encodePfm(file, picture);
    case PictureFormat::Npy: return encodeNpy(picture);
    }
    throw std::logic_error("a picture format without an encoder");
}

} // namespace

PictureFormat pictureFormat(const fs::path& file) {
    static constexpr std::pair<std::string_view, PictureFormat> formats[] = {{".png", PictureFormat::Png},
                                                                             {".exr", PictureFormat::Exr},
                                                                             {".pfm", PictureFormat::Pfm},
                                                                             {".npy", PictureFormat::Npy}};
    const std::string ending = file.extension().string();
    for (const auto& [name, format] : formats)
        if (name == ending) return format;
    throw InputError(fmt::format("{}: pictures end in .png, .exr, .pfm or .npy", file.string()));
}

void writePicture(const fs::path& file, const Picture& picture, const Json& facts) {
    ensure(facts.is_null() || facts.is_object(), "facts have names");
    ensure(picture.values.size() ==
               static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height) * picture.channels.size(),
           "a picture has another number of values than it says");
    writeFileAtomically(file, encode(file, picture, facts));
}

Json readPictureFacts(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status)) throw InputError(fmt::format("{}: No such file or directory", file.string()));
    if (!fs::is_regular_file(status)) throw InputError(fmt::format("{}: is not a regular file", file.string()));
    switch (pictureFormat(file)) {
    case PictureFormat::Png: return pngFacts(file);
    case PictureFormat::Exr: return exrFacts(file);
    default: return nullptr;
    }
}

} // namespace penumbra
