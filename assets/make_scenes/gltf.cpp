// SPDX-License-Identifier: MIT
#include "assets/make_scenes/gltf.h"

#include "renderer/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>

namespace make_scenes {
namespace {

using namespace penumbra;
using glm::dquat;
using json = nlohmann::ordered_json;

double rounded(double value, double grid) {
    const double result = std::round(value / grid) * grid;
    return result == 0 ? 0 : result; // no −0
}

json numbers(const auto& vector, int count, double grid) {
    json list = json::array();
    for (int i = 0; i < count; ++i) list.push_back(rounded(double(vector[i]), grid));
    return list;
}
json numbers(const dvec3& v) { return numbers(v, 3, 1e-6); }
json numbers(const dquat& q) { return numbers(std::array{q.x, q.y, q.z, q.w}, 4, 1e-7); }

json posed(const std::string& name, const dvec3& position, const glm::mat4& localFromWorld) {
    const dquat rotation = glm::quat_cast(glm::transpose(glm::dmat3(localFromWorld)));
    return {{"name", name}, {"translation", numbers(position)}, {"rotation", numbers(rotation)}};
}

template <class T> std::vector<uint8_t> littleEndian(const std::vector<T>& values) {
    std::vector<uint8_t> bytes;
    for (const T value : values) {
        uint32_t bits = 0;
        if constexpr (std::is_same_v<T, float>)
            bits = std::bit_cast<uint32_t>(value);
        else
            bits = value;
        for (size_t i = 0; i < sizeof(T); ++i) bytes.push_back(uint8_t(bits >> 8 * i));
    }
    return bytes;
}

// glTF's constants, as OpenGL numbers them.
enum : int { glUnsignedShort = 5123, glUnsignedInt = 5125, glFloat = 5126 };

} // namespace

Gltf::Gltf(const std::string& name, const std::string& description) : name_(name) {
    document_["asset"] = {
        {"version", "2.0"}, {"generator", "make-scenes of Penumbra"}, {"extras", {{"description", description}}}};
    document_["scene"] = 0;
    document_["scenes"] = {{{"name", name}, {"nodes", json::array()}}};
}

int Gltf::material(const Material& material) {
    const dvec3& colour = material.colour;
    json pbr = {{"baseColorFactor", {colour.r, colour.g, colour.b, 1.0}}, {"metallicFactor", 0.0}};
    json entry = {{"name", material.name}};
    if (material.texture >= 0) pbr["baseColorTexture"] = {{"index", material.texture}};
    if (material.masked) {
        entry["alphaMode"] = "MASK";
        entry["alphaCutoff"] = 0.5;
    }
    if (material.doubleSided) entry["doubleSided"] = true;
    entry["pbrMetallicRoughness"] = std::move(pbr);
    return push("materials", entry);
}

int Gltf::texture(const std::string& name, const std::vector<uint8_t>& png) {
    const int image = push("images", {{"name", name}, {"mimeType", "image/png"}, {"bufferView", bufferView(png, 0)}});
    return push("textures", {{"source", image}});
}

int Gltf::mesh(const std::string& name, const std::vector<Part>& parts) {
    json primitives = json::array();
    for (const Part& part : parts) primitives.push_back(primitive(part));
    return push("meshes", {{"name", name}, {"primitives", primitives}});
}

int Gltf::node(const std::string& name, int mesh, const dvec3& translation, double degreesAboutY, double scale) {
    json entry = {{"name", name}, {"mesh", mesh}};
    if (translation != dvec3(0)) entry["translation"] = numbers(translation);
    if (degreesAboutY != 0) entry["rotation"] = numbers(glm::angleAxis(glm::radians(degreesAboutY), dvec3(0, 1, 0)));
    if (scale != 1) entry["scale"] = {scale, scale, scale};
    return root(entry);
}

int Gltf::object(const std::string& name, const Shape& shape, int material) {
    return node(name, mesh(name, {{shape, material}}));
}

void Gltf::camera(const Camera& camera) {
    const int index = push(
        "cameras", {{"name", "camera"},
                    {"type", "perspective"},
                    {"perspective", {{"yfov", rounded(glm::radians(double(camera.fovY)), 1e-7)}, {"znear", 0.05}}}});
    json entry = posed("camera", dvec3(camera.eye), eyeFromWorld(camera));
    entry["camera"] = index;
    root(entry);
}

void Gltf::light(const AreaLight& light) {
    document_["extensionsUsed"] = {"KHR_lights_punctual"};
    // glTF's own lights have no size; ours is an extra.
    document_["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"name", "light"},
         {"type", "spot"},
         {"color", numbers(light.colour, 3, 1e-6)},
         {"spot", json::object()},
         {"extras",
          {{"shape", std::string(lightShapeNames()[size_t(light.shape)])}, {"size", numbers(light.size, 2, 1e-6)}}}}};
    json entry = posed("light", dvec3(light.position), lightFromWorld(light));
    entry["extensions"]["KHR_lights_punctual"]["light"] = 0;
    root(entry);
}

