// SPDX-License-Identifier: MIT
#include "ui/viewport.h"

#include "ui/navigation.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra {

namespace {

constexpr float degreesPerUnit = 0.3f; // of a drag, at 96 dots per inch

constexpr uint64_t framesToSettle = 6; // more than the timer's ring of queries
constexpr double dearFrame = 50;       // [ms]

template <class T> void append(std::vector<uint32_t>& words, const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);
    const auto bits = std::bit_cast<std::array<uint32_t, sizeof(T) / 4>>(value);
    words.insert(words.end(), bits.begin(), bits.end());
}

} // namespace

void Viewport::draw(Session& session, Renderer& renderer, const SceneFacts& facts, const Keys& keys, Timing timing,
                    bool always, bool showLight, float seconds, float pixelsPerUnit) {
    renderedNow_ = false;
    const ImVec2 corner = ImGui::GetCursorScreenPos(), size = ImGui::GetContentRegionAvail();
    const glm::ivec2 pixels(std::lround(size.x * pixelsPerUnit), std::lround(size.y * pixelsPerUnit));
    if (size.x < 1 || size.y < 1 || pixels.x < 1 || pixels.y < 1) return;
    session.size = glm::min(pixels, glm::ivec2(static_cast<int>(limits::pixels.max)));
    ImGui::InvisibleButton("viewport", size,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                               ImGuiButtonFlags_MouseButtonRight);
    navigate(session, facts, keys, seconds, size);
    const std::vector<std::string>& shaderErrors = renderer.pollShaders();
    render(session, renderer, timing, always);
    // OpenGL's first row is the lowest.
    if (renderer.hasFrame())
        ImGui::GetWindowDrawList()->AddImage(
            textureId(renderer.runner().texture(renderer.flow(), renderer.display()).name()), corner,
            {corner.x + size.x, corner.y + size.y}, {0, 1}, {1, 0});
    if (showLight || keys.light || drag_ == Drag::Light) drawLight(session, corner, size);
    drawTroubles(shaderErrors, corner, size);
}

void Viewport::navigate(Session& session, const SceneFacts& facts, const Keys& keys, float seconds, ImVec2 size) {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemActivated()) {
        if (ImGui::IsMouseDown(ImGuiMouseButton_Right))
            drag_ = Drag::Fly;
        else if (ImGui::IsMouseDown(ImGuiMouseButton_Middle) || keys.shift)
            drag_ = Drag::Pan;
        else
            drag_ = keys.light ? Drag::Light : Drag::Orbit;
    }
    if (!ImGui::IsItemActive()) drag_ = Drag::None;

    const float degrees = degreesPerUnit * 13 / std::max(ImGui::GetFontSize(), 1.0f);
    const float x = io.MouseDelta.x, y = io.MouseDelta.y;
    if (x != 0 || y != 0) switch (drag_) {
        case Drag::None: break;
        case Drag::Orbit: orbit(session.camera, -x * degrees, y * degrees); break;
        case Drag::Pan: pan(session.camera, {x, y}, size.y); break;
        case Drag::Fly: look(session.camera, -x * degrees, -y * degrees); break;
        case Drag::Light: orbitLight(session.light, x * degrees, -y * degrees); break;
        }
    if (drag_ == Drag::Fly) {
        const glm::vec3 direction(keys.right - keys.left, keys.up - keys.down, keys.forward - keys.back);
        const float metres = flySpeed_ * facts.size * seconds * (keys.shift ? 4.0f : 1.0f);
        if (direction != glm::vec3(0)) fly(session.camera, metres * glm::normalize(direction));
        flySpeed_ = std::clamp(flySpeed_ * std::pow(1.25f, io.MouseWheel), 0.001f, 10.0f);
    } else if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
        if (keys.light)
            moveLightAway(session.light, io.MouseWheel, facts.size);
        else
            zoom(session.camera, io.MouseWheel, facts.size);
    }
    if (keys.frameScene) frameBounds(session.camera, facts.boundsWorld, size.x / size.y);
    if (drag_ == Drag::Fly && io.MouseWheel != 0)
        ImGui::SetTooltip("%s", ShortText("{:.3g} m/s", flySpeed_ * facts.size).begin());
}

