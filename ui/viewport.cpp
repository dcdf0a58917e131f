// SPDX-License-Identifier: MIT
#include "ui/viewport.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra {

namespace {

constexpr float degreesPerUnit = 0.3f, notchesPerUnit = 0.05f; // of a drag, at 96 dots per inch

// A second of a key:
constexpr float degreesPerSecond = 60;
constexpr float viewsPerSecond = 0.5f; // of panning, heights of the view
constexpr float notchesPerSecond = 8;
constexpr float sprint = 4; // times as fast with Shift
constexpr float sizePerSecond = 2.5f;

constexpr double glimpse = 1.2; // how long a hint stays [s]

constexpr uint64_t framesToSettle = 6; // more than the timer's ring of queries
constexpr double dearFrame = 50;       // [ms]
// What a frame of the window may spend on the picture [ms], so that it answers well within a tenth of a second even
// while pictures take seconds.
constexpr double shareOfFrame = 30;

template <class T> void append(std::vector<uint32_t>& words, const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);
    const auto bits = std::bit_cast<std::array<uint32_t, sizeof(T) / 4>>(value);
    words.insert(words.end(), bits.begin(), bits.end());
}

glm::vec2 vec(ImVec2 v) { return {v.x, v.y}; }
ImVec2 vec(glm::vec2 v) { return {v.x, v.y}; }

// Over any picture: a dark edge around the colour.
void inkLine(ImDrawList& list, glm::vec2 from, glm::vec2 to, ImU32 ink) {
    const float width = 0.13f * ImGui::GetFontSize();
    list.AddLine(vec(from), vec(to), IM_COL32(0, 0, 0, 130), 2.2f * width);
    list.AddLine(vec(from), vec(to), ink, width);
}

void inkCircle(ImDrawList& list, glm::vec2 centre, float radius, ImU32 ink, bool filled) {
    const float width = 0.13f * ImGui::GetFontSize();
    if (filled) {
        list.AddCircleFilled(vec(centre), radius + 0.6f * width, IM_COL32(0, 0, 0, 150));
        list.AddCircleFilled(vec(centre), radius, ink);
    } else {
        list.AddCircle(vec(centre), radius, IM_COL32(0, 0, 0, 130), 0, 2.2f * width);
        list.AddCircle(vec(centre), radius, ink, 0, width);
    }
}

// A line of text on a dark ground, centred on `x`.
void drawHint(float x, float y, const ShortText& line) {
    const float padding = 0.5f * ImGui::GetFontSize();
    const ImVec2 extent = ImGui::CalcTextSize(line.begin(), line.end());
    const ImVec2 from{std::round(x - extent.x / 2 - padding), std::round(y)};
    ImVec4 paper = ImGui::GetStyleColorVec4(ImGuiCol_PopupBg);
    paper.w = 0.9f;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(from, {from.x + extent.x + 2 * padding, from.y + extent.y + padding}, ImGui::GetColorU32(paper),
                       0.3f * ImGui::GetFontSize());
    list.AddText({from.x + padding, from.y + padding / 2}, ImGui::GetColorU32(colour::text), line.begin(), line.end());
}

ShortText sizeText(const AreaLight& light) {
    switch (light.shape) {
    case LightShape::Rectangle: return ShortText("{:.3g} m × {:.3g} m", light.size.x, light.size.y);
    case LightShape::Disk: return ShortText("{:.3g} m across", light.size.x);
    case LightShape::Directional: return ShortText("{:.3g}°", light.size.x);
    }
    return ShortText("");
}

// What a handle does, or while it is held what it has done.
ShortText handleText(LightHandle handle, const AreaLight& light, bool held) {
    const glm::vec3 target = light.target;
    const LightDirection direction = lightDirection(light);
    switch (handle) {
    case LightHandle::None: break;
    case LightHandle::Centre:
        if (!held) return ShortText("Light: drag to move it");
        return ShortText("{:.3g} m from the target, {:.0f}° high", direction.distance, direction.elevation);
    case LightHandle::Target:
        if (!held) return ShortText("Light's target: drag to aim");
        return ShortText("({:.3g}, {:.3g}, {:.3g}) m", target.x, target.y, target.z);
    case LightHandle::Width:
    case LightHandle::Height:
        if (held) return sizeText(light);
        return light.shape == LightShape::Rectangle
                   ? ShortText("Light's edge: drag to resize; Shift: both sides\n{}", sizeText(light).view())
                   : ShortText("Light's edge: drag to resize\n{}", sizeText(light).view());
    }
    return ShortText("");
}

} // namespace