void Gltf::animate(int node, const char* path, const std::vector<double>& times, const std::vector<double>& values) {
    const int components = int(values.size() / times.size());
    if (!document_.contains("animations"))
        document_["animations"] = {{{"channels", json::array()}, {"samplers", json::array()}}};
    json& animation = document_["animations"][0];
    const int input = accessor(times, 1, true), output = accessor(values, components, false);
    animation["samplers"].push_back({{"input", input}, {"output", output}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
}

void Gltf::spin(int node, double seconds) {
    std::vector<double> times, values;
    for (int i = 0; i <= 4; ++i) {
        times.push_back(seconds * i / 4);
        const dquat q = glm::angleAxis(pi * i / 2, dvec3(0, 1, 0));
        values.insert(values.end(), {q.x, q.y, q.z, q.w});
    }
    animate(node, "rotation", times, values);
}

void Gltf::swing(int node, const dvec3& axis, double degrees, double seconds) {
    constexpr int steps = 24; // straight pieces of the sine, too short to be told
    std::vector<double> times, values;
    for (int i = 0; i <= steps; ++i) {
        times.push_back(seconds * i / steps);
        const dquat q = glm::angleAxis(glm::radians(degrees) * std::sin(2 * pi * i / steps), glm::normalize(axis));
        values.insert(values.end(), {q.x, q.y, q.z, q.w});
    }
    animate(node, "rotation", times, values);
}

void Gltf::save(const std::filesystem::path& folder) {
    while (binary_.size() % 4 != 0) binary_.push_back(0);
    document_["buffers"] = {{{"byteLength", binary_.size()}}};
    std::string text = document_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string bytes = "glTF";
    const auto word = [&](size_t value) {
        for (int i = 0; i < 4; ++i) bytes += char(value >> 8 * i & 255);
    };
    word(2);
    word(12 + 8 + text.size() + 8 + binary_.size());
    word(text.size());
    bytes += "JSON" + text;
    word(binary_.size());
    bytes += std::string("BIN\0", 4);
    bytes.append(binary_.begin(), binary_.end());

    const std::filesystem::path file = folder / (name_ + ".glb"), temporary = folder / (name_ + ".glb.part");
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(bytes.data(), std::streamsize(bytes.size()));
    stream.close();
    if (!stream) throw InputError(fmt::format("{}: cannot be written", temporary.string()));
    std::filesystem::rename(temporary, file);
}

int Gltf::push(const char* collection, json entry) {
    json& list = document_[collection];
    list.push_back(std::move(entry));
    return int(list.size()) - 1;
}

int Gltf::root(const json& entry) {
    const int index = push("nodes", entry);
    document_["scenes"][0]["nodes"].push_back(index);
    return index;
}

int Gltf::bufferView(const std::vector<uint8_t>& bytes, int target) {
    while (binary_.size() % 4 != 0) binary_.push_back(0);
    json entry = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
    if (target != 0) entry["target"] = target;
    binary_.insert(binary_.end(), bytes.begin(), bytes.end());
    return push("bufferViews", entry);
}

int Gltf::accessor(const std::vector<double>& values, int components, bool withBounds, int target) {
    constexpr const char* types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    std::vector<float> rounded;
    for (const double value : values) rounded.push_back(float(make_scenes::rounded(value, 1.0 / 65536)));
    json entry = {{"bufferView", bufferView(littleEndian(rounded), target)},
                  {"componentType", int(glFloat)},
                  {"count", values.size() / size_t(components)},
                  {"type", types[components]}};
    if (withBounds)
        for (int c = 0; c < components; ++c) {
            float low = rounded[size_t(c)], high = low;
            for (size_t i = size_t(c); i < rounded.size(); i += size_t(components)) {
                low = std::min(low, rounded[i]);
                high = std::max(high, rounded[i]);
            }
            entry["min"].push_back(low);
            entry["max"].push_back(high);
        }
    return push("accessors", entry);
}

Gltf::json Gltf::primitive(const Part& part) {
    constexpr int arrayBuffer = 34962, elementArrayBuffer = 34963;
    std::vector<double> positions, normals, uvs;
    for (const Vertex& v : part.shape.vertices) {
        positions.insert(positions.end(), {v.position.x, v.position.y, v.position.z});
        normals.insert(normals.end(), {v.normal.x, v.normal.y, v.normal.z});
        uvs.insert(uvs.end(), {v.uv.x, v.uv.y});
    }
    json attributes = {{"POSITION", accessor(positions, 3, true, arrayBuffer)},
                       {"NORMAL", accessor(normals, 3, false, arrayBuffer)}};
    if (document_["materials"][size_t(part.material)]["pbrMetallicRoughness"].contains("baseColorTexture"))
        attributes["TEXCOORD_0"] = accessor(uvs, 2, false, arrayBuffer);
    const bool narrow = part.shape.vertices.size() <= 65535;
    const std::vector<uint16_t> shorts(part.shape.indices.begin(), part.shape.indices.end());
    const int view = bufferView(narrow ? littleEndian(shorts) : littleEndian(part.shape.indices), elementArrayBuffer);
    const int indices = push("accessors", {{"bufferView", view},
                                           {"componentType", int(narrow ? glUnsignedShort : glUnsignedInt)},
                                           {"count", part.shape.indices.size()},
                                           {"type", "SCALAR"}});
    return {{"attributes", attributes}, {"indices", indices}, {"material", part.material}};
}

} // namespace make_scenes
