// SPDX-License-Identifier: MIT
#pragma once

#include <epoxy/gl.h>

#include <string_view>

namespace penumbra {

// A named group in RenderDoc and apitrace for as long as it lives.
class DebugGroup {
public:
    explicit DebugGroup(std::string_view label) {
        glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, static_cast<GLsizei>(label.size()), label.data());
    }
    ~DebugGroup() { glPopDebugGroup(); }
    DebugGroup(const DebugGroup&) = delete;
    DebugGroup& operator=(const DebugGroup&) = delete;
};

} // namespace penumbra
