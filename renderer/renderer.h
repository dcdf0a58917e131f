// SPDX-License-Identifier: MIT
// Draws sessions. Needs a current OpenGL 4.5 context; knows no window.
#pragma once

#include "renderer/core/paths.h"
#include "renderer/frame.h"
#include "renderer/gl/flow_runner.h"

#include <optional>
#include <string>
#include <vector>

namespace penumbra {

class GpuScene;

// A scene that is ready to be drawn: its vertices and textures are on the GPU. Made in the context that will draw it,
// or in one that shares its objects, on any thread.
class PreparedScene {
public:
    explicit PreparedScene(std::shared_ptr<const Scene> scene, Progress* progress = nullptr); // may throw Cancelled
    ~PreparedScene();
    PreparedScene(PreparedScene&&) noexcept;
    PreparedScene& operator=(PreparedScene&&) noexcept;
    PreparedScene shared() const; // the same vertices and textures
    const std::shared_ptr<const Scene>& scene() const { return scene_; }

private:
    friend class Renderer;
    PreparedScene() = default;
    std::shared_ptr<const Scene> scene_;
    SceneState state_;
    std::shared_ptr<GpuScene> geometry_;
};

class Renderer {
public:
    Renderer(); // throws InputError if the context is not OpenGL 4.5
    ~Renderer();
    // Another one with images and a history of its own, that shares the programs and, if it `sharesScene`, this one's
    // copy of the scene; that must not be done where vertices move, since each copy holds one moment.
    std::unique_ptr<Renderer> sibling(bool sharesScene) const;

    // Draws one frame of the session at session.size. Throws InputError, before anything is drawn, if it would hold
    // more textures than session.textureLimit or one that the driver cannot have. There is no frame to look at then,
    // and the next one is a first one.
    void render(const Session& session, Timing timing = Timing::Off, Turn turn = Turn::Next);
    // The same in parts, for those who must not be kept waiting: begin() takes over what the session says now, and each
    // advance() goes on for about so long; true when the frame is finished. Until then the images are partly those of
    // the frame before, but picture() is whole.
    void begin(const Session& session, Timing timing, Turn turn = Turn::Next);
    bool advance(double milliseconds);
    // Draws ψ on what a directional light sees instead of a frame (frame.h): there are images but no picture.
    std::vector<LightLayer> renderFromLight(const Session& session, int size, int layers);
    bool underWay() const { return runner_.underWay(); }
    // The next session that shows this scene finds it ready; a scene that nobody prepared is prepared by render().
    void take(PreparedScene prepared) { next_ = std::move(prepared); }
    // Drops all history: the next frame is the first.
    void reset();
    // What the next frames are looked into for.
    void inspect(const Inspection& inspection) { inspection_ = inspection; }
    const Inspection& inspection() const { return inspection_; }
    const Inspection& inspected() const { return inspected_; } // of the last frame begun

    const Flow& flow() const { return flow_; }
    const FlowRunner& runner() const { return runner_; }
    const SceneState& state() const { return drawn_->state_; } // of the scene that render() drew last
    // Whether a frame was finished and none has failed since, so that there are images.
    bool hasFrame() const { return picture_ != nullptr; }
    // Images of the last frame. `shadow` is ψ; `display` is RGBA8, sRGB encoded, row 0 below as OpenGL has it.
    Image display() const { return frame_->display; }
    Image shadow() const { return frame_->shadow; }
    const std::optional<Image>& rival() const { return frame_->rival; } // ψ of technique B
    Image depth() const { return frame_->depth; }
    const View& view() const { return view_; }
    // The display image of the frame that was finished last; null if there is none, or the last attempt failed.
    const Texture* picture() const { return picture_.get(); }
    // The surface that picture() shows at a pixel, counted from its upper left corner; nothing where there is none.
    // Reads one texel. Not while a frame is under way.
    std::optional<glm::vec3> surfaceAt(glm::ivec2 pixel) const;

    // Reads an image back: `channels` floats a texel, row 0 at the top. Stalls.
    struct Pixels {
        int width = 0, height = 0, channels = 0;
        std::vector<float> values;
    };
    Pixels read(Image image, int layer = 0, int level = 0) const;
    // The part of an image that the picture shows: those of the geometry buffer may have a margin.
    Pixels readPicture(Image image) const;

    // For passes of others than the frame's, under the same watch.
    ProgramLibrary& programs() { return *programs_; }
    // Recompiles shaders whose files changed on disk; call now and then. Errors stay until mended, one text each with
    // our file and line; the last good program runs on meanwhile.
    const std::vector<std::string>& pollShaders() { return programs_->poll(); }
    uint64_t shaderGeneration() const { return programs_->generation(); }
    // Takes in the times of frames drawn before that have come in since.
    void pollTimes() { runner_.pollTimes(); }
    bool softwareRenderer() const { return software_; }
    const std::string& driver() const { return driver_; } // "llvmpipe (...), Mesa ..."

private:
    Renderer(std::string driver, std::shared_ptr<ProgramLibrary> programs);
    void adopt(const Session& session, Turn turn);
    void fail();

    std::string driver_; // first: its initialisation refuses what is not OpenGL 4.5
    std::shared_ptr<ProgramLibrary> programs_;
    Flow flow_;
    FlowRunner runner_{*programs_};
    std::optional<PreparedScene> drawn_, next_;
    std::optional<Frame> frame_;
    std::shared_ptr<const Texture> picture_;
    View view_;                            // of the frame
    std::optional<LastFrame> past_, last_; // that the frame was built on; that the next one will be
    Inspection inspection_, inspected_;
    bool software_ = false;
};

} // namespace penumbra
