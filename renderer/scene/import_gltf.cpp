// SPDX-License-Identifier: MIT
#include "renderer/core/error.h"
#include "renderer/scene/closed_surface.h"
#include "renderer/scene/gltf_accessors.h"
#include "renderer/scene/gltf_draco.h"
#include "renderer/scene/gltf_file.h"
#include "renderer/scene/part_bounds.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace penumbra {
namespace {

using json = nlohmann::json;

// Extensions that a scene may require: read, or without effect on geometry and light.
constexpr std::string_view readExtensions[] = {"KHR_lights_punctual",
                                               "KHR_texture_transform",
                                               "KHR_mesh_quantization",
                                               "KHR_draco_mesh_compression",
                                               "EXT_meshopt_compression",
                                               "EXT_mesh_gpu_instancing",
                                               "KHR_materials_unlit",
                                               "KHR_materials_variants",
                                               "KHR_materials_pbrSpecularGlossiness",
                                               "EXT_texture_webp"};
constexpr std::string_view harmlessExtensions[] = {"KHR_materials_anisotropy",   "KHR_materials_clearcoat",
                                                   "KHR_materials_dispersion",   "KHR_materials_emissive_strength",
                                                   "KHR_materials_ior",          "KHR_materials_iridescence",
                                                   "KHR_materials_sheen",        "KHR_materials_specular",
                                                   "KHR_materials_transmission", "KHR_materials_volume",
                                                   "KHR_texture_basisu",         "EXT_texture_avif"};

// A few bytes of a file may be used again and again; these keep what comes of it within the memory of a machine.
constexpr size_t mostVertices = size_t{1} << 26, mostIndices = size_t{1} << 28, mostKeys = size_t{1} << 26;
constexpr size_t mostTextureBytes = size_t{1} << 32, mostNotes = 100, mostNodes = size_t{1} << 22;
constexpr size_t mostTargets = 4096, mostJoints = 65536;
constexpr uint64_t mostDrawables = uint64_t{1} << 22, mostCorners = uint64_t{1} << 30; // over all nodes
constexpr size_t mostInfluenceSets = 2;                                                // of four joints each

bool contains(std::span<const std::string_view> list, std::string_view name) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

std::vector<std::string_view> acceptedExtensions() {
    std::vector<std::string_view> names(std::begin(readExtensions), std::end(readExtensions));
    names.insert(names.end(), std::begin(harmlessExtensions), std::end(harmlessExtensions));
    return names;
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
    Importer(GltfFile file, const ImportChoice& choice, Progress* progress)
        : file_(std::move(file))
        , choice_(choice)
        , progress_(progress) {}

    Scene run() {
        scene_.name = file_.path().stem().string();
        scene_.file = file_.path();
        file_.checkBytes();
        parseModel();
        accessors_.checkAll();
        noteExtensions();
        describe();
        chooseScene();
        chooseVariant();
        for (size_t i = 0; i < model_.materials.size(); ++i) {
            report("decoding pictures", 0.1 + 0.4 * double(i) / double(model_.materials.size()));
            addMaterial(i);
        }
        scene_.materials.push_back(
            {.name = "default"}); // of primitives without one; also keeps the list from being empty
        for (size_t i = 0; i < model_.meshes.size(); ++i) {
            report("reading meshes", 0.5 + 0.3 * double(i) / double(model_.meshes.size()));
            addMesh(i);
        }
        addNodes();
        for (size_t i = 0; i < model_.skins.size(); ++i) addSkin(i);
        for (size_t i = 0; i < model_.nodes.size(); ++i) checkSkin(i);
        for (size_t i = 0; i < model_.animations.size(); ++i) addAnimation(i);
        checkAmount();
        checkReach();
        if (scene_.triangleCount() == 0) note("there is nothing in it to draw");
        scene_.checksum = file_.checksum();
        return std::move(scene_);
    }

private:
    struct VertexRange {
        uint32_t first = 0, count = 0;
        uint32_t influenceSets = 0, firstInfluence = 0;
        uint32_t morphTargets = 0, firstDelta = 0;
    };

    void report(const char* doing, double share) {
        if (progress_) progress_->report(doing, share);
    }
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

    // --- members of JSON that tinygltf does not look at, or not always in the same way -------------------------------

    const json& element(const char* collection, size_t index) const { return file_.document()[collection][index]; }
    int integerMember(const json& object, const char* name, int otherwise, const std::string& place) const {
        if (!object.contains(name)) return otherwise;
        constexpr size_t largest = std::numeric_limits<int>::max();
        return int(std::min(file_.unsignedMember(object, name, 0, place), largest));
    }
    // `into` keeps what it has where there is no such member.
    template <int N>
    void numbersMember(const json& object, const char* name, glm::vec<N, float>& into, const std::string& place) const {
        const auto found = object.find(name);
        if (found == object.end()) return;
        if (!found->is_array() || found->size() != size_t(N))
            file_.refuse(place, fmt::format("{} is not an array of {} numbers", name, N));
        for (int i = 0; i < N; ++i) into[i] = numberOf((*found)[size_t(i)], name, place);
    }
    float numberOf(const json& value, const char* name, const std::string& place) const {
        const float number = value.is_number() ? value.get<float>() : std::numeric_limits<float>::quiet_NaN();
        if (!usableNumber(number)) file_.refuse(place, fmt::format("{} is {}; expected a number", name, value.dump()));
        return number;
    }
    // "node 3 'wheel'": what messages call an element.
    static std::string placeOf(const char* what, size_t index, const std::string& name) {
        return name.empty() ? fmt::format("{} {}", what, index) : fmt::format("{} {} '{}'", what, index, name);
    }
    std::string nameOr(const json& object, const std::string& otherwise) const {
        const auto found = object.find("name");
        return found != object.end() && found->is_string() ? oneLine(found->get<std::string>()) : otherwise;
    }

    // Buffers and images are left out of what tinygltf sees: their bytes are read and checked by GltfFile. So are the
    // indices of primitives, for which it wants a bufferView that Draco's need not have.
    void parseModel() {
        json document, none = json::array();
        for (const auto& [key, value] : file_.document().items())
            if (key != "buffers" && key != "images") document[key] = value;
        for (json& mesh : document.contains("meshes") ? document["meshes"] : none)
            for (json& primitive : mesh.contains("primitives") ? mesh["primitives"] : none)
                if (primitive.is_object()) primitive.erase("indices");
        if (const std::string error = parsed(document, model_); !error.empty()) refuseElement(document, error);
        // A mistyped element may have been left out, which would shift what the others refer to.
        const auto complete = [&](const char* name, size_t count) {
            const auto found = document.find(name);
            if (count != (found == document.end() ? 0 : found->size()))
                file_.refuse(name, "has elements that are not understood");
        };
        complete("accessors", model_.accessors.size());
        complete("animations", model_.animations.size());
        complete("bufferViews", model_.bufferViews.size());
        complete("materials", model_.materials.size());
        complete("meshes", model_.meshes.size());
        complete("nodes", model_.nodes.size());
        complete("samplers", model_.samplers.size());
        complete("scenes", model_.scenes.size());
        complete("skins", model_.skins.size());
        complete("textures", model_.textures.size());
    }

    // The reason if tinygltf cannot read it.
    static std::string parsed(const json& document, tinygltf::Model& model) {
        const std::string text = document.dump();
        std::string error, warning;
        bool read = false;
        try {
            tinygltf::TinyGLTF loader;
            read = text.size() <= std::numeric_limits<unsigned>::max() &&
                   loader.LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "");
        } catch (const std::exception& exception) {
            error = exception.what();
        }
        return read ? std::string() : error.empty() ? "expected glTF 2.0" : error;
    }

