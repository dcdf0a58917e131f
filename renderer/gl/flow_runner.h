// SPDX-License-Identifier: MIT
// Carries out a flow: allocates its images, compiles its programs, runs its passes under debug groups and timers.
#pragma once

#include "renderer/core/flow.h"
#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/timer.h"

#include <memory>
#include <vector>

namespace penumbra {

class FlowRunner {
public:
    explicit FlowRunner(ProgramLibrary& programs);

    // Compiles and allocates what is new, then runs every pass; textures that no pass used any more are freed. If
    // something cannot be had (a shader that does not compile, a texture too large) it throws before any pass has run.
    void run(const Flow& flow, Timing timing);

    // The texture that holds an image of the flow that ran last; or last frame's image as that flow read it.
    const Texture& texture(const Flow& flow, Image image) const;
    const Texture& texture(const Flow& flow, PastImage image) const;

    const PassTimer& timer() const { return timer_; }
    void pollTimes() { timer_.poll(); }

private:
    struct Slot {
        int label;
        int turn; // rounds of a repeat, and frames of a kept image, take turns between 0 and 1
        ImageSpec spec;
        Texture texture;
        uint64_t lastUsed;
    };
    static void destroyFramebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }

    int turnOf(const Flow::ImageNode& node) const;
    const Slot* find(int label, int turn) const;
    void allocate(const Flow& flow, int label, int turn, const ImageSpec& spec, bool clear);
    const Program& program(const Flow::PassNode& pass, const char* variant = nullptr); // with a define more
    void bindReads(const Flow& flow, const Flow::PassNode& pass, const Program& program);
    void runCompute(const Flow& flow, const Flow::PassNode& pass);
    void runDraw(const Flow& flow, const Flow::PassNode& pass, const Draw& draw);

    ProgramLibrary& programs_;
    Samplers samplers_;
    std::vector<std::unique_ptr<Slot>> slots_;
    UniformRing uniforms_;
    Handle<destroyFramebuffer> framebuffer_;
    PassTimer timer_;
    uint64_t frame_ = 0;
};

} // namespace penumbra
