// SPDX-License-Identifier: MIT
#include "renderer/core/error.h"
#include "renderer/scene/gltf_file.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>

namespace penumbra {
namespace {

using json = nlohmann::json;

// Extensions that a scene may require: read, or without effect on geometry and light.
constexpr std::string_view readExtensions[] = {"KHR_lights_punctual", "KHR_texture_transform", "KHR_mesh_quantization"};
constexpr std::string_view acceptedExtensions[] = {"KHR_lights_punctual",
                                                   "KHR_texture_transform",
                                                   "KHR_mesh_quantization",
                                                   "KHR_materials_unlit",
                                                   "KHR_materials_emissive_strength",
                                                   "KHR_materials_clearcoat",
                                                   "KHR_materials_ior",
                                                   "KHR_materials_iridescence",
                                                   "KHR_materials_sheen",
                                                   "KHR_materials_specular",
                                                   "KHR_materials_transmission",
                                                   "KHR_materials_variants",
                                                   "KHR_materials_volume",
                                                   "KHR_materials_pbrSpecularGlossiness"};

constexpr float largestNumber = 1e9f; // [m]; beyond it products of coordinates leave the range of float
// A few bytes of a file may be used again and again; these keep what comes of it within the memory of a machine.
constexpr size_t mostVertices = size_t{1} << 26, mostIndices = size_t{1} << 28, mostKeys = size_t{1} << 26;
constexpr size_t mostTextureBytes = size_t{1} << 32, mostNotes = 100;
constexpr size_t mostZeros = size_t{1} << 20; // elements of an accessor that has no bytes of its own

bool usable(float value) { return std::abs(value) <= largestNumber; } // NaN and infinity are not

// Where the elements of an accessor lie. Empty bytes: all are zero.
struct Elements {
    std::span<const uint8_t> bytes;
    size_t count = 0, stride = 0, components = 0, componentSize = 0;
    int componentType = 0;
    bool normalised = false;
};

template <class T> T loadAs(const uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

// glTF 2.0 specification, 3.11: integers that stand for [0, 1] or [-1, 1].
float componentAt(const uint8_t* bytes, int type, bool normalised) {
    const auto scaled = [normalised](float value, float largest) {
        return normalised ? std::max(value / largest, -1.0f) : value;
    };
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return scaled(loadAs<int8_t>(bytes), 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return scaled(*bytes, 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return scaled(loadAs<int16_t>(bytes), 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return scaled(loadAs<uint16_t>(bytes), 65535);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return scaled(float(loadAs<uint32_t>(bytes)), 4294967295.0f);
    default: return loadAs<float>(bytes);
    }
}

uint32_t integerAt(const uint8_t* bytes, int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return *bytes;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return loadAs<uint16_t>(bytes);
    default: return loadAs<uint32_t>(bytes);
    }
}

bool isUnsigned(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

// KHR_texture_transform: uv of the picture from uv of the vertex.
struct TextureTransform {
    glm::vec2 offset{0}, scale{1};
    float rotation = 0;
    bool operator==(const TextureTransform&) const = default;

    glm::vec2 operator()(glm::vec2 uv) const {
        const glm::vec2 p = scale * uv;
        const float c = std::cos(rotation), s = std::sin(rotation);
        return offset + glm::vec2(c * p.x + s * p.y, c * p.y - s * p.x);
    }
};

// What a primitive must know of its material besides what the scene keeps.
struct TextureCoordinates {
    int set = -1; // of TEXCOORD; -1: the material has no texture
    TextureTransform transform;
};

class Importer {
public:
    explicit Importer(const std::filesystem::path& file) : file_(file, acceptedExtensions) {}

    Scene run() {
        scene_.name = file_.path().stem().string();
        scene_.file = file_.path();
        parseModel();
        checkBytes();
        noteExtensions();
        for (size_t i = 0; i < model_.materials.size(); ++i) addMaterial(i);
        for (size_t i = 0; i < model_.meshes.size(); ++i) addMesh(i);
        finishMaterialsAndNormals();
        addNodes();
        for (size_t i = 0; i < model_.animations.size(); ++i) addAnimation(i);
        checkExtent();
        return std::move(scene_);
    }

private:
    struct VertexRange {
        uint32_t first = 0, count = 0;
    };

    void note(const std::string& text) {
        const std::string line = oneLine(text);
        const bool isNew = std::find(scene_.notes.begin(), scene_.notes.end(), line) == scene_.notes.end();
        if (isNew && scene_.notes.size() < mostNotes) scene_.notes.push_back(line);
    }
    template <class T>
    const T& at(const std::vector<T>& list, int index, const char* what, const std::string& user) const {
        if (index < 0 || size_t(index) >= list.size())
            file_.refuse(user, fmt::format("refers to {} {} of {}", what, index, list.size()));
        return list[size_t(index)];
    }

    // Buffers and images are left out of what tinygltf sees: their bytes are read and checked by GltfFile.
    void parseModel() {
        json document;
        for (const auto& [key, value] : file_.document().items())
            if (key != "buffers" && key != "images") document[key] = value;
        const std::string text = document.dump();
        std::string error, warning;
        bool read = false;
        try {
            tinygltf::TinyGLTF loader;
            read = text.size() <= std::numeric_limits<unsigned>::max() &&
                   loader.LoadASCIIFromString(&model_, &error, &warning, text.data(), unsigned(text.size()), "");
        } catch (const std::exception& exception) {
            error = exception.what();
        }
        if (!read) file_.refuse("JSON", error.empty() ? "expected glTF 2.0" : error);
        // A mistyped element may have been left out, which would shift what the others refer to.
        const auto complete = [&](const char* name, size_t count) {
            const auto found = document.find(name);
            if (count != (found == document.end() ? 0 : found->size()))
                file_.refuse(name, "has elements that are not understood");
        };
        complete("accessors", model_.accessors.size());
        complete("bufferViews", model_.bufferViews.size());
        complete("materials", model_.materials.size());
        complete("meshes", model_.meshes.size());
        complete("nodes", model_.nodes.size());
    }

    void noteExtensions() {
        for (const std::string& name : model_.extensionsUsed)
            if (std::find(std::begin(readExtensions), std::end(readExtensions), name) == std::end(readExtensions))
                note(fmt::format("extension {} is not read", name));
        if (!model_.skins.empty()) note("skinning is not read: skinned meshes stand in their bind pose");
    }

    // Also what no mesh uses: a file with a hole is better refused than half shown.
    void checkBytes() {
        for (size_t i = 0; i < model_.bufferViews.size(); ++i) file_.bufferView(i, "scene");
        for (size_t i = 0; i < model_.accessors.size(); ++i) elements(int(i), fmt::format("accessor {}", i));
    }

    // --- accessors ---------------------------------------------------------------------------------------------------

    Elements view(int bufferView, size_t byteOffset, size_t count, size_t components, int componentType,
                  const std::string& place) {
        Elements e;
        e.count = count;
        e.components = components;
        e.componentType = componentType;
        const bool known = componentType >= TINYGLTF_COMPONENT_TYPE_BYTE &&
                           componentType <= TINYGLTF_COMPONENT_TYPE_FLOAT &&
                           componentType != TINYGLTF_COMPONENT_TYPE_INT;
        if (!known) file_.refuse(place, fmt::format("has component type {}, which glTF does not know", componentType));
        e.componentSize = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(componentType)));
        const size_t size = e.componentSize * components;
        const auto& description = at(model_.bufferViews, bufferView, "bufferView", place);
        e.stride = description.byteStride == 0 ? size : description.byteStride;
        if (e.stride < size)
            file_.refuse(place, fmt::format("has elements of {} bytes but a byteStride of {}", size, e.stride));
        e.bytes = file_.bufferView(size_t(bufferView), place);
        const size_t available = e.bytes.size();
        if (byteOffset > available || size > available - byteOffset ||
            count - 1 > (available - byteOffset - size) / e.stride)
            file_.refuse(place, fmt::format("has {} elements of {} bytes from byte {} on, more than the {} bytes of "
                                            "bufferView {}",
                                            count, size, byteOffset, available, bufferView));
        e.bytes = e.bytes.subspan(byteOffset);
        return e;
    }

    Elements elements(int index, const std::string& place) {
        const tinygltf::Accessor& accessor = at(model_.accessors, index, "accessor", place);
        const auto components = size_t(tinygltf::GetNumComponentsInType(uint32_t(accessor.type)));
        if (accessor.count == 0) file_.refuse(place, "has a count of 0; expected at least 1");
        Elements e;
        if (accessor.bufferView >= 0) {
            e = view(accessor.bufferView, accessor.byteOffset, accessor.count, components, accessor.componentType,
                     place);
        } else {
            if (accessor.count > mostZeros)
                file_.refuse(place, fmt::format("has {} elements and no bufferView", accessor.count));
            e.count = accessor.count;
            e.components = components;
            e.componentType = accessor.componentType;
        }
        e.normalised = accessor.normalized;
        return e;
    }

    std::string accessorPlace(int index, const std::string& user) const {
        return fmt::format("accessor {}, {}", index, user);
    }

    // All components of all elements, sparse ones replaced. They are finite.
    std::vector<float> readFloats(int index, std::initializer_list<size_t> allowedComponents, const std::string& user) {
        const std::string place = accessorPlace(index, user);
        const Elements e = elements(index, place);
        if (std::find(allowedComponents.begin(), allowedComponents.end(), e.components) == allowedComponents.end())
            file_.refuse(place,
                         fmt::format("has {} components; expected {}", e.components, *allowedComponents.begin()));
        std::vector<float> values(e.count * e.components, 0.0f);
        const auto copy = [&](const Elements& from, size_t i, size_t to) {
            for (size_t c = 0; c < e.components; ++c)
                values[to * e.components + c] = componentAt(
                    from.bytes.data() + i * from.stride + c * from.componentSize, from.componentType, e.normalised);
        };
        if (!e.bytes.empty())
            for (size_t i = 0; i < e.count; ++i) copy(e, i, i);

        const auto& sparse = model_.accessors[size_t(index)].sparse;
        if (sparse.isSparse) {
            if (sparse.count < 1 || size_t(sparse.count) > e.count || int64_t(sparse.indices.byteOffset) < 0 ||
                int64_t(sparse.values.byteOffset) < 0 || !isUnsigned(sparse.indices.componentType))
                file_.refuse(place, "has a sparse part with an impossible count, offset or type");
            const auto count = size_t(sparse.count);
            const Elements at = view(sparse.indices.bufferView, size_t(sparse.indices.byteOffset), count, 1,
                                     sparse.indices.componentType, place);
            const Elements with = view(sparse.values.bufferView, size_t(sparse.values.byteOffset), count, e.components,
                                       e.componentType, place);
            for (size_t i = 0; i < count; ++i) {
                const uint32_t target = integerAt(at.bytes.data() + i * at.stride, at.componentType);
                if (target >= e.count)
                    file_.refuse(place, fmt::format("has a sparse index {} of {} elements", target, e.count));
                copy(with, i, target);
            }
        }
        const auto bad = std::find_if_not(values.begin(), values.end(), usable);
        if (bad != values.end())
            file_.refuse(place, fmt::format("element {} is {}; expected a number of at most {}",
                                            size_t(bad - values.begin()) / e.components, *bad, largestNumber));
        return values;
    }

    std::vector<uint32_t> readIndices(int index, size_t vertexCount, const std::string& user) {
        const std::string place = accessorPlace(index, user);
        const Elements e = elements(index, place);
        if (e.components != 1 || !isUnsigned(e.componentType) || e.bytes.empty())
            file_.refuse(place, "expected indices: unsigned integers with a bufferView");
        std::vector<uint32_t> indices(e.count);
        for (size_t i = 0; i < e.count; ++i) {
            indices[i] = integerAt(e.bytes.data() + i * e.stride, e.componentType);
            if (indices[i] >= vertexCount)
                file_.refuse(place, fmt::format("index {} is {}; expected less than the {} vertices", i, indices[i],
                                                vertexCount));
        }
        return indices;
    }

    // --- materials ---------------------------------------------------------------------------------------------------

    void addMaterial(size_t index) {
        const tinygltf::Material& from = model_.materials[index];
        const std::string place = fmt::format("material {} '{}'", index, from.name);
        const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
        Material to;
        to.name = from.name;
        for (size_t c = 0; c < std::min<size_t>(4, pbr.baseColorFactor.size()); ++c)
            to.baseColour[int(c)] = unitNumber(pbr.baseColorFactor[c], "baseColorFactor", place);
        for (size_t c = 0; c < std::min<size_t>(3, from.emissiveFactor.size()); ++c)
            to.emissive[int(c)] = unitNumber(from.emissiveFactor[c], "emissiveFactor", place);
        to.doubleSided = from.doubleSided;
        if (from.alphaMode == "MASK") {
            to.masked = true;
            to.alphaCutoff = float(from.alphaCutoff);
            if (!usable(to.alphaCutoff)) file_.refuse(place, "alphaCutoff is not a number");
        } else if (from.alphaMode == "BLEND") {
            to.masked = true;
            note(fmt::format("material '{}' is blended; it is drawn cut out at half of its alpha", from.name));
        } else if (from.alphaMode != "OPAQUE") {
            file_.refuse(place, fmt::format("alphaMode is '{}'; expected OPAQUE, MASK or BLEND", from.alphaMode));
        }
        TextureCoordinates coordinates;
        if (pbr.baseColorTexture.index >= 0) {
            to.texture = addTexture(pbr.baseColorTexture.index, place);
            coordinates = coordinatesOf(pbr.baseColorTexture, place);
        }
        coordinates_.push_back(coordinates);
        scene_.materials.push_back(std::move(to));
    }

    float unitNumber(double value, const char* name, const std::string& place) const {
        if (!(value >= 0 && value <= 1)) file_.refuse(place, fmt::format("{} is {}; expected 0..1", name, value));
        return float(value);
    }

    TextureCoordinates coordinatesOf(const tinygltf::TextureInfo& info, const std::string& place) const {
        TextureCoordinates result{.set = info.texCoord, .transform = {}};
        const auto extension = info.extensions.find("KHR_texture_transform");
        if (extension == info.extensions.end()) return result;
        const tinygltf::Value& value = extension->second;
        const auto number = [&](const tinygltf::Value& v) {
            const float f = float(v.GetNumberAsDouble());
            if (!v.IsNumber() || !usable(f)) file_.refuse(place, "KHR_texture_transform has a value that is no number");
            return f;
        };
        const auto pair = [&](const char* name, glm::vec2& into) {
            if (!value.Has(name)) return;
            const tinygltf::Value& list = value.Get(name);
            if (list.ArrayLen() != 2) file_.refuse(place, "KHR_texture_transform has a pair without two numbers");
            into = {number(list.Get(0)), number(list.Get(1))};
        };
        pair("offset", result.transform.offset);
        pair("scale", result.transform.scale);
        if (value.Has("rotation")) result.transform.rotation = number(value.Get("rotation"));
        if (value.Has("texCoord")) result.set = int(number(value.Get("texCoord")));
        return result;
    }

    int addTexture(int index, const std::string& user) {
        const tinygltf::Texture& texture = at(model_.textures, index, "texture", user);
        if (texture.source < 0) {
            note(fmt::format("texture {} has no picture in a format that is read", index));
            return -1;
        }
        const auto [known, isNew] =
            textures_.try_emplace({texture.source, texture.sampler}, int(scene_.textures.size()));
        if (!isNew) return known->second;
        TextureImage image = file_.image(size_t(texture.source));
        textureBytes_ += image.rgba.size();
        if (textureBytes_ > mostTextureBytes) file_.refuse(user, "brings the pictures to more than 4 GiB");
        if (texture.sampler >= 0) {
            const tinygltf::Sampler& sampler = at(model_.samplers, texture.sampler, "sampler", user);
            image.wrapU = wrapOf(sampler.wrapS);
            image.wrapV = wrapOf(sampler.wrapT);
            image.magnifyNearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
        }
        scene_.textures.push_back(std::move(image));
        return known->second;
    }

    static Wrap wrapOf(int mode) {
        if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::ClampToEdge;
        return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::MirroredRepeat : Wrap::Repeat;
    }

    // --- meshes ------------------------------------------------------------------------------------------------------

    void addMesh(size_t index) {
        const tinygltf::Mesh& from = model_.meshes[index];
        Mesh& to = scene_.meshes.emplace_back();
        to.name = from.name;
        for (size_t i = 0; i < from.primitives.size(); ++i)
            addPrimitive(from.primitives[i], to, fmt::format("mesh {} '{}' primitive {}", index, from.name, i));
    }

    void addPrimitive(const tinygltf::Primitive& from, Mesh& mesh, const std::string& place) {
        if (from.mode < TINYGLTF_MODE_POINTS || from.mode > TINYGLTF_MODE_TRIANGLE_FAN)
            file_.refuse(place, fmt::format("has mode {}; expected 0..6", from.mode));
        if (from.mode < TINYGLTF_MODE_TRIANGLES) return note(place + ": points and lines are not drawn");
        if (!from.attributes.contains("POSITION")) return note(place + ": has no positions and is not drawn");
        if (!from.targets.empty()) note("morphing is not read: meshes with morph targets keep their base shape");
        if (from.attributes.contains("COLOR_0")) note("vertex colours are not read");
        if (from.material >= 0) at(scene_.materials, from.material, "material", place);

        const int positionAccessor = from.attributes.at("POSITION");
        const size_t vertexCount = at(model_.accessors, positionAccessor, "accessor", place).count;
        std::vector<uint32_t> indices;
        if (from.indices >= 0) {
            indices = readIndices(from.indices, vertexCount, place);
        } else {
            elements(positionAccessor, accessorPlace(positionAccessor, place)); // its count is real
            indices.resize(vertexCount);
            std::iota(indices.begin(), indices.end(), 0u);
        }
        indices = triangleList(indices, from.mode);
        if (indices.empty()) return note(place + ": has no whole triangle and is not drawn");

        Primitive to;
        to.material = from.material >= 0 ? from.material : int(model_.materials.size());
        const bool flat = !from.attributes.contains("NORMAL");
        const VertexRange range = flat ? addFlatVertices(from, indices, place) : addVertices(from, place);
        to.firstVertex = range.first;
        to.vertexCount = range.count;
        to.firstIndex = uint32_t(scene_.indices.size());
        to.indexCount = uint32_t(indices.size());
        if (indices.size() > mostIndices - scene_.indices.size()) file_.refuse(place, "brings too many indices");
        scene_.indices.insert(scene_.indices.end(), indices.begin(), indices.end());
        for (const uint32_t i : indices) to.bounds.add(scene_.positions[range.first + i]);
        mendNormals(range, indices);
        mesh.primitives.push_back(to);
    }

    static std::vector<uint32_t> triangleList(const std::vector<uint32_t>& indices, int mode) {
        std::vector<uint32_t> list;
        const size_t n = indices.size();
        if (mode == TINYGLTF_MODE_TRIANGLES) {
            list.assign(indices.begin(), indices.begin() + std::ptrdiff_t(n - n % 3));
        } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) { // every other triangle is turned to keep the winding
            for (size_t i = 2; i < n; ++i)
                list.insert(list.end(), {indices[i - 2], indices[i - 1 + i % 2], indices[i - i % 2]});
        } else {
            for (size_t i = 2; i < n; ++i) list.insert(list.end(), {indices[0], indices[i - 1], indices[i]});
        }
        return list;
    }

    struct Streams {
        std::vector<float> positions, normals, uvs; // uvs may be empty
    };
    Streams readStreams(const tinygltf::Primitive& primitive, const std::string& place) {
        Streams streams;
        streams.positions = readFloats(primitive.attributes.at("POSITION"), {3}, place + " POSITION");
        const auto normal = primitive.attributes.find("NORMAL");
        if (normal != primitive.attributes.end()) streams.normals = readFloats(normal->second, {3}, place + " NORMAL");
        const int uv = uvAccessor(primitive);
        if (uv >= 0) {
            streams.uvs = readFloats(uv, {2}, place + " TEXCOORD");
            const TextureTransform& transform = coordinates_[size_t(primitive.material)].transform;
            for (size_t i = 0; i < streams.uvs.size(); i += 2) {
                const glm::vec2 moved = transform({streams.uvs[i], streams.uvs[i + 1]});
                streams.uvs[i] = moved.x;
                streams.uvs[i + 1] = moved.y;
            }
        }
        const size_t count = streams.positions.size() / 3;
        if ((!streams.normals.empty() && streams.normals.size() != 3 * count) ||
            (!streams.uvs.empty() && streams.uvs.size() != 2 * count))
            file_.refuse(place, "has attributes of different counts");
        return streams;
    }

    int uvAccessor(const tinygltf::Primitive& primitive) const {
        if (primitive.material < 0) return -1;
        const auto found =
            primitive.attributes.find(fmt::format("TEXCOORD_{}", coordinates_[size_t(primitive.material)].set));
        return found == primitive.attributes.end() ? -1 : found->second;
    }

    void append(const Streams& streams, size_t i) {
        const float* p = &streams.positions[3 * i];
        scene_.positions.emplace_back(p[0], p[1], p[2]);
        scene_.uvs.push_back(streams.uvs.empty() ? glm::vec2(0)
                                                 : glm::vec2(streams.uvs[2 * i], streams.uvs[2 * i + 1]));
    }

    VertexRange beginVertices(size_t count, const std::string& place) const {
        if (count > mostVertices - scene_.positions.size()) file_.refuse(place, "brings too many vertices");
        return {uint32_t(scene_.positions.size()), uint32_t(count)};
    }

    // Primitives with the same attributes share their vertices.
    VertexRange addVertices(const tinygltf::Primitive& primitive, const std::string& place) {
        const int uv = uvAccessor(primitive);
        const bool moved = uv >= 0 && coordinates_[size_t(primitive.material)].transform != TextureTransform{};
        const auto [known, isNew] =
            vertices_.try_emplace({primitive.attributes.at("POSITION"), primitive.attributes.at("NORMAL"), uv,
                                   moved ? primitive.material : -1});
        if (!isNew) return known->second;
        const Streams streams = readStreams(primitive, place);
        known->second = beginVertices(streams.positions.size() / 3, place);
        for (size_t i = 0; i < known->second.count; ++i) {
            append(streams, i);
            const float* n = &streams.normals[3 * i];
            const glm::vec3 normal(n[0], n[1], n[2]);
            const float length = glm::length(normal);
            scene_.normals.push_back(length > 1e-12f ? normal / length : glm::vec3(0));
        }
        return known->second;
    }

    // Without normals in the file triangles are flat, so each has vertices of its own; `indices` then just counts.
    VertexRange addFlatVertices(const tinygltf::Primitive& primitive, std::vector<uint32_t>& indices,
                                const std::string& place) {
        const Streams streams = readStreams(primitive, place);
        const VertexRange range = beginVertices(indices.size(), place);
        for (uint32_t& index : indices) {
            append(streams, index);
            scene_.normals.emplace_back(0);
        }
        std::iota(indices.begin(), indices.end(), 0u);
        return range;
    }

    // Gives vertices without a normal the one of a triangle that they belong to.
    void mendNormals(const VertexRange& range, const std::vector<uint32_t>& indices) {
        const auto isMissing = [](const glm::vec3& normal) { return normal == glm::vec3(0); };
        for (size_t i = 0; i + 2 < indices.size(); i += 3) {
            const std::array<size_t, 3> corner{range.first + indices[i], range.first + indices[i + 1],
                                               range.first + indices[i + 2]};
            if (std::none_of(corner.begin(), corner.end(), [&](size_t v) { return isMissing(scene_.normals[v]); }))
                continue;
            const glm::dvec3 a(scene_.positions[corner[0]]), b(scene_.positions[corner[1]]),
                c(scene_.positions[corner[2]]);
            const glm::dvec3 normal = glm::cross(b - a, c - a);
            const double length = glm::length(normal);
            if (!(length > 0)) continue;
            for (const size_t v : corner)
                if (isMissing(scene_.normals[v])) scene_.normals[v] = glm::vec3(normal / length);
        }
    }

    void finishMaterialsAndNormals() {
        // The material of primitives without one, which also keeps the list from being empty.
        scene_.materials.push_back({.name = "default"});
        // Vertices of degenerate triangles only: never seen, but a unit vector is promised.
        for (glm::vec3& normal : scene_.normals)
            if (normal == glm::vec3(0)) normal = {0, 1, 0};
    }

    // --- nodes -------------------------------------------------------------------------------------------------------

    std::string nodePlace(size_t index) const { return fmt::format("node {} '{}'", index, model_.nodes[index].name); }

    void addNodes() {
        const size_t count = model_.nodes.size();
        std::vector<int> parents(count, -1);
        for (size_t i = 0; i < count; ++i)
            for (const int child : model_.nodes[i].children) {
                at(model_.nodes, child, "node", nodePlace(i));
                if (parents[size_t(child)] >= 0)
                    file_.refuse(nodePlace(size_t(child)), "has two parents; expected a tree");
                parents[size_t(child)] = int(i);
            }

        std::vector<size_t> order; // parents first
        for (size_t i = 0; i < count; ++i)
            if (parents[i] < 0) order.push_back(i);
        for (size_t next = 0; next < order.size(); ++next)
            for (const int child : model_.nodes[order[next]].children) order.push_back(size_t(child));
        if (order.size() != count) {
            std::vector<bool> reached(count);
            for (const size_t i : order) reached[i] = true;
            const auto lost = size_t(std::find(reached.begin(), reached.end(), false) - reached.begin());
            file_.refuse(nodePlace(lost), "is its own ancestor; expected a tree");
        }

        const std::vector<bool> visible = visibleNodes();
        nodes_.resize(count);
        for (size_t i = 0; i < count; ++i) nodes_[order[i]] = int(i);
        for (const size_t i : order) {
            Node node = readNode(i);
            node.parent = parents[i] < 0 ? -1 : nodes_[size_t(parents[i])];
            node.visible = visible[i];
            scene_.nodes.push_back(std::move(node));
        }
        for (size_t i = 0; i < count; ++i)
            if (visible[i]) addCameraAndLight(i);
    }

    // Those below the default scene, the first one, or all if there are no scenes.
    std::vector<bool> visibleNodes() const {
        std::vector<bool> visible(model_.nodes.size(), model_.scenes.empty());
        if (model_.scenes.empty()) return visible;
        const tinygltf::Scene& chosen =
            at(model_.scenes, model_.defaultScene < 0 ? 0 : model_.defaultScene, "scene", "scene");
        std::vector<int> open(chosen.nodes);
        while (!open.empty()) {
            const int node = open.back();
            open.pop_back();
            at(model_.nodes, node, "node", fmt::format("scene '{}'", chosen.name));
            if (visible[size_t(node)]) continue;
            visible[size_t(node)] = true;
            const std::vector<int>& children = model_.nodes[size_t(node)].children;
            open.insert(open.end(), children.begin(), children.end());
        }
        return visible;
    }

    Node readNode(size_t index) {
        const tinygltf::Node& from = model_.nodes[index];
        const std::string place = nodePlace(index);
        const auto numbers = [&](const std::vector<double>& list, size_t count, const char* name) {
            if (list.size() != count)
                file_.refuse(place, fmt::format("{} has {} numbers; expected {}", name, list.size(), count));
            std::array<float, 16> values{};
            for (size_t i = 0; i < count; ++i) {
                values[i] = float(list[i]);
                if (!usable(values[i])) file_.refuse(place, fmt::format("{} has a value of {}", name, list[i]));
            }
            return values;
        };
        Node to;
        to.name = from.name;
        if (!from.matrix.empty()) {
            const std::array<float, 16> values = numbers(from.matrix, 16, "matrix");
            to.matrix = glm::make_mat4(values.data());
            if (glm::row(*to.matrix, 3) != glm::vec4(0, 0, 0, 1))
                file_.refuse(place, "matrix is not affine; expected 0, 0, 0, 1 as its last row");
        }
        if (!from.translation.empty())
            to.translation = glm::make_vec3(numbers(from.translation, 3, "translation").data());
        if (!from.scale.empty()) to.scale = glm::make_vec3(numbers(from.scale, 3, "scale").data());
        if (!from.rotation.empty()) {
            const std::array<float, 16> q = numbers(from.rotation, 4, "rotation");
            const glm::quat rotation(q[3], q[0], q[1], q[2]);
            if (!(glm::length(rotation) > 1e-6f))
                file_.refuse(place, "rotation has no length; expected a unit quaternion");
            to.rotation = glm::normalize(rotation);
        }
        if (from.mesh >= 0) {
            at(scene_.meshes, from.mesh, "mesh", place);
            to.mesh = from.mesh;
        }
        return to;
    }

    void addCameraAndLight(size_t index) {
        const tinygltf::Node& node = model_.nodes[index];
        const std::string place = nodePlace(index);
        if (node.camera >= 0) addCamera(at(model_.cameras, node.camera, "camera", place), index);
        // Asked of the JSON, since versions of tinygltf differ in where they keep it.
        const json extensions = file_.document()["nodes"][index].value("extensions", json());
        const json reference = extensions.is_object() ? extensions.value("KHR_lights_punctual", json()) : json();
        if (!reference.is_object()) return;
        const json light = reference.value("light", json());
        addLight(at(model_.lights, light.is_number_integer() ? light.get<int>() : -1, "light", place), index);
    }

    void addCamera(const tinygltf::Camera& from, size_t node) {
        const std::string place = nodePlace(node);
        NamedCamera to;
        to.name = from.name.empty() ? model_.nodes[node].name : from.name;
        to.node = nodes_[node];
        if (from.type == "perspective") {
            to.fovY = float(glm::degrees(from.perspective.yfov));
            if (!(to.fovY > 0.01f && to.fovY < 179))
                file_.refuse(place,
                             fmt::format("camera has a yfov of {}; expected radians below pi", from.perspective.yfov));
        } else if (from.type == "orthographic") {
            to.halfHeight = float(std::abs(from.orthographic.ymag));
            if (!(to.halfHeight > 0 && usable(to.halfHeight)))
                file_.refuse(place, fmt::format("camera has a ymag of {}; expected metres", from.orthographic.ymag));
            note(fmt::format("camera '{}' is orthographic; a perspective one frames the same", to.name));
        } else {
            file_.refuse(place, fmt::format("camera has type '{}'; expected perspective or orthographic", from.type));
        }
        scene_.cameras.push_back(std::move(to));
    }

    void addLight(const tinygltf::Light& from, size_t node) {
        const std::string place = nodePlace(node);
        NamedLight to;
        to.name = from.name.empty() ? model_.nodes[node].name : from.name;
        to.node = nodes_[node];
        if (from.type == "directional")
            to.shape = LightShape::Directional;
        else if (from.type == "point")
            to.everywhere = true;
        else if (from.type != "spot")
            file_.refuse(place, fmt::format("light has type '{}'; expected point, spot or directional", from.type));
        for (size_t c = 0; c < std::min<size_t>(3, from.color.size()); ++c)
            to.colour[int(c)] = unitNumber(from.color[c], "light colour", place);
        if (from.extras.Has("shape")) {
            const tinygltf::Value& shape = from.extras.Get("shape");
            if (shape.IsString() && shape.Get<std::string>() == "disk" && to.shape == LightShape::Rectangle)
                to.shape = LightShape::Disk;
        }
        if (from.extras.Has("size")) to.size = lightSize(from.extras.Get("size"), place);
        scene_.lights.push_back(std::move(to));
    }

    // "size": d, or "size": [w, h].
    glm::vec2 lightSize(const tinygltf::Value& value, const std::string& place) const {
        glm::vec2 size(-1);
        if (value.IsNumber())
            size = glm::vec2(float(value.GetNumberAsDouble()));
        else if (value.ArrayLen() == 2 && value.Get(0).IsNumber() && value.Get(1).IsNumber())
            size = {float(value.Get(0).GetNumberAsDouble()), float(value.Get(1).GetNumberAsDouble())};
        if (!(size.x > 0 && size.y > 0 && usable(size.x) && usable(size.y)))
            file_.refuse(place, "light has an extra 'size' that is not one or two positive numbers");
        return size;
    }

    // --- animations --------------------------------------------------------------------------------------------------

    void addAnimation(size_t index) {
        const tinygltf::Animation& from = model_.animations[index];
        Animation to;
        to.name = from.name;
        for (size_t i = 0; i < from.channels.size(); ++i)
            addChannel(from, from.channels[i], to, fmt::format("animation {} '{}' channel {}", index, from.name, i));
        std::stable_sort(to.channels.begin(), to.channels.end(),
                         [](const auto& a, const auto& b) { return a.node < b.node; });
        for (const AnimationChannel& channel : to.channels) to.duration = std::max(to.duration, channel.times.back());
        if (!to.channels.empty()) scene_.animations.push_back(std::move(to));
    }

    void addChannel(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& from, Animation& into,
                    const std::string& place) {
        if (from.target_node < 0) return note(place + ": moves no node");
        at(model_.nodes, from.target_node, "node", place);
        AnimationChannel to;
        to.node = nodes_[size_t(from.target_node)];
        if (from.target_path == "translation")
            to.path = AnimationChannel::Path::Translation;
        else if (from.target_path == "rotation")
            to.path = AnimationChannel::Path::Rotation;
        else if (from.target_path == "scale")
            to.path = AnimationChannel::Path::Scale;
        else
            return note(fmt::format("animation of '{}' is not read", from.target_path));
        if (scene_.nodes[size_t(to.node)].matrix) return note(place + ": moves a node that is given as a matrix");

        const tinygltf::AnimationSampler& sampler = at(animation.samplers, from.sampler, "sampler", place);
        if (sampler.interpolation == "STEP")
            to.interpolation = AnimationChannel::Interpolation::Step;
        else if (sampler.interpolation == "CUBICSPLINE")
            to.interpolation = AnimationChannel::Interpolation::CubicSpline;
        else if (sampler.interpolation != "LINEAR")
            file_.refuse(place, fmt::format("interpolation is '{}'; expected STEP, LINEAR or CUBICSPLINE",
                                            sampler.interpolation));
        to.times = readFloats(sampler.input, {1}, place + " input");
        for (size_t i = 0; i < to.times.size(); ++i)
            if (to.times[i] < 0 || (i > 0 && to.times[i] <= to.times[i - 1]))
                file_.refuse(place,
                             fmt::format("time {} is {} s; expected increasing times from 0 on", i, to.times[i]));

        const size_t components = to.path == AnimationChannel::Path::Rotation ? 4 : 3;
        const std::vector<float> values = readFloats(sampler.output, {components}, place + " output");
        const size_t perTime = to.interpolation == AnimationChannel::Interpolation::CubicSpline ? 3 : 1;
        if (values.size() != components * perTime * to.times.size())
            file_.refuse(place, fmt::format("has {} values for {} times; expected {}", values.size() / components,
                                            to.times.size(), perTime * to.times.size()));
        keyCount_ += values.size() / components;
        if (keyCount_ > mostKeys) file_.refuse(place, "brings too many keys");
        for (size_t i = 0; i < values.size(); i += components)
            to.values.emplace_back(values[i], values[i + 1], values[i + 2], components == 4 ? values[i + 3] : 0.0f);
        into.channels.push_back(std::move(to));
    }

    // Every number was fine, but their products may not be.
    void checkExtent() const {
        Pose pose;
        evaluatePose(scene_, 0, pose);
        for (size_t i = 0; i < pose.worldFromNode.size(); ++i) {
            const float* values = glm::value_ptr(pose.worldFromNode[i]);
            if (!std::all_of(values, values + 16, usable))
                file_.refuse(fmt::format("node '{}'", scene_.nodes[i].name), "lies or stretches beyond all measure");
        }
        const Bounds bounds = worldBounds(scene_, pose);
        for (int axis = 0; !bounds.empty() && axis < 3; ++axis)
            if (!usable(bounds.min[axis]) || !usable(bounds.max[axis]))
                file_.refuse("scene", fmt::format("reaches farther than {} m", largestNumber));
    }

    GltfFile file_;
    tinygltf::Model model_;
    Scene scene_;
    std::vector<TextureCoordinates> coordinates_;        // one per material of the file
    std::map<std::pair<int, int>, int> textures_;        // (image, sampler) to Scene::textures
    std::map<std::array<int, 4>, VertexRange> vertices_; // (position, normal, uv, material if it moves uv)
    std::vector<int> nodes_;                             // node of the file to Scene::nodes
    size_t keyCount_ = 0, textureBytes_ = 0;
};

} // namespace

Scene importGltf(const std::filesystem::path& file) { return Importer(file).run(); }

} // namespace penumbra
