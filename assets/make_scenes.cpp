// SPDX-License-Identifier: MIT
// Writes the built-in scenes as binary glTF: make-scenes [FOLDER]. The same files come out on every machine: numbers
// are rounded to a grid far coarser than the last bits of a mathematics library, and pictures are stored uncompressed.
#include "renderer/core/error.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/light.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>
#include <png.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace penumbra;
using glm::dvec2, glm::dvec3, glm::dquat, glm::dmat4;
using json = nlohmann::ordered_json;
constexpr double pi = glm::pi<double>();

double rounded(double value, double grid) {
    const double result = std::round(value / grid) * grid;
    return result == 0 ? 0 : result; // no −0
}

// A linear congruential generator (Knuth's MMIX), since the standard distributions differ between libraries.
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    double operator()(double low, double high) {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return low + (high - low) * double(state_ >> 40) / double(1 << 24);
    }

private:
    uint64_t state_;
};

// --- shapes ----------------------------------------------------------------------------------------------------------

struct Vertex {
    dvec3 position{0}, normal{0, 1, 0};
    dvec2 uv{0};
};

struct Shape {
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;

    size_t add(const Vertex& vertex) {
        vertices.push_back(vertex);
        return vertices.size() - 1;
    }
    void triangle(size_t a, size_t b, size_t c) {
        indices.insert(indices.end(), {uint32_t(a), uint32_t(b), uint32_t(c)});
    }
    // Counter-clockwise seen from where it faces; uv runs (0, 0), (1, 0), (1, 1), (0, 1).
    void quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
        const dvec3 normal = glm::normalize(glm::cross(c - a, d - b));
        const size_t first = add({a, normal, {0, 0}});
        add({b, normal, {1, 0}});
        add({c, normal, {1, 1}});
        add({d, normal, {0, 1}});
        triangle(first, first + 1, first + 2);
        triangle(first, first + 2, first + 3);
    }
    void add(const Shape& other, const dmat4& matrix = dmat4(1)) {
        const size_t first = vertices.size();
        const glm::dmat3 normalMatrix = glm::transpose(glm::inverse(glm::dmat3(matrix)));
        for (const Vertex& v : other.vertices)
            add({dvec3(matrix * glm::dvec4(v.position, 1)), glm::normalize(normalMatrix * v.normal), v.uv});
        for (size_t i = 0; i < other.indices.size(); i += 3)
            triangle(first + other.indices[i], first + other.indices[i + 1], first + other.indices[i + 2]);
    }
};

dmat4 moved(const dvec3& by) { return glm::translate(dmat4(1), by); }
dmat4 turned(double degrees, const dvec3& axis) { return glm::rotate(dmat4(1), glm::radians(degrees), axis); }

Shape box(const dvec3& low, const dvec3& high) {
    const auto p = [&](int x, int y, int z) {
        return dvec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
    };
    Shape shape;
    shape.quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
    shape.quad(p(1, 0, 0), p(0, 0, 0), p(0, 1, 0), p(1, 1, 0));
    shape.quad(p(1, 0, 1), p(1, 0, 0), p(1, 1, 0), p(1, 1, 1));
    shape.quad(p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0));
    shape.quad(p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), p(0, 1, 0));
    shape.quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
    return shape;
}

Shape boxAround(const dvec3& centre, const dvec3& size) { return box(centre - 0.5 * size, centre + 0.5 * size); }

// A grid of (columns + 1) x (rows + 1) vertices, facing ∂u × ∂v of `surface`, which maps [0, 1]² to vertices.
Shape patch(int columns, int rows, const std::function<Vertex(double, double)>& surface) {
    Shape shape;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) shape.add(surface(double(i) / columns, double(j) / rows));
    const auto at = [&](int i, int j) { return size_t(j * (columns + 1) + i); };
    const auto same = [&](size_t a, size_t b) {
        return glm::distance(shape.vertices[a].position, shape.vertices[b].position) < 1e-9;
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const size_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            if (!same(a, b)) shape.triangle(a, b, c); // poles have no width
            if (!same(c, d)) shape.triangle(a, c, d);
        }
    return shape;
}

Shape sphere(const dvec3& centre, double radius, int segments) {
    return patch(segments, segments / 2, [&](double u, double v) {
        const double longitude = -2 * pi * u, polar = pi * (1 - v); // from the lower pole upwards
        const double ring = v == 0 || v == 1 ? 0 : std::sin(polar);
        const dvec3 normal(ring * std::cos(longitude), std::cos(polar), ring * std::sin(longitude));
        return Vertex{centre + radius * normal, normal, {u, v}};
    });
}

Shape torus(double radius, double thickness, int segments, int sides) {
    return patch(segments, sides, [&](double u, double v) {
        const double around = -2 * pi * u, across = 2 * pi * v;
        const dvec3 out(std::cos(around), 0, std::sin(around));
        const dvec3 normal = std::cos(across) * out + dvec3(0, std::sin(across), 0);
        return Vertex{radius * out + thickness * normal, normal, {u, v}};
    });
}

