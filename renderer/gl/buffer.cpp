// SPDX-License-Identifier: MIT
#include "renderer/gl/buffer.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <cstring>

namespace penumbra {

Buffer::Buffer(std::string_view label, size_t bytes, const void* data, GLbitfield flags) : bytes_(bytes) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    handle_ = Handle<destroy>(name);
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes ? bytes : 16), bytes ? data : nullptr, flags);
    if (glGetError() == GL_OUT_OF_MEMORY)
        throw InputError(std::string(label) + ": the driver has no memory for " + std::to_string(bytes) + " bytes");
    glObjectLabel(GL_BUFFER, name, static_cast<GLsizei>(label.size()), label.data());
}

void Buffer::update(size_t offset, size_t bytes, const void* data) {
    ensure(offset + bytes <= bytes_, "a buffer is updated past its end");
    glNamedBufferSubData(name(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

UniformRing::~UniformRing() { releaseFences(); }

void UniformRing::releaseFences() {
    for (GLsync& fence : fences_) {
        if (fence) glDeleteSync(fence);
        fence = nullptr;
    }
}

void UniformRing::beginFrame(size_t bytesNeeded) {
    used_ = 0;
    if (bytesNeeded > bytesPerTurn_) {
        constexpr GLbitfield flags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
        bytesPerTurn_ = aligned(bytesNeeded + bytesNeeded / 2);
        releaseFences();
        buffer_ = Buffer("uniforms", turns * bytesPerTurn_, nullptr, flags);
        mapped_ = static_cast<std::byte*>(
            glMapNamedBufferRange(buffer_.name(), 0, static_cast<GLsizeiptr>(turns * bytesPerTurn_), flags));
        ensure(mapped_, "the uniform buffer cannot be mapped");
    }
    turn_ = (turn_ + 1) % turns;
    if (GLsync& fence = fences_[turn_]) {
        constexpr GLuint64 oneSecond = 1'000'000'000;
        while (glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, oneSecond) == GL_TIMEOUT_EXPIRED) {
        }
        glDeleteSync(fence);
        fence = nullptr;
    }
}

size_t UniformRing::put(const void* data, size_t bytes) {
    ensure(used_ + bytes <= bytesPerTurn_, "more uniforms than the frame asked for");
    const size_t offset = turn_ * bytesPerTurn_ + used_;
    std::memcpy(mapped_ + offset, data, bytes);
    used_ += aligned(bytes);
    return offset;
}

void UniformRing::bind(GLuint binding, size_t offset, size_t bytes) const {
    glBindBufferRange(GL_UNIFORM_BUFFER, binding, buffer_.name(), static_cast<GLintptr>(offset),
                      static_cast<GLsizeiptr>(aligned(bytes)));
}

void UniformRing::endFrame() { fences_[turn_] = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0); }

} // namespace penumbra
