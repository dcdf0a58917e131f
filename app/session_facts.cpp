// SPDX-License-Identifier: MIT
#include "app/session_facts.h"

#include "app/image_file.h"
#include "app/preset.h"
#include "renderer/core/paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

constexpr Range anyCount{1, std::numeric_limits<int>::max()};
constexpr Range anyIndex{0, std::numeric_limits<int>::max()};
constexpr Range anySeed{0, std::numeric_limits<uint32_t>::max()};

// The facts of a picture, once. `Io` is a Writer or a Reader; both meet them in this order.
template <class Io, class AnyOrigin, class AnySession, class AnyShot>
void listFacts(Io& io, AnyOrigin& origin, AnySession& session, AnyShot& shot) {
    io.text("program", origin.program);
    io.text("driver", origin.driver);
    io.group("scene", [&](Io& in) {
        in.text("name", origin.scene.name);
        in.text("file", origin.scene.file);
        in.text("checksum", origin.scene.checksum);
        in.text("scene", origin.scene.scene);
        in.text("variant", origin.scene.variant);
        in.text("clip", origin.scene.clip);
    });
    io.technique(session.techniques);
    io.group("camera", [&](Io& in) {
        auto& camera = session.camera;
        in.vector("eye", camera.eye, limits::coordinate);
        in.vector("target", camera.target, limits::coordinate);
        in.vector("up", camera.up, limits::coordinate);
        in.number("fov", camera.fovY, limits::fovY);
        in.demand(camera.eye != camera.target, "eye and target were expected to be two points");
    });
    const auto lightFacts = [](Io& in, auto& light) {
        in.choice("shape", light.shape, lightShapeNames());
        in.vector("position", light.position, limits::coordinate);
        in.vector("target", light.target, limits::coordinate);
        in.vector("size", light.size,
                  light.shape == LightShape::Directional ? limits::lightDegrees : limits::lightMetres);
        in.vector("colour", light.colour, limits::brightness);
        in.number("intensity", light.intensity, limits::brightness);
    };
    io.group("light", [&](Io& in) { lightFacts(in, session.light); });
    io.list("further-lights", session.furtherLights, mostFurtherLights, [&](Io& in, auto& further) {
        lightFacts(in, further.light);
        in.flag("on", further.on);
    });
    io.flag("ground", session.ground);
    io.group("display", [&](Io& in) {
        in.choice("show", session.display.show, showNames());
        in.number("exposure", session.display.exposure, limits::exposure);
        in.number("ambient", session.display.ambient, limits::ambient);
    });
    io.group("comparison", [&](Io& in) {
        auto& comparison = session.comparison;
        in.choice("against", comparison.against, againstNames());
        if (comparison.against == Against::Nothing) return;
        in.choice("as", comparison.as, compareAsNames());
        in.number("line", comparison.line, {0, 1});
        in.flag("exchanged", comparison.exchanged);
        in.number("gain", comparison.gain, {1, 100});
        if (comparison.against == Against::Technique) in.technique(session.rival);
    });
    io.number("time", session.time, limits::seconds);
    io.number("time-step", session.timeStep, limits::seconds);
    io.number("frames", shot.frames, anyCount);
    io.number("seed", session.seed, anySeed);
    io.vector("size", session.size, limits::pixels);
    io.text("buffer", shot.buffer);
    io.number("layer", shot.layer, anyIndex);
    io.number("level", shot.level, anyIndex);
    io.flag("panels", shot.panels);
}

// --- writing -------------------------------------------------------------------------------------------------------

template <class Number> Json numberJson(Number value) {
    if constexpr (std::is_same_v<Number, float>) {
        // The double with the float's own shortest text: 0.1 instead of 0.10000000149011612.
        const std::string text = fmt::format("{}", value);
        double shortest = value;
        std::from_chars(text.data(), text.data() + text.size(), shortest);
        return shortest;
    } else {
        return value;
    }
}

class Writer {
public:
    Json json = Json::object();