// Equal fingerprints give equal pictures, but for history.
void Viewport::fingerprint(const Session& session, const Renderer& renderer) {
    now_.clear();
    const Scene* scene = session.scene.get();
    const Card* card = &session.techniques.card();
    append(now_, scene);
    append(now_, card);
    for (const Parameter* parameter : session.techniques.parameters().all()) now_.push_back(parameter->bits());
    append(now_, session.camera);
    append(now_, session.light);
    append(now_, session.display);
    append(now_, session.clip);
    append(now_, session.time);
    append(now_, session.size);
    append(now_, session.seed);
    append(now_, renderer.shaderGeneration());
    now_.push_back(session.ground);
}

void Viewport::render(Session& session, Renderer& renderer, Timing timing, bool always) {
    fingerprint(session, renderer);
    const bool changed = now_ != drawn_ || restart_;
    // A few frames more until the timer queries of the last change have come in, unless frames are dear.
    const bool settling = frames_ < settledFrame_ && renderer.runner().timer().newest().milliseconds < dearFrame;
    // After a failure only a change can help.
    const bool living =
        trouble_.empty() && (always || settling || session.timeStep != 0 || !renderer.flow().pasts().empty());
    if (!changed && !living) return;
    if (restart_) {
        renderer.reset();
        session.frame = 0;
        restart_ = false;
    }
    if (changed) settledFrame_ = frames_ + framesToSettle;
    drawn_ = now_;
    trouble_.clear();
    try {
        renderer.render(session, timing);
        ++session.frame;
        ++frames_;
        renderedNow_ = true;
    } catch (const std::exception& error) { // too large, or a shader that never compiled: only a change can help
        trouble_ = error.what();
    }
}

void Viewport::drawLight(const Session& session, ImVec2 corner, ImVec2 size) const {
    const View view = makeView(session.camera, session.size, 0.1f, 1.0f);
    const AreaLight& light = session.light;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 ink = ImGui::GetColorU32(colour::accent);
    const auto line = [&](glm::vec3 fromWorld, glm::vec3 toWorld) {
        const glm::vec4 a = view.clipFromWorld * glm::vec4(fromWorld, 1),
                        b = view.clipFromWorld * glm::vec4(toWorld, 1);
        if (a.w <= 0 || b.w <= 0) return; // behind the eye
        const auto place = [&](glm::vec4 p) {
            return ImVec2(corner.x + size.x * (0.5f + 0.5f * p.x / p.w), corner.y + size.y * (0.5f - 0.5f * p.y / p.w));
        };
        list.AddLine(place(a), place(b), ink, 0.12f * ImGui::GetFontSize());
    };
    line(light.position, light.target);
    if (light.shape == LightShape::Directional) return;
    const glm::mat4 worldFromLight = glm::inverse(lightFromWorld(light));
    const glm::vec2 half = halfSize(light);
    const bool disk = light.shape == LightShape::Disk;
    const int corners = disk ? 48 : 4;
    const auto edge = [&](int i) {
        const float angle = glm::radians(360.0f * (static_cast<float>(i) + 0.5f) / static_cast<float>(corners));
        const float reach = disk ? 1.0f : std::sqrt(2.0f); // of the unit square's corners
        return glm::vec3(worldFromLight * glm::vec4(half * reach * glm::vec2(std::cos(angle), std::sin(angle)), 0, 1));
    };
    for (int i = 0; i < corners; ++i) line(edge(i), edge(i + 1));
}

void Viewport::drawTroubles(const std::vector<std::string>& shaderErrors, ImVec2 corner, ImVec2 size) const {
    const float padding = 0.6f * ImGui::GetFontSize(), width = std::max(size.x - 4 * padding, 1.0f);
    float y = corner.y + padding;
    const auto banner = [&](const std::string& message) {
        const char* first = message.data();
        const char* last = first + message.size();
        const ImVec2 extent = ImGui::CalcTextSize(first, last, false, width);
        ImDrawList& list = *ImGui::GetWindowDrawList();
        const ImVec2 from{corner.x + padding, y};
        list.AddRectFilled(from, {from.x + extent.x + 2 * padding, from.y + extent.y + padding},
                           IM_COL32(48, 20, 20, 235), 0.3f * ImGui::GetFontSize());
        list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), {from.x + padding, from.y + padding / 2},
                     ImGui::GetColorU32(colour::error), first, last, width);
        y += extent.y + 2 * padding;
    };
    if (!trouble_.empty()) banner(trouble_);
    for (const std::string& error : shaderErrors)
        if (error != trouble_) banner(error);
}

} // namespace penumbra
