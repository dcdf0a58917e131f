// SPDX-License-Identifier: MIT
// Broken glTF files as a user meets them: one line that says what is wrong, or a picture that is none the worse for it.
#include "tests/app/picture_reader.h"
#include "tests/app/program.h"
#include "tests/catch.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <future>

using namespace penumbra::test;
namespace fs = std::filesystem;

namespace {

// Whether each of the shared broken files loads, or else what its refusal says after the file's name. A place that
// others call an error but that nothing drawn depends on, such as a camera's far plane, is no reason to refuse.
struct Broken {
    const char* file;
    const char* refusal; // null: it loads
};
constexpr const char* loads = nullptr;
constexpr Broken brokenFiles[] = {
    {"assimp/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb",
     "accessor 2, mesh 0 'Mesh' primitive 0 POSITION: element 0 is -inf; expected a number"},
    {"assimp/IndexOutOfRange/IndexOutOfRange.gltf", "index 0 is 255; expected less than the 24 vertices"},
    {"assimp/MissingBin/BoxTextured.gltf", "buffer 0 'BoxTextured0.bin': no such file"},
    {"assimp/RecursiveNodes/RecursiveNodes.gltf", "node 0: is its own ancestor; expected a tree"},
    {"assimp/TestNoRootNode/NoScene.gltf", "scene: refers to scene 0 of 0"},
    {"assimp/wrongTypes/badArray.gltf", "meshes.primitives: expected an array"},
    {"assimp/wrongTypes/badUint.gltf", "material 0 'Texture': index is -1; expected a whole number of at least 0"},
    {"draco/ZeroLengthBufferView/ZeroLengthBufferView.gltf", "bufferView 2: byteLength is 0 or missing"},
    {"tinygltf/BoundsChecking/integer-out-of-bounds.gltf",
     "bufferView 0: byteLength is 1e+300; expected a whole number"},
    {"tinygltf/BoundsChecking/invalid-buffer-index.gltf", "bufferView 1: refers to buffers[1] of 1"},
    {"validator/accessor/invalid_sparse_count_and_stride.gltf", "buffer 0: has neither a uri nor a binary chunk"},
    {"validator/accessor/small_stride.gltf", "buffer 0: has neither a uri nor a binary chunk"},
    {"validator/accessor/unresolved_bufferviews.gltf", "accessor 0: refers to bufferView 0 of 0"},
    {"validator/accessor_data/invalid_elements_float.gltf", loads},
    {"validator/animation/sampler_output_count_invalid.gltf", "animation 0 channel 0: has 6 numbers for 1 times"},
    {"validator/animation/unresolved_channel_target.gltf", "animation 0 channel 0: refers to node 0 of 0"},
    {"validator/animation_data/invalid_input_values.gltf", loads},
    {"validator/asset/1_0_version.gltf", "asset.version: is 1.0; expected 2.0"},
    {"validator/buffer/invalid_uri_data_bytelength.gltf", "buffer 0: byteLength is 2 but 1 bytes are there"},
    {"validator/buffer/not_found.gltf", "buffer 0 'not_found.bin': no such file"},
    {"validator/buffer/wrong_bytelength.glb", "buffer 0: byteLength is 17 but 16 bytes are there"},
    {"validator/buffer/zero_bytelength.gltf", loads}, // nothing uses it
    {"validator/buffer_view/invalid_length.gltf", "bufferView 0: ends at byte 5 of a buffer of 4"},
    {"validator/buffer_view/unresolved_buffer.gltf", "bufferView 0: refers to buffers[1] of 1"},
    {"validator/camera/perspective_z.gltf", loads},
    {"validator/glb/chunk_too_big.glb", "chunk 0: has no room in the 13 bytes that the header states"},
    {"validator/glb/empty_file.glb", "file: is empty; expected glTF 2.0"},
    {"validator/glb/invalid_json_chunk.glb", "line 1: is not valid JSON"},
    {"validator/glb/invalid_magic.glb", "header: expected a binary glTF file, which starts with 'glTF'"},
    {"validator/glb/length_mismatch.glb", "header: states 49 bytes but the file has 48; it was cut short"},
    {"validator/glb/no_header.glb", "header: expected a binary glTF file, which starts with 'glTF'"},
    {"validator/glb/truncated_chunk_data.glb", "header: states 48 bytes but the file has 47; it was cut short"},
    {"validator/glb/two_bin_chunks.glb", "chunk 0: expected the JSON chunk first"},
    {"validator/glb/unaligned_chunk.glb", loads},
    {"validator/glb/valid_buffer.glb", loads},
    {"validator/image/invalid_image_data.gltf", loads}, // nothing uses it
    {"validator/image/not_found.gltf", loads},          // nor this
    {"validator/json/bom.gltf", loads},
    {"validator/json/invalid_syntax.gltf", "line 1: is not valid JSON"},
    {"validator/mesh/accessor_unequal_count.gltf", "has attributes of different counts: 4 COLOR_0 and 3 positions"},
    {"validator/mesh/indices_invalid_format.gltf",
     "accessor 1, mesh 0 primitive 0: expected indices: unsigned integers"},
    {"validator/mesh/position_accessor_no_bounds.gltf", loads},
    {"validator/mesh/primitive_no_position.gltf", loads},
    {"validator/mesh/unresolved_indices.gltf", "mesh 0 primitive 0: refers to accessor 1 of 1"},
    {"validator/mesh_data/index_buffer_degenerate_triangle.gltf", loads},
    {"validator/mesh_data/index_buffer_oob.gltf", "index 5 is 5; expected less than the 4 vertices"},
    {"validator/node/infinite_transform.gltf", "JSON: number overflow parsing '1e309'"},
    {"validator/node/matrix_trs.gltf", loads},
    {"validator/node/node_loop.gltf", "node 0: is its own ancestor; expected a tree"},
    {"validator/node/unresolved_mesh.gltf", "node 0: refers to mesh 0 of 0"},
    {"validator/root/invalid_collection_type.gltf", "samplers: expected an array of objects"},
    {"validator/scene/unresolved_node.gltf", "scene 0: refers to node 0 of 0"},
    {"validator/skin/ibm_invalid_count.gltf", "skin 2: has 2 inverse bind matrices for 3 joints"},
    {"validator_lights/light/spot_invalid_angles.gltf", loads},
    {"validator_lights/node/unresolved_light_no_root_ext.gltf", "node 0: refers to light 0 of 0"},
};

struct Outcome {
    Result result;
    double seconds = 0;
    std::vector<float> psi;
};

Outcome shadowOf(const fs::path& scene) {
    const TemporaryFolder folder;
    const auto start = std::chrono::steady_clock::now();
    Outcome outcome;
    outcome.result = runProgram({"capture", scene, "--buffer", "shadow", "--size", "32x18", "-o", folder / "psi.npy"});
    outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (outcome.result.exitCode == 0) outcome.psi = readNpy(folder / "psi.npy").values;
    return outcome;
}

} // namespace

