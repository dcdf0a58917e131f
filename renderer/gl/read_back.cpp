// SPDX-License-Identifier: MIT
#include "renderer/gl/read_back.h"

namespace penumbra {

void ReadBack::start(const Texture& texture) {
    forget();
    const Extent& extent = texture.extent();
    count_ = static_cast<size_t>(extent.width) * static_cast<size_t>(extent.height);
    const size_t bytes = count_ * sizeof(float);
    if (buffer_.bytes() < bytes) buffer_ = Buffer("read-back", bytes, nullptr, GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glGetTextureImage(texture.name(), 0, GL_RED, GL_FLOAT, static_cast<GLsizei>(bytes), nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    fence_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
}

bool ReadBack::take(std::vector<float>& values) {
    if (!fence_ || glClientWaitSync(fence_, 0, 0) == GL_TIMEOUT_EXPIRED) return false;
    forget();
    const size_t bytes = count_ * sizeof(float);
    const void* mapped = glMapNamedBufferRange(buffer_.name(), 0, static_cast<GLsizeiptr>(bytes), GL_MAP_READ_BIT);
    ensure(mapped, "a buffer that was read back cannot be mapped");
    const float* texels = static_cast<const float*>(mapped);
    values.assign(texels, texels + count_);
    glUnmapNamedBuffer(buffer_.name());
    return true;
}

void ReadBack::forget() {
    if (fence_) glDeleteSync(std::exchange(fence_, nullptr));
}

} // namespace penumbra
