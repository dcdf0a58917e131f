// SPDX-License-Identifier: MIT
// Ray traces the truth in rounds, each of which leaves a picture.
#pragma once

#include "renderer/truth/casters.h"
#include "renderer/truth/crew.h"
#include "renderer/truth/truth.h"

#include <array>

namespace penumbra {

class Tracer {
public:
    Tracer(const TruthInput& input, const TruthSettings& settings, const Casters& casters, Crew& crew);

    // Traces another round. False: all is done. Throws Cancelled within some milliseconds of being told so.
    bool next(Progress* progress);
    // Of all rounds so far.
    const Truth& truth() const { return truth_; }

private:
    // A pixel from which rays are needed.
    struct Point {
        glm::vec3 originWorld;
        glm::vec3 normalWorld; // for pixels whose horizon cuts the light, else zero
        uint32_t pixel;
        uint32_t rays = 0;   // traced so far
        uint32_t wanted = 0; // to be traced when this round is over
        std::array<uint16_t, truthReplicates> hidden{};
    };
    void findPoints();
    size_t blockOf(uint32_t pixel) const;
    void askOfBlocks();
    void askAll();
    void dropCertain();
    void trace(Point& point) const;
    double shareDone(uint64_t rays) const; // of all rays, as far as can be foreseen
    void estimate();
    bool plan();

    const TruthInput& input_;
    const TruthSettings settings_;
    const Casters& casters_;
    Crew& crew_;
    glm::vec3 lightCentre_, lightX_, lightY_; // world: a sample is at lightCentre_ + x lightX_ + y lightY_
    bool directional_ = false, round_ = false;
    glm::vec2 halfLight_{0};
    std::vector<float> haltonX_, haltonY_;
    std::vector<Point> points_;          // in small squares of pixels
    std::vector<uint32_t> squares_;      // the first of the points of each, and their end; before any is dropped
    std::vector<uint32_t> unfinished_;   // of points_, this round
    std::vector<uint32_t> pixelOfBlock_; // of each 2x2 pixels the one that is traced first
    uint32_t raysOfAll_ = 0;             // that every point has had, or has this round
    std::vector<float> spread_;          // by pixel; see plan()
    Truth truth_;
    size_t asked_ = 0; // how many points there were at first
    uint64_t raysTraced_ = 0, raysForeseen_ = 0;
};

// The share of the light that `hidden` of `rays` say is not seen, and its standard error; see tracer.cpp.
struct Estimate {
    float psi, standardError;
};
Estimate estimateOf(const std::array<uint16_t, truthReplicates>& hidden, uint32_t rays);

// The surface point that a pixel shows [m].
glm::vec3 positionWorld(const TruthInput& input, size_t pixel);
// And the unit normal there, towards the viewer.
glm::vec3 normalWorld(const TruthInput& input, size_t pixel);

std::vector<PixelClass> classesOf(const TruthInput& input);
// How a surface point stands to a light. `normalLight` is unit.
PixelClass classify(const AreaLight& light, glm::vec3 positionLight, glm::vec3 normalLight);

} // namespace penumbra
