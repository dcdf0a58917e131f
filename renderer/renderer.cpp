// SPDX-License-Identifier: MIT
#include "renderer/renderer.h"

#include "renderer/scene/gpu_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace penumbra {

namespace {

// The driver in words; throws InputError if it is not OpenGL 4.5.
std::string checkedDriver() {
    const auto text = [](GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); };
    if (!epoxy_is_desktop_gl() || epoxy_gl_version() < 45)
        throw InputError(
            fmt::format("OpenGL 4.5 is needed, this driver gives {} ({})", text(GL_VERSION), text(GL_RENDERER)));
    return fmt::format("{}, {}", text(GL_RENDERER), text(GL_VERSION));
}

} // namespace

PreparedScene::PreparedScene(std::shared_ptr<const Scene> scene, Progress* progress) : scene_(std::move(scene)) {
    state_.setScene(scene_);
    state_.update(0, 0, false);
    geometry_ = std::make_shared<GpuScene>(state_, progress);
    state_.restart();
}
PreparedScene::~PreparedScene() = default;
PreparedScene::PreparedScene(PreparedScene&&) noexcept = default;
PreparedScene& PreparedScene::operator=(PreparedScene&&) noexcept = default;

PreparedScene PreparedScene::shared() const {
    PreparedScene other;
    other.scene_ = scene_;
    other.state_ = state_;
    other.state_.restart();
    other.geometry_ = geometry_;
    return other;
}

Renderer::Renderer() : Renderer(checkedDriver(), std::make_shared<ProgramLibrary>(shaderFolder())) {}

Renderer::Renderer(std::string driver, std::shared_ptr<ProgramLibrary> programs)
    : driver_(std::move(driver))
    , programs_(std::move(programs)) {
    for (const std::string_view name : {"llvmpipe", "softpipe", "SWR"})
        software_ = software_ || driver_.find(name) != std::string::npos;
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

Renderer::~Renderer() = default;

std::unique_ptr<Renderer> Renderer::sibling(bool sharesScene) const {
    std::unique_ptr<Renderer> other(new Renderer(driver_, programs_));
    if (sharesScene && drawn_) other->take(drawn_->shared());
    return other;
}

void Renderer::reset() {
    flow_.forget();
    if (drawn_) drawn_->state_.restart();
    past_.reset();
    last_.reset();
}

void Renderer::render(const Session& session, Timing timing, Turn turn) {
    begin(session, timing, turn);
    advance(std::numeric_limits<double>::infinity());
}

// Takes over the session's scene as it is at its time.
void Renderer::adopt(const Session& session, Turn turn) {
    if (!drawn_ || drawn_->scene_ != session.scene) {
        if (!next_ || next_->scene_ != session.scene) next_.emplace(session.scene);
        drawn_ = std::move(next_);
        next_.reset();
        reset();
    }
    SceneState& state = drawn_->state_;
    state.update(session.clip, session.time, session.ground, turn);
    drawn_->geometry_->update(state);
}

std::vector<LightLayer> Renderer::renderFromLight(const Session& session, int size, int layers) {
    adopt(session, Turn::Next);
    frame_.reset();
    picture_.reset();
    past_.reset();
    last_.reset();
    flow_.begin();
    try {
        const std::vector<LightLayer> drawn =
            buildLightLayers(flow_, session, drawn_->state_, drawn_->geometry_.get(), size, layers);
        flow_.refuseAbove(session.textureLimit);
        runner_.begin(flow_, Timing::Off);
        runner_.step(flow_, std::numeric_limits<double>::infinity());
        return drawn;
    } catch (...) {
        fail();
        throw;
    }
}

void Renderer::begin(const Session& session, Timing timing, Turn turn) {
    adopt(session, turn);
    view_ = sessionView(session, drawn_->state_.bounds());
    if (turn == Turn::Next) past_ = last_;
    inspected_ = inspection_;
    flow_.begin(turn);
    try {
        frame_ =
            buildFrame(flow_, session, drawn_->state_, drawn_->geometry_.get(), past_ ? &*past_ : nullptr, inspection_);
        flow_.refuseAbove(session.textureLimit);
        runner_.begin(flow_, timing, turn);
    } catch (...) {
        fail();
        throw;
    }
    last_ = {view_, session.light};
    for (const FurtherLight& light : session.furtherLights) last_->furtherLights.push_back(light);
}

bool Renderer::advance(double milliseconds) {
    try {
        if (!runner_.step(flow_, milliseconds)) return false;
    } catch (...) {
        fail();
        throw;
    }
    picture_ = runner_.share(flow_, frame_->display);
    return true;
}

// Nothing of the frame is of use.
void Renderer::fail() {
    reset();
    runner_.giveUp();
    drawn_->state_.restart();
    frame_.reset();
    picture_.reset();
}

std::optional<glm::vec3> Renderer::surfaceAt(glm::ivec2 pixel) const {
    if (!picture_ || underWay()) return std::nullopt;
    const glm::ivec2 fromBelow(pixel.x, view_.size.y - 1 - pixel.y);
    if (glm::any(glm::lessThan(fromBelow, glm::ivec2(0))) || glm::any(glm::greaterThanEqual(fromBelow, view_.size)))
        return std::nullopt;
    const Texture& depths = runner_.texture(flow_, frame_->depth);
    const glm::ivec2 texel = fromBelow + (glm::ivec2(depths.extent().width, depths.extent().height) - view_.size) / 2;
    const float depth = depths.readTexel(texel.x, texel.y);
    if (!(depth > 0)) return std::nullopt;
    const glm::vec2 centre = glm::vec2(fromBelow) + 0.5f;
    return view_.eyeWorld + depth * (view_.rayCorner + centre.x * view_.rayDx + centre.y * view_.rayDy);
}

Renderer::Pixels Renderer::read(Image image, int layer, int level) const {
    const Texture& texture = runner_.texture(flow_, image);
    const Extent& extent = texture.extent();
    ensure(layer >= 0 && layer < extent.layers && level >= 0 && level < extent.levels,
           "a layer or level that is not there");
    Pixels pixels{std::max(extent.width >> level, 1), std::max(extent.height >> level, 1),
                  info(texture.format()).channels, texture.read(layer, level)};
    const auto row = static_cast<std::ptrdiff_t>(pixels.width) * pixels.channels;
    for (std::ptrdiff_t low = 0, high = pixels.height - 1; low < high; ++low, --high)
        std::swap_ranges(pixels.values.begin() + low * row, pixels.values.begin() + (low + 1) * row,
                         pixels.values.begin() + high * row);
    return pixels;
}

Renderer::Pixels Renderer::readPicture(Image image) const {
    Pixels pixels = read(image);
    const glm::ivec2 margin = (glm::ivec2(pixels.width, pixels.height) - view_.size) / 2;
    if (margin == glm::ivec2(0)) return pixels;
    Pixels picture{view_.size.x, view_.size.y, pixels.channels, {}};
    const auto row = static_cast<std::ptrdiff_t>(pixels.width) * pixels.channels;
    for (int y = 0; y < view_.size.y; ++y) {
        const auto first = pixels.values.begin() + (y + margin.y) * row + margin.x * pixels.channels;
        picture.values.insert(picture.values.end(), first, first + view_.size.x * pixels.channels);
    }
    return picture;
}

} // namespace penumbra