float Viewport::unit() const { return std::max(ImGui::GetFontSize(), 1.0f) / 15; }

void Viewport::draw(Session& session, Renderer& renderer, const SceneFacts& facts, const Keys& keys,
                    ViewSettings& settings, HistoryControl& history, Timing timing, bool always, float pixelsPerUnit) {
    renderedNow_ = false;
    const ImVec2 corner = ImGui::GetCursorScreenPos(), size = ImGui::GetContentRegionAvail();
    const glm::ivec2 pixels(std::lround(size.x * pixelsPerUnit), std::lround(size.y * pixelsPerUnit));
    if (size.x < 1 || size.y < 1 || pixels.x < 1 || pixels.y < 1) return;
    const int panes = session.comparison.sideBySide() ? 2 : 1;
    session.size = glm::clamp(pixels / glm::ivec2(panes, 1), glm::ivec2(1), glm::ivec2(int(limits::pixels.max)));
    const glm::vec2 pane(panes > 1 ? static_cast<float>(session.size.x) / pixelsPerUnit : size.x, size.y);
    ImGui::InvisibleButton("viewport", size,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                               ImGuiButtonFlags_MouseButtonRight);
    if (drag_ == Drag::None || pane_ >= panes)
        pane_ = panes > 1 && ImGui::GetIO().MousePos.x >= corner.x + pane.x ? 1 : 0;
    const auto paneCorner = [&](int i) { return vec(corner) + glm::vec2(static_cast<float>(i) * pane.x, 0); };
    screen_ = {sessionView(session, facts.boundsWorld), paneCorner(pane_), pane};
    click();
    navigate(session, facts, keys, settings);
    const std::vector<std::string>& shaderErrors = renderer.pollShaders();
    render(session, renderer, history, timing, always);
    if (point_ && upToDate()) takePoint(session, renderer, facts.size);
    if (const Texture* picture = renderer.picture()) {
        // Of two pictures side by side the second may still be missing.
        const bool whole = picture->extent().width >= panes * session.size.x;
        const glm::vec2 end = vec(corner) + glm::vec2(whole ? static_cast<float>(panes) * pane.x : pane.x, pane.y);
        // OpenGL's first row is the lowest.
        ImGui::GetWindowDrawList()->AddImage(textureId(picture->name()), corner, vec(end), {0, 1}, {1, 0});
    }
    screen_.view = sessionView(session, facts.boundsWorld);
    for (int i = 0; i < panes; ++i) {
        screen_.corner = paneCorner(i);
        drawOver(session, settings);
    }
    screen_.corner = vec(corner);
    screen_.size = vec(size);
    if (ImGui::GetTime() < speedUntil_) drawSpeed(settings, facts.size);
    drawTroubles(shaderErrors);
}

// What lies over each picture.
void Viewport::drawOver(const Session& session, const ViewSettings& settings) const {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect(vec(screen_.corner), vec(screen_.corner + screen_.size), true);
    if (lightDrawn_) drawLight(session);
    if (ImGui::GetTime() < targetUntil_) drawTarget(session);
    if (settings.rulerShown) drawRuler(settings.ruler, screen_, rulerGrip_);
    list.PopClipRect();
}

// What the mouse drag of this frame does.
Motion Viewport::ofMouse() const {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::vec2 pixels = vec(io.MouseDelta), units = pixels / unit();
    Motion motion;
    switch (drag_) {
    case Drag::None:
    case Drag::Handle:
    case Drag::Ruler:
    case Drag::Line: break;
    case Drag::Orbit: // the camera's scene, or the light, follows the pointer
        motion.turn = degreesPerUnit * (dragsLight_ ? glm::vec2(units.x, -units.y) : glm::vec2(-units.x, units.y));
        break;
    case Drag::Pan: motion.pan = pixels; break;
    case Drag::Zoom: motion.nearer = -notchesPerUnit * units.y; break;
    case Drag::Look: motion.look = -degreesPerUnit * units; break;
    }
    if (drag_ != Drag::Look && ImGui::IsItemHovered()) motion.nearer += io.MouseWheel;
    return motion;
}

