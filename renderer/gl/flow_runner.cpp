// SPDX-License-Identifier: MIT
#include "renderer/gl/flow_runner.h"

#include "renderer/gl/debug.h"
#include "renderer/gl/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace penumbra {
namespace {

constexpr double dearFrame = 16;       // [ms]; a frame that took less goes at one go
constexpr size_t firstBandShare = 128; // of a pass whose pace is not known, and
constexpr size_t fewestFirst = 16;     // groups of texels at least
constexpr size_t bandGrowth = 4;

constexpr double forever = std::numeric_limits<double>::infinity();

struct Groups {
    size_t width, height, layers;
    explicit Groups(const Extent& extent)
        : width(static_cast<size_t>((extent.width + groupSide - 1) / groupSide))
        , height(static_cast<size_t>((extent.height + groupSide - 1) / groupSide))
        , layers(static_cast<size_t>(extent.layers)) {}
    size_t count() const { return width * height * layers; }
};
// What a pass can be divided into: groups of texels or pieces of geometry.
size_t partsOf(const Flow& flow, const Flow::PassNode& pass) {
    if (const Compute* compute = std::get_if<Compute>(&pass.work)) {
        if (!compute->over) return Groups(flow.spec(pass.writes[0]).extent).count();
        const Flow::TileNode& tiles = flow.node(*compute->over);
        return static_cast<size_t>(tiles.width) * static_cast<size_t>(tiles.height);
    }
    const Draw* const draw = std::get_if<Draw>(&pass.work);
    return draw && draw->geometry ? draw->geometry->pieces() : 1;
}

// Of a pass that has a shader.
struct ShaderChoice {
    std::string_view shader;
    const Defines& defines;
};
ShaderChoice shaderOf(const Work& work) {
    if (const Draw* draw = std::get_if<Draw>(&work)) return {draw->shader, draw->defines};
    if (const PoseVertices* pose = std::get_if<PoseVertices>(&work)) return {pose->shader, pose->defines};
    const Compute& compute = std::get<Compute>(work);
    return {compute.shader, compute.defines};
}

} // namespace

FlowRunner::FlowRunner(ProgramLibrary& programs) : programs_(programs) {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    framebuffer_ = Handle<destroyFramebuffer>(name);
    glObjectLabel(GL_FRAMEBUFFER, name, -1, "draw passes");
}

FlowRunner::~FlowRunner() {
    if (fence_) glDeleteSync(fence_);
}

int FlowRunner::turnOf(const Flow::ImageNode& node) const {
    if (node.repeat > 0) return (node.repeat - 1) % 2;
    return node.kept ? turn_ : 0;
}

const FlowRunner::Slot* FlowRunner::find(int label, int turn) const {
    for (const auto& slot : slots_)
        if (slot->label == label && slot->turn == turn) return slot.get();
    return nullptr;
}

void FlowRunner::allocate(const Flow& flow, int label, int turn, const ImageSpec& spec, bool clear) {
    Slot* slot = const_cast<Slot*>(find(label, turn));
    if (slot && slot->spec.sameStorage(spec)) {
        slot->lastUsed = frame_;
        if (clear) slot->texture->clear();
        return;
    }
    auto texture = std::make_shared<Texture>(flow.label(label), spec.format, spec.extent);
    if (clear) texture->clear();
    if (slot) {
        slot->spec = spec;
        slot->texture = std::move(texture);
        slot->lastUsed = frame_;
        slot->supplied.reset();
    } else {
        slots_.push_back(std::make_unique<Slot>(Slot{label, turn, spec, std::move(texture), frame_}));
    }
}

const FlowRunner::Slot& FlowRunner::slotOf(const Flow& flow, Image image) const {
    const Flow::ImageNode& node = flow.node(image);
    const Slot* slot = find(node.label, turnOf(node));
    ensure(slot, "an image was asked for that no pass has written");
    return *slot;
}

const Texture& FlowRunner::texture(const Flow& flow, Image image) const { return *slotOf(flow, image).texture; }

std::shared_ptr<const Texture> FlowRunner::share(const Flow& flow, Image image) const {
    return slotOf(flow, image).texture;
}

