// SPDX-License-Identifier: MIT
#include "tests/app/picture_reader.h"

#include "tests/app/program.h"

#include <png.h>
#include <tinyexr.h>

#include <cstring>
#include <regex>
#include <stdexcept>

namespace penumbra::test {
namespace {

void expect(bool condition, const std::string& what) {
    if (!condition) throw std::runtime_error("not a well-formed picture: " + what);
}

uint32_t bigEndian(const std::string& bytes, size_t at) {
    uint32_t number = 0;
    for (size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(bytes.at(at + i));
    return number;
}

// iTXt: keyword 0 compressed method language 0 translation 0 text
void readText(const std::string& chunk, std::map<std::string, std::string>& facts) {
    const size_t keyEnd = chunk.find('\0');
    expect(chunk.at(keyEnd + 1) == 0, "the text is not compressed");
    const size_t languageEnd = chunk.find('\0', keyEnd + 3);
    const size_t translationEnd = chunk.find('\0', languageEnd + 1);
    facts[chunk.substr(0, keyEnd)] = chunk.substr(translationEnd + 1);
}

std::vector<float> floats(const std::string& bytes, size_t at, size_t count) {
    expect(bytes.size() == at + count * sizeof(float), "the size of the file fits its header");
    std::vector<float> values(count);
    std::memcpy(values.data(), bytes.data() + at, count * sizeof(float));
    return values;
}

} // namespace

ReadPicture readPng(const std::filesystem::path& file) {
    png_image image = {};
    image.version = PNG_IMAGE_VERSION;
    expect(png_image_begin_read_from_file(&image, file.c_str()), image.message);
    const bool grey = (image.format & PNG_FORMAT_FLAG_COLOR) == 0;
    image.format = grey ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
    std::vector<png_byte> texels(PNG_IMAGE_SIZE(image));
    expect(png_image_finish_read(&image, nullptr, texels.data(), 0, nullptr), image.message);
    ReadPicture picture{static_cast<int>(image.width),
                        static_cast<int>(image.height),
                        std::vector<std::string>(grey ? 1 : 3),
                        {texels.begin(), texels.end()}};

    const std::string bytes = readAll(file);
    for (size_t at = 8; at < bytes.size(); at += bigEndian(bytes, at) + 12)
        if (bytes.substr(at + 4, 4) == "iTXt") readText(bytes.substr(at + 8, bigEndian(bytes, at)), picture.facts);
    return picture;
}

ReadPicture readExr(const std::filesystem::path& file) {
    EXRVersion version;
    EXRHeader header;
    EXRImage image;
    InitEXRHeader(&header);
    InitEXRImage(&image);
    const char* error = nullptr;
    expect(ParseEXRVersionFromFile(&version, file.c_str()) == TINYEXR_SUCCESS, "EXR version");
    expect(ParseEXRHeaderFromFile(&header, &version, file.c_str(), &error) == TINYEXR_SUCCESS, "EXR header");
    expect(LoadEXRImageFromFile(&image, &header, file.c_str(), &error) == TINYEXR_SUCCESS, "EXR pixels");
    ReadPicture picture{image.width, image.height};
    const auto channels = static_cast<size_t>(image.num_channels);
    const size_t texels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    picture.values.resize(texels * channels);
    for (size_t c = 0; c < channels; ++c) {
        expect(header.pixel_types[c] == TINYEXR_PIXELTYPE_FLOAT, "32-bit floats");
        picture.channels.push_back(header.channels[c].name);
        for (size_t t = 0; t < texels; ++t)
            picture.values[t * channels + c] = reinterpret_cast<float*>(image.images[c])[t];
    }
    for (int i = 0; i < header.num_custom_attributes; ++i) {
        const EXRAttribute& attribute = header.custom_attributes[i];
        picture.facts[attribute.name] =
            std::string(reinterpret_cast<char*>(attribute.value), static_cast<size_t>(attribute.size));
    }
    FreeEXRImage(&image);
    FreeEXRHeader(&header);
    return picture;
}

ReadPicture readPfm(const std::filesystem::path& file) {
    const std::string bytes = readAll(file);
    std::smatch match;
    expect(std::regex_search(bytes, match, std::regex("^P([Ff])\n([0-9]+) ([0-9]+)\n-1.0\n")), "PFM header");
    const size_t channels = match[1] == "F" ? 3 : 1;
    ReadPicture picture{std::stoi(match[2]), std::stoi(match[3]), std::vector<std::string>(channels)};
    const size_t row = static_cast<size_t>(picture.width) * channels, rows = static_cast<size_t>(picture.height);
    const std::vector<float> upwards = floats(bytes, static_cast<size_t>(match.length()), row * rows);
    for (size_t y = rows; y-- > 0;)
        picture.values.insert(picture.values.end(), upwards.begin() + static_cast<std::ptrdiff_t>(y * row),
                              upwards.begin() + static_cast<std::ptrdiff_t>((y + 1) * row));
    return picture;
}

ReadPicture readNpy(const std::filesystem::path& file) {
    const std::string bytes = readAll(file);
    expect(bytes.substr(0, 8) == std::string("\x93NUMPY\x01\x00", 8), "NPY magic");
    const size_t length = static_cast<unsigned char>(bytes.at(8)) + 256u * static_cast<unsigned char>(bytes.at(9));
    const std::string header = bytes.substr(10, length);
    expect((10 + length) % 64 == 0 && header.back() == '\n', "NPY header's padding");
    std::smatch match;
    expect(
        std::regex_search(
            header, match,
            std::regex(R"(^\{'descr': '<f4', 'fortran_order': False, 'shape': \((\d+), (\d+)(, (\d+))?\), \} *\n$)")),
        "NPY header " + header);
    const size_t channels = match[4].matched ? std::stoul(match[4]) : 1;
    ReadPicture picture{std::stoi(match[2]), std::stoi(match[1]), std::vector<std::string>(channels)};
    picture.values =
        floats(bytes, 10 + length, static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height) * channels);
    return picture;
}

} // namespace penumbra::test
