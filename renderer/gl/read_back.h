// SPDX-License-Identifier: MIT
// Reads textures back while the frames go on.
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"

#include <utility>
#include <vector>

namespace penumbra {

// The first channel of a texture, as floats, row 0 below. One at a time.
class ReadBack {
public:
    ReadBack() = default;
    ~ReadBack() { forget(); }
    ReadBack(const ReadBack&) = delete;

    void start(const Texture& texture);
    bool underWay() const { return fence_ != nullptr; }
    // True if the texels have come; they replace what `values` holds. Never waits.
    bool take(std::vector<float>& values);
    void forget();

private:
    Buffer buffer_;
    size_t count_ = 0;
    GLsync fence_ = nullptr;
};

} // namespace penumbra
