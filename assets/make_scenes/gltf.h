// SPDX-License-Identifier: MIT
// A glTF scene that grows part by part and is written as one binary file. Numbers are rounded to a grid far coarser
// than the last bits of a mathematics library, so that every machine writes the same file.
#pragma once

#include "assets/make_scenes/shapes.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/light.h"

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace make_scenes {

struct Material {
    std::string name;
    dvec3 colour{1}; // linear
    int texture = -1;
    bool masked = false; // by the texture's alpha
    bool doubleSided = false;
};

class Gltf {
public:
    // `description`: one sentence on what the scene shows, kept in the file as asset.extras.description.
    Gltf(const std::string& name, const std::string& description);

    int material(const Material& material);
    int texture(const std::string& name, const std::vector<uint8_t>& png);

    struct Part {
        Shape shape;
        int material;
    };
    int mesh(const std::string& name, const std::vector<Part>& parts);
    int node(const std::string& name, int mesh, const dvec3& translation = dvec3(0), double degreesAboutY = 0,
             double scale = 1);
    int object(const std::string& name, const Shape& shape, int material);

    void camera(const penumbra::Camera& camera);
    void light(const penumbra::AreaLight& light);

    // Linear keys of one node; `values` holds as many components for each time.
    void animate(int node, const char* path, const std::vector<double>& times, const std::vector<double>& values);
    void spin(int node, double seconds);                                     // a turn about +Y
    void swing(int node, const dvec3& axis, double degrees, double seconds); // to and fro, like a pendulum

    void save(const std::filesystem::path& folder);

private:
    using json = nlohmann::ordered_json;

    int push(const char* collection, json entry);
    int root(const json& entry);
    int bufferView(const std::vector<uint8_t>& bytes, int target);
    int accessor(const std::vector<double>& values, int components, bool withBounds, int target = 0);
    json primitive(const Part& part);

    std::string name_;
    json document_;
    std::vector<uint8_t> binary_;
};

} // namespace make_scenes