Motion Viewport::ofKeys(const Keys& keys, const ViewSettings& settings, float sceneSize) const {
    Motion motion;
    const glm::vec2 arrows(keys.arrowRight - keys.arrowLeft, keys.arrowUp - keys.arrowDown);
    if (keys.control)
        motion.look = degreesPerSecond * glm::vec2(-arrows.x, arrows.y);
    else if (keys.shift) // a camera goes to where the arrow points, so that the scene goes the other way
        motion.pan = viewsPerSecond * screen_.size.y * glm::vec2(arrows.x, -arrows.y) * (keys.light ? 1.0f : -1.0f);
    else
        motion.turn = degreesPerSecond * arrows;
    motion.nearer = notchesPerSecond * (keys.nearer - keys.further);
    if (!keys.control)
        motion.fly = settings.flySpeed * sceneSize * (keys.shift ? sprint : 1.0f) *
                     glm::vec3(keys.right - keys.left, keys.rise - keys.sink, keys.forward - keys.back);
    return motion;
}

// What of the mouse is no drag.
void Viewport::click() {
    const ImGuiIO& io = ImGui::GetIO();
    clicked_.reset();
    pointed_.reset();
    rightClicked_ = false;
    if (!ImGui::IsItemHovered()) return;
    pointed_ = glm::clamp((vec(io.MousePos) - screen_.corner) / screen_.size, 0.0f, 1.0f);
    if (!ImGui::IsItemDeactivated()) return;
    const auto still = [&](ImGuiMouseButton button) {
        return ImGui::IsMouseReleased(button) &&
               io.MouseDragMaxDistanceSqr[button] <= io.MouseDragThreshold * io.MouseDragThreshold;
    };
    const bool plain = drag_ == Drag::None || drag_ == Drag::Orbit || drag_ == Drag::Look;
    if (plain && still(ImGuiMouseButton_Left)) clicked_ = pointed_;
    rightClicked_ = plain && still(ImGuiMouseButton_Right);
}

// A button went down in the view.
void Viewport::grab(const Keys& keys) {
    dragsLight_ = keys.light;
    if (ImGui::IsMouseDown(ImGuiMouseButton_Right))
        drag_ = Drag::Look;
    else if (ImGui::IsMouseDown(ImGuiMouseButton_Middle))
        drag_ = Drag::Pan;
    else if (rulerGrip_ != RulerGrip::None)
        drag_ = Drag::Ruler;
    else if (handle_ != LightHandle::None)
        drag_ = Drag::Handle;
    else if (onLine_)
        drag_ = Drag::Line;
    else
        drag_ = keys.shift ? Drag::Pan : keys.control ? Drag::Zoom : Drag::Orbit;
    if (drag_ == Drag::Look) dragsLight_ = false;
}

// What of the ruler and the wipe's line lies under the pointer.
void Viewport::hover(const Session& session, const ViewSettings& settings, bool hovered) {
    const glm::vec2 pointer = vec(ImGui::GetIO().MousePos);
    const float reach = 0.55f * ImGui::GetFontSize();
    rulerGrip_ = hovered && settings.rulerShown ? gripAt(settings.ruler, screen_, pointer, reach) : RulerGrip::None;
    const float line = screen_.corner.x + session.comparison.line * screen_.size.x;
    onLine_ = hovered && session.comparing() && session.comparison.as == CompareAs::Wipe &&
              std::abs(pointer.x - line) <= reach;
}

