// SPDX-License-Identifier: MIT
#include "renderer/core/error.h"
#include "renderer/scene/posing.h"
#include "tests/catch.h"
#include "tests/scene/promises.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <random>
#include <set>

using namespace penumbra;
namespace fs = std::filesystem;
using json = nlohmann::json;

namespace {

// Bounds of the vertices themselves, in the pose at time 0.
Bounds exactBounds(const Scene& scene) {
    Pose pose;
    evaluatePose(scene, 0, 0, pose);
    Bounds bounds;
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        if (!node.visible || node.mesh < 0) continue;
        for (const Primitive& primitive : scene.meshes[size_t(node.mesh)].primitives)
            for (uint32_t i = 0; i < primitive.indexCount; ++i)
                bounds.add(glm::vec3(
                    pose.worldFromNode[n] *
                    glm::vec4(scene.positions[primitive.firstVertex + scene.indices[primitive.firstIndex + i]], 1)));
    }
    return bounds;
}

// A folder of the test's own that is gone afterwards.
class Folder {
public:
    Folder() : path_(fs::temp_directory_path() / ("penumbra-import-" + std::to_string(std::random_device{}()))) {
        fs::create_directories(path_);
    }
    ~Folder() { fs::remove_all(path_); }
    fs::path write(const std::string& name, const std::string& content) const {
        fs::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name, std::ios::binary) << content;
        return path_ / name;
    }

private:
    fs::path path_;
};

template <class T> std::string bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string base64(const std::string& bytes) {
    const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : alphabet[bits >> (18 - 6 * k) & 63];
    }
    return text;
}

