// SPDX-License-Identifier: MIT
#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace penumbra {

// Owns one OpenGL name; moves, never copies. `Delete` frees it.
template <void (*Delete)(GLuint)> class Handle {
public:
    Handle() = default;
    explicit Handle(GLuint name) : name_(name) {}
    Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~Handle() {
        if (name_) Delete(name_);
    }
    GLuint get() const { return name_; }

private:
    GLuint name_ = 0;
};

} // namespace penumbra