// Turns a profile of (radius, height), listed from below with its outside to the right, about the y axis. Corners
// sharper than 40 degrees stay sharp.
Shape lathe(const std::vector<dvec2>& profile, int segments) {
    const auto outward = [&](size_t i) { // of the i-th piece
        const dvec2 along = profile[i + 1] - profile[i];
        return glm::normalize(dvec2(along.y, -along.x));
    };
    Shape shape;
    for (size_t i = 0; i + 1 < profile.size(); ++i) {
        const dvec2 own = outward(i);
        const auto smooth = [&](size_t neighbour, bool exists) {
            if (!exists) return own;
            const dvec2 other = outward(neighbour);
            return glm::dot(own, other) > std::cos(glm::radians(40.0)) ? glm::normalize(own + other) : own;
        };
        const std::array<dvec2, 2> normals{smooth(i - 1, i > 0), smooth(i + 1, i + 2 < profile.size())};
        shape.add(patch(segments, 1, [&](double u, double v) {
            const dvec2 point = profile[i + (v > 0.5)], normal = normals[v > 0.5];
            const dvec3 out(std::cos(-2 * pi * u), 0, std::sin(-2 * pi * u));
            return Vertex{point.x * out + dvec3(0, point.y, 0), normal.x * out + dvec3(0, normal.y, 0), {u, v}};
        }));
    }
    return shape;
}

Shape cylinder(double radius, double height, int segments) {
    return lathe({{0, 0}, {radius, 0}, {radius, height}, {0, height}}, segments);
}