const Texture& FlowRunner::texture(const Flow& flow, PastImage image) const {
    const Flow::PastNode& node = flow.pasts()[static_cast<size_t>(image.index())];
    const Slot* slot = find(node.label, 1 - turn_);
    ensure(slot, "a past image was asked for that was not allocated");
    return *slot->texture;
}

const Program& FlowRunner::program(const Flow::PassNode& pass, const char* variant) {
    const Draw* draw = std::get_if<Draw>(&pass.work);
    const ProgramKind kind = draw ? ProgramKind::Raster : ProgramKind::Compute;
    const ShaderChoice choice = shaderOf(pass.work);
    Defines defines = choice.defines;
    if (variant) defines.push_back({variant});
    if (draw && draw->geometry && draw->geometry->hasColours()) defines.push_back({"VERTEX_COLOURS"});
    return programs_.get(kind, choice.shader, defines, pass.parameters);
}

void FlowRunner::bindReads(const Flow& flow, const Flow::PassNode& pass, const Program& program) {
    for (const Read& read : pass.reads)
        ensure(program.mentions(read.sampler), "a pass reads an image that its shader never mentions");
    for (const Program::Binding& sampler : program.samplers()) {
        const auto read = std::find_if(pass.reads.begin(), pass.reads.end(),
                                       [&](const Read& r) { return r.sampler == sampler.name; });
        if (read == pass.reads.end()) {
            ensure(std::holds_alternative<Draw>(pass.work), "a shader samples an image that its pass does not read");
            continue; // a material's texture, bound by the geometry
        }
        const Image* image = std::get_if<Image>(&read->image);
        const Texture& texture =
            image ? this->texture(flow, *image) : this->texture(flow, std::get<PastImage>(read->image));
        glBindTextureUnit(sampler.unit, texture.name());
        glBindSampler(sampler.unit, samplers_.get(read->sampling, read->anisotropy));
    }
    if (pass.constants.size()) uniforms_.bind(0, at_.constants, pass.constants.size());
    if (!pass.parameterBlock.empty()) uniforms_.bind(1, at_.parameters, pass.parameterBlock.size() * sizeof(uint32_t));
}

void FlowRunner::bindWrites(const Flow& flow, const Flow::PassNode& pass, const Program& program) {
    for (const Program::Binding& image : program.images()) {
        const auto written = std::find_if(pass.writes.begin(), pass.writes.end(),
                                          [&](Image w) { return camelCase(flow.spec(w).name) == image.name; });
        ensure(written != pass.writes.end(), "a shader stores to an image that its pass does not write");
        const Texture& texture = this->texture(flow, *written);
        glBindImageTexture(image.unit, texture.name(), 0, GL_TRUE, 0, GL_READ_WRITE,
                           glFormat(texture.format()).internal);
    }
}

// Words of the buffer that shaders/tiles.glsl describes.
enum TileWord : GLintptr { GroupsX, GroupsY, GroupsZ, Listed, Width, Height };

constexpr std::string_view listTiles = "tiles/list.glsl", cutTiles = "tiles/cut.glsl";

const Program& FlowRunner::tileProgram(std::string_view shader) {
    return programs_.get(ProgramKind::Compute, shader, {}, nullptr);
}