void Viewport::navigate(Session& session, const SceneFacts& facts, const Keys& keys, ViewSettings& settings) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool dialog = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    const bool hovered = ImGui::IsItemHovered();
    if (keys.handles && !dialog) settings.lightShown = !settings.lightShown;
    lightDrawn_ = settings.lightShown || keys.light || (drag_ != Drag::None && dragsLight_);

    const glm::vec2 pointer = vec(io.MousePos);
    if (drag_ == Drag::None)
        handle_ = hovered && lightDrawn_ ? handleAt(session.light, screen_, pointer, 0.55f * ImGui::GetFontSize())
                                         : LightHandle::None;
    if (drag_ == Drag::None) hover(session, settings, hovered);
    if (rulerGrip_ != RulerGrip::None)
        ImGui::SetMouseCursor(rulerGrip_ == RulerGrip::Both ? ImGuiMouseCursor_ResizeAll : ImGuiMouseCursor_Hand);
    else if (onLine_)
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (keys.doubleClick && hovered && handle_ == LightHandle::None) {
        const glm::vec2 place = (pointer - screen_.corner) / screen_.size * glm::vec2(session.size);
        point_ = {glm::ivec2(place), keys.light};
    }
    if (ImGui::IsItemActivated()) grab(keys);
    if (!ImGui::IsItemActive()) drag_ = Drag::None;

    const glm::vec2 delta = vec(io.MouseDelta);
    if (drag_ == Drag::Handle && delta != glm::vec2(0))
        dragHandle(session.light, handle_, screen_, pointer - delta, pointer, keys.shift, facts.size);

    if (drag_ == Drag::Ruler) dragRuler(settings.ruler, rulerGrip_, screen_, delta);
    if (drag_ == Drag::Line)
        session.comparison.line = std::clamp((pointer.x - screen_.corner.x) / screen_.size.x, 0.0f, 1.0f);

    const auto apply = [&](const Motion& motion, bool toLight) {
        if (motion == Motion{}) return;
        if (toLight) return move(session.light, session.camera, motion, screen_.size.y, facts.size);
        move(session.camera, motion, screen_.size.y, facts.size);
        if (motion.turn != glm::vec2(0)) targetUntil_ = ImGui::GetTime() + glimpse;
    };
    apply(ofMouse(), drag_ == Drag::None ? keys.light : dragsLight_);
    if (drag_ == Drag::Look && io.MouseWheel != 0) {
        settings.changeSpeed(io.MouseWheel);
        speedUntil_ = ImGui::GetTime() + glimpse;
    }
    if (dialog) return;
    apply(ofKeys(keys, settings, facts.size), keys.light);
    if (keys.larger != keys.smaller)
        scaleLight(session.light, glm::vec2(std::pow(sizePerSecond, keys.larger - keys.smaller)));
    if (keys.fast != keys.slow) {
        settings.changeSpeed(notchesPerSecond * (keys.fast - keys.slow));
        speedUntil_ = ImGui::GetTime() + glimpse;
    }
    if (keys.frameScene) frameBounds(session.camera, facts.boundsWorld, screen_.size.x / screen_.size.y);
    if (keys.reset && keys.light) session.light = defaultLight(*facts.scene, facts.pose);
    if (keys.reset && !keys.light) session.camera = defaultCamera(*facts.scene, facts.pose);
}

// What a double click asked for, now that the picture is known to be that of the camera.
void Viewport::takePoint(Session& session, const Renderer& renderer, float sceneSize) {
    const Point point = *point_;
    point_.reset();
    const std::optional<glm::vec3> surface = renderer.surfaceAt(point.pixel);
    if (!surface) return;
    if (point.aimsLight) {
        put(session.light.target, *surface, session.light.position, sceneSize);
    } else {
        put(session.camera.target, *surface, session.camera.eye, sceneSize);
        targetUntil_ = ImGui::GetTime() + glimpse;
    }
    fingerprint(session, renderer);
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
    for (const auto& [light, on] : session.furtherLights) append(now_, light), now_.push_back(on);
    append(now_, session.display);
    append(now_, session.clip);
    append(now_, session.time);
    append(now_, session.size);
    append(now_, session.seed);
    append(now_, renderer.shaderGeneration());
    const Comparison& comparison = session.comparison;
    append(now_, comparison.against);
    append(now_, comparison.as);
    append(now_, comparison.line);
    append(now_, comparison.gain);
    now_.push_back(comparison.exchanged);
    append(now_, session.currentTruth());
    if (comparison.against == Against::Technique) {
        append(now_, &session.rival.card());
        for (const Parameter* parameter : session.rival.parameters().all()) now_.push_back(parameter->bits());
    }
    now_.push_back(session.ground);
    now_.push_back(renderer.inspection().images);
    append(now_, renderer.inspection().probe.value_or(glm::ivec2(-1)));
}

