// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/gl/handle.h"

#include <array>
#include <cstddef>
#include <string_view>

namespace penumbra {

// A labelled buffer with immutable storage.
class Buffer {
public:
    Buffer() = default;
    Buffer(std::string_view label, size_t bytes, const void* data, GLbitfield flags = 0);
    GLuint name() const { return handle_.get(); }
    size_t bytes() const { return bytes_; }
    void update(size_t offset, size_t bytes, const void* data); // needs GL_DYNAMIC_STORAGE_BIT

private:
    static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
    Handle<destroy> handle_;
    size_t bytes_ = 0;
};

// Uniform blocks of the passes of a frame. Three frames take turns in one persistently mapped buffer; a fence per frame
// keeps the GPU from seeing the bytes of a later one, and in the steady state is always signalled already.
class UniformRing {
public:
    ~UniformRing();
    void beginFrame(size_t bytesNeeded); // waits only if the GPU is three frames behind; grows the buffer if need be
    // Copies the bytes of a uniform block; where they are, for bind(), until the frame's end.
    size_t put(const void* data, size_t bytes);
    void bind(GLuint binding, size_t offset, size_t bytes) const;
    void endFrame();
    static size_t aligned(size_t bytes) { return (bytes + 255) / 256 * 256; } // GL's largest permitted alignment

private:
    static constexpr size_t turns = 3;
    void releaseFences();
    Buffer buffer_;
    std::byte* mapped_ = nullptr;
    size_t bytesPerTurn_ = 0, turn_ = 0, used_ = 0;
    std::array<GLsync, turns> fences_{};
};

} // namespace penumbra