void FlowRunner::empty(const Flow& flow, TileSet set) {
    const Flow::TileNode& node = flow.node(set);
    auto tiles = std::find_if(tiles_.begin(), tiles_.end(), [&](const auto& t) { return t->label == node.label; });
    if (tiles == tiles_.end() || (*tiles)->width != node.width || (*tiles)->height != node.height) {
        auto made = std::make_unique<Tiles>(
            Tiles{node.label, node.width, node.height, Buffer(flow.label(node.label), node.bytes(), nullptr), frame_});
        if (tiles == tiles_.end())
            tiles = tiles_.insert(tiles, std::move(made));
        else
            *tiles = std::move(made);
    }
    (*tiles)->lastUsed = frame_;
    const GLuint buffer = (*tiles)->buffer.name();
    const GLuint zero = 0;
    glClearNamedBufferData(buffer, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
    const auto put = [&](TileWord word, int value) {
        const GLuint number = static_cast<GLuint>(value);
        glClearNamedBufferSubData(buffer, GL_R32UI, word * 4, 4, GL_RED_INTEGER, GL_UNSIGNED_INT, &number);
    };
    put(Width, node.width), put(Height, node.height);
}

const FlowRunner::Tiles& FlowRunner::tilesOf(const Flow& flow, TileSet set) const {
    const auto tiles =
        std::find_if(tiles_.begin(), tiles_.end(), [&](const auto& t) { return t->label == flow.node(set).label; });
    ensure(tiles != tiles_.end(), "a set of tiles was not allocated");
    return **tiles;
}

void FlowRunner::bindTiles(const Flow& flow, const Flow::PassNode& pass, const Program& program) {
    for (const Program::Binding& binding : program.tileSets()) {
        const Compute& compute = std::get<Compute>(pass.work);
        std::optional<TileSet> set;
        if (binding.name == "over") set = compute.over;
        for (const TileSet marked : pass.marks)
            if (flow.node(marked).name == binding.name) set = marked;
        ensure(set.has_value(), "a shader marks tiles of a set that its pass does not name");
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding.unit, tilesOf(flow, *set).buffer.name());
    }
}

// At most so many tiles more of those that were marked. How many there are only the GPU knows: a band past the last is
// empty.
void FlowRunner::dispatchOver(const Flow& flow, const Flow::PassNode& pass, TileSet over, size_t tiles) {
    const size_t all = partsOf(flow, pass);
    tiles = (tiles + groupSide - 1) / groupSide * groupSide; // of which each fills a row of a group
    const GLuint buffer = tilesOf(flow, over).buffer.name();
    const auto use = [&](std::string_view shader) -> const Program& {
        const Program& program = tileProgram(shader);
        glUseProgram(program.name());
        for (const Program::Binding& binding : program.tileSets())
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding.unit, buffer);
        return program;
    };
    if (at_.parts == 0) {
        use(listTiles);
        glDispatchCompute(static_cast<GLuint>((all + 63) / 64), 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    glUniform3ui(use(cutTiles).bandOrigin(), static_cast<GLuint>(at_.parts), static_cast<GLuint>(tiles), 0);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);

    const Program& program = *chosen_[at_.pass].plain;
    bindReads(flow, pass, program);
    bindWrites(flow, pass, program);
    bindTiles(flow, pass, program);
    glUseProgram(program.name());
    glUniform3ui(program.bandOrigin(), static_cast<GLuint>(at_.parts), 0, 0);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffer);
    glDispatchComputeIndirect(GroupsX * 4);
    at_.lastParts = std::min(tiles, all - at_.parts);
}

// At most so many groups more of a compute pass: all, some rows of a layer or a part of a row.
void FlowRunner::dispatch(const Flow& flow, const Flow::PassNode& pass, size_t groups) {
    const Program& program = *chosen_[at_.pass].plain;
    bindTiles(flow, pass, program);
    bindReads(flow, pass, program);
    bindWrites(flow, pass, program);
    const Groups all(flow.spec(pass.writes[0]).extent);
    const size_t x = at_.parts % all.width, y = at_.parts / all.width % all.height,
                 layer = at_.parts / (all.width * all.height);
    Groups band = all;
    if (at_.parts > 0 || groups < all.count()) {
        band.width = x > 0 || groups < all.width ? std::min(groups, all.width - x) : all.width;
        band.height = std::clamp<size_t>(band.width < all.width ? 1 : groups / all.width, 1, all.height - y);
        band.layers = 1;
    }
    glUseProgram(program.name());
    if (program.bandOrigin() >= 0)
        glUniform3ui(program.bandOrigin(), static_cast<GLuint>(x) * groupSide, static_cast<GLuint>(y) * groupSide,
                     static_cast<GLuint>(layer));
    glDispatchCompute(static_cast<GLuint>(band.width), static_cast<GLuint>(band.height),
                      static_cast<GLuint>(band.layers));
    at_.lastParts = band.count();
}

