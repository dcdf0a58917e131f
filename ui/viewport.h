// SPDX-License-Identifier: MIT
// The picture in the window: renders the session when there is something new to see and takes the mouse.
#pragma once

#include "ui/keys.h"
#include "ui/scene_facts.h"
#include "ui/widgets.h"

#include "renderer/renderer.h"

#include <optional>

namespace penumbra {

class Viewport {
public:
    // Fills the current ImGui window: moves camera and light, renders if `always` or if the session changed since the
    // last frame or the technique keeps history, and shows the result. `pixelsPerUnit` is the framebuffer's scale.
    void draw(Session& session, Renderer& renderer, const SceneFacts& facts, const Keys& keys, Timing timing,
              bool always, bool showLight, float seconds, float pixelsPerUnit);

    // The next frame is the first: no history.
    void restart() { restart_ = true; }
    // A new scene: whatever is shown next has nothing to do with what was.
    void invalidate() { drawn_.clear(); }

    uint64_t frames() const { return frames_; } // rendered so far
    bool renderedNow() const { return renderedNow_; }

private:
    enum class Drag { None, Orbit, Pan, Fly, Light };

    void navigate(Session& session, const SceneFacts& facts, const Keys& keys, float seconds, ImVec2 size);
    void render(Session& session, Renderer& renderer, Timing timing, bool always);
    void drawLight(const Session& session, ImVec2 corner, ImVec2 size) const;
    void drawTroubles(const std::vector<std::string>& shaderErrors, ImVec2 corner, ImVec2 size) const;
    void fingerprint(const Session& session, const Renderer& renderer);

    Drag drag_ = Drag::None;
    float flySpeed_ = 0.2f; // scene sizes per second
    bool restart_ = false;
    std::vector<uint32_t> now_, drawn_; // what decides the picture, as words: of this frame, of the last one rendered
    uint64_t frames_ = 0, settledFrame_ = 0;
    bool renderedNow_ = false;
    std::string trouble_; // why the last attempt to render failed
};

} // namespace penumbra
