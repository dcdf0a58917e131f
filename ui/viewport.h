// SPDX-License-Identifier: MIT
// The picture in the window: renders the session when there is something new to see and takes mouse and keys.
#pragma once

#include "ui/history_control.h"
#include "ui/keys.h"
#include "ui/light_gizmo.h"
#include "ui/navigation.h"
#include "ui/ruler.h"
#include "ui/scene_facts.h"
#include "ui/widgets.h"

#include "renderer/renderer.h"

#include <optional>

namespace penumbra {

class Viewport {
public:
    // Fills the current ImGui window: moves camera and light, renders if `always` or if the session changed since the
    // last frame or the technique keeps history, and shows the result. A dear frame takes several calls; the one before
    // is shown meanwhile. `pixelsPerUnit` is the framebuffer's scale.
    void draw(Session& session, Renderer& renderer, const SceneFacts& facts, const Keys& keys, ViewSettings& settings,
              HistoryControl& history, Timing timing, bool always, float pixelsPerUnit);

    // Whether to draw only what changed: somebody measures meanwhile.
    void rest(bool resting) { resting_ = resting; }
    // The next frame is the first: no history.
    void restart() { restart_ = true; }
    // A new scene: whatever is shown next has nothing to do with what was.
    void invalidate() { drawn_.clear(); }

    uint64_t frames() const { return frames_; }                // finished so far
    bool renderedNow() const { return renderedNow_; }          // a frame was finished in this call
    bool upToDate() const { return drawn_ == now_ && !busy_; } // the picture is what the session says
    bool busy() const { return busy_; }                        // a frame is under way
    // Places of the picture, in [0, 1]² from its upper left corner: clicked with the left button without dragging, and
    // where the pointer is.
    const std::optional<glm::vec2>& clicked() const { return clicked_; }
    const std::optional<glm::vec2>& pointed() const { return pointed_; }
    bool rightClicked() const { return rightClicked_; }

private:
    enum class Drag { None, Orbit, Pan, Zoom, Look, Handle, Ruler, Line };

    void navigate(Session& session, const SceneFacts& facts, const Keys& keys, ViewSettings& settings);
    Motion ofMouse() const;
    Motion ofKeys(const Keys& keys, const ViewSettings& settings, float sceneSize) const;
    void grab(const Keys& keys);
    void click();
    void hover(const Session& session, const ViewSettings& settings, bool hovered);
    void drawOver(const Session& session, const ViewSettings& settings) const;
    void render(Session& session, Renderer& renderer, HistoryControl& history, Timing timing, bool always);
    void takePoint(Session& session, const Renderer& renderer, float sceneSize);
    void drawLight(const Session& session) const;
    void drawTarget(const Session& session) const;
    void drawSpeed(const ViewSettings& settings, float sceneSize) const;
    void drawTroubles(const std::vector<std::string>& shaderErrors) const;
    void fingerprint(const Session& session, const Renderer& renderer);
    float unit() const; // of a drag: a pixel at 96 dots per inch [window units]

    ScreenView screen_; // the picture that the pointer is on; as the camera stood when the call began
    int pane_ = 0;      // of two pictures side by side, which one that is
    Drag drag_ = Drag::None;
    std::optional<glm::vec2> clicked_, pointed_;
    bool rightClicked_ = false;
    RulerGrip rulerGrip_ = RulerGrip::None;  // under the pointer, or held
    bool onLine_ = false;                    // the pointer is on the wipe's line, or holds it
    bool dragsLight_ = false;                // instead of the camera
    LightHandle handle_ = LightHandle::None; // under the pointer, or held
    bool lightDrawn_ = false;
    struct Point { // a double click: a pixel of the picture
        glm::ivec2 pixel;
        bool aimsLight;
    };
    std::optional<Point> point_;              // looked up as soon as the picture is what the session says
    double targetUntil_ = 0, speedUntil_ = 0; // how long they are drawn; ImGui's time [s]

    bool restart_ = false, resting_ = false;
    Turn turn_ = Turn::Next;            // of the frame that is under way
    std::vector<uint32_t> now_, drawn_; // what decides the picture, as words: of this call, of the last frame begun
    uint64_t frames_ = 0, settledFrame_ = 0;
    bool renderedNow_ = false, busy_ = false;
    std::string trouble_; // why the last attempt to render failed
};

} // namespace penumbra
