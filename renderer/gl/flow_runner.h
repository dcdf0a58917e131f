// SPDX-License-Identifier: MIT
// Carries out a flow: allocates its images, compiles its programs, runs its passes under debug groups and timers.
//
// Whoever must not be kept waiting runs a frame in steps of some milliseconds. A dear frame then goes pass by pass, and
// a dear pass in bands: as many groups of texels or pieces of geometry as should fit into what is left of the step. A
// fence behind each tells when it is done (a software renderer works within the call, a GPU behind our back), and how
// long it took is the pace of the next. Where a pass has changed since the last frame nothing is known of its pace: it
// starts with a small band, and bands grow at most fourfold, since the first rows may be cheaper than the others.
// Frames that took little and did not change run at one go and wait for nothing. The images are the same bit for bit,
// since a group does the same work in whichever dispatch it is (shaders/band.glsl) and pieces are drawn in their order;
// nobody above needs to know.
#pragma once

#include "renderer/core/flow.h"
#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/timer.h"

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

namespace penumbra {

class FlowRunner {
public:
    explicit FlowRunner(ProgramLibrary& programs);
    ~FlowRunner();

    // Compiles and allocates what is new. If something cannot be had (a shader that does not compile, a texture too
    // large) it throws before any pass has run. The flow stays as it is until the last step.
    void begin(const Flow& flow, Timing timing, Turn turn = Turn::Next);
    // Runs passes for about so long; true when all are done. Textures that no pass used any more are freed then.
    bool step(const Flow& flow, double milliseconds);
    bool underWay() const { return underWay_; }
    void giveUp(); // the frame that is under way

    // What a pass of the flow that ran last was carried out with.
    const Program& programOf(size_t pass) const { return *chosen_[pass].plain; }
    // All of it at once.
    void run(const Flow& flow, Timing timing);

    // The texture that holds an image of the flow that ran last; or last frame's image as that flow read it.
    const Texture& texture(const Flow& flow, Image image) const;
    const Texture& texture(const Flow& flow, PastImage image) const;
    // The same, to outlive the flow.
    std::shared_ptr<const Texture> share(const Flow& flow, Image image) const;

    const PassTimer& timer() const { return timer_; }
    void pollTimes() { timer_.poll(); }

private:
    struct Slot {
        int label;
        int turn; // rounds of a repeat, and frames of a kept image, take turns between 0 and 1
        ImageSpec spec;
        std::shared_ptr<Texture> texture;
        uint64_t lastUsed;
        std::shared_ptr<const std::vector<float>> supplied = {}; // what it holds, if a Supply pass writes it
    };
    struct Tiles {
        int label;
        int width, height;
        Buffer buffer; // as shaders/tiles.glsl has it
        uint64_t lastUsed;
    };
    // What was chosen for a pass when the frame began; parameters may change under way.
    struct Programs {
        const Program *plain, *textured, *masked;
    };
    // How long a group of texels or a piece of geometry takes; known of a pass that has run before as it is.
    struct Pace {
        int label;
        Work work;
        Extent extent;
        FixedVector<uint32_t, 64> parameters;
        double milliseconds; // a part of the dearest band; negative: not known yet
        uint64_t lastUsed;
    };
    // The pass that is under way, as far as it has come.
    struct Progress {
        size_t pass = 0;
        size_t parts = 0;            // done: groups of texels in rows, then layers; pieces of geometry; or the one
        double dearest = 0;          // milliseconds that a part took in the dearest band
        size_t lastParts = 0;        // of the last band
        double lastMilliseconds = 0; // that it took
        size_t constants = 0, parameters = 0; // where their bytes are
        Pace* pace = nullptr;
    };
    using Clock = std::chrono::steady_clock;
    static void destroyFramebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }

    int turnOf(const Flow::ImageNode& node) const;
    const Slot* find(int label, int turn) const;
    const Slot& slotOf(const Flow& flow, Image image) const;
    void allocate(const Flow& flow, int label, int turn, const ImageSpec& spec, bool clear);
    const Program& program(const Flow::PassNode& pass, const char* variant = nullptr); // with a define more
    void bindReads(const Flow& flow, const Flow::PassNode& pass, const Program& program);
    void bindWrites(const Flow& flow, const Flow::PassNode& pass, const Program& program);
    const Program& tileProgram(std::string_view shader);
    void empty(const Flow& flow, TileSet tiles);
    const Tiles& tilesOf(const Flow& flow, TileSet tiles) const;
    void bindTiles(const Flow& flow, const Flow::PassNode& pass, const Program& program);
    void dispatchOver(const Flow& flow, const Flow::PassNode& pass, TileSet over, size_t tiles);
    void supply(const Flow& flow, const Flow::PassNode& pass, const Supply& work);
    void runDraw(const Flow& flow, const Flow::PassNode& pass, const Draw& draw, size_t pieces);
    void dispatch(const Flow& flow, const Flow::PassNode& pass, size_t groups);
    Pace& paceOf(const Flow& flow, const Flow::PassNode& pass);
    double paceAfter(const Flow::PassNode& pass) const;
    size_t nextBand(size_t all, size_t fewest, double millisecondsLeft) const;
    void runPart(const Flow& flow, std::optional<double> millisecondsLeft);
    bool settled(double milliseconds);

    ProgramLibrary& programs_;
    Samplers samplers_;
    std::vector<std::unique_ptr<Slot>> slots_;
    std::vector<std::unique_ptr<Tiles>> tiles_;
    UniformRing uniforms_;
    Handle<destroyFramebuffer> framebuffer_;
    PassTimer timer_;
    uint64_t frame_ = 0;
    int turn_ = 0; // of the two textures of a kept image the one that is written; the other is the past

    std::vector<Programs> chosen_; // one a pass
    std::vector<Pace> paces_;
    Progress at_;
    bool underWay_ = false;
    bool careful_ = false;    // this frame may be dear: bands
    double milliseconds_ = 0; // of this frame's bands so far
    GLsync fence_ = nullptr;  // behind the band that is under way
    Clock::time_point bandStart_;
};

} // namespace penumbra