    template <class Body> void group(const char* key, Body&& body) {
        Writer inner;
        body(inner);
        json[key] = std::move(inner.json);
    }
    template <class T, class Body>
    void list(const char* key, const std::vector<T>& items, size_t /*most*/, Body&& body) {
        json[key] = Json::array();
        for (const T& item : items) {
            Writer inner;
            body(inner, item);
            json[key].push_back(std::move(inner.json));
        }
    }
    void technique(const TechniqueShelf& techniques) {
        json["technique"] = techniques.card().id;
        json["parameters"] = parametersJson(techniques.parameters(), Which::All);
    }
    template <class Number> void number(const char* key, Number value, Range) { json[key] = numberJson(value); }
    template <class Vector> void vector(const char* key, const Vector& value, Range) {
        json[key] = Json::array();
        for (int i = 0; i < value.length(); ++i) json[key].push_back(numberJson(value[i]));
    }
    template <class E> void choice(const char* key, E value, std::span<const std::string_view> names) {
        json[key] = names[static_cast<size_t>(value)];
    }
    void flag(const char* key, bool value) { json[key] = value; }
    void text(const char* key, const std::string& value) { json[key] = value; }
    void demand(bool, const char*) {}
};

// --- reading -------------------------------------------------------------------------------------------------------

// A fact that is not told leaves what is there.
class Reader {
public:
    Reader(const Json& json, std::string place) : json_(json), place_(std::move(place)) {}

    template <class Body> void group(const char* key, Body&& body) {
        const Json* json = find(key);
        if (!json) return;
        if (!json->is_object()) refuse(key, "an object", *json);
        Reader inner(*json, place_ + key + ".");
        body(inner);
        inner.refuseUnknown();
    }
    template <class T, class Body> void list(const char* key, std::vector<T>& items, size_t most, Body&& body) {
        const Json* json = find(key);
        if (!json) return;
        if (!json->is_array() || json->size() > most)
            refuse(key, fmt::format("a list of at most {} objects", most), *json);
        items.clear();
        for (const Json& item : *json) {
            const std::string place = fmt::format("{}{}[{}]", place_, key, items.size());
            if (!item.is_object()) throw InputError(fmt::format("'{}': an object was expected", place));
            Reader inner(item, place + ".");
            body(inner, items.emplace_back());
            inner.refuseUnknown();
        }
    }
    void technique(TechniqueShelf& techniques) {
        const Json* id = find("technique");
        const auto values = techniqueFromJson(id, find("parameters"));
        // All values are told; those that are the defaults stay defaults.
        for (Parameter* parameter : values->parameters().all())
            if (!parameter->changed()) parameter->reset();
        techniques.take(values->parameters());
    }
    template <class Number> void number(const char* key, Number& value, Range range) {
        if (const Json* json = find(key)) value = numberFrom<Number>(key, *json, range);
    }
    template <class Vector> void vector(const char* key, Vector& value, Range range) {
        const Json* json = find(key);
        if (!json) return;
        const auto length = static_cast<size_t>(value.length());
        if (!json->is_array() || json->size() != length) refuse(key, fmt::format("{} numbers", length), *json);
        for (size_t i = 0; i < length; ++i)
            value[static_cast<int>(i)] = numberFrom<typename Vector::value_type>(key, (*json)[i], range);
    }
    template <class E> void choice(const char* key, E& value, std::span<const std::string_view> names) {
        const Json* json = find(key);
        if (!json) return;
        const std::string expected = fmt::format("one of {}", fmt::join(names, ", "));
        if (!json->is_string()) refuse(key, expected, *json);
        const auto& name = json->get_ref<const std::string&>();
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) refuse(key, expected + suggestion(name, names), *json);
        value = static_cast<E>(found - names.begin());
    }
    void flag(const char* key, bool& value) {
        const Json* json = find(key);
        if (!json) return;
        if (!json->is_boolean()) refuse(key, "true or false", *json);
        value = json->get<bool>();
    }
    void text(const char* key, std::string& value) {
        const Json* json = find(key);
        if (!json) return;
        if (!json->is_string()) refuse(key, "a text", *json);
        value = json->get<std::string>();
    }
    void demand(bool holds, const char* expectation) const {
        if (!holds) throw InputError(fmt::format("'{}': {}", place_.substr(0, place_.size() - 1), expectation));
    }

    void refuseUnknown() const {
        for (const auto& [key, value] : json_.items())
            if (std::find(known_.begin(), known_.end(), key) == known_.end())
                throw InputError(fmt::format("unknown fact '{}{}'{}", place_, key, suggestion(key, known_)));
    }