void FlowRunner::supply(const Flow& flow, const Flow::PassNode& pass, const Supply& work) {
    Slot& slot = const_cast<Slot&>(slotOf(flow, pass.writes[0]));
    if (slot.supplied == work.texels) return;
    const Extent& extent = slot.spec.extent;
    ensure(work.texels->size() == static_cast<size_t>(extent.width) * static_cast<size_t>(extent.height) *
                                      static_cast<size_t>(info(slot.spec.format).channels),
           "supplied texels do not fill their image");
    const GlFormat format = glFormat(slot.spec.format);
    glTextureSubImage2D(slot.texture->name(), 0, 0, 0, extent.width, extent.height, format.layout, GL_FLOAT,
                        work.texels->data());
    slot.supplied = work.texels;
}

// At most so many pieces more.
void FlowRunner::runDraw(const Flow& flow, const Flow::PassNode& pass, const Draw& draw, size_t pieces) {
    const GLuint target = framebuffer_.get();
    GLenum buffers[4] = {GL_NONE, GL_NONE, GL_NONE, GL_NONE};
    GLsizei colours = 0;
    bool hasDepth = false;
    for (const Image image : pass.writes) {
        const Texture& texture = this->texture(flow, image);
        if (texture.format() == Format::Depth32F) {
            glNamedFramebufferTexture(target, GL_DEPTH_ATTACHMENT, texture.name(), 0);
            hasDepth = true;
        } else {
            buffers[colours] = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(colours);
            glNamedFramebufferTexture(target, buffers[colours++], texture.name(), 0);
        }
    }
    for (int i = colours; i < 4; ++i)
        glNamedFramebufferTexture(target, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i), 0, 0);
    if (!hasDepth) glNamedFramebufferTexture(target, GL_DEPTH_ATTACHMENT, 0, 0);
    glNamedFramebufferDrawBuffers(target, std::max(colours, 1), buffers);
    ensure(glCheckNamedFramebufferStatus(target, GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
           "a draw pass writes images that cannot be drawn to together");

    const Extent& extent = flow.spec(pass.writes[0]).extent;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
    glViewport(0, 0, extent.width, extent.height);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    const auto set = [](GLenum capability, bool on) { on ? glEnable(capability) : glDisable(capability); };
    set(GL_DEPTH_TEST, hasDepth);
    glDepthFunc(draw.reversedDepth ? GL_GREATER : GL_LESS);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    set(GL_DEPTH_CLAMP, draw.depthClamp);
    glDisable(GL_SCISSOR_TEST);
    if (at_.parts == 0) {
        for (GLsizei i = 0; i < colours; ++i) glClearNamedFramebufferfv(target, GL_COLOR, i, draw.clear);
        const float far = draw.reversedDepth ? 0 : 1;
        if (hasDepth) glClearNamedFramebufferfv(target, GL_DEPTH, 0, &far);
    }
    at_.lastParts = std::min(pieces, partsOf(flow, pass) - at_.parts);

    if (draw.geometry) {
        set(GL_SCISSOR_TEST, draw.border > 0);
        glScissor(draw.border, draw.border, std::max(extent.width - 2 * draw.border, 0),
                  std::max(extent.height - 2 * draw.border, 0));
        const Programs& programs = chosen_[at_.pass];
        bindReads(flow, pass, *programs.plain);
        draw.geometry->draw(draw, {*programs.plain, *programs.textured, *programs.masked}, at_.parts, at_.lastParts);
    }
    at_.parts += at_.lastParts;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    set(GL_SCISSOR_TEST, false);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    set(GL_DEPTH_CLAMP, false);
    set(GL_DEPTH_TEST, false);
}

FlowRunner::Pace& FlowRunner::paceOf(const Flow& flow, const Flow::PassNode& pass) {
    Work work = pass.work;
    if (Draw* const draw = std::get_if<Draw>(&work)) draw->poseVersion = 0; // wherever it stands
    const Extent& extent = flow.spec(pass.writes[0]).extent;
    auto pace = std::find_if(paces_.begin(), paces_.end(), [&](const Pace& p) {
        return p.label == pass.label && p.work == work && p.extent == extent && p.parameters == pass.parameterBlock;
    });
    if (pace == paces_.end()) pace = paces_.insert(pace, {pass.label, work, extent, pass.parameterBlock, -1, frame_});
    pace->lastUsed = frame_;
    return *pace;
}