    // tinygltf says what is wrong but seldom where: the place is the first element that it does not take alone.
    [[noreturn]] void refuseElement(const json& document, const std::string& reason) const {
        for (const auto& [collection, elements] : document.items())
            if (elements.is_array())
                for (size_t i = 0; i < elements.size(); ++i) {
                    tinygltf::Model alone;
                    const json one{{"asset", {{"version", "2.0"}}}, {collection, json::array({elements[i]})}};
                    if (const std::string error = parsed(one, alone); !error.empty())
                        file_.refuse(fmt::format("{}[{}]", collection, i), error);
                }
        file_.refuse("JSON", reason);
    }

    void noteExtensions() {
        for (const std::string& name : model_.extensionsUsed)
            if (!contains(readExtensions, name)) note(fmt::format("extension {} is not read", name));
    }

    // --- what is taken of the file -----------------------------------------------------------------------------------

    int chosenOf(const std::vector<std::string>& names, const std::string& wanted, const char* what) const {
        const auto found = std::find(names.begin(), names.end(), wanted);
        if (found != names.end()) return int(found - names.begin());
        const std::vector<std::string_view> views(names.begin(), names.end());
        file_.refuse(fmt::format("{} '{}'", what, wanted),
                     names.empty()
                         ? "the file has none"
                         : fmt::format("is not one of {}{}", fmt::join(names, ", "), suggestion(wanted, views)));
    }

    void describe() {
        const json& asset = file_.document()["asset"];
        const json extras = asset.value("extras", json());
        const json description = extras.is_object() ? extras.value("description", json()) : json();
        if (description.is_string()) scene_.description = oneLine(description.get<std::string>());
    }

    void chooseScene() {
        for (size_t i = 0; i < model_.scenes.size(); ++i)
            scene_.sceneNames.push_back(nameOr(element("scenes", i), fmt::format("scene {}", i)));
        if (!choice_.scene.empty())
            scene_.chosenScene = chosenOf(scene_.sceneNames, choice_.scene, "scene");
        else if (model_.defaultScene >= 0)
            at(model_.scenes, scene_.chosenScene = model_.defaultScene, "scene", "scene");
    }

    // KHR_materials_variants.
    void chooseVariant() {
        if (const json* extension = findExtension(file_.document(), "KHR_materials_variants")) {
            const json variants = extension->value("variants", json::array());
            if (!variants.is_array()) file_.refuse("KHR_materials_variants", "expected an array of variants");
            for (size_t i = 0; i < variants.size(); ++i)
                scene_.variantNames.push_back(variants[i].is_object()
                                                  ? nameOr(variants[i], fmt::format("variant {}", i))
                                                  : fmt::format("variant {}", i));
        }
        if (!choice_.variant.empty()) scene_.chosenVariant = chosenOf(scene_.variantNames, choice_.variant, "variant");
    }

    // --- materials ---------------------------------------------------------------------------------------------------

    void addMaterial(size_t index) {
        const tinygltf::Material& from = model_.materials[index];
        const std::string place = placeOf("material", index, from.name);
        const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
        Material to;
        to.name = from.name;
        for (size_t c = 0; c < std::min<size_t>(4, pbr.baseColorFactor.size()); ++c)
            to.baseColour[int(c)] = unitNumber(pbr.baseColorFactor[c], "baseColorFactor", place);
        for (size_t c = 0; c < std::min<size_t>(3, from.emissiveFactor.size()); ++c)
            to.emissive[int(c)] = unitNumber(from.emissiveFactor[c], "emissiveFactor", place);
        if (from.emissiveTexture.index >= 0) {
            to.emissive = glm::vec3(0); // the factor without its texture would make all of it shine
            note("emissive textures are not read");
        }
        to.doubleSided = from.doubleSided;
        const json& description = element("materials", index);
        to.unlit = findExtension(description, "KHR_materials_unlit") != nullptr;
        if (from.alphaMode == "MASK") {
            to.masked = true;
            to.alphaCutoff = float(from.alphaCutoff);
            if (!usableNumber(to.alphaCutoff)) file_.refuse(place, "alphaCutoff is not a number");
        } else if (from.alphaMode == "BLEND") {
            to.masked = true;
            note(place + " is blended; it is drawn cut out at half of its alpha");
        } else if (from.alphaMode != "OPAQUE") {
            file_.refuse(place, fmt::format("alphaMode is '{}'; expected OPAQUE, MASK or BLEND", from.alphaMode));
        }
        TextureCoordinates coordinates;
        const json* info = memberObject(description, "pbrMetallicRoughness");
        if (info) info = memberObject(*info, "baseColorTexture");
        // What older exporters write instead.
        if (const json* glossiness = findExtension(description, "KHR_materials_pbrSpecularGlossiness")) {
            numbersMember(*glossiness, "diffuseFactor", to.baseColour, place);
            if (const json* diffuse = memberObject(*glossiness, "diffuseTexture")) info = diffuse;
        }
        if (info) {
            to.texture = addTexture(integerMember(*info, "index", -1, place), place);
            coordinates = coordinatesOf(*info, place);
        }
        coordinates_.push_back(coordinates);
        scene_.materials.push_back(std::move(to));
    }

