// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/core/flow.h"
#include "renderer/gl/program.h"

namespace penumbra {

// Something with triangles that a Draw pass sends through the rasteriser, with the attributes of shaders/draws.glsl.
class Geometry {
public:
    // The variants of a pass's program: as it is; with TEXTURED defined, for base colours that have a texture (the same
    // program where Draw::textured is off); with MASKED defined, which discards where the base colour's alpha is below
    // the cutoff.
    struct Programs {
        const Program& plain;
        const Program& textured;
        const Program& masked;
    };
    virtual ~Geometry() = default;
    // Whether vertices have colours of their own: VERTEX_COLOURS is then defined in every variant.
    virtual bool hasColours() const { return false; }
    // Works out the vertices that skins and morph targets move, by a compute program.
    virtual void pose(const Program&) const {}
    // The pieces that draw() can be told to begin and end with, of some thousand triangles at most. At least one.
    virtual size_t pieces() const = 0;
    virtual void draw(const Draw& draw, const Programs& programs, size_t firstPiece, size_t pieces) const = 0;
};

} // namespace penumbra