// A unit square in the xz plane of 4 vertices, 0 to 3 along its rim, in one buffer; tests spoil copies of it.
json square() {
    const std::vector<float> positions{0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0};
    const std::vector<uint16_t> indices{0, 1, 2, 0, 2, 3};
    const std::string bytes = bytesOf(positions) + bytesOf(indices);
    json scene;
    scene["asset"]["version"] = "2.0";
    scene["buffers"] = {
        {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
    scene["bufferViews"] = {{{"buffer", 0}, {"byteLength", 48}},
                            {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 12}}};
    scene["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                          {{"bufferView", 1}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}};
    scene["meshes"] = {{{"name", "square"}, {"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}};
    scene["nodes"] = {{{"mesh", 0}}};
    scene["scenes"] = {{{"nodes", {0}}}};
    return scene;
}

std::string messageOf(const fs::path& file) {
    try {
        importGltf(file);
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

} // namespace

TEST_CASE("the shared scenes load with the triangles and bounds that others found") {
    const fs::path folder = fs::path(PENUMBRA_SHARED_FOLDER) / "scenes";
    if (!fs::exists(folder)) {
        WARN("left out: no shared scenes");
        return;
    }
    const json report = json::parse(std::ifstream(folder / "REPORT.json"));
    for (const json& entry : report) {
        const std::string file = entry["file"];
        CAPTURE(file);
        Scene scene;
        REQUIRE_NOTHROW(scene = importGltf(folder / file));
        CHECK_NOTHROW(test::checkPromises(scene));
        const json& found = entry["inspect"];
        const uint64_t instances =
            std::max(entry["gpu_instances"].get<uint64_t>(), uint64_t{1}); // theirs are not counted as triangles
        CHECK(scene.triangleCount() == entry["tris_scene"].get<uint64_t>() * instances);
        CHECK(scene.cameras.size() == found["cameras"].get<size_t>());
        CHECK(scene.skins.size() == found["skins"].get<size_t>());
        size_t joints = 0;
        for (const Skin& skin : scene.skins) joints += skin.joints.size();
        CHECK(joints == found["joints"].get<size_t>());
        CHECK(scene.animations.size() == found["animations"].get<size_t>());
        float longest = 0;
        for (const Animation& animation : scene.animations) longest = std::max(longest, animation.duration);
        CHECK(longest == Approx(found["anim_len"].get<float>()).margin(6e-4));
        scene.animations.clear(); // theirs are those of the pose at rest, without skins and instances
        const Bounds bounds = instances > 1 ? scene.meshes.at(0).primitives.at(0).bounds : exactBounds(scene);
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(bounds.min[axis] == Approx(entry["bbox"][0][size_t(axis)].get<float>()).margin(6e-4));
            CHECK(bounds.max[axis] == Approx(entry["bbox"][1][size_t(axis)].get<float>()).margin(6e-4));
        }
    }
}

TEST_CASE("the bounds of a pose hold every vertex, skinned and morphed ones too") {
    const fs::path folder = fs::path(PENUMBRA_SHARED_FOLDER) / "scenes";
    if (!fs::exists(folder)) {
        WARN("left out: no shared scenes");
        return;
    }
    for (const char* file : {"fox/Fox.glb", "cesium_man/CesiumMan.glb", "robot_expressive/RobotExpressive.glb",
                             "littlest_tokyo/LittlestTokyo.glb", "animated_morph_cube/AnimatedMorphCube.gltf",
                             "gpu_instancing/simple-instancing.glb", "box_animated/BoxAnimated.gltf"}) {
        CAPTURE(file);
        const Scene scene = importGltf(folder / file);
        for (size_t clip = 0; clip <= scene.animations.size(); ++clip) // the last one: at rest
            for (const double seconds : {0.0, 0.3, 0.9, 2.1}) {
                CAPTURE(clip, seconds);
                Pose pose;
                evaluatePose(scene, clip, seconds, pose);
                Bounds exact;
                std::vector<glm::vec3> positionsWorld;
                for (size_t n = 0; n < scene.nodes.size(); ++n) {
                    if (!scene.nodes[n].visible || scene.nodes[n].mesh < 0) continue;
                    for (const Primitive& primitive : scene.meshes[size_t(scene.nodes[n].mesh)].primitives) {
                        posedPositions(scene, pose, n, primitive, positionsWorld);
                        for (uint32_t i = 0; i < primitive.indexCount; ++i)
                            exact.add(positionsWorld[scene.indices[primitive.firstIndex + i]]);
                    }
                }
                const Bounds box = worldBounds(scene, pose);
                const float slack = 1e-4f * box.diagonal();
                CHECK(glm::all(glm::lessThanEqual(box.min - slack, exact.min)));
                CHECK(glm::all(glm::greaterThanEqual(box.max + slack, exact.max)));
                CHECK(box.diagonal() < 1.7f * exact.diagonal()); // and is not much larger
            }
    }
}

TEST_CASE("a minimal file loads from base64, beside itself and from .glb") {
    const Folder folder;
    const json embedded = square();
    const Scene first = importGltf(folder.write("square.gltf", embedded.dump()));
    CHECK(first.name == "square");
    CHECK(first.triangleCount() == 2);
    CHECK(first.positions.size() == 4);
    for (const glm::vec3& normal : first.normals) CHECK(normal == glm::vec3(0)); // the file gives none: flat

    const std::string bytes = bytesOf(std::vector<float>{0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0}) +
                              bytesOf(std::vector<uint16_t>{0, 1, 2, 0, 2, 3});
    folder.write("below/a part.bin", bytes);
    json beside = square();
    beside["buffers"][0]["uri"] = "below/a%20part.bin";
    CHECK(importGltf(folder.write("beside.gltf", beside.dump())).positions == first.positions);

    json binary = square();
    binary["buffers"][0].erase("uri");
    std::string text = binary.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto word = [](uint32_t value) { return bytesOf(std::vector<uint32_t>{value}); };
    const std::string chunks =
        word(uint32_t(text.size())) + "JSON" + text + word(uint32_t(bytes.size())) + std::string("BIN\0", 4) + bytes;
    const std::string glb = "glTF" + word(2) + word(uint32_t(12 + chunks.size())) + chunks;
    CHECK(importGltf(folder.write("binary.glb", glb)).positions == first.positions);

    // Wherever the file is cut, that is noticed.
    for (size_t length = 0; length < glb.size(); ++length) {
        CAPTURE(length);
        CHECK(!messageOf(folder.write("cut.glb", glb.substr(0, length))).empty());
    }
}

TEST_CASE("strips and fans become triangle lists with the same winding") {
    const Folder folder;
    json strip = square(), fan = square();
    // The same four corners as a strip go 0, 1, 3, 2; as a fan 0, 1, 2, 3.
    const std::string positions = bytesOf(std::vector<float>{0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0});
    const auto withIndices = [&](json scene, const std::vector<uint16_t>& indices, int mode) {
        const std::string bytes = positions + bytesOf(indices);
        scene["buffers"][0] = {{"byteLength", bytes.size()}, {"uri", "data:;base64," + base64(bytes)}};
        scene["bufferViews"][1]["byteLength"] = indices.size() * 2;
        scene["accessors"][1]["count"] = indices.size();
        scene["meshes"][0]["primitives"][0]["mode"] = mode;
        return scene;
    };
    for (const json& scene : {withIndices(strip, {0, 1, 3, 2}, 5), withIndices(fan, {0, 1, 2, 3}, 6)}) {
        const Scene loaded = importGltf(folder.write("modes.gltf", scene.dump()));
        CHECK(loaded.triangleCount() == 2);
        for (size_t i = 0; i < loaded.indices.size(); i += 3) {
            const auto corner = [&](size_t k) { return loaded.positions[loaded.indices[i + k]]; };
            CHECK(glm::cross(corner(1) - corner(0), corner(2) - corner(0)) == glm::vec3(0, 1, 0));
        }
        CHECK(exactBounds(loaded).extent() == glm::vec3(1, 0, 1));
    }
    const Scene lines = importGltf(folder.write("lines.gltf", withIndices(strip, {0, 1, 2}, 3).dump()));
    CHECK(lines.triangleCount() == 0);
    CHECK(lines.notes == std::vector<std::string>{"mesh 0 'square' primitive 0: points and lines are not drawn",
                                                  "there is nothing in it to draw"});
}

TEST_CASE("what does not fit is refused with file and place") {
    const Folder folder;
    struct Case {
        const char* expected; // part of the message
        void (*spoil)(json&);
    };
    const Case cases[] = {
        {"accessor 0", [](json& s) { s["accessors"][0]["count"] = 5; }},
        {"accessor 0", [](json& s) { s["accessors"][0]["count"] = 1'000'000'000'000'000; }},
        {"accessor 0", [](json& s) { s["accessors"][0]["byteOffset"] = 4; }},
        {"accessor 0", [](json& s) { s["accessors"][0]["type"] = "VEC2"; }},
        {"accessor 0",
         [](json& s) { s["accessors"][0].erase("bufferView"), s["accessors"][0]["count"] = 1'000'000'000'000; }},
        {"accessor 1", [](json& s) { s["accessors"][1]["componentType"] = 5126; }},
        {"index 2 is 2", [](json& s) { s["accessors"][0]["count"] = 2; }},
        {"bufferView 0", [](json& s) { s["bufferViews"][0]["byteLength"] = 61; }},
        {"bufferView 0", [](json& s) { s["bufferViews"][0]["byteOffset"] = 1'000'000'000'000'000; }},
        {"buffers[3]", [](json& s) { s["bufferViews"][0]["buffer"] = 3; }},
        {"buffer 0", [](json& s) { s["buffers"][0]["byteLength"] = 61; }},
        {"buffer 0", [](json& s) { s["buffers"][0]["byteLength"] = 1'000'000'000'000'000; }},
        {"not a file beside", [](json& s) { s["buffers"][0]["uri"] = "http://example.org/a.bin"; }},
        {"outside the scene's folder", [](json& s) { s["buffers"][0]["uri"] = "../a.bin"; }},
        {"outside the scene's folder", [](json& s) { s["buffers"][0]["uri"] = "a/%2e%2e/..%2Fa.bin"; }},
        {"outside the scene's folder", [](json& s) { s["buffers"][0]["uri"] = "/etc/hostname"; }},
        {"no such file", [](json& s) { s["buffers"][0]["uri"] = "missing.bin"; }},
        {"not base64", [](json& s) { s["buffers"][0]["uri"] = "data:;base64,@@@@"; }},
        {"mesh 7 of 1", [](json& s) { s["nodes"][0]["mesh"] = 7; }},
        {"material 1 of 0", [](json& s) { s["meshes"][0]["primitives"][0]["material"] = 1; }},
        {"node 9 of 1", [](json& s) { s["scenes"][0]["nodes"][0] = 9; }},
        {"its own ancestor", [](json& s) { s["nodes"][0]["children"] = {0}; }},
        {"two parents",
         [](json& s) {
             s["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, json::object()};
         }},
        {"beyond all measure",
         [](json& s) {
             s["nodes"] = {{{"children", {1}}, {"scale", {1e9, 1, 1}}}, {{"mesh", 0}, {"scale", {1e9, 1, 1}}}};
         }},
        {"more than 4194304 primitives",
         [](json& s) {
             json& primitives = s["meshes"][0]["primitives"];
             for (int i = 1; i < 2100; ++i) {
                 primitives.push_back(primitives[0]);
                 s["nodes"].push_back(s["nodes"][0]);
                 s["scenes"][0]["nodes"].push_back(i);
             }
         }},
        {"translation",
         [](json& s) {
             s["nodes"][0]["translation"] = {1e39, 0, 0};
         }},
        {"rotation",
         [](json& s) {
             s["nodes"][0]["rotation"] = {0, 0, 0, 0};
         }},
        {"XYZ_unknown", [](json& s) { s["extensionsRequired"] = {"XYZ_unknown"}; }},
        {"asset.version", [](json& s) { s["asset"]["version"] = "1.0"; }},
        {"meshes",
         [](json& s) {
             s["meshes"] = {{"a", 1}};
         }},
        {"alphaMode",
         [](json& s) {
             s["materials"] = {{{"alphaMode", "GLASS"}}};
         }},
        {"texture 0 of 0",
         [](json& s) {
             s["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
         }},
    };
    REQUIRE(messageOf(folder.write("good.gltf", square().dump())).empty());
    for (const Case& spoiled : cases) {
        json scene = square();
        spoiled.spoil(scene);
        CAPTURE(spoiled.expected);
        const std::string message = messageOf(folder.write("spoiled.gltf", scene.dump()));
        CAPTURE(message);
        CHECK(message.find("spoiled.gltf: ") != std::string::npos);
        CHECK(message.find(spoiled.expected) != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
    }
    CHECK(messageOf(folder.write("deep.gltf", std::string(100'000, '[')).string()).find("nests") != std::string::npos);
    CHECK(messageOf(folder.write("empty.gltf", "")).find("empty") != std::string::npos);
    CHECK(messageOf(folder.write("x/y", "").parent_path()).find("not a file") != std::string::npos);
    CHECK(messageOf("no-such-scene.glb").find("no such file") != std::string::npos);
    const std::string twoLines = "{\"asset\": {\n\"version\": }";
    CHECK(messageOf(folder.write("syntax.gltf", twoLines)).find("line 2") != std::string::npos);
}

TEST_CASE("a link out of the scene's folder is not followed") {
    const Folder folder;
    folder.write("secret.bin", std::string(60, 'x'));
    folder.write("scene/beside", "");
    json scene = square();
    scene["buffers"][0]["uri"] = "link.bin";
    const fs::path file = folder.write("scene/linked.gltf", scene.dump());
    fs::create_symlink(file.parent_path().parent_path() / "secret.bin", file.parent_path() / "link.bin");
    CHECK(messageOf(file).find("outside") != std::string::npos);
}

TEST_CASE("a picture is checked before it is decoded") {
    const Folder folder;
    json scene = square();
    scene["images"] = {{{"uri", "picture.png"}}};
    scene["textures"] = {{{"source", 0}}};
    scene["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    const fs::path file = folder.write("textured.gltf", scene.dump());
    CHECK(messageOf(file).find("no such file") != std::string::npos);
    folder.write("picture.png", "no picture");
    CHECK(messageOf(file).find("cannot be decoded") != std::string::npos);
    // A PNG of 17,000 x 1 texels that has none of them.
    const std::string head("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x42\x68\0\0\0\1\x08\6\0\0\0\0\0\0\0", 33);
    const std::string noTexels("\0\0\0\0IDAT\0\0\0\0", 12);
    folder.write("picture.png", head + noTexels);
    const std::string message = messageOf(file);
    CAPTURE(message);
    CHECK(message.find("17000x1 texels") != std::string::npos);
}

TEST_CASE("a texture transform moves the texture coordinates") {
    const fs::path file = fs::path(PENUMBRA_SHARED_FOLDER) / "scenes/texture_transform_test/TextureTransformTest.gltf";
    if (!fs::exists(file)) {
        WARN("left out: no shared scenes");
        return;
    }
    const Scene scene = importGltf(file);
    CHECK(scene.textures.size() >= 1);
    std::set<std::pair<float, float>> corners;
    for (const glm::vec2& uv : scene.uvs) corners.insert({uv.x, uv.y});
    CHECK(corners.contains({0.0f, 0.0f}));
    CHECK(corners.size() > 4); // more than those of the square itself
}

TEST_CASE("lights keep the size and shape that their extras state") {
    const Folder folder;
    json scene = square();
    scene["extensionsUsed"] = {"KHR_lights_punctual"};
    scene["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", json::object()}, {"color", {1, 0.5, 0.25}}, {"extras", {{"size", {2, 3}}}}},
        {{"type", "point"}, {"extras", {{"size", 0.5}, {"shape", "disk"}}}},
        {{"type", "directional"}}};
    const auto lightNode = [](int light) {
        return json{{"translation", {0.5, 4, 0.5}},
                    {"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}, // −Z turned to −Y
                    {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}};
    };
    scene["nodes"] = {{{"mesh", 0}}, lightNode(0), lightNode(1), lightNode(2)};
    scene["scenes"][0]["nodes"] = {0, 1, 2, 3};
    const Scene loaded = importGltf(folder.write("lights.gltf", scene.dump()));
    REQUIRE(loaded.lights.size() == 3);
    CHECK(loaded.notes.empty());
    Pose pose;
    evaluatePose(loaded, 0, 0, pose);

    const AreaLight rectangle = sceneLight(loaded, pose, loaded.lights[0]);
    CHECK(rectangle.shape == LightShape::Rectangle);
    CHECK(rectangle.size == glm::vec2(2, 3));
    CHECK(rectangle.colour == glm::vec3(1, 0.5f, 0.25f));
    CHECK(glm::distance(rectangle.position, glm::vec3(0.5f, 4, 0.5f)) < 1e-5f);
    CHECK(glm::distance(rectangle.target, glm::vec3(0.5f, 0, 0.5f)) < 1e-5f);

    const AreaLight disk = sceneLight(loaded, pose, loaded.lights[1]);
    CHECK(disk.shape == LightShape::Disk);
    CHECK(disk.size.x == 0.5f);

    const AreaLight sun = sceneLight(loaded, pose, loaded.lights[2]);
    CHECK(sun.shape == LightShape::Directional);
    CHECK(sun.size.x == 2);
    CHECK(glm::normalize(sun.position - sun.target).y == Approx(1));
    CHECK(sun.position.y > 1);

    scene["extensions"]["KHR_lights_punctual"]["lights"][0]["extras"]["size"] = -1;
    CHECK(messageOf(folder.write("lights.gltf", scene.dump())).find("'size'") != std::string::npos);
}

namespace {

// A file below ../shared/scenes, or nothing with a word about it.
std::optional<Scene> sharedScene(const char* name) {
    const fs::path file = fs::path(PENUMBRA_SHARED_FOLDER) / "scenes" / name;
    if (fs::exists(file)) return importGltf(file);
    WARN("left out: no " << name);
    return std::nullopt;
}

// How far the corners of the triangles of `a` are from the nearest vertex of `b` at most.
float farthest(const Scene& a, const Scene& b) {
    float most = 0;
    for (size_t i = 0; i < a.positions.size(); i += 97) {
        float nearest = 1e30f;
        for (const glm::vec3& q : b.positions) nearest = std::min(nearest, glm::distance(a.positions[i], q));
        most = std::max(most, nearest);
    }
    return most;
}

} // namespace

TEST_CASE("what Draco and meshopt compressed is what was there before") {
    const auto plain = sharedScene("draco_pair/draco_test.glb"), draco = sharedScene("draco_pair/draco_test_draco.glb");
    if (plain && draco) {
        CHECK(draco->triangleCount() == plain->triangleCount());
        const float step = worldBounds(*plain,
                                       [&] {
                                           Pose pose;
                                           evaluatePose(*plain, 0, 0, pose);
                                           return pose;
                                       }())
                               .diagonal() /
                           2048; // of a quantisation to 11 bits
        CHECK(farthest(*plain, *draco) < step);
        CHECK(farthest(*draco, *plain) < step);
    }
    const auto fallback = sharedScene("meshopt_quantized_boxes/meshopt-fallback/meshopt-fallback.gltf"),
               compressed = sharedScene("meshopt_quantized_boxes/meshopt-no-fallback/meshopt-no-fallback.gltf");
    if (fallback && compressed) {
        CHECK(compressed->triangleCount() == fallback->triangleCount());
        CHECK(farthest(*compressed, *fallback) == 0);
        CHECK(farthest(*fallback, *compressed) == 0);
    }
}

TEST_CASE("a file's scenes and variants are chosen by name") {
    const Folder folder;
    json scene = square();
    scene["extensionsUsed"] = {"KHR_materials_variants"};
    scene["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "wood"}}, {{"name", "stone"}}};
    scene["materials"] = {{{"name", "plain"}}, {{"name", "oak"}}, {{"name", "granite"}}};
    scene["meshes"][0]["primitives"][0]["material"] = 0;
    scene["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", 1}, {"variants", {0}}}, {{"material", 2}, {"variants", {1}}}};
    scene["nodes"] = {{{"mesh", 0}}, {{"name", "empty"}}};
    scene["scenes"] = {{{"name", "full"}, {"nodes", {0}}}, {{"name", "bare"}, {"nodes", {1}}}};
    const fs::path file = folder.write("choice.gltf", scene.dump());

    const auto materialOf = [](const Scene& s) { return s.materials[size_t(s.meshes[0].primitives[0].material)].name; };
    const Scene plain = importGltf(file);
    CHECK(plain.sceneNames == std::vector<std::string>{"full", "bare"});
    CHECK(plain.variantNames == std::vector<std::string>{"wood", "stone"});
    CHECK(plain.triangleCount() == 2);
    CHECK(materialOf(plain) == "plain");
    CHECK(materialOf(importGltf(file, ImportChoice{.scene = {}, .variant = "wood"})) == "oak");
    CHECK(materialOf(importGltf(file, ImportChoice{.scene = {}, .variant = "stone"})) == "granite");
    CHECK(importGltf(file, ImportChoice{.scene = "bare", .variant = {}}).triangleCount() == 0);
    CHECK_THROWS_WITH(importGltf(file, ImportChoice{.scene = "ful", .variant = {}}), contains("did you mean 'full'"));
    CHECK_THROWS_WITH(importGltf(file, ImportChoice{.scene = {}, .variant = "gold"}), contains("wood, stone"));
}

TEST_CASE("instances of a mesh stand where their attributes put them") {
    const Folder folder;
    json scene = square();
    const std::string positions = bytesOf(std::vector<float>{0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0}),
                      indices = bytesOf(std::vector<uint16_t>{0, 1, 2, 0, 2, 3}),
                      places = bytesOf(std::vector<float>{0, 0, 0, 5, 0, 0}),
                      scales = bytesOf(std::vector<float>{1, 1, 1, 2, 2, 2});
    const std::string bytes = positions + indices + places + scales;
    scene["buffers"][0] = {{"byteLength", bytes.size()}, {"uri", "data:;base64," + base64(bytes)}};
    scene["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 48}});
    scene["accessors"].push_back({{"bufferView", 2}, {"componentType", 5126}, {"count", 2}, {"type", "VEC3"}});
    scene["accessors"].push_back(
        {{"bufferView", 2}, {"byteOffset", 24}, {"componentType", 5126}, {"count", 2}, {"type", "VEC3"}});
    scene["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    scene["nodes"][0]["translation"] = {0, 3, 0};
    scene["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", 2}, {"SCALE", 3}};
    const Scene loaded = importGltf(folder.write("instances.gltf", scene.dump()));
    CHECK(loaded.triangleCount() == 4);
    const Bounds bounds = exactBounds(loaded);
    CHECK(bounds.min == glm::vec3(0, 3, 0));
    CHECK(bounds.max == glm::vec3(7, 3, 2));
    CHECK(loaded.notes.empty());
}

TEST_CASE("a progress that is cancelled stops the import") {
    const Folder folder;
    const fs::path file = folder.write("square.gltf", square().dump());
    Progress progress;
    CHECK_NOTHROW(importGltf(file, {}, &progress));
    CHECK(progress.share() > 0.5);
    progress.cancel();
    CHECK_THROWS_AS(importGltf(file, {}, &progress), Cancelled);
}