TEST_CASE("every shared broken scene is refused in one line or gives a shadow of finite numbers") {
    const fs::path folder = fs::path(PENUMBRA_SHARED_FOLDER) / "scenes/bad";
    if (!fs::exists(folder)) {
        WARN("left out: no shared scenes");
        return;
    }
    size_t found = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        found += entry.is_regular_file() && (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb");
    CHECK(found == std::size(brokenFiles));

    const auto start = [&](size_t i) { return std::async(std::launch::async, shadowOf, folder / brokenFiles[i].file); };
    std::future<Outcome> next = start(0); // two at a time
    for (size_t i = 0; i < std::size(brokenFiles); ++i) {
        std::future<Outcome> running = std::move(next);
        if (i + 1 < std::size(brokenFiles)) next = start(i + 1);
        const auto& [file, refusal] = brokenFiles[i];
        const auto [result, seconds, psi] = running.get();
        CAPTURE(file, result.errors);
        CHECK(seconds < 10);
        if (refusal) {
            CHECK(result.exitCode == 2);
            CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
            CHECK(contains(result.errors, (folder / file).string() + ": "));
            CHECK(contains(result.errors, refusal));
        } else {
            CHECK(result.exitCode == 0);
            CHECK_FALSE(contains(result.errors, "OpenGL"));
            CHECK(psi.size() == size_t(32) * 18);
            CHECK(std::all_of(psi.begin(), psi.end(), [](float value) { return value >= 0 && value <= 1; }));
        }
    }
}
