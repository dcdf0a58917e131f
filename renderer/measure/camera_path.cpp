// SPDX-License-Identifier: MIT
#include "renderer/measure/camera_path.h"

#include "renderer/session.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace penumbra {
namespace {

glm::vec3 turned(glm::vec3 v, float degrees) { // about the vertical, to the left
    return glm::vec3(glm::rotate(glm::mat4(1), glm::radians(degrees), {0, 1, 0}) * glm::vec4(v, 0));
}

bool within(Range range, double value) { return value >= range.min && value <= range.max; }

std::vector<float> numbers(std::string_view line) {
    std::vector<float> values;
    for (bool more = true; more;) {
        const size_t comma = line.find(',');
        more = comma != std::string_view::npos;
        std::string_view piece = line.substr(0, comma);
        while (piece.starts_with(' ')) piece.remove_prefix(1);
        while (piece.ends_with(' ') || piece.ends_with('\r')) piece.remove_suffix(1);
        float value = 0;
        const auto [end, error] = std::from_chars(piece.data(), piece.data() + piece.size(), value);
        if (error != std::errc() || end != piece.data() + piece.size() || !std::isfinite(value)) return {};
        values.push_back(value);
        if (more) line.remove_prefix(comma + 1);
    }
    return values;
}

CameraPath::Key parseKey(std::string_view line, const Camera& start) {
    const std::vector<float> v = numbers(line);
    if (v.size() != 7 && v.size() != 8) throw InputError("T,X,Y,Z,TX,TY,TZ or T,X,Y,Z,TX,TY,TZ,FOV was expected");
    if (!std::all_of(v.begin() + 1, v.begin() + 7, [](float x) { return within(limits::coordinate, x); }))
        throw InputError(fmt::format("places within {:g} m were expected", limits::coordinate.max));
    Camera camera = start;
    camera.eye = {v[1], v[2], v[3]};
    camera.target = {v[4], v[5], v[6]};
    camera.up = {0, 1, 0};
    if (v.size() == 8) camera.fovY = v[7];
    if (camera.eye == camera.target) throw InputError("eye and target were expected to be two points");
    if (!within(limits::fovY, camera.fovY))
        throw InputError(fmt::format("FOV was expected in {:g}..{:g} degrees", limits::fovY.min, limits::fovY.max));
    return {v[0], camera};
}

} // namespace

CameraPath::CameraPath(std::vector<Key> keys) : keys_(std::move(keys)) { ensure(!keys_.empty(), "a path of no keys"); }

CameraPath CameraPath::orbit(const Camera& start) {
    std::vector<Key> keys;
    for (int degree = 0; degree <= 360; ++degree) {
        Camera camera = start;
        camera.eye = start.target + turned(start.eye - start.target, static_cast<float>(degree));
        camera.up = turned(start.up, static_cast<float>(degree));
        keys.push_back({degree * step, camera});
    }
    return CameraPath(std::move(keys));
}

CameraPath CameraPath::walk(const Camera& start) {
    constexpr int steps = 240;
    constexpr float widest = 15; // degrees
    const glm::vec3 gaze = start.target - start.eye;
    const glm::vec3 goal = 0.5f * glm::vec3(gaze.x, 0, gaze.z);
    std::vector<Key> keys;
    for (int i = 0; i <= steps; ++i) {
        const float share = static_cast<float>(i) / steps;
        Camera camera = start;
        camera.eye = start.eye + share * goal;
        camera.target = camera.eye + turned(gaze, widest * std::sin(share * 6.2831853f));
        camera.up = {0, 1, 0};
        keys.push_back({i * step, camera});
    }
    return CameraPath(std::move(keys));
}

CameraPath CameraPath::parse(std::string_view text, const Camera& start) {
    std::vector<Key> keys;
    for (int number = 1; !text.empty(); ++number) {
        const size_t end = text.find('\n');
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (line.starts_with('#') || line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        try {
            keys.push_back(parseKey(line, start));
            if (keys.size() == 1 && keys[0].seconds != 0) throw InputError("a path was expected to start at 0 s");
            if (keys.size() > 1 && !(keys.back().seconds > keys[keys.size() - 2].seconds))
                throw InputError("a later time was expected than in the line before");
            if (keys.back().seconds > 3600) throw InputError("a time within an hour was expected");
        } catch (const InputError& error) {
            throw InputError(fmt::format("line {}: {}", number, error.what()));
        }
    }
    if (keys.empty()) throw InputError("lines of T,X,Y,Z,TX,TY,TZ were expected");
    return CameraPath(std::move(keys));
}

int CameraPath::frames() const { return static_cast<int>(std::floor(keys_.back().seconds / step + 1e-6)) + 1; }

Camera CameraPath::at(int frame) const {
    const double seconds = frame * step;
    const auto later =
        std::find_if(keys_.begin(), keys_.end(), [&](const Key& key) { return key.seconds >= seconds - 1e-9; });
    if (later == keys_.begin()) return keys_.front().camera;
    if (later == keys_.end()) return keys_.back().camera;
    const Key &a = *(later - 1), &b = *later;
    const auto share = static_cast<float>((seconds - a.seconds) / (b.seconds - a.seconds));
    Camera camera = a.camera;
    camera.eye = glm::mix(a.camera.eye, b.camera.eye, share);
    camera.target = glm::mix(a.camera.target, b.camera.target, share);
    camera.up = glm::mix(a.camera.up, b.camera.up, share);
    camera.fovY = glm::mix(a.camera.fovY, b.camera.fovY, share);
    return camera;
}

} // namespace penumbra
