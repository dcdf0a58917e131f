// SPDX-License-Identifier: MIT
// fuzz-seeds MOST_BYTES OUT FOLDER ...: packs every small glTF file below the folders, with what it refers to, into a
// .glb in OUT: files without company for the fuzzer, which mutates their two chunks apart.
#include "tests/robustness/support/hostile.h"
#include "tests/robustness/support/mutations.h"

#include "renderer/core/error.h"
#include "renderer/scene/gltf_file.h"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>

using namespace penumbra;
using namespace penumbra::test;
namespace fs = std::filesystem;
using json = nlohmann::json;

namespace {

size_t append(std::vector<uint8_t>& binary, std::span<const uint8_t> bytes) {
    binary.resize((binary.size() + 3) / 4 * 4);
    const size_t offset = binary.size();
    binary.insert(binary.end(), bytes.begin(), bytes.end());
    return offset;
}

// All buffers as one; pictures beside the file become views of it. Throws InputError if something is missing.
std::vector<uint8_t> packed(const fs::path& file) {
    const std::vector<std::string_view> required{
        "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_mesh_quantization",   "KHR_texture_transform",
        "KHR_lights_punctual",        "KHR_materials_unlit",     "EXT_mesh_gpu_instancing", "EXT_texture_webp"};
    GltfFile gltf(file, required);
    json document = gltf.document();
    Glb glb;
    std::vector<size_t> offsets;
    for (size_t i = 0; i < document.value("buffers", json::array()).size(); ++i) {
        const bool isFallback =
            document["buffers"][i].contains("extensions") && !document["buffers"][i].contains("uri");
        offsets.push_back(isFallback ? 0 : append(glb.binary, gltf.buffer(i, "buffer")));
    }
    const auto move = [&](json& view) {
        view["byteOffset"] = view.value("byteOffset", size_t{0}) + offsets.at(view.at("buffer"));
        view["buffer"] = 0;
    };
    for (json& view : document["bufferViews"]) {
        move(view);
        if (view.contains("extensions") && view["extensions"].contains("EXT_meshopt_compression"))
            move(view["extensions"]["EXT_meshopt_compression"]);
    }
    for (json& image : document.value("images", json::array()).empty() ? json::array() : document["images"]) {
        const std::string uri = image.value("uri", "data:");
        if (uri.starts_with("data:")) continue;
        const std::vector<uint8_t> bytes = bytesOfFile(file.parent_path() / uri);
        const size_t offset = append(glb.binary, bytes);
        document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
        image = {{"bufferView", document["bufferViews"].size() - 1}, {"mimeType", "image/png"}};
    }
    document["buffers"] = {{{"byteLength", glb.binary.size()}}};
    glb.json = document.dump();
    return joinGlb(glb);
}

} // namespace

int main(int count, char** arguments) {
    if (count < 4) return 2;
    const size_t mostBytes = std::stoul(arguments[1]);
    const fs::path out = arguments[2];
    fs::create_directories(out);
    size_t written = 0;
    for (int i = 3; i < count; ++i)
        for (const fs::path& file : gltfFilesBelow(arguments[i], mostBytes)) {
            std::vector<uint8_t> bytes;
            try {
                bytes = packed(file);
            } catch (const std::exception&) {
                bytes = bytesOfFile(file); // broken files are good seeds as they are
            }
            if (bytes.size() > mostBytes) continue;
            std::ofstream(out / fmt::format("{:03}-{}.glb", written++, file.stem().string()), std::ios::binary)
                .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
        }
    std::printf("fuzz-seeds: %zu files in %s\n", written, out.c_str());
    return written > 0 ? 0 : 2;
}
