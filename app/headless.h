// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace penumbra {

// A current OpenGL 4.5 core context without window and surface, through EGL. A hardware device is preferred to a
// software renderer. Without one, throws InputError that says what was found.
class HeadlessContext {
public:
    HeadlessContext();
    ~HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

    // What the driver complained about so far: errors and everything of high or medium severity.
    const std::vector<std::string>& messages() const { return *messages_; }
    const std::string& rendererName() const { return rendererName_; } // "llvmpipe (LLVM 15.0.6, 256 bits)"

private:
    void* display_ = nullptr;
    void* context_ = nullptr;
    std::string rendererName_;
    std::unique_ptr<std::vector<std::string>> messages_; // its address is known to the driver
};

} // namespace penumbra
