// SPDX-License-Identifier: MIT
// Writes a large .glb: wavy sheets of triangles, each with a picture of noise that no compression makes smaller.
//
//     big-scene FILE MEGABYTES
//
// Two fifths of the bytes are vertices and triangles, the rest pictures. Prints the bytes of vertices, triangles and
// decoded pictures.
#include "app/file_io.h"
#include "app/image_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>

using namespace penumbra;

namespace {

constexpr int side = 1024;      // of a picture
constexpr uint32_t cells = 180; // along a sheet

std::string noisePng(const std::filesystem::path& folder, std::minstd_rand& random) {
    Picture picture{side, side, {"R", "G", "B"}, {}};
    picture.values.resize(size_t(side) * side * 3);
    for (float& value : picture.values) value = static_cast<float>(random() % 256) / 255;
    const std::filesystem::path file = folder / "noise.png";
    writePicture(file, picture);
    std::string bytes = readFile(file, size_t{1} << 30);
    std::filesystem::remove(file);
    return bytes;
}

template <class T> void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

std::string sheet(float height) { // positions, normals, texture coordinates, indices
    std::string positions, normals, uvs, indices;
    constexpr uint32_t points = cells + 1;
    for (uint32_t j = 0; j < points; ++j)
        for (uint32_t i = 0; i < points; ++i) {
            const float u = float(i) / cells, v = float(j) / cells;
            for (const float x : {u, height + 0.02f * std::sin(20 * u) * std::sin(20 * v), v}) append(positions, x);
            for (const float x : {0.0f, 1.0f, 0.0f}) append(normals, x);
            for (const float x : {u, v}) append(uvs, x);
        }
    for (uint32_t j = 0; j < cells; ++j)
        for (uint32_t i = 0; i < cells; ++i) {
            const uint32_t a = j * points + i, c = a + points;
            for (const uint32_t corner : {a, c, a + 1, a + 1, c, c + 1}) append(indices, corner);
        }
    return positions + normals + uvs + indices;
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 3) return std::fprintf(stderr, "big-scene FILE MEGABYTES\n"), 2;
    const std::filesystem::path file = argv[1];
    const double wanted = std::atof(argv[2]) * 1e6;
    std::minstd_rand random(7);

    constexpr uint32_t points = (cells + 1) * (cells + 1), corners = cells * cells * 6;
    const std::string noise = noisePng(file.parent_path(), random);
    std::string body, views, accessors, meshes, nodes, images, textures, materials;
    uint64_t geometry = 0, decoded = 0;
    int view = 0, accessor = 0, count = 0;
    const auto item = [](std::string& list, const std::string& text) { list += (list.empty() ? "" : ",") + text; };
    const auto bufferView = [&](size_t offset, size_t bytes) {
        item(views, fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}}})", offset, bytes));
        return view++;
    };
    const auto access = [&](size_t offset, size_t bytes, int type, uint32_t n, const char* shape, const char* bounds) {
        item(accessors, fmt::format(R"({{"bufferView":{},"componentType":{},"count":{},"type":"{}"{}}})",
                                    bufferView(offset, bytes), type, n, shape, bounds));
        return accessor++;
    };
    std::string pictures;
    const size_t sheetBytes = size_t(points) * 32 + size_t(corners) * 4;
    const int sheets = std::max(1, int(0.4 * wanted / double(sheetBytes)));
    const int noises = std::max(1, int(0.6 * wanted / double(noise.size())));
    for (int i = 0; i < noises; ++i) {
        const std::string bytes = i == 0 ? noise : noisePng(file.parent_path(), random);
        const size_t offset = body.size();
        body += bytes;
        body.resize((body.size() + 3) / 4 * 4);
        item(images, fmt::format(R"({{"bufferView":{},"mimeType":"image/png"}})", bufferView(offset, bytes.size())));
        item(textures, fmt::format(R"({{"source":{}}})", i));
        item(materials,
             fmt::format(R"({{"doubleSided":true,"pbrMetallicRoughness":{{"baseColorTexture":{{"index":{}}}}}}})", i));
        decoded += uint64_t(side) * side * 4;
    }
    for (int i = 0; i < sheets; ++i) {
        const size_t at = body.size();
        body += sheet(0.3f * float(i) / float(sheets));
        geometry += sheetBytes;
        const int position = access(at, size_t(points) * 12, 5126, points, "VEC3",
                                    R"(,"min":[0,-0.1,0],"max":[1,0.4,1])"); // more than enough
        const int normal = access(at + size_t(points) * 12, size_t(points) * 12, 5126, points, "VEC3", "");
        const int uv = access(at + size_t(points) * 24, size_t(points) * 8, 5126, points, "VEC2", "");
        const int index = access(at + size_t(points) * 32, size_t(corners) * 4, 5125, corners, "SCALAR", "");
        item(meshes, fmt::format(R"({{"primitives":[{{"attributes":{{"POSITION":{},"NORMAL":{},"TEXCOORD_0":{}}},)"
                                 R"("indices":{},"material":{}}}]}})",
                                 position, normal, uv, index, i % noises));
        item(nodes, fmt::format(R"({{"mesh":{}}})", i));
        ++count;
    }
    std::string roots;
    for (int i = 0; i < count; ++i) item(roots, fmt::format("{}", i));
    std::string json =
        fmt::format(R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],"meshes":[{}],)"
                    R"("materials":[{}],"textures":[{}],"images":[{}],"accessors":[{}],"bufferViews":[{}],)"
                    R"("buffers":[{{"byteLength":{}}}]}})",
                    roots, nodes, meshes, materials, textures, images, accessors, views, body.size());
    json.resize((json.size() + 3) / 4 * 4, ' ');

    std::string glb = "glTF";
    append(glb, uint32_t{2});
    append(glb, static_cast<uint32_t>(12 + 8 + json.size() + 8 + body.size()));
    append(glb, static_cast<uint32_t>(json.size()));
    glb += "JSON" + json;
    append(glb, static_cast<uint32_t>(body.size()));
    glb += std::string("BIN\0", 4) + body;
    writeFileAtomically(file, {glb.data(), glb.size()});
    std::printf("%llu %llu\n", static_cast<unsigned long long>(geometry), static_cast<unsigned long long>(decoded));
    return 0;
}
