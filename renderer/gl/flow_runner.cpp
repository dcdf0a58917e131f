// SPDX-License-Identifier: MIT
#include "renderer/gl/flow_runner.h"

#include "renderer/gl/debug.h"
#include "renderer/gl/geometry.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra {
namespace {

constexpr int groupSize = 8; // compute shaders work in groups of 8x8

const Defines& definesOf(const Work& work) {
    return std::visit([](const auto& w) -> const Defines& { return w.defines; }, work);
}

std::string_view shaderOf(const Work& work) {
    return std::visit([](const auto& w) { return w.shader; }, work);
}

} // namespace

FlowRunner::FlowRunner(ProgramLibrary& programs) : programs_(programs) {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    framebuffer_ = Handle<destroyFramebuffer>(name);
    glObjectLabel(GL_FRAMEBUFFER, name, -1, "draw passes");
}

int FlowRunner::turnOf(const Flow::ImageNode& node) const {
    if (node.repeat > 0) return (node.repeat - 1) % 2;
    return node.kept ? static_cast<int>(frame_ % 2) : 0;
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
        if (clear) slot->texture.clear();
        return;
    }
    Texture texture(flow.label(label), spec.format, spec.extent);
    if (clear) texture.clear();
    if (slot) {
        slot->spec = spec;
        slot->texture = std::move(texture);
        slot->lastUsed = frame_;
    } else {
        slots_.push_back(std::make_unique<Slot>(Slot{label, turn, spec, std::move(texture), frame_}));
    }
}

const Texture& FlowRunner::texture(const Flow& flow, Image image) const {
    const Flow::ImageNode& node = flow.node(image);
    const Slot* slot = find(node.label, turnOf(node));
    ensure(slot, "an image was asked for that no pass has written");
    return slot->texture;
}

const Texture& FlowRunner::texture(const Flow& flow, PastImage image) const {
    const Flow::PastNode& node = flow.pasts()[static_cast<size_t>(image.index())];
    const Slot* slot = find(node.label, static_cast<int>((frame_ + 1) % 2));
    ensure(slot, "a past image was asked for that was not allocated");
    return slot->texture;
}

const Program& FlowRunner::program(const Flow::PassNode& pass, const char* variant) {
    const Draw* draw = std::get_if<Draw>(&pass.work);
    const ProgramKind kind = draw ? ProgramKind::Raster : ProgramKind::Compute;
    Defines defines = definesOf(pass.work);
    if (variant) defines.push_back({variant});
    if (draw && draw->geometry && draw->geometry->hasColours()) defines.push_back({"VERTEX_COLOURS"});
    return programs_.get(kind, shaderOf(pass.work), defines, pass.parameters);
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
        glBindSampler(sampler.unit, samplers_.get(read->sampling));
    }
    if (pass.constants.size()) uniforms_.bind(0, pass.constants.data(), pass.constants.size());
    if (!pass.parameterBlock.empty())
        uniforms_.bind(1, pass.parameterBlock.data(), pass.parameterBlock.size() * sizeof(uint32_t));
}

void FlowRunner::runCompute(const Flow& flow, const Flow::PassNode& pass) {
    const Program& program = this->program(pass);
    bindReads(flow, pass, program);
    for (const Program::Binding& image : program.images()) {
        const auto written = std::find_if(pass.writes.begin(), pass.writes.end(),
                                          [&](Image w) { return camelCase(flow.spec(w).name) == image.name; });
        ensure(written != pass.writes.end(), "a shader stores to an image that its pass does not write");
        const Texture& texture = this->texture(flow, *written);
        glBindImageTexture(image.unit, texture.name(), 0, GL_TRUE, 0, GL_READ_WRITE,
                           glFormat(texture.format()).internal);
    }
    const Extent& extent = flow.spec(pass.writes[0]).extent;
    glUseProgram(program.name());
    glDispatchCompute(static_cast<GLuint>((extent.width + groupSize - 1) / groupSize),
                      static_cast<GLuint>((extent.height + groupSize - 1) / groupSize),
                      static_cast<GLuint>(extent.layers));
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                    GL_FRAMEBUFFER_BARRIER_BIT);
}

void FlowRunner::runDraw(const Flow& flow, const Flow::PassNode& pass, const Draw& draw) {
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
    for (GLsizei i = 0; i < colours; ++i) glClearNamedFramebufferfv(target, GL_COLOR, i, draw.clear);
    const float far = draw.reversedDepth ? 0 : 1;
    if (hasDepth) glClearNamedFramebufferfv(target, GL_DEPTH, 0, &far);

    if (draw.geometry) {
        set(GL_SCISSOR_TEST, draw.border > 0);
        glScissor(draw.border, draw.border, std::max(extent.width - 2 * draw.border, 0),
                  std::max(extent.height - 2 * draw.border, 0));
        bindReads(flow, pass, program(pass));
        draw.geometry->draw(
            draw, {program(pass), program(pass, draw.textured ? "TEXTURED" : nullptr), program(pass, "MASKED")});
    }
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    set(GL_SCISSOR_TEST, false);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    set(GL_DEPTH_CLAMP, false);
    set(GL_DEPTH_TEST, false);
}

void FlowRunner::run(const Flow& flow, Timing timing) {
    ++frame_;
    size_t uniformBytes = 0;
    for (const Flow::PassNode& pass : flow.passes()) {
        program(pass);
        if (const Draw* draw = std::get_if<Draw>(&pass.work)) {
            program(pass, "MASKED");
            if (draw->textured) program(pass, "TEXTURED");
        }
        uniformBytes += UniformRing::aligned(pass.constants.size()) +
                        UniformRing::aligned(pass.parameterBlock.size() * sizeof(uint32_t));
    }
    for (const Flow::ImageNode& node : flow.images()) allocate(flow, node.label, turnOf(node), node.spec, false);
    for (const Flow::PastNode& node : flow.pasts())
        allocate(flow, node.label, static_cast<int>((frame_ + 1) % 2), node.spec, !node.valid);

    uniforms_.beginFrame(uniformBytes);
    timer_.beginFrame(timing);
    for (const Flow::PassNode& pass : flow.passes()) {
        const DebugGroup group(flow.label(pass.label));
        if (const Draw* draw = std::get_if<Draw>(&pass.work))
            runDraw(flow, pass, *draw);
        else if (const PoseVertices* pose = std::get_if<PoseVertices>(&pass.work))
            pose->geometry->pose(program(pass));
        else
            runCompute(flow, pass);
        timer_.endPass(pass.stage, pass.label);
    }
    timer_.endFrame();
    uniforms_.endFrame();
    for (GLuint unit = 0; unit < 16; ++unit) glBindSampler(unit, 0);
    std::erase_if(slots_, [&](const std::unique_ptr<Slot>& slot) { return slot->lastUsed != frame_; });
}

} // namespace penumbra
