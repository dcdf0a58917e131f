// SPDX-License-Identifier: MIT
#include "renderer/scene/closed_surface.h"
#include "renderer/scene/scene.h"
#include "tests/catch.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

using namespace penumbra;
namespace fs = std::filesystem;

namespace {

const fs::path builtInFolder = fs::path(PENUMBRA_SOURCE_FOLDER) / "assets/scenes";

std::string contentOf(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<fs::path> builtInFiles() {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(builtInFolder))
        if (entry.path().extension() == ".glb") files.push_back(entry.path());
    return files;
}

Scene builtIn(const std::string& name) { return importGltf(builtInFolder / (name + ".glb")); }

} // namespace

TEST_CASE("make-scenes writes the built-in scenes as they are stored") {
    const fs::path folder = fs::temp_directory_path() / ("penumbra-scenes-" + std::to_string(std::random_device{}()));
    const std::string command = "'" PENUMBRA_MAKE_SCENES "' '" + folder.string() + "'";
    REQUIRE(std::system(command.c_str()) == 0);
    size_t made = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        CAPTURE(entry.path().filename().string());
        CHECK((contentOf(entry.path()) == contentOf(builtInFolder / entry.path().filename())));
        ++made;
    }
    CHECK(made == builtInFiles().size());
    fs::remove_all(folder);
}

TEST_CASE("every built-in scene has a camera, a light with a size, a floor and nothing to note") {
    CHECK(builtInFiles().size() == 14);
    for (const fs::path& file : builtInFiles()) {
        CAPTURE(file.filename().string());
        const Scene scene = importGltf(file);
        CHECK(scene.name == file.stem().string());
        CHECK(scene.cameras.size() == 1);
        REQUIRE(scene.lights.size() == 1);
        CHECK(scene.lights[0].size.x > 0);
        CHECK(scene.notes.empty());
        CHECK(scene.description.ends_with('.'));
        Pose pose;
        evaluatePose(scene, 0, 0, pose);
        CHECK_FALSE(wantsGround(scene, pose));
        const AreaLight light = defaultLight(scene, pose);
        CHECK(light.position.y > worldBounds(scene, pose).max.y);

        // Surfaces face where their normals point.
        for (const Mesh& mesh : scene.meshes)
            for (const Primitive& primitive : mesh.primitives) {
                int turned = 0;
                for (uint32_t i = 0; i < primitive.indexCount; i += 3) {
                    const uint32_t* corner = &scene.indices[primitive.firstIndex + i];
                    const auto position = [&](int k) { return scene.positions[primitive.firstVertex + corner[k]]; };
                    const glm::vec3 normal = glm::cross(position(1) - position(0), position(2) - position(0));
                    turned += glm::dot(normal, scene.normals[primitive.firstVertex + corner[0]]) < 0;
                }
                CAPTURE(mesh.name);
                CHECK(turned == 0);
            }
    }
}

TEST_CASE("the courtyard is rich but not heavy") {
    const Scene scene = builtIn("courtyard");
    CHECK(scene.triangleCount() >= 66'000);
    CHECK(scene.triangleCount() <= 74'000);
    CHECK(fs::file_size(builtInFolder / "courtyard.glb") < 2u << 20);
    CHECK(scene.textures.size() <= 6); // each is a draw call of its own

    // What is solid is closed, so that its backs need no drawing into a shadow map; sheets show both sides.
    int masked = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& primitive : mesh.primitives) {
            const Material& material = scene.materials[size_t(primitive.material)];
            CAPTURE(mesh.name, material.name);
            const bool tiles = material.name == "azulejos"; // lie on the risers of the stairs
            CHECK((tiles || material.doubleSided != isClosedSurface(scene, primitive)));
            masked += material.masked;
        }
    CHECK(masked >= 2); // railing and fence
}

TEST_CASE("in the courtyard a lantern swings slowly, and nothing else moves") {
    const Scene scene = builtIn("courtyard");
    REQUIRE(scene.animations.size() == 1);
    CHECK(scene.animations[0].duration >= 4);
    const double duration = scene.animations[0].duration;
    Pose now, next;
    for (double time = 0; time < duration; time += 0.5) { // at 0 it repeats
        evaluatePose(scene, 0, duration + time - 1.0 / 120, now);
        evaluatePose(scene, 0, duration + time + 1.0 / 120, next);
        for (size_t i = 0; i < scene.nodes.size(); ++i) {
            CAPTURE(time, scene.nodes[i].name);
            const bool moves = now.worldFromNode[i] != next.worldFromNode[i];
            CHECK(moves == (scene.nodes[i].name == "lantern"));
            if (!moves) continue;
            for (const Primitive& primitive : scene.meshes[size_t(scene.nodes[i].mesh)].primitives) {
                const glm::vec3 before = transformed(primitive.bounds, now.worldFromNode[i]).centre();
                const glm::vec3 after = transformed(primitive.bounds, next.worldFromNode[i]).centre();
                CHECK(glm::distance(before, after) < 0.01f); // 60 cm a second
            }
        }
    }
}

TEST_CASE("the scenes with closed forms stand where their formulas expect them") {
    const auto lightOf = [](const Scene& scene) {
        Pose pose;
        evaluatePose(scene, 0, 0, pose);
        return defaultLight(scene, pose);
    };
    for (const char* name : {"half-plane", "rectangle", "sphere"}) {
        CAPTURE(name);
        const AreaLight light = lightOf(builtIn(name));
        CHECK(light.shape == (std::string(name) == "sphere" ? LightShape::Disk : LightShape::Rectangle));
        CHECK(light.position == glm::vec3(0, 10, 0));
        CHECK(light.size == glm::vec2(1));
        // Its width lies along world x, and it faces straight down.
        const glm::mat4 matrix = lightFromWorld(light);
        CHECK(glm::distance(glm::vec3(matrix * glm::vec4(1, 10, 0, 1)), glm::vec3(1, 0, 0)) < 1e-6f);
        CHECK(glm::distance(glm::vec3(matrix * glm::vec4(0, 0, 0, 1)), glm::vec3(0, 0, -10)) < 1e-5f);
    }
    const auto casterOf = [](const char* name) {
        const Scene scene = builtIn(name);
        return scene.meshes.at(1).primitives.at(0).bounds; // the first is the floor
    };
    CHECK(casterOf("half-plane").max.x == 0);
    CHECK(casterOf("half-plane").max.y == 6);
    CHECK(casterOf("rectangle").max.x == Approx(0.6).margin(1e-5));
    CHECK(casterOf("rectangle").max.z == Approx(0.4).margin(1e-5));
    CHECK(casterOf("rectangle").max.y == 6);
    CHECK(casterOf("sphere").min.y == Approx(5.4).margin(1e-5));

    const Scene boxes = builtIn("two-boxes");
    Pose pose;
    evaluatePose(boxes, 0, 0, pose);
    const Camera camera = defaultCamera(boxes, pose);
    CHECK(glm::distance(camera.eye, glm::vec3(2.5f, 3, 4)) < 1e-5f);
    CHECK(camera.fovY == Approx(45));
    CHECK(glm::distance(glm::normalize(camera.target - camera.eye),
                        glm::normalize(glm::vec3(0, 0.5f, 0) - camera.eye)) < 1e-5f);
}