    static const json* memberObject(const json& object, const char* name) {
        const auto found = object.find(name);
        return found != object.end() && found->is_object() ? &*found : nullptr;
    }

    float unitNumber(double value, const char* name, const std::string& place) const {
        if (!(value >= 0 && value <= 1)) file_.refuse(place, fmt::format("{} is {}; expected 0..1", name, value));
        return float(value);
    }

    TextureCoordinates coordinatesOf(const json& info, const std::string& place) const {
        TextureCoordinates result{.set = integerMember(info, "texCoord", 0, place), .transform = {}};
        const json* transform = findExtension(info, "KHR_texture_transform");
        if (!transform) return result;
        numbersMember(*transform, "offset", result.transform.offset, place);
        numbersMember(*transform, "scale", result.transform.scale, place);
        if (const auto rotation = transform->find("rotation"); rotation != transform->end())
            result.transform.rotation = numberOf(*rotation, "rotation", place);
        result.set = integerMember(*transform, "texCoord", result.set, place);
        return result;
    }

    int addTexture(int index, const std::string& user) {
        const tinygltf::Texture& texture = at(model_.textures, index, "texture", user);
        const std::string place = fmt::format("texture {}", index);
        int source = texture.source;
        if (const json* webp = findExtension(element("textures", size_t(index)), "EXT_texture_webp"))
            source = integerMember(*webp, "source", source, place);
        const auto neutral = [&] {
            note(fmt::format("{} has no picture in a format that is read; a neutral one stands in", place));
            return -1;
        };
        if (source < 0) return neutral();
        const auto known = textures_.find({source, texture.sampler});
        if (known != textures_.end()) return known->second;
        const auto sibling = textures_.lower_bound({source, -1}); // the same picture with another sampler
        std::optional<TextureImage> image;
        if (sibling == textures_.end() || sibling->first.first != source)
            image = file_.image(size_t(source));
        else if (sibling->second >= 0)
            image = scene_.textures[size_t(sibling->second)];
        if (!image) return textures_[{source, texture.sampler}] = neutral();
        textureBytes_ += image->rgba.size();
        if (textureBytes_ > mostTextureBytes) file_.refuse(user, "brings the pictures to more than 4 GiB");
        const tinygltf::Sampler sampler =
            texture.sampler >= 0 ? at(model_.samplers, texture.sampler, "sampler", user) : tinygltf::Sampler();
        image->wrapU = wrapOf(sampler.wrapS);
        image->wrapV = wrapOf(sampler.wrapT);
        image->magnifyNearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
        scene_.textures.push_back(std::move(*image));
        return textures_[{source, texture.sampler}] = int(scene_.textures.size()) - 1;
    }

    static Wrap wrapOf(int mode) {
        if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::ClampToEdge;
        return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::MirroredRepeat : Wrap::Repeat;
    }

    // --- meshes ------------------------------------------------------------------------------------------------------

    // A primitive as the file describes it, and what it is called in messages.
    struct Source {
        const tinygltf::Primitive& primitive;
        const json& description;
        std::string place;
        std::optional<DracoMesh> draco = {};
        std::map<std::string, int> dracoAttributes = {}; // unique ids by semantic
        int material = -1;

        bool has(const std::string& name) const { return primitive.attributes.contains(name); }
    };

    void addMesh(size_t index) {
        const tinygltf::Mesh& from = model_.meshes[index];
        Mesh& to = scene_.meshes.emplace_back();
        const std::string place = placeOf("mesh", index, from.name);
        to.name = from.name;
        for (size_t i = 0; i < from.primitives.size(); ++i)
            addPrimitive(Source{from.primitives[i], element("meshes", index)["primitives"][i],
                                fmt::format("{} primitive {}", place, i)},
                         to);
        for (const Primitive& primitive : to.primitives)
            if (primitive.morphTargets != to.primitives[0].morphTargets)
                file_.refuse(place, "has primitives with different numbers of morph targets");
    }

    void addPrimitive(Source from, Mesh& mesh) {
        const std::string& place = from.place;
        const int mode = from.primitive.mode;
        if (mode < TINYGLTF_MODE_POINTS || mode > TINYGLTF_MODE_TRIANGLE_FAN)
            file_.refuse(place, fmt::format("has mode {}; expected 0..6", mode));
        if (mode < TINYGLTF_MODE_TRIANGLES) return note(place + ": points and lines are not drawn");
        if (!from.has("POSITION")) return note(place + ": has no positions and is not drawn");
        from.material = materialOf(from);
        if (from.material >= 0) at(model_.materials, from.material, "material", place);
        openDraco(from);

        Primitive to;
        to.material = from.material >= 0 ? from.material : int(model_.materials.size());
        const VertexRange range = addVertices(from);
        std::vector<uint32_t> indices;
        if (from.draco) {
            indices = from.draco->indices(place);
        } else if (const int accessor = integerMember(from.description, "indices", -1, place); accessor >= 0) {
            indices = accessors_.indices(accessor, range.count, place);
        } else {
            indices.resize(range.count);
            std::iota(indices.begin(), indices.end(), 0u);
        }
        indices = triangleList(std::move(indices), mode);
        if (indices.empty()) return note(place + ": has no whole triangle and is not drawn");
        to.firstVertex = range.first;
        to.vertexCount = range.count;
        to.influenceSets = range.influenceSets;
        to.firstInfluence = range.firstInfluence;
        to.morphTargets = range.morphTargets;
        to.firstDelta = range.firstDelta;
        to.firstIndex = uint32_t(scene_.indices.size());
        to.indexCount = uint32_t(indices.size());
        if (indices.size() > mostIndices - scene_.indices.size()) file_.refuse(place, "brings too many indices");
        scene_.indices.insert(scene_.indices.end(), indices.begin(), indices.end());
        measure(to);
        mesh.primitives.push_back(std::move(to));
    }

    int materialOf(const Source& from) const {
        const json* variants =
            scene_.chosenVariant < 0 ? nullptr : findExtension(from.description, "KHR_materials_variants");
        const auto mappings = variants ? variants->find("mappings") : json::const_iterator();
        if (variants && mappings != variants->end() && mappings->is_array())
            for (const json& mapping : *mappings) {
                const json list = mapping.is_object() ? mapping.value("variants", json()) : json();
                if (list.is_array() && std::find(list.begin(), list.end(), json(scene_.chosenVariant)) != list.end())
                    return integerMember(mapping, "material", -1, from.place);
            }
        return from.primitive.material;
    }