void FlowRunner::begin(const Flow& flow, Timing timing, Turn turn) {
    giveUp();
    ++frame_;
    if (turn == Turn::Next) turn_ = 1 - turn_;
    size_t uniformBytes = 0;
    chosen_.clear();
    for (const Flow::PassNode& pass : flow.passes()) {
        if (std::holds_alternative<Supply>(pass.work)) {
            chosen_.push_back({});
            continue;
        }
        const Draw* draw = std::get_if<Draw>(&pass.work);
        const Program* plain = &program(pass);
        chosen_.push_back({plain, draw && draw->textured ? &program(pass, "TEXTURED") : plain,
                           draw ? &program(pass, "MASKED") : plain});
        uniformBytes += UniformRing::aligned(pass.constants.size()) +
                        UniformRing::aligned(pass.parameterBlock.size() * sizeof(uint32_t));
    }
    for (const Flow::ImageNode& node : flow.images()) allocate(flow, node.label, turnOf(node), node.spec, false);
    for (const Flow::PastNode& node : flow.pasts()) allocate(flow, node.label, 1 - turn_, node.spec, node.age == 0);
    for (size_t i = 0; i < flow.tileSets().size(); ++i) empty(flow, flow.tileSet(i));
    if (!flow.tileSets().empty()) (void)tileProgram(listTiles), (void)tileProgram(cutTiles);

    careful_ = std::max(milliseconds_, timer_.newest().milliseconds) > dearFrame;
    for (const Flow::PassNode& pass : flow.passes())
        if (partsOf(flow, pass) > 1 && paceOf(flow, pass).milliseconds < 0) careful_ = true;
    at_ = {};
    milliseconds_ = 0;
    underWay_ = true;
    uniforms_.beginFrame(uniformBytes);
    timer_.beginFrame(timing);
}

void FlowRunner::giveUp() {
    if (underWay_) uniforms_.endFrame();
    if (fence_) glDeleteSync(std::exchange(fence_, nullptr));
    underWay_ = false;
}

// Whether the band that is under way is done; waits for it no longer than so many milliseconds.
bool FlowRunner::settled(double milliseconds) {
    if (!fence_) return true;
    const double nanoseconds = std::clamp(milliseconds, 0.0, 1e9) * 1e6;
    GLenum state = GL_TIMEOUT_EXPIRED;
    do {
        state = glClientWaitSync(fence_, GL_SYNC_FLUSH_COMMANDS_BIT, static_cast<GLuint64>(nanoseconds));
    } while (state == GL_TIMEOUT_EXPIRED && milliseconds == forever);
    if (state == GL_TIMEOUT_EXPIRED) return false;
    glDeleteSync(std::exchange(fence_, nullptr));
    at_.lastMilliseconds = std::chrono::duration<double, std::milli>(Clock::now() - bandStart_).count();
    at_.dearest = std::max(at_.dearest, at_.lastMilliseconds / static_cast<double>(at_.lastParts));
    milliseconds_ += at_.lastMilliseconds;
    return true;
}

// How many parts of the pass under way should fit into the time.
size_t FlowRunner::nextBand(size_t all, size_t fewest, double millisecondsLeft) const {
    const double known = at_.pace->milliseconds;
    if (at_.parts == 0 && known < 0) return std::max(fewest, all / firstBandShare);
    const double last = at_.parts == 0 ? 0 : at_.lastMilliseconds / static_cast<double>(at_.lastParts);
    const double fitting = std::max(millisecondsLeft, 0.0) / std::max({known, last, 1e-9});
    const size_t parts = fitting < static_cast<double>(all) ? static_cast<size_t>(fitting) : all;
    return std::clamp<size_t>(known < 0 ? std::min(parts, bandGrowth * at_.parts) : parts, 1, all);
}