Shape rod(const dvec3& from, const dvec3& to, double radius, int segments) {
    const dvec3 y = glm::normalize(to - from);
    const dvec3 x = glm::normalize(glm::cross(y, std::abs(y.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(0, 0, 1)));
    const glm::dmat3 axes(x, y, glm::cross(x, y));
    Shape shape;
    shape.add(cylinder(radius, glm::length(to - from), segments), moved(from) * dmat4(axes));
    return shape;
}

// A bay of an arcade from x = −width/2 to width/2 with a round arch, its front at z = thickness/2.
Shape archBay(double width, double height, double opening, double spring, double thickness, int segments) {
    const double half = 0.5 * thickness, pier = 0.5 * (width - opening), r = 0.5 * opening;
    Shape shape;
    shape.add(box({-0.5 * width, 0, -half}, {-0.5 * width + pier, spring, half}));
    shape.add(box({0.5 * width - pier, 0, -half}, {0.5 * width, spring, half}));
    std::vector<dvec2> curve{{-0.5 * width, spring}};
    for (int i = 0; i <= segments; ++i) {
        const double angle = pi * (1 - double(i) / segments);
        curve.push_back({r * std::cos(angle), spring + r * std::sin(angle)});
    }
    curve.push_back({0.5 * width, spring});
    for (size_t i = 0; i + 1 < curve.size(); ++i) {
        const dvec2 a = curve[i], b = curve[i + 1];
        shape.quad({a.x, a.y, half}, {b.x, b.y, half}, {b.x, height, half}, {a.x, height, half});
        shape.quad({b.x, b.y, -half}, {a.x, a.y, -half}, {a.x, height, -half}, {b.x, height, -half});
        shape.quad({a.x, a.y, -half}, {b.x, b.y, -half}, {b.x, b.y, half}, {a.x, a.y, half});
    }
    shape.quad({-0.5 * width, height, half}, {0.5 * width, height, half}, {0.5 * width, height, -half},
               {-0.5 * width, height, -half});
    for (const double side : {-1.0, 1.0}) { // above the piers the ends are open up to here
        const double x = side * 0.5 * width;
        shape.quad({x, spring, side * half}, {x, spring, -side * half}, {x, height, -side * half},
                   {x, height, side * half});
    }
    return shape;
}

// --- pictures --------------------------------------------------------------------------------------------------------

// White where `covered`, which takes (u, v) in [0, 1]; transparent elsewhere.
std::vector<uint8_t> maskPicture(unsigned size, const std::function<bool(double, double)>& covered) {
    std::vector<uint8_t> texels(size_t{4} * size * size, 255);
    for (unsigned y = 0; y < size; ++y)
        for (unsigned x = 0; x < size; ++x) {
            int hits = 0; // of 4 x 4 points in the texel
            for (int k = 0; k < 16; ++k)
                hits += covered((x + (k % 4 + 0.5) / 4) / size, (y + (k / 4 + 0.5) / 4) / size);
            texels[size_t{4} * (y * size + x) + 3] = uint8_t(hits * 255 / 16);
        }
    std::vector<uint8_t> bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    ensure(info != nullptr, "libpng cannot start");
    png_set_write_fn(
        png, &bytes,
        [](png_structp p, png_bytep data, size_t length) {
            auto& out = *static_cast<std::vector<uint8_t>*>(png_get_io_ptr(p));
            out.insert(out.end(), data, data + length);
        },
        nullptr);
    png_set_compression_level(png, 0);
    png_set_filter(png, 0, PNG_FILTER_NONE);
    png_set_IHDR(png, info, size, size, 8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (unsigned y = 0; y < size; ++y) png_write_row(png, &texels[size_t{4} * size * y]);
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

// --- glTF ------------------------------------------------------------------------------------------------------------

json numbers(const auto& vector, int count, double grid) {
    json list = json::array();
    for (int i = 0; i < count; ++i) list.push_back(rounded(double(vector[i]), grid));
    return list;
}
json numbers(const dvec3& v) { return numbers(v, 3, 1e-6); }
json numbers(const dquat& q) { return numbers(std::array{q.x, q.y, q.z, q.w}, 4, 1e-7); }

// glTF's constants, as OpenGL numbers them.
enum : int { glUnsignedShort = 5123, glUnsignedInt = 5125, glFloat = 5126 };

class Gltf {
public:
    explicit Gltf(const std::string& name) : name_(name) {
        document_["asset"] = {{"version", "2.0"}, {"generator", "make-scenes of Penumbra"}};
        document_["scene"] = 0;
        document_["scenes"] = {{{"name", name}, {"nodes", json::array()}}};
    }

    // Matt; `texture` masks it.
    int material(const std::string& name, const dvec3& colour, int texture = -1, bool doubleSided = false) {
        json pbr = {{"baseColorFactor", {colour.r, colour.g, colour.b, 1.0}}, {"metallicFactor", 0.0}};
        json entry = {{"name", name}};
        if (texture >= 0) {
            pbr["baseColorTexture"] = {{"index", texture}};
            entry["alphaMode"] = "MASK";
            entry["alphaCutoff"] = 0.5;
        }
        if (doubleSided) entry["doubleSided"] = true;
        entry["pbrMetallicRoughness"] = std::move(pbr);
        return push("materials", entry);
    }
    int texture(const std::string& name, const std::vector<uint8_t>& png) {
        const int image =
            push("images", {{"name", name}, {"mimeType", "image/png"}, {"bufferView", bufferView(png, 0)}});
        return push("textures", {{"source", image}});
    }

    struct Part {
        Shape shape;
        int material;
    };
    int mesh(const std::string& name, const std::vector<Part>& parts) {
        json primitives = json::array();
        for (const Part& part : parts) primitives.push_back(primitive(part));
        return push("meshes", {{"name", name}, {"primitives", primitives}});
    }

    int node(const std::string& name, int mesh, const dvec3& translation = dvec3(0), double degreesAboutY = 0,
             double scale = 1) {
        json entry = {{"name", name}, {"mesh", mesh}};
        if (translation != dvec3(0)) entry["translation"] = numbers(translation);
        if (degreesAboutY != 0)
            entry["rotation"] = numbers(glm::angleAxis(glm::radians(degreesAboutY), dvec3(0, 1, 0)));
        if (scale != 1) entry["scale"] = {scale, scale, scale};
        return root(entry);
    }
    int object(const std::string& name, const Shape& shape, int material) {
        return node(name, mesh(name, {{shape, material}}));
    }

    void camera(const Camera& camera) {
        const int index =
            push("cameras",
                 {{"name", "camera"},
                  {"type", "perspective"},
                  {"perspective", {{"yfov", rounded(glm::radians(double(camera.fovY)), 1e-7)}, {"znear", 0.05}}}});
        json entry = posed("camera", dvec3(camera.eye), eyeFromWorld(camera));
        entry["camera"] = index;
        root(entry);
    }
    void light(const AreaLight& light) {
        document_["extensionsUsed"] = {"KHR_lights_punctual"};
        // glTF's own lights have no size; ours is an extra.
        document_["extensions"]["KHR_lights_punctual"]["lights"] = {
            {{"name", "light"},
             {"type", "spot"},
             {"spot", json::object()},
             {"extras",
              {{"shape", std::string(lightShapeNames()[size_t(light.shape)])},
               {"size", numbers(light.size, 2, 1e-6)}}}}};
        json entry = posed("light", dvec3(light.position), lightFromWorld(light));
        entry["extensions"]["KHR_lights_punctual"]["light"] = 0;
        root(entry);
    }

    // Linear keys of one node; `values` holds `components` numbers for each time.
    void animate(int node, const char* path, const std::vector<double>& times, const std::vector<double>& values) {
        const int components = int(values.size() / times.size());
        if (!document_.contains("animations"))
            document_["animations"] = {{{"channels", json::array()}, {"samplers", json::array()}}};
        json& animation = document_["animations"][0];
        const int input = accessor(times, 1, true), output = accessor(values, components, false);
        animation["samplers"].push_back({{"input", input}, {"output", output}});
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
    }
    // A turn about +Y in `seconds`.
    void spin(int node, double seconds) {
        std::vector<double> times, values;
        for (int i = 0; i <= 4; ++i) {
            times.push_back(seconds * i / 4);
            const dquat q = glm::angleAxis(pi * i / 2, dvec3(0, 1, 0));
            values.insert(values.end(), {q.x, q.y, q.z, q.w});
        }
        animate(node, "rotation", times, values);
    }

    void save(const std::filesystem::path& folder) {
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

private:
    int push(const char* collection, json entry) {
        json& list = document_[collection];
        list.push_back(std::move(entry));
        return int(list.size()) - 1;
    }
    int root(const json& entry) {
        const int index = push("nodes", entry);
        document_["scenes"][0]["nodes"].push_back(index);
        return index;
    }
    static json posed(const std::string& name, const dvec3& position, const glm::mat4& localFromWorld) {
        const dquat rotation = glm::quat_cast(glm::transpose(glm::dmat3(localFromWorld)));
        return {{"name", name}, {"translation", numbers(position)}, {"rotation", numbers(rotation)}};
    }

    int bufferView(const std::vector<uint8_t>& bytes, int target) {
        while (binary_.size() % 4 != 0) binary_.push_back(0);
        json entry = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
        if (target != 0) entry["target"] = target;
        binary_.insert(binary_.end(), bytes.begin(), bytes.end());
        return push("bufferViews", entry);
    }
    template <class T> static std::vector<uint8_t> littleEndian(const std::vector<T>& values) {
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
    int accessor(const std::vector<double>& values, int components, bool withBounds, int target = 0) {
        constexpr const char* types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
        std::vector<float> rounded;
        for (const double value : values) rounded.push_back(float(::rounded(value, 1.0 / 65536)));
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
    json primitive(const Part& part) {
        constexpr int arrayBuffer = 34962, elementArrayBuffer = 34963;
        std::vector<double> positions, normals, uvs;
        for (const Vertex& v : part.shape.vertices) {
            positions.insert(positions.end(), {v.position.x, v.position.y, v.position.z});
            normals.insert(normals.end(), {v.normal.x, v.normal.y, v.normal.z});
            uvs.insert(uvs.end(), {v.uv.x, v.uv.y});
        }
        json attributes = {{"POSITION", accessor(positions, 3, true, arrayBuffer)},
                           {"NORMAL", accessor(normals, 3, false, arrayBuffer)}};
        if (document_["materials"][size_t(part.material)].contains("alphaMode"))
            attributes["TEXCOORD_0"] = accessor(uvs, 2, false, arrayBuffer);
        const bool narrow = part.shape.vertices.size() <= 65535;
        const std::vector<uint16_t> shorts(part.shape.indices.begin(), part.shape.indices.end());
        const int view =
            bufferView(narrow ? littleEndian(shorts) : littleEndian(part.shape.indices), elementArrayBuffer);
        const int indices = push("accessors", {{"bufferView", view},
                                               {"componentType", int(narrow ? glUnsignedShort : glUnsignedInt)},
                                               {"count", part.shape.indices.size()},
                                               {"type", "SCALAR"}});
        return {{"attributes", attributes}, {"indices", indices}, {"material", part.material}};
    }

    std::string name_;
    json document_;
    std::vector<uint8_t> binary_;
};

// --- the courtyard ---------------------------------------------------------------------------------------------------

// Leaves scattered in a ball: kites, widest a third of the way up. Their outline is geometry, not a mask: as cheap to
// draw as leaves can be, and as crisp from near.
Shape foliage(Random& random, int leaves, double radius, double leafLength) {
    Shape shape;
    while (leaves > 0) {
        const dvec3 p(random(-1, 1), random(-1, 1), random(-1, 1));
        const dvec3 direction(random(-1, 1), random(-1, 1), random(-1, 1));
        if (glm::length(p) > 1 || glm::length(p) < 0.35 || glm::length(direction) < 0.2) continue;
        const dvec3 along = glm::normalize(direction + p);
        const dvec3 across = glm::normalize(glm::cross(along, dvec3(0.3, 1, 0.2)));
        const dvec3 a = 0.5 * leafLength * along, b = 0.21 * leafLength * across;
        const dvec3 centre = radius * p * dvec3(1, 0.8, 1);
        shape.quad(centre - a, centre - 0.3 * a - b, centre + a, centre - 0.3 * a + b);
        --leaves;
    }
    return shape;
}

std::vector<dvec2> columnProfile(double height) {
    std::vector<dvec2> profile{{0, 0}, {0.26, 0}, {0.26, 0.08}, {0.24, 0.08}};
    for (int i = 0; i <= 4; ++i) // torus of the base
        profile.push_back({0.21 + 0.03 * std::cos(pi * i / 4 - pi / 2), 0.11 + 0.03 * std::sin(pi * i / 4 - pi / 2)});
    const double bottom = 0.16, top = height - 0.28;
    for (int i = 0; i <= 8; ++i) { // the shaft swells a little
        const double t = i / 8.0;
        profile.push_back({0.18 - 0.03 * t * t, bottom + t * (top - bottom)});
    }
    for (int i = 1; i <= 4; ++i) // echinus
        profile.push_back({0.15 + 0.09 * (1 - std::cos(pi * i / 8)), top + 0.13 * std::sin(pi * i / 8)});
    profile.insert(profile.end(), {{0.26, height - 0.12}, {0.26, height}, {0, height}});
    return profile;
}

void addPaving(Gltf& gltf, Random& random, int light, int dark, int joints) {
    Shape lightSlabs, darkSlabs;
    for (int j = 0; j < 5; ++j)
        for (int i = 0; i < 5; ++i) {
            const dvec3 low(-1.5 + 0.6 * i, -0.06, -1.5 + 0.6 * j);
            const double gap = 0.008, top = random(-0.006, 0);
            const Shape slab = box(low + dvec3(gap, 0, gap), dvec3(low.x + 0.6 - gap, top, low.z + 0.6 - gap));
            (random(0, 1) < 0.6 ? lightSlabs : darkSlabs).add(slab);
        }
    const int patch = gltf.mesh("paving", {{lightSlabs, light}, {darkSlabs, dark}});
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
            gltf.node("paving", patch, {-4.5 + 3 * i, 0, -4.5 + 3 * j}, 90 * ((3 * i + 5 * j + i * j) % 4));
    gltf.object("ground", box({-8, -0.4, -8}, {6.2, -0.03, 6.2}), joints);
}

void addArcade(Gltf& gltf, int plaster, int roof) {
    const int bay = gltf.mesh("bay", {{archBay(3, 3.6, 2.1, 1.9, 0.5, 24), plaster}});
    for (int i = 0; i < 4; ++i) {
        gltf.node("bay north", bay, {-4.5 + 3 * i, 0, -6.25});
        gltf.node("bay west", bay, {-6.25, 0, -4.5 + 3 * i}, 90);
    }
    Shape walls;
    walls.add(box({-8, -0.03, -8}, {6, 4, -7.7}));
    walls.add(box({-8, -0.03, -7.7}, {-7.7, 4, 6}));
    walls.add(box({-6.5, -0.03, -6.5}, {-6, 3.6, -6}));
    gltf.object("walls", walls, plaster);
    Shape roofs;
    roofs.add(box({-8.1, 3.6, -7.7}, {6.1, 3.75, -5.85}));
    roofs.add(box({-7.7, 3.6, -5.85}, {-5.85, 3.75, 6.1}));
    gltf.object("roof", roofs, roof);
}

void addPergola(Gltf& gltf, int stone, int wood) {
    const int column = gltf.mesh("column", {{lathe(columnProfile(2.6), 32), stone}});
    for (int i = 0; i < 3; ++i) {
        gltf.node("column", column, {1.2, 0, -5 + 2.1 * i});
        gltf.node("column", column, {4.2, 0, -5 + 2.1 * i});
    }
    Shape beams;
    for (const double x : {1.2, 4.2}) beams.add(box({x - 0.07, 2.6, -5.4}, {x + 0.07, 2.78, -0.4}));
    for (int i = 0; i < 13; ++i) beams.add(boxAround({2.7, 2.84, -5.2 + 0.38 * i}, {3.9, 0.12, 0.06}));
    gltf.object("pergola", beams, wood);
}

void addTrees(Gltf& gltf, Random& random, int leaf, int bark, int clay) {
    const int cluster = gltf.mesh("foliage", {{foliage(random, 1050, 0.75, 0.16), leaf}});
    const std::array<dvec3, 6> crowns{
        {{0, 2.9, 0}, {0.7, 2.4, 0.2}, {-0.55, 2.5, 0.5}, {-0.4, 2.45, -0.6}, {0.35, 2.55, -0.65}, {0.1, 3.35, 0.15}}};
    Shape wood = lathe({{0, 0}, {0.16, 0}, {0.11, 0.3}, {0.09, 1.2}, {0.07, 2.0}, {0.02, 3.1}}, 14);
    for (size_t i = 1; i < crowns.size(); ++i) wood.add(rod({0, 1.3 + 0.15 * double(i), 0}, crowns[i], 0.03, 8));
    const int trunk = gltf.mesh("trunk", {{wood, bark}});
    const std::array<dvec3, 2> places{{{-3.9, 0, -3.7}, {-4.3, 0, 3.3}}};
    for (size_t t = 0; t < places.size(); ++t) {
        gltf.node("trunk", trunk, places[t], 70.0 * double(t));
        const dmat4 turn = turned(70.0 * double(t), {0, 1, 0});
        for (size_t i = 0; i < crowns.size(); ++i)
            gltf.node("foliage", cluster, places[t] + dvec3(turn * glm::dvec4(crowns[i], 0)), 61.0 * double(i + 6 * t),
                      0.9 + 0.06 * double(i % 3));
    }

    const int pot = gltf.mesh("pot", {{lathe({{0, 0},
                                              {0.2, 0},
                                              {0.28, 0.2},
                                              {0.3, 0.4},
                                              {0.34, 0.42},
                                              {0.34, 0.5},
                                              {0.29, 0.5},
                                              {0.27, 0.4},
                                              {0, 0.4}},
                                             28),
                                       clay}});
    const int bush = gltf.mesh("bush", {{foliage(random, 300, 0.42, 0.14), leaf}});
    const std::array<dvec3, 4> pots{{{-5.3, 0, -1.5}, {-5.3, 0, 1.5}, {-1.5, 0, -5.3}, {5.2, 0, -5.3}}};
    for (size_t i = 0; i < pots.size(); ++i) {
        gltf.node("pot", pot, pots[i]);
        gltf.node("bush", bush, pots[i] + dvec3(0, 0.72, 0), 77.0 * double(i));
    }
}

void addFurniture(Gltf& gltf, int wood, int stone, int metal, int white) {
    Shape bench;
    for (int i = 0; i < 4; ++i) bench.add(boxAround({0, 0.44, -0.18 + 0.12 * i}, {1.7, 0.04, 0.09}));
    for (int i = 0; i < 3; ++i) bench.add(boxAround({0, 0.6 + 0.13 * i, -0.27}, {1.7, 0.08, 0.03}));
    for (const double x : {-0.7, 0.7}) {
        bench.add(boxAround({x, 0.21, 0.15}, {0.06, 0.42, 0.06}));
        bench.add(boxAround({x, 0.46, -0.25}, {0.06, 0.92, 0.04}));
        bench.add(boxAround({x, 0.4, -0.03}, {0.05, 0.05, 0.44}));
    }
    const int benchMesh = gltf.mesh("bench", {{bench, wood}});
    gltf.node("bench", benchMesh, {-4.9, 0, 0}, 90);
    gltf.node("bench", benchMesh, {2.7, 0, -4.6});

    Shape table;
    table.add(cylinder(0.62, 0.05, 48), moved({0, 0.7, 0}));
    for (int i = 0; i < 3; ++i) {
        const double angle = 2 * pi * i / 3;
        table.add(rod({0.5 * std::cos(angle), 0, 0.5 * std::sin(angle)},
                      {0.15 * std::cos(angle), 0.71, 0.15 * std::sin(angle)}, 0.025, 10));
    }
    gltf.node("table", gltf.mesh("table", {{table, metal}}), {2.7, 0, -2.6});
    const int ball = gltf.mesh("ball", {{sphere(dvec3(0), 1, 32), white}});
    gltf.node("fruit", ball, {2.55, 0.84, -2.6}, 0, 0.09);
    gltf.node("fruit", ball, {2.8, 0.83, -2.45}, 0, 0.08);
    gltf.node("globe", ball, {3.6, 0.35, 2.6}, 0, 0.35);
    gltf.node("globe", ball, {4.3, 0.2, 2.1}, 0, 0.2);

    Shape dais; // three steps up to a platform
    for (int i = 0; i < 3; ++i) {
        const double half = 1.9 - 0.35 * i;
        dais.add(boxAround({0, 0.16 * (i + 0.5), 0}, {2 * half, 0.16, 2 * half}));
    }
    gltf.node("steps", gltf.mesh("steps", {{dais, stone}}), {-1, 0, 0.2});
    const Shape basin = lathe({{0, 0},
                               {0.42, 0},
                               {0.42, 0.06},
                               {0.2, 0.14},
                               {0.14, 0.3},
                               {0.13, 0.5},
                               {0.18, 0.62},
                               {0.45, 0.72},
                               {0.66, 0.82},
                               {0.78, 0.95},
                               {0.8, 1.02},
                               {0.74, 1.02},
                               {0.7, 0.95},
                               {0.58, 0.86},
                               {0.35, 0.8},
                               {0.1, 0.79},
                               {0.07, 1.15},
                               {0, 1.17}},
                              56);
    gltf.node("basin", gltf.mesh("basin", {{basin, stone}}), {-1, 0.48, 0.2});
}

void addRailing(Gltf& gltf, int metal) {
    Shape railing;
    for (int i = 0; i <= 20; ++i) railing.add(rod({-1.2 + 0.12 * i, 0, 0}, {-1.2 + 0.12 * i, 0.95, 0}, 0.009, 8));
    railing.add(rod({-1.25, 0.95, 0}, {1.25, 0.95, 0}, 0.022, 12));
    railing.add(rod({-1.2, 0.12, 0}, {1.2, 0.12, 0}, 0.012, 8));
    const int mesh = gltf.mesh("railing", {{railing, metal}});
    for (int i = 0; i < 3; ++i) gltf.node("railing", mesh, {5.6, 0, -0.2 + 2.5 * i}, 90);
}

void addWireFence(Gltf& gltf, int wire, int wood) {
    Shape net, posts;
    const auto point = [](double x, double y) { return dvec3(x, y, 0); };
    net.quad(point(-1.6, 0.1), point(1.6, 0.1), point(1.6, 1.3), point(-1.6, 1.3));
    for (size_t i = 0; i < 4; ++i) net.vertices[i].uv *= dvec2(16, 6); // the picture repeats every 20 cm
    for (const double x : {-1.6, 0.0, 1.6}) posts.add(boxAround({x, 0.7, -0.05}, {0.07, 1.4, 0.07}));
    posts.add(boxAround({0, 1.34, -0.05}, {3.3, 0.05, 0.09}));
    gltf.node("wire fence", gltf.mesh("wire fence", {{net, wire}, {posts, wood}}), {-1.6, 0, 4.6}, 8);
}

// Three rings within each other on a thread from a gallows, slowly turning.
void addOrnament(Gltf& gltf, int metal, int gold) {
    Shape gallows;
    gallows.add(rod({1.2, 0, 5.2}, {1.2, 3.3, 5.2}, 0.04, 14));
    gallows.add(rod({1.2, 3.25, 5.2}, {1.52, 3.25, 3.6}, 0.03, 12));
    gallows.add(rod({1.2, 2.5, 5.2}, {1.35, 3.25, 4.45}, 0.02, 10));
    gallows.add(rod({1.5, 3.25, 3.7}, {1.5, 2.62, 3.7}, 0.006, 8));
    gltf.object("gallows", gallows, metal);
    Shape rings;
    rings.add(torus(0.5, 0.025, 56, 12), turned(90, {1, 0, 0}));
    rings.add(torus(0.42, 0.02, 56, 10), turned(60, {1, 0, 0.4}));
    rings.add(torus(0.34, 0.018, 48, 10), turned(20, {1, 0, 0.2}));
    rings.add(sphere(dvec3(0), 0.13, 28));
    const int node = gltf.node("ornament", gltf.mesh("ornament", {{rings, gold}}), {1.5, 2.1, 3.7});
    gltf.spin(node, 16);
}

Gltf courtyard() {
    Gltf gltf("courtyard");
    Random random(20);
    const int wirePicture =
        gltf.texture("wire", maskPicture(64, [](double u, double v) {
                         const auto nearWhole = [](double x) { return std::abs(x - std::round(x)) < 0.09; };
                         return nearWhole(u + v) || nearWhole(u - v);
                     }));
    const int lightStone = gltf.material("light stone", {0.62, 0.57, 0.48});
    const int darkStone = gltf.material("dark stone", {0.46, 0.42, 0.37});
    const int joints = gltf.material("joints", {0.25, 0.23, 0.2});
    const int plaster = gltf.material("plaster", {0.75, 0.62, 0.45});
    const int roof = gltf.material("roof", {0.52, 0.22, 0.14});
    const int marble = gltf.material("marble", {0.78, 0.76, 0.72});
    const int wood = gltf.material("wood", {0.36, 0.23, 0.13});
    const int metal = gltf.material("metal", {0.16, 0.17, 0.19});
    const int gold = gltf.material("gold", {0.72, 0.5, 0.18});
    const int clay = gltf.material("clay", {0.6, 0.3, 0.18});
    const int bark = gltf.material("bark", {0.27, 0.2, 0.15});
    const int leaf = gltf.material("leaf", {0.2, 0.38, 0.11}, -1, true);
    const int wire = gltf.material("wire", {0.2, 0.24, 0.22}, wirePicture, true);

    addPaving(gltf, random, lightStone, darkStone, joints);
    addArcade(gltf, plaster, roof);
    addPergola(gltf, marble, wood);
    addTrees(gltf, random, leaf, bark, clay);
    addFurniture(gltf, wood, marble, metal, plaster);
    addRailing(gltf, metal);
    addWireFence(gltf, wire, wood);
    addOrnament(gltf, metal, gold);
    gltf.camera({.eye = {7.4f, 4.6f, 8.6f}, .target = {-0.6f, 0.7f, -0.6f}, .fovY = 48});
    gltf.light({.position = {4.5f, 9, 2.5f}, .target = {-0.5f, 0, -0.5f}, .size = {1.5f, 1.5f}});
    return gltf;
}

// --- one difficulty each ---------------------------------------------------------------------------------------------

// A floor whose top is at y = 0 and the materials that these scenes use.
struct Stage {
    Gltf gltf;
    int grey, red, blue;

    Stage(const std::string& name, double halfFloor) : gltf(name) {
        const int floor = gltf.material("floor", {0.7, 0.7, 0.7});
        grey = gltf.material("grey", {0.5, 0.5, 0.5});
        red = gltf.material("red", {0.65, 0.25, 0.18});
        blue = gltf.material("blue", {0.2, 0.35, 0.6});
        gltf.object("floor", box({-halfFloor, -0.1, -halfFloor}, {halfFloor, 0, halfFloor}), floor);
    }
};

// Scherzer 2009, figure 5: where penumbrae of casters at several heights overlap, averaged blocker depths band.
Gltf overlappingOccluders() {
    Stage s("overlapping-occluders", 5);
    Shape low, high;
    for (int i = 0; i < 4; ++i) low.add(boxAround({-1.2 + 0.8 * i, 0.8, 0}, {0.25, 0.06, 3}));
    for (int i = 0; i < 3; ++i) high.add(boxAround({0, 1.9, -1 + i}, {3, 0.06, 0.3}));
    s.gltf.object("low bars", low, s.red);
    s.gltf.object("high bars", high, s.blue);
    s.gltf.object("ball", sphere({0.6, 1.3, 0.5}, 0.3, 48), s.grey);
    s.gltf.camera({.eye = {3.6f, 3.4f, 5}, .target = {0, 0.4f, 0}});
    s.gltf.light({.position = {-1, 5, 1}, .target = {0, 0, 0}, .size = {1.5f, 1.5f}});
    return std::move(s.gltf);
}

// A light larger than its casters: no umbra reaches the floor from the higher ones.
Gltf largePenumbra() {
    Stage s("large-penumbra", 6);
    s.gltf.object("pole", rod({-1.2, 0, -0.5}, {-1.2, 3, -0.5}, 0.08, 32), s.grey);
    s.gltf.object("block", boxAround({0.4, 1.6, 0}, {0.9, 0.9, 0.9}), s.red);
    s.gltf.object("ball", sphere({1.9, 0.5, 0.8}, 0.5, 64), s.blue);
    s.gltf.camera({.eye = {4, 4, 6}, .target = {0, 0.6f, 0}});
    s.gltf.light({.position = {-1.5f, 5, -1}, .target = {0, 0, 0}, .size = {3, 3}});
    return std::move(s.gltf);
}

// Casters that touch the receiver: shadows must begin sharp, where they touch, and not beside it.
Gltf contact() {
    Stage s("contact", 4);
    s.gltf.object("block", box({-1.5, 0, -0.4}, {-0.8, 0.7, 0.3}), s.red);
    s.gltf.object("cylinder", cylinder(0.3, 1, 48), s.grey);
    s.gltf.object("ball", sphere({1.1, 0.35, 0.1}, 0.35, 64), s.blue);
    s.gltf.object("tile", box({-0.6, 0, 0.8}, {0.2, 0.03, 1.4}), s.red);
    Shape card;
    card.add(boxAround({0, 0.4, 0}, {0.8, 0.8, 0.01}), moved({1, 0, 1.2}) * turned(35, {0, 1, 0}));
    s.gltf.object("card", card, s.grey);
    s.gltf.camera({.eye = {1.8f, 2.2f, 4}, .target = {0, 0.3f, 0.2f}});
    s.gltf.light({.position = {-2.2f, 3.4f, 1.2f}, .target = {0, 0, 0}, .size = {0.6f, 0.6f}});
    return std::move(s.gltf);
}

// A low light: shadows many times longer than their casters, penumbrae far longer than wide.
Gltf elongated() {
    Stage s("elongated", 8);
    Shape posts;
    for (int i = 0; i < 7; ++i) posts.add(rod({-3, 0, -3 + i}, {-3, 0.5 + 0.15 * i, -3 + i}, 0.05, 20));
    s.gltf.object("posts", posts, s.red);
    s.gltf.object("bar", boxAround({-2, 0.9, 0}, {0.06, 0.06, 6}), s.blue);
    s.gltf.camera({.eye = {4.5f, 4, 6.5f}, .target = {0, 0, 0}});
    s.gltf.light({.position = {-7, 2.2f, 0.5f}, .target = {0, 0, 0}, .size = {0.6f, 0.6f}});
    return std::move(s.gltf);
}

// Casters thinner than any depth bias ought to be (after Valient 2014's thin occluders): light leaks through them.
Gltf thinSlab() {
    Stage s("thin-slab", 4);
    s.gltf.object("slab", box({-1.6, 0.05, -0.6}, {-0.2, 0.06, 0.8}), s.red);
    Shape room; // walls of one centimetre and a lid; inside it is dark
    room.add(box({0.3, 0, -0.7}, {1.7, 0.9, -0.69}));
    room.add(box({0.3, 0, -0.69}, {0.31, 0.9, 0.7}));
    room.add(box({1.69, 0, -0.69}, {1.7, 0.9, 0.7}));
    room.add(box({0.3, 0.9, -0.7}, {1.7, 0.91, 0.7}));
    s.gltf.object("thin walls", room, s.grey);
    s.gltf.object("blade", boxAround({-0.2, 0.4, 1.4}, {1.6, 0.8, 0.01}), s.blue);
    s.gltf.camera({.eye = {1.6f, 1.8f, 4.4f}, .target = {0.1f, 0.3f, 0}});
    s.gltf.light({.position = {-1, 4, -1.6f}, .target = {0, 0, 0}, .size = {0.8f, 0.8f}});
    return std::move(s.gltf);
}

// Two casters one over the other with a wide gap: a filter of depths sees a spread that no single caster explains, and
// light leaks into the lower shadow along the edge of the upper one.
Gltf twoDepths() {
    Stage s("two-depths", 5);
    s.gltf.object("upper", box({-1.6, 3, -1.2}, {0.3, 3.05, 1.2}), s.blue);
    s.gltf.object("lower", box({-0.5, 0.5, -0.9}, {1.6, 0.55, 0.9}), s.red);
    s.gltf.camera({.eye = {3.2f, 2, 4.6f}, .target = {0, 0.6f, 0}});
    s.gltf.light({.position = {0.3f, 6, 0.4f}, .target = {0, 0, 0}, .size = {0.7f, 0.7f}});
    return std::move(s.gltf);
}

// A shape that floats over stairs (Peters 2015): the receiver's depth jumps inside of one filter kernel.
Gltf overStairs() {
    Stage s("over-stairs", 5);
    Shape stairs;
    for (int i = 0; i < 10; ++i) stairs.add(box({-2.5, 0, -2.5 + 0.4 * i}, {2.5, 0.2 * (10 - i), -2.1 + 0.4 * i}));
    s.gltf.object("stairs", stairs, s.grey);
    Shape ring;
    ring.add(torus(0.8, 0.12, 96, 24), moved({-0.9, 3, 0}) * turned(25, {1, 0, 0}));
    s.gltf.object("ring", ring, s.red);
    Shape star;
    for (int i = 0; i < 3; ++i)
        star.add(boxAround(dvec3(0), {1.7, 0.06, 0.16}), moved({1.2, 3, 0}) * turned(60 * i + 10, {0, 1, 0}));
    s.gltf.object("star", star, s.blue);
    s.gltf.camera({.eye = {2.6f, 4.6f, 6}, .target = {0, 1.2f, 0}});
    s.gltf.light({.position = {-1, 8, 2}, .target = {0, 1, 0}, .size = {0.8f, 0.8f}});
    return std::move(s.gltf);
}

// What keeps its history must let go of it: a sliding box, a turning bar, and a pillar that stands still.
Gltf movingCaster() {
    Stage s("moving-caster", 5);
    s.gltf.object("pillar", box({-0.2, 0, -1.8}, {0.2, 1.6, -1.4}), s.grey);
    const int slider = s.gltf.object("slider", boxAround({0, 0.9, 0.6}, {0.6, 0.6, 0.6}), s.red);
    s.gltf.animate(slider, "translation", {0, 2, 4}, {-1.8, 0, 0, 1.8, 0, 0, -1.8, 0, 0});
    const int bar =
        s.gltf.node("bar", s.gltf.mesh("bar", {{boxAround(dvec3(0), {2.4, 0.1, 0.1}), s.blue}}), {0, 1.8, -0.6});
    s.gltf.spin(bar, 4);
    s.gltf.camera({.eye = {2.8f, 3.4f, 5}, .target = {0, 0.4f, 0}});
    s.gltf.light({.position = {-1.2f, 5, 0.8f}, .target = {0, 0, 0}, .size = {1, 1}});
    return std::move(s.gltf);
}

Gltf twoBoxes() {
    Stage s("two-boxes", 4);
    s.gltf.object("standing", box({-1.1, 0, -0.5}, {-0.3, 0.8, 0.3}), s.red);
    s.gltf.object("floating", box({0.3, 1, -0.2}, {0.9, 1.5, 0.5}), s.blue);
    s.gltf.camera({.eye = {2.5f, 3, 4}, .target = {0, 0.5f, 0}, .fovY = 45});
    s.gltf.light({.position = {0, 4, 0}, .target = {0, 0, 0}, .size = {1, 1}});
    return std::move(s.gltf);
}

// --- those with closed forms: light at 10 m facing down, caster at 6 m, floor at 0 ----------------------------------

// V(x) = clamp((a + x (H − h)/h) / 2a) with a = ½, H = 10, h = 6, over |z| < 3: there no ray to the light passes the
// slab's other sides. It is no larger, so that a shadow map has its texels where the edge is.
Gltf halfPlane() {
    Stage s("half-plane", 6);
    s.gltf.object("slab", box({-5, 5.99, -5}, {0, 6, 5}), s.red);
    s.gltf.camera({.eye = {3, 3, 2.5f}, .target = {0, 0, 0}});
    s.gltf.light({.position = {0, 10, 0}, .target = {0, 0, 0}, .size = {1, 1}});
    return std::move(s.gltf);
}

// V = 1 − overlap of the occluder [−0.6, 0.6] x [−0.4, 0.4], projected from the receiver, with the light.
Gltf rectangle() {
    Stage s("rectangle", 10);
    s.gltf.object("plate", box({-0.6, 5.998, -0.4}, {0.6, 6, 0.4}), s.red);
    s.gltf.camera({.eye = {3, 4, 4}, .target = {0, 0, 0}});
    s.gltf.light({.position = {0, 10, 0}, .target = {0, 0, 0}, .size = {1, 1}});
    return std::move(s.gltf);
}

// A ball of radius 0.6 under a disk of radius ½.
Gltf ball() {
    Stage s("sphere", 10);
    s.gltf.object("ball", sphere({0, 6, 0}, 0.6, 256), s.red);
    s.gltf.camera({.eye = {3, 4, 4}, .target = {0, 0, 0}});
    s.gltf.light({.shape = LightShape::Disk, .position = {0, 10, 0}, .target = {0, 0, 0}, .size = {1, 1}});
    return std::move(s.gltf);
}

} // namespace

int main(int argc, char** argv) {
    try {
        const std::filesystem::path folder = argc > 1 ? argv[1] : "assets/scenes";
        std::filesystem::create_directories(folder);
        for (const auto& make : {courtyard, overlappingOccluders, largePenumbra, contact, elongated, thinSlab,
                                 twoDepths, overStairs, movingCaster, twoBoxes, halfPlane, rectangle, ball})
            make().save(folder);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make-scenes: %s\n", error.what());
        return 2;
    }
}