    void openDraco(Source& from) {
        const json* extension = findExtension(from.description, "KHR_draco_mesh_compression");
        if (!extension) return;
        const std::string place = from.place + " Draco";
        const int view = integerMember(*extension, "bufferView", -1, place);
        if (view < 0) file_.refuse(place, "has no bufferView");
        if (const json* attributes = memberObject(*extension, "attributes"))
            for (const auto& [name, id] : attributes->items())
                from.dracoAttributes[name] = integerMember(*attributes, name.c_str(), 0, place);
        if (!from.dracoAttributes.contains("POSITION")) file_.refuse(place, "has no POSITION");
        from.draco.emplace(file_, file_.bufferView(size_t(view), place), place);
        if (from.primitive.mode != TINYGLTF_MODE_TRIANGLES)
            note(from.place + ": Draco's triangles stand in for its strip");
    }

    static std::vector<uint32_t> triangleList(std::vector<uint32_t> indices, int mode) {
        const size_t n = indices.size();
        if (mode == TINYGLTF_MODE_TRIANGLES) {
            indices.resize(n - n % 3);
            return indices;
        }
        std::vector<uint32_t> list;
        if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) { // every other triangle is turned to keep the winding
            for (size_t i = 2; i < n; ++i)
                list.insert(list.end(), {indices[i - 2], indices[i - 1 + i % 2], indices[i - i % 2]});
        } else {
            for (size_t i = 2; i < n; ++i) list.insert(list.end(), {indices[0], indices[i - 1], indices[i]});
        }
        return list;
    }

    // The values of an attribute of `count` vertices (0: any), decompressed where they are compressed.
    std::vector<float> attribute(const Source& from, const std::string& name, std::initializer_list<size_t> components,
                                 size_t count) {
        const std::string place = from.place + " " + name;
        const int accessor = from.primitive.attributes.at(name);
        std::vector<float> values;
        size_t width = *components.begin();
        if (const auto id = from.dracoAttributes.find(name); id != from.dracoAttributes.end()) {
            const bool normalised = at(model_.accessors, accessor, "accessor", place).normalized;
            width = from.draco->components(uint32_t(id->second), place);
            if (std::find(components.begin(), components.end(), width) == components.end())
                file_.refuse(place, fmt::format("has {} components; expected {}", width, *components.begin()));
            values = from.draco->floats(uint32_t(id->second), normalised, place);
            if (!std::all_of(values.begin(), values.end(), usableNumber))
                file_.refuse(place, "has a value that is not a usable number");
        } else {
            const size_t stated = accessors_.count(accessor, place);
            values = accessors_.floats(accessor, components, place);
            width = stated > 0 ? values.size() / stated : width;
        }
        if (count > 0 && values.size() != count * width)
            file_.refuse(from.place, fmt::format("has attributes of different counts: {} {} and {} positions",
                                                 values.size() / width, name, count));
        return values;
    }

    // The accessor of the texture coordinates that the material looks at.
    std::optional<std::string> uvAttribute(const Source& from) const {
        if (from.material < 0 || coordinates_[size_t(from.material)].set < 0) return std::nullopt;
        std::string name = fmt::format("TEXCOORD_{}", coordinates_[size_t(from.material)].set);
        return from.has(name) ? std::optional(std::move(name)) : std::nullopt;
    }

    // Primitives with the same attributes share their vertices.
    VertexRange addVertices(const Source& from) {
        const std::optional<std::string> uv = uvAttribute(from);
        const auto accessorOf = [&](const std::string& name) {
            const auto found = from.primitive.attributes.find(name);
            return found == from.primitive.attributes.end() ? -1 : found->second;
        };
        const bool moved = uv && coordinates_[size_t(from.material)].transform != TextureTransform{};
        std::vector<int> key{uv ? accessorOf(*uv) : -1, moved ? from.material : -1};
        for (const char* name : {"POSITION", "NORMAL", "COLOR_0", "JOINTS_0", "WEIGHTS_0", "JOINTS_1", "WEIGHTS_1"})
            key.push_back(accessorOf(name));
        for (const auto& target : from.primitive.targets)
            for (const char* name : {"POSITION", "NORMAL"}) key.push_back(target.contains(name) ? target.at(name) : -1);
        if (!from.draco)
            if (const auto known = vertices_.find(key); known != vertices_.end()) return known->second;

        std::vector<float> values = attribute(from, "POSITION", {3}, 0);
        VertexRange range{.first = uint32_t(scene_.positions.size()), .count = uint32_t(values.size() / 3)};
        const size_t count = values.size() / 3;
        if (count > mostVertices - scene_.positions.size()) file_.refuse(from.place, "brings too many vertices");
        scene_.positions.resize(range.first + count); // not one by one: a vector that grows by itself doubles
        for (size_t i = 0; i < count; ++i) scene_.positions[range.first + i] = glm::make_vec3(&values[3 * i]);
        values = {};
        addNormals(from, count);
        addTextureCoordinates(from, uv, count);
        addColours(from, range);
        addInfluences(from, range);
        addMorphTargets(from, range);
        if (!from.draco) vertices_[std::move(key)] = range;
        return range;
    }

    // Unit vectors; zero where the file has none, which means flat.
    void addNormals(const Source& from, size_t count) {
        const size_t first = scene_.normals.size();
        scene_.normals.resize(first + count, glm::vec3(0));
        if (!from.has("NORMAL")) return;
        const std::vector<float> values = attribute(from, "NORMAL", {3}, count);
        for (size_t i = 0; i < count; ++i) {
            const glm::vec3 normal = glm::make_vec3(&values[3 * i]);
            const float length = glm::length(normal);
            if (length > 1e-12f && std::isfinite(length)) scene_.normals[first + i] = normal / length;
        }
    }

    void addTextureCoordinates(const Source& from, const std::optional<std::string>& uv, size_t count) {
        const size_t first = scene_.uvs.size();
        scene_.uvs.resize(first + count, glm::vec2(0));
        if (!uv) return;
        const std::vector<float> values = attribute(from, *uv, {2}, count);
        const TextureTransform& transform = coordinates_[size_t(from.material)].transform;
        for (size_t i = 0; i < count; ++i) scene_.uvs[first + i] = transform(glm::make_vec2(&values[2 * i]));
    }

    void addColours(const Source& from, const VertexRange& range) {
        constexpr glm::u16vec4 white(65535);
        if (from.has("COLOR_0")) {
            const std::vector<float> values = attribute(from, "COLOR_0", {4, 3}, range.count);
            const size_t width = values.size() / range.count;
            scene_.colours.resize(range.first, white);
            for (size_t i = 0; i < range.count; ++i) {
                const float* c = &values[width * i];
                const glm::vec4 colour(c[0], c[1], c[2], width == 4 ? c[3] : 1.0f);
                scene_.colours.emplace_back(glm::clamp(colour, 0.0f, 1.0f) * 65535.0f + 0.5f);
            }
        } else if (!scene_.colours.empty()) {
            scene_.colours.resize(range.first + range.count, white);
        }
    }

    void addInfluences(const Source& from, VertexRange& range) {
        uint32_t sets = 0;
        while (from.has(fmt::format("JOINTS_{}", sets)) && from.has(fmt::format("WEIGHTS_{}", sets))) ++sets;
        if (sets > mostInfluenceSets) note(from.place + ": more than eight joints a vertex; the first eight are read");
        sets = std::min<uint32_t>(sets, mostInfluenceSets);
        range.influenceSets = sets;
        range.firstInfluence = uint32_t(scene_.influences.size());
        scene_.influences.resize(scene_.influences.size() + size_t(sets) * range.count);
        for (uint32_t set = 0; set < sets; ++set) {
            const std::vector<float> joints = attribute(from, fmt::format("JOINTS_{}", set), {4}, range.count);
            const std::vector<float> weights = attribute(from, fmt::format("WEIGHTS_{}", set), {4}, range.count);
            for (size_t v = 0; v < range.count; ++v) {
                Influences& to = scene_.influences[range.firstInfluence + size_t(set) * range.count + v];
                for (int k = 0; k < 4; ++k) {
                    const float joint = joints[4 * v + size_t(k)];
                    to.weights[k] = std::max(weights[4 * v + size_t(k)], 0.0f);
                    if (!(joint >= 0 && joint < float(mostJoints)))
                        file_.refuse(from.place, fmt::format("vertex {} has joint {}", v, joint));
                    to.joints[k] = to.weights[k] > 0 ? uint16_t(joint) : uint16_t(0);
                }
            }
        }
        normaliseWeights(from, range);
    }

    void normaliseWeights(const Source& from, const VertexRange& range) {
        bool any = false;
        for (size_t v = 0; v < range.count && range.influenceSets > 0; ++v) {
            const auto set = [&](uint32_t s) -> Influences& {
                return scene_.influences[range.firstInfluence + size_t(s) * range.count + v];
            };
            float sum = 0;
            for (uint32_t s = 0; s < range.influenceSets; ++s)
                for (int k = 0; k < 4; ++k) sum += set(s).weights[k];
            if (sum > 0)
                for (uint32_t s = 0; s < range.influenceSets; ++s) set(s).weights /= sum;
            else
                set(0).weights.x = 1;
            any = any || !(sum > 0);
        }
        if (any) note(from.place + ": vertices without weights follow the first joint");
    }

    void addMorphTargets(const Source& from, VertexRange& range) {
        const auto& targets = from.primitive.targets;
        if (targets.size() > mostTargets || targets.size() * range.count > mostVertices - scene_.morphDeltas.size())
            file_.refuse(from.place, "brings too many morph targets");
        range.morphTargets = uint32_t(targets.size());
        range.firstDelta = uint32_t(scene_.morphDeltas.size());
        scene_.morphDeltas.resize(scene_.morphDeltas.size() + targets.size() * range.count);
        for (size_t t = 0; t < targets.size(); ++t) {
            const auto read = [&](const char* name, glm::vec3 MorphDelta::*member) {
                const auto found = targets[t].find(name);
                if (found == targets[t].end()) return;
                const std::string place = fmt::format("{} target {} {}", from.place, t, name);
                const std::vector<float> values = accessors_.floats(found->second, {3}, place);
                if (values.size() != size_t(3) * range.count)
                    file_.refuse(place, fmt::format("has {} values for {} vertices", values.size() / 3, range.count));
                for (size_t v = 0; v < range.count; ++v)
                    scene_.morphDeltas[range.firstDelta + t * range.count + v].*member = glm::make_vec3(&values[3 * v]);
            };
            read("POSITION", &MorphDelta::position);
            if (from.has("NORMAL")) read("NORMAL", &MorphDelta::normal); // what is flat stays flat
        }
    }

    // The boxes of a primitive: of its triangles at rest, of what each joint pulls on, of how far each target moves.
    void measure(Primitive& primitive) {
        std::map<uint32_t, Bounds> byJoint;
        std::vector<bool> seen(primitive.vertexCount);
        primitive.morphBounds.resize(primitive.morphTargets);
        for (uint32_t i = 0; i < primitive.indexCount; ++i) {
            const uint32_t v = scene_.indices[primitive.firstIndex + i];
            if (seen[v]) continue;
            seen[v] = true;
            const glm::vec3 p = scene_.positions[primitive.firstVertex + v];
            primitive.bounds.add(p);
            for (uint32_t t = 0; t < primitive.morphTargets; ++t)
                primitive.morphBounds[t].add(
                    scene_.morphDeltas[primitive.firstDelta + size_t(t) * primitive.vertexCount + v].position);
            for (uint32_t s = 0; s < primitive.influenceSets; ++s) {
                const Influences& pull =
                    scene_.influences[primitive.firstInfluence + size_t(s) * primitive.vertexCount + v];
                for (int k = 0; k < 4; ++k)
                    if (pull.weights[k] > 0) byJoint[pull.joints[k]].add(p);
            }
        }
        for (const auto& [joint, bounds] : byJoint) primitive.jointBounds.push_back({joint, bounds});
    }

    // --- nodes -------------------------------------------------------------------------------------------------------

    std::string nodePlace(size_t index) const { return placeOf("node", index, model_.nodes[index].name); }

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
        for (size_t i = 0; i < count; ++i) {
            if (visible[i]) addCameraAndLight(i);
            addInstances(i);
        }
    }

    // EXT_mesh_gpu_instancing: the node's mesh at several places below it, each a node of its own.
    void addInstances(size_t index) {
        const json* extension = findExtension(element("nodes", index), "EXT_mesh_gpu_instancing");
        const json* attributes = extension ? memberObject(*extension, "attributes") : nullptr;
        if (!attributes || scene_.nodes[size_t(nodes_[index])].mesh < 0) return;
        const std::string place = nodePlace(index) + " instances";
        size_t count = 0;
        const auto read = [&](const char* name, size_t components) {
            const int accessor = integerMember(*attributes, name, -1, place);
            if (accessor < 0) return std::vector<float>();
            std::vector<float> values = accessors_.floats(accessor, {components}, place);
            if (count > 0 && values.size() / components != count)
                file_.refuse(place, "have attributes of different counts");
            count = values.size() / components;
            return values;
        };
        const std::vector<float> translations = read("TRANSLATION", 3), rotations = read("ROTATION", 4),
                                 scales = read("SCALE", 3);
        if (count > mostNodes - std::min(mostNodes, scene_.nodes.size())) file_.refuse(place, "are too many");
        const int parent = nodes_[index];
        Node instance;
        instance.parent = parent;
        instance.visible = scene_.nodes[size_t(parent)].visible;
        instance.mesh =
            std::exchange(scene_.nodes[size_t(parent)].mesh, count > 0 ? -1 : scene_.nodes[size_t(parent)].mesh);
        if (std::exchange(scene_.nodes[size_t(parent)].skin, -1) >= 0) note(place + ": instances are not skinned");
        for (size_t i = 0; i < count; ++i) {
            if (!translations.empty()) instance.translation = glm::make_vec3(&translations[3 * i]);
            if (!scales.empty()) instance.scale = glm::make_vec3(&scales[3 * i]);
            if (!rotations.empty()) instance.rotation = unitQuaternion(&rotations[4 * i], place);
            instance.firstWeight = scene_.nodes[size_t(parent)].firstWeight;
            scene_.nodes.push_back(instance);
        }
    }

    glm::quat unitQuaternion(const float* xyzw, const std::string& place) const {
        const glm::quat rotation(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
        if (!(glm::length(rotation) > 1e-6f)) file_.refuse(place, "rotation has no length; expected a unit quaternion");
        return glm::normalize(rotation);
    }

    // Those below the chosen scene, or all if there are no scenes.
    std::vector<bool> visibleNodes() const {
        std::vector<bool> visible(model_.nodes.size(), model_.scenes.empty());
        if (model_.scenes.empty()) return visible;
        const tinygltf::Scene& chosen = at(model_.scenes, scene_.chosenScene, "scene", "scene");
        std::vector<int> open(chosen.nodes);
        while (!open.empty()) {
            const int node = open.back();
            open.pop_back();
            at(model_.nodes, node, "node", placeOf("scene", size_t(scene_.chosenScene), chosen.name));
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
                if (!usableNumber(values[i])) file_.refuse(place, fmt::format("{} has a value of {}", name, list[i]));
            }
            return values;
        };
        Node to;
        to.name = from.name;
        if (!from.matrix.empty()) {
            const json& description = element("nodes", index); // tinygltf leaves out the rest
            if (description.contains("translation") || description.contains("rotation") ||
                description.contains("scale"))
                note(place + ": has a matrix besides translation, rotation or scale; the matrix is taken");
            const std::array<float, 16> values = numbers(from.matrix, 16, "matrix");
            to.matrix = glm::make_mat4(values.data());
            if (glm::row(*to.matrix, 3) != glm::vec4(0, 0, 0, 1))
                file_.refuse(place, "matrix is not affine; expected 0, 0, 0, 1 as its last row");
        }
        if (!from.translation.empty())
            to.translation = glm::make_vec3(numbers(from.translation, 3, "translation").data());
        if (!from.scale.empty()) to.scale = glm::make_vec3(numbers(from.scale, 3, "scale").data());
        if (!from.rotation.empty()) to.rotation = unitQuaternion(numbers(from.rotation, 4, "rotation").data(), place);
        if (from.mesh >= 0) {
            const Mesh& mesh = at(scene_.meshes, from.mesh, "mesh", place);
            to.mesh = from.mesh;
            to.firstWeight = uint32_t(scene_.restWeights.size());
            addRestWeights(mesh, from, place);
        }
        if (from.skin >= 0 && from.mesh >= 0) {
            at(model_.skins, from.skin, "skin", place);
            to.skin = from.skin;
        }
        return to;
    }

    static uint32_t targetsOf(const Mesh& mesh) {
        return mesh.primitives.empty() ? 0 : mesh.primitives[0].morphTargets;
    }

    // The node's own weights, or the mesh's, or none of any target.
    void addRestWeights(const Mesh& mesh, const tinygltf::Node& from, const std::string& place) {
        const std::vector<double>& weights =
            from.weights.empty() ? model_.meshes[size_t(from.mesh)].weights : from.weights;
        for (uint32_t t = 0; t < targetsOf(mesh); ++t) {
            scene_.restWeights.push_back(t < weights.size() ? float(weights[t]) : 0.0f);
            if (!usableNumber(scene_.restWeights.back()))
                file_.refuse(place, "has a weight that is not a usable number");
        }
    }

    // --- skins -------------------------------------------------------------------------------------------------------

    void addSkin(size_t index) {
        const tinygltf::Skin& from = model_.skins[index];
        const std::string place = placeOf("skin", index, from.name);
        Skin to;
        to.name = from.name;
        to.firstMatrix =
            scene_.skins.empty() ? 0 : scene_.skins.back().firstMatrix + uint32_t(scene_.skins.back().joints.size());
        if (from.joints.empty() || from.joints.size() > mostJoints)
            file_.refuse(place, fmt::format("has {} joints; expected 1..{}", from.joints.size(), mostJoints));
        for (const int joint : from.joints) {
            at(model_.nodes, joint, "node", place);
            to.joints.push_back(nodes_[size_t(joint)]);
        }
        to.jointFromMesh.resize(to.joints.size(), glm::mat4(1));
        if (from.inverseBindMatrices >= 0) {
            const std::vector<float> values = accessors_.floats(from.inverseBindMatrices, {16}, place);
            if (values.size() < 16 * to.joints.size())
                file_.refuse(place, fmt::format("has {} inverse bind matrices for {} joints", values.size() / 16,
                                                to.joints.size()));
            for (size_t i = 0; i < to.joints.size(); ++i) {
                to.jointFromMesh[i] = glm::make_mat4(&values[16 * i]);
                for (int column = 0; column < 4; ++column) to.jointFromMesh[i][column].w = column == 3 ? 1.0f : 0.0f;
            }
        }
        scene_.skins.push_back(std::move(to));
    }

    void checkSkin(size_t index) const {
        const Node& node = scene_.nodes[size_t(nodes_[index])];
        if (node.skin < 0) return;
        for (const Primitive& primitive : scene_.meshes[size_t(node.mesh)].primitives)
            for (const Primitive::JointBounds& pulled : primitive.jointBounds)
                if (pulled.joint >= scene_.skins[size_t(node.skin)].joints.size())
                    file_.refuse(nodePlace(index),
                                 fmt::format("has a mesh with joint {} and a skin of {} joints", pulled.joint,
                                             scene_.skins[size_t(node.skin)].joints.size()));
    }

    void addCameraAndLight(size_t index) {
        const tinygltf::Node& node = model_.nodes[index];
        const std::string place = nodePlace(index);
        if (node.camera >= 0) addCamera(at(model_.cameras, node.camera, "camera", place), index);
        // Asked of the JSON, since versions of tinygltf differ in where they keep it.
        if (const json* reference = findExtension(element("nodes", index), "KHR_lights_punctual"))
            addLight(at(model_.lights, integerMember(*reference, "light", -1, place), "light", place), index);
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
            if (!(to.halfHeight > 0 && usableNumber(to.halfHeight)))
                file_.refuse(place, fmt::format("camera has a ymag of {}; expected metres", from.orthographic.ymag));
            note(place + ": its orthographic camera becomes a perspective one that frames the same");
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
        if (!(size.x > 0 && size.y > 0 && usableNumber(size.x) && usableNumber(size.y)))
            file_.refuse(place, "light has an extra 'size' that is not one or two positive numbers");
        return size;
    }

    // --- animations --------------------------------------------------------------------------------------------------

    void addAnimation(size_t index) {
        const tinygltf::Animation& from = model_.animations[index];
        Animation to;
        to.name = from.name.empty() ? fmt::format("animation {}", index) : oneLine(from.name);
        for (size_t i = 0; i < from.channels.size(); ++i)
            addChannel(from, from.channels[i], to,
                       fmt::format("{} channel {}", placeOf("animation", index, from.name), i));
        std::stable_sort(to.channels.begin(), to.channels.end(),
                         [](const auto& a, const auto& b) { return a.node < b.node; });
        for (const AnimationChannel& channel : to.channels) to.duration = std::max(to.duration, channel.times.back());
        if (!to.channels.empty()) scene_.animations.push_back(std::move(to));
    }

    void addChannel(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& from, Animation& into,
                    const std::string& place) {
        using Path = AnimationChannel::Path;
        if (from.target_node < 0) return note(place + ": moves no node");
        at(model_.nodes, from.target_node, "node", place);
        AnimationChannel to;
        to.node = nodes_[size_t(from.target_node)];
        const Node& node = scene_.nodes[size_t(to.node)];
        if (from.target_path == "translation") {
            to.path = Path::Translation;
        } else if (from.target_path == "rotation") {
            to.path = Path::Rotation;
            to.width = 4;
        } else if (from.target_path == "scale") {
            to.path = Path::Scale;
        } else if (from.target_path == "weights") {
            to.path = Path::Weights;
            to.width = node.mesh < 0 ? 0 : targetsOf(scene_.meshes[size_t(node.mesh)]);
            if (to.width == 0) return note(place + ": weighs morph targets that are not there");
        } else {
            return note(fmt::format("animation of '{}' is not read", from.target_path));
        }
        if (to.path != Path::Weights && node.matrix) return note(place + ": moves a node that is given as a matrix");

        const tinygltf::AnimationSampler& sampler = at(animation.samplers, from.sampler, "sampler", place);
        if (sampler.interpolation == "STEP")
            to.interpolation = AnimationChannel::Interpolation::Step;
        else if (sampler.interpolation == "CUBICSPLINE")
            to.interpolation = AnimationChannel::Interpolation::CubicSpline;
        else if (sampler.interpolation != "LINEAR")
            file_.refuse(place, fmt::format("interpolation is '{}'; expected STEP, LINEAR or CUBICSPLINE",
                                            sampler.interpolation));
        const std::vector<float> times = accessors_.floats(sampler.input, {1}, place + " input");
        const size_t components = to.path == Path::Weights ? 1 : to.width;
        const std::vector<float> values = accessors_.floats(sampler.output, {components}, place + " output");
        const size_t perTime =
            to.width * (to.interpolation == AnimationChannel::Interpolation::CubicSpline ? size_t(3) : size_t(1));
        if (values.size() != perTime * times.size())
            file_.refuse(place, fmt::format("has {} numbers for {} times; expected {}", values.size(), times.size(),
                                            perTime * times.size()));
        keyCount_ += values.size();
        if (keyCount_ > mostKeys) file_.refuse(place, "brings too many keys");
        // Exporters repeat times, and stored rounding makes some run back: such keys are never reached.
        for (size_t i = 0; i < times.size(); ++i) {
            if (times[i] < 0 || (!to.times.empty() && times[i] <= to.times.back())) {
                note(fmt::format("animation '{}' has keys whose time does not increase from 0 on; they are left out",
                                 into.name));
                continue;
            }
            to.times.push_back(times[i]);
            to.values.insert(to.values.end(), values.begin() + std::ptrdiff_t(perTime * i),
                             values.begin() + std::ptrdiff_t(perTime * (i + 1)));
        }
        if (!to.times.empty()) into.channels.push_back(std::move(to));
    }

    // Many nodes may each draw a mesh of many primitives, or of many that share a long list of vertices.
    void checkAmount() const {
        uint64_t drawables = 0, corners = 0;
        for (const Node& node : scene_.nodes) {
            if (node.mesh < 0 || !node.visible) continue;
            const Mesh& mesh = scene_.meshes[size_t(node.mesh)];
            drawables += mesh.primitives.size();
            if (drawables > mostDrawables)
                file_.refuse("nodes", fmt::format("draw more than {} primitives", mostDrawables));
            for (const Primitive& primitive : mesh.primitives) corners += primitive.vertexCount + primitive.indexCount;
            if (corners > mostCorners)
                file_.refuse("nodes", fmt::format("draw more than {} vertices and indices", mostCorners));
        }
    }

    // Every number was fine, but their products may not be. So that no moment of any clip leaves the range of float, it
    // is followed from the roots on how far off and how much stretched each node could at most be.
    void checkReach() const {
        struct Most {
            double stretch = 0, distance = 0; // of vectors; of the origin [m]
            Most operator*(const Most& child) const {
                return {stretch * child.stretch, distance + stretch * child.distance};
            }
        };
        const auto ofMatrix = [](const glm::mat4& m) {
            const glm::dvec3 lengths(glm::length(m[0]), glm::length(m[1]), glm::length(m[2]));
            return Most{glm::length(lengths), glm::length(glm::dvec3(m[3]))};
        };
        const auto radius = [](const Bounds& box) {
            return box.empty() ? 0.0 : glm::length(glm::dvec3(glm::max(glm::abs(box.min), glm::abs(box.max))));
        };

        std::vector<Most> most;
        for (const Node& node : scene_.nodes) {
            const glm::vec3 scale = glm::abs(node.scale);
            most.push_back(node.matrix ? ofMatrix(*node.matrix)
                                       : Most{std::max({scale.x, scale.y, scale.z}), glm::length(node.translation)});
        }
        std::vector<double> weights(scene_.restWeights.begin(), scene_.restWeights.end());
        for (double& weight : weights) weight = std::abs(weight);
        for (const Animation& animation : scene_.animations)
            for (const AnimationChannel& channel : animation.channels) {
                const double largest = largestOf(channel);
                double& stretch = most[size_t(channel.node)].stretch;
                double& distance = most[size_t(channel.node)].distance;
                if (channel.path == AnimationChannel::Path::Scale) stretch = std::max(stretch, largest);
                if (channel.path == AnimationChannel::Path::Translation)
                    distance = std::max(distance, std::sqrt(3.0) * largest);
                for (uint32_t t = 0; channel.path == AnimationChannel::Path::Weights && t < channel.width; ++t) {
                    double& weight = weights[scene_.nodes[size_t(channel.node)].firstWeight + t];
                    weight = std::max(weight, largest);
                }
            }

        for (size_t i = 0; i < scene_.nodes.size(); ++i) {
            const Node& node = scene_.nodes[i];
            if (node.parent >= 0) most[i] = most[size_t(node.parent)] * most[i];
            if (!(std::max(most[i].stretch, most[i].distance) <= largestNumber)) refuseReach(i);
        }
        for (size_t i = 0; i < scene_.nodes.size(); ++i) {
            const Node& node = scene_.nodes[i];
            if (node.mesh < 0) continue;
            for (const Primitive& primitive : scene_.meshes[size_t(node.mesh)].primitives) {
                double morphed = 0;
                for (uint32_t t = 0; t < primitive.morphTargets; ++t)
                    morphed += weights[node.firstWeight + t] * radius(primitive.morphBounds[t]);
                const auto check = [&](const Most& placed, const Bounds& box) {
                    if (!((placed * Most{1, radius(box) + morphed}).distance <= largestNumber)) refuseReach(i);
                };
                check(most[i], primitive.bounds);
                if (node.skin < 0) continue;
                const Skin& skin = scene_.skins[size_t(node.skin)];
                for (const auto& [joint, box] : primitive.jointBounds)
                    check(most[size_t(skin.joints[joint])] * ofMatrix(skin.jointFromMesh[joint]), box);
            }
        }
    }

    [[noreturn]] void refuseReach(size_t node) const {
        auto found = std::find(nodes_.begin(), nodes_.end(), int(node));
        if (found == nodes_.end())
            found = std::find(nodes_.begin(), nodes_.end(), scene_.nodes[node].parent); // instance
        file_.refuse(nodePlace(size_t(found - nodes_.begin())),
                     fmt::format("may lie or stretch beyond all measure; expected at most {} m", largestNumber));
    }

    // Of all that a channel's values could at most become. The tangents of a cubic spline are times the interval.
    static double largestOf(const AnimationChannel& channel) {
        double largest = 0, longest = 0;
        for (const float value : channel.values) largest = std::max(largest, std::abs(double(value)));
        for (size_t i = 1; i < channel.times.size(); ++i)
            longest = std::max(longest, double(channel.times[i]) - channel.times[i - 1]);
        return channel.interpolation == AnimationChannel::Interpolation::CubicSpline ? largest * (1 + longest)
                                                                                     : largest;
    }

    GltfFile file_;
    const ImportChoice& choice_;
    Progress* progress_;
    tinygltf::Model model_;
    GltfAccessors accessors_{file_, model_};
    Scene scene_;
    std::vector<TextureCoordinates> coordinates_;      // one per material of the file
    std::map<std::pair<int, int>, int> textures_;      // (image, sampler) to Scene::textures
    std::map<std::vector<int>, VertexRange> vertices_; // by accessors, and the material if it moves uv
    std::vector<int> nodes_;                           // node of the file to Scene::nodes
    size_t keyCount_ = 0, textureBytes_ = 0;
};

Scene imported(GltfFile file, const ImportChoice& choice, Progress* progress) {
    Scene scene = Importer(std::move(file), choice, progress).run(); // and the file's bytes are gone
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        if (progress) progress->report("finding closed surfaces", 0.8 + 0.2 * double(m) / double(scene.meshes.size()));
        for (Primitive& primitive : scene.meshes[m].primitives) {
            if (primitive.influenceSets > 0 || primitive.morphTargets > 0) continue;
            primitive.closed = !scene.materials[size_t(primitive.material)].masked && isClosedSurface(scene, primitive);
            primitive.shadesItself = mayShadeItself(scene, primitive);
            primitive.parts = partBounds(scene, primitive);
        }
    }
    return scene;
}

} // namespace

Scene importGltf(const std::filesystem::path& file, const ImportChoice& choice, Progress* progress) {
    if (progress) progress->report("reading the file", 0);
    return imported(GltfFile(file, acceptedExtensions()), choice, progress);
}

Scene importGltf(const std::filesystem::path& file, std::vector<uint8_t> bytes) {
    return imported(GltfFile(file, std::move(bytes), acceptedExtensions()), {}, nullptr);
}

} // namespace penumbra