// A whole pass or, in as many milliseconds, a band of it; a shader that does not know where a band begins runs whole.
void FlowRunner::runPart(const Flow& flow, std::optional<double> millisecondsLeft) {
    const Flow::PassNode& pass = flow.passes()[at_.pass];
    const DebugGroup group(flow.label(pass.label));
    if (at_.parts == 0) {
        at_.constants = uniforms_.put(pass.constants.data(), pass.constants.size());
        at_.parameters = uniforms_.put(pass.parameterBlock.data(), pass.parameterBlock.size() * sizeof(uint32_t));
    }
    if (millisecondsLeft) timer_.resume();
    bandStart_ = Clock::now();
    const size_t all = partsOf(flow, pass);
    if (at_.parts == 0 && all > 1) at_.pace = &paceOf(flow, pass);
    if (const Draw* draw = std::get_if<Draw>(&pass.work)) {
        runDraw(flow, pass, *draw, millisecondsLeft && all > 1 ? nextBand(all, 1, *millisecondsLeft) : all);
    } else if (const PoseVertices* poseVertices = std::get_if<PoseVertices>(&pass.work)) {
        poseVertices->geometry->pose(*chosen_[at_.pass].plain);
        at_.parts = at_.lastParts = 1;
    } else if (const Supply* supplied = std::get_if<Supply>(&pass.work)) {
        supply(flow, pass, *supplied);
        at_.parts = at_.lastParts = 1;
    } else {
        const bool divisible = chosen_[at_.pass].plain->bandOrigin() >= 0 && all > 1;
        const size_t groups = millisecondsLeft && divisible ? nextBand(all, fewestFirst, *millisecondsLeft) : all;
        const Compute& compute = std::get<Compute>(pass.work);
        if (compute.over)
            dispatchOver(flow, pass, *compute.over, groups);
        else
            dispatch(flow, pass, groups);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                        GL_TEXTURE_UPDATE_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
        at_.parts += at_.lastParts;
    }
    if (at_.parts == all)
        for (const Image image : pass.writes)
            if (flow.spec(image).extent.levels > 1) glGenerateTextureMipmap(texture(flow, image).name());
    timer_.endPass(pass.stage, pass.label);
    if (millisecondsLeft) fence_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

// Of tiles, those of one frame may be few and those of the next many: their pace is that of the dearest frame.
double FlowRunner::paceAfter(const Flow::PassNode& pass) const {
    const Compute* compute = std::get_if<Compute>(&pass.work);
    return compute && compute->over ? std::max(at_.pace->milliseconds, at_.dearest) : at_.dearest;
}

bool FlowRunner::step(const Flow& flow, double milliseconds) {
    ensure(underWay_, "a step of no frame");
    const bool bands = careful_ && std::isfinite(milliseconds);
    const Clock::time_point start = Clock::now();
    const auto spent = [&] { return std::chrono::duration<double, std::milli>(Clock::now() - start).count(); };
    constexpr double mostlySpent = 0.8; // what is left then is too little for a band
    for (bool begun = false; settled(bands ? milliseconds - spent() : forever); begun = true) {
        if (at_.pass < flow.passes().size() && at_.parts == partsOf(flow, flow.passes()[at_.pass])) {
            if (at_.pace && bands) at_.pace->milliseconds = paceAfter(flow.passes()[at_.pass]);
            at_ = {.pass = at_.pass + 1};
        }
        underWay_ = at_.pass < flow.passes().size();
        if (!underWay_ || (begun && bands && spent() > mostlySpent * milliseconds)) break;
        runPart(flow, bands ? std::optional(milliseconds - spent()) : std::nullopt);
    }
    for (GLuint unit = 0; unit < 16; ++unit) glBindSampler(unit, 0);
    if (underWay_) return false;
    timer_.endFrame();
    uniforms_.endFrame();
    std::erase_if(slots_, [&](const std::unique_ptr<Slot>& slot) { return slot->lastUsed != frame_; });
    std::erase_if(tiles_, [&](const std::unique_ptr<Tiles>& tiles) { return tiles->lastUsed != frame_; });
    std::erase_if(paces_, [&](const Pace& pace) { return pace.lastUsed != frame_; });
    return true;
}

void FlowRunner::run(const Flow& flow, Timing timing) {
    begin(flow, timing);
    step(flow, forever);
}

} // namespace penumbra