void Viewport::render(Session& session, Renderer& renderer, HistoryControl& history, Timing timing, bool always) {
    fingerprint(session, renderer);
    try {
        if (!renderer.underWay()) {
            const bool changed = now_ != drawn_ || restart_;
            // A few frames more until the timer queries of the last change have come in, unless frames are dear.
            const bool settling =
                frames_ < settledFrame_ && renderer.runner().timer().newest().milliseconds < dearFrame;
            // After a failure only a change can help.
            turn_ = history.next();
            const bool goesOn = turn_ == Turn::Next && (history.counting() || renderer.flow().living());
            const bool living =
                trouble_.empty() && !resting_ && (always || settling || session.timeStep != 0 || goesOn);
            if (!changed && !living) return;
            if (restart_) {
                renderer.reset();
                session.frame = 0;
                restart_ = false;
            }
            if (changed) settledFrame_ = frames_ + framesToSettle;
            drawn_ = now_;
            trouble_.clear();
            renderer.begin(session, timing, turn_);
            if (turn_ == Turn::Next) ++session.frame;
        }
        renderedNow_ = renderer.advance(shareOfFrame);
        if (renderedNow_) {
            ++frames_;
            history.finished(turn_, renderer.flow().historyLength());
        }
    } catch (const std::exception& error) { // too large, or a shader that never compiled: only a change can help
        trouble_ = error.what();
    }
    busy_ = renderer.underWay();
}

void Viewport::drawLight(const Session& session) const {
    const AreaLight& light = session.light;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float em = ImGui::GetFontSize();
    const ImU32 ink = ImGui::GetColorU32(colour::accent), bright = IM_COL32(255, 255, 255, 255);
    const auto inkOf = [&](bool lit) { return lit ? bright : ink; };
    const auto line = [&](glm::vec3 fromWorld, glm::vec3 toWorld, bool lit) {
        if (const auto ends = screen_.project(fromWorld, toWorld)) inkLine(list, ends->first, ends->second, inkOf(lit));
    };
    line(light.position, light.target, false);
    const LightOutline outline = lightOutline(light);
    for (size_t i = 0; i < outline.size(); ++i)
        line(outline[i], outline[(i + 1) % outline.size()],
             handle_ != LightHandle::None && handle_ == edgeAt(light, i));
    if (const auto centre = screen_.project(light.position))
        inkCircle(list, *centre, 0.32f * em, inkOf(handle_ == LightHandle::Centre), true);
    if (const auto target = screen_.project(light.target)) {
        const bool lit = handle_ == LightHandle::Target;
        inkCircle(list, *target, 0.4f * em, inkOf(lit), false);
        inkCircle(list, *target, 0.12f * em, inkOf(lit), true);
    }
    if (handle_ == LightHandle::None) return;
    const bool held = drag_ == Drag::Handle;
    ImGui::SetMouseCursor(handle_ == LightHandle::Width || handle_ == LightHandle::Height ? ImGuiMouseCursor_Hand
                                                                                          : ImGuiMouseCursor_ResizeAll);
    if (held || drag_ == Drag::None) ImGui::SetTooltip("%s", handleText(handle_, light, held).begin());
}

// What the camera turns round.
void Viewport::drawTarget(const Session& session) const {
    const auto target = screen_.project(session.camera.target);
    if (!target) return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float em = ImGui::GetFontSize();
    ImVec4 ink = colour::text;
    ink.w = static_cast<float>(std::clamp(3 * (targetUntil_ - ImGui::GetTime()), 0.0, 1.0));
    const ImU32 fading = ImGui::GetColorU32(ink);
    list.AddCircle(vec(*target), 0.45f * em, fading, 0, 0.12f * em);
    list.AddCircleFilled(vec(*target), 0.13f * em, fading);
}

void Viewport::drawSpeed(const ViewSettings& settings, float sceneSize) const {
    drawHint(screen_.corner.x + screen_.size.x / 2, screen_.corner.y + ImGui::GetFontSize(),
             ShortText("Flying at {:.3g} m/s", settings.flySpeed * sceneSize));
}

void Viewport::drawTroubles(const std::vector<std::string>& shaderErrors) const {
    const glm::vec2 corner = screen_.corner, size = screen_.size;
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