private:
    const Json* find(const char* key) {
        known_.push_back(key);
        return findKey(json_, key);
    }
    [[noreturn]] void refuse(const char* key, std::string_view expectation, const Json& json) const {
        throw InputError(fmt::format("'{}{}': {} was expected, not {}", place_, key, expectation, briefText(json)));
    }
    template <class Number> Number numberFrom(const char* key, const Json& json, Range range) const {
        constexpr bool whole = std::is_integral_v<Number>;
        const bool fits = whole ? json.is_number_integer() : json.is_number();
        const double value = fits ? json.get<double>() : 0;
        if (!fits || !(value >= range.min && value <= range.max))
            refuse(key, fmt::format("a{} number in {}..{}", whole ? " whole" : "", range.min, range.max), json);
        return static_cast<Number>(value);
    }

    const Json& json_;
    std::string place_; // "camera."
    std::vector<std::string_view> known_;
};

Shot readFacts(const Json& facts, Origin& origin, Session& session) {
    Shot shot;
    Reader reader(facts, "");
    listFacts(reader, origin, session, shot);
    reader.refuseUnknown();
    return shot;
}

// --- the scene -----------------------------------------------------------------------------------------------------

// Built-in scenes by name, so that another installation finds its own.
std::string sceneName(const Scene& scene) {
    if (scene.file.empty()) return scene.name;
    std::error_code ignored;
    const fs::path folder = assetFolder() / "scenes", beside = fs::absolute(scene.file, ignored).parent_path();
    if (fs::equivalent(folder, beside, ignored)) return scene.name;
    return fs::absolute(scene.file, ignored).lexically_normal().string();
}

std::string checksumText(const Scene& scene) { return fmt::format("crc32 {:08x}", scene.checksum); }

} // namespace

Json factsOf(const Session& session, const Shot& shot, const std::string& driver) {
    const Scene& scene = *session.scene;
    const auto nameAt = [](const auto& names, auto index) {
        return index >= 0 && static_cast<size_t>(index) < names.size() ? names[static_cast<size_t>(index)] : "";
    };
    Origin origin{
        "Penumbra " PENUMBRA_VERSION, driver, {scene.name, sceneName(scene), checksumText(scene), "", "", ""}};
    if (scene.sceneNames.size() > 1) origin.scene.scene = nameAt(scene.sceneNames, scene.chosenScene);
    origin.scene.variant = nameAt(scene.variantNames, scene.chosenVariant);
    if (session.clip < scene.animations.size()) origin.scene.clip = scene.animations[session.clip].name;
    Writer writer;
    listFacts(writer, origin, session, shot);
    return std::move(writer.json);
}

PictureFacts::PictureFacts(const fs::path& picture) : picture_(picture.string()) {
    try {
        facts_ = readPictureFacts(picture);
        if (facts_.is_null())
            throw InputError("tells nothing of how it was made; a picture saved by Penumbra was expected");
        if (!facts_.is_object()) throw InputError("an object was expected in what it tells of how it was made");
        Session trial; // so that restore() succeeds or was never reached
        readFacts(facts_, origin_, trial);
    } catch (const InputError& error) {
        const std::string message = error.what();
        throw InputError(message.starts_with(picture_) ? message : picture_ + ": " + message);
    }
}

fs::path PictureFacts::scene() const {
    try {
        return findScene(origin_.scene.file);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: its scene: {}", picture_, error.what()));
    }
}

Shot PictureFacts::restore(Session& session) const {
    Origin ignored;
    const std::vector<Animation>& clips = session.scene->animations;
    const auto clip =
        std::find_if(clips.begin(), clips.end(), [&](const Animation& c) { return c.name == origin_.scene.clip; });
    session.clip = clip == clips.end() ? 0 : static_cast<size_t>(clip - clips.begin()); // of a scene that has changed
    return readFacts(facts_, ignored, session);
}

std::string PictureFacts::doubtAboutScene(const Scene& scene) const {
    const std::string &made = origin_.scene.checksum, found = checksumText(scene);
    if (made.empty() || made == found) return {};
    return fmt::format("{}: its scene {} has changed since ({}, then {})", picture_, sceneName(scene), found, made);
}

std::string PictureFacts::doubtAboutDriver(const std::string& driver) const {
    if (origin_.driver.empty() || origin_.driver == driver) return {};
    return fmt::format("{}: was made by another driver, which may round differently ({})", picture_, origin_.driver);
}

bool mayHoldFacts(const fs::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    return ending == ".png" || ending == ".exr";
}

} // namespace penumbra
