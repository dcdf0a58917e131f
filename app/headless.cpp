// SPDX-License-Identifier: MIT
#include "app/headless.h"

#include "renderer/core/error.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace penumbra {
namespace {

// One way to reach OpenGL through EGL.
struct Candidate {
    std::string name; // for people
    EGLenum platform;
    void* native;
};

struct Opened {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    std::string renderer;
    bool software() const {
        static constexpr std::string_view names[] = {"llvmpipe", "softpipe", "swrast", "Software Rasterizer"};
        return std::any_of(std::begin(names), std::end(names),
                           [&](std::string_view name) { return renderer.find(name) != std::string::npos; });
    }
};

std::vector<Candidate> candidates() {
    std::vector<Candidate> found;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        found.push_back({"EGL surfaceless", EGL_PLATFORM_SURFACELESS_MESA, nullptr});
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") ||
        !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration"))
        return found;
    std::array<EGLDeviceEXT, 32> devices;
    EGLint count = 0;
    if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count))
        for (int i = 0; i < count; ++i)
            found.push_back(
                {fmt::format("EGL device {}", i), EGL_PLATFORM_DEVICE_EXT, devices[static_cast<size_t>(i)]});
    return found;
}

void close(const Opened& opened) {
    if (opened.context != EGL_NO_CONTEXT) {
        eglMakeCurrent(opened.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(opened.display, opened.context);
    }
    if (opened.display != EGL_NO_DISPLAY) eglTerminate(opened.display);
}

EGLContext createContext(EGLDisplay display) {
    if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context") || !eglBindAPI(EGL_OPENGL_API))
        return EGL_NO_CONTEXT;
    const EGLint configAttributes[] = {EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, configAttributes, &config, 1, &count) || count == 0) return EGL_NO_CONTEXT;
    const EGLint contextAttributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                        4,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        5,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                        EGL_CONTEXT_OPENGL_DEBUG,
                                        EGL_TRUE,
                                        EGL_NONE};
    return eglCreateContext(display, config, EGL_NO_CONTEXT, contextAttributes);
}

// Leaves the context current if there is one; otherwise says in `trouble` why not.
Opened open(const Candidate& candidate, std::string& trouble) {
    Opened opened;
    EGLDisplay display = eglGetPlatformDisplayEXT(candidate.platform, candidate.native, nullptr);
    EGLint major = 0, minor = 0;
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor)) {
        trouble = fmt::format("{}: EGL error {:#x}", candidate.name, eglGetError());
        return opened;
    }
    opened.display = display;
    opened.context = createContext(display);
    if (opened.context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, opened.context)) {
        trouble = fmt::format("{}: {} has no OpenGL 4.5 core context without a surface (EGL error {:#x})",
                              candidate.name, eglQueryString(display, EGL_VENDOR), eglGetError());
        close(opened);
        return {};
    }
    opened.renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return opened;
}

// The first hardware renderer, else the first software renderer; current.
Opened openBest() {
    std::vector<std::string> troubles;
    Opened best;
    for (const Candidate& candidate : candidates()) {
        std::string trouble;
        Opened opened = open(candidate, trouble);
        if (opened.context == EGL_NO_CONTEXT) {
            troubles.push_back(trouble);
            continue;
        }
        if (best.context == EGL_NO_CONTEXT || !opened.software()) std::swap(best, opened);
        close(opened);
        if (!best.software()) break;
    }
    if (best.context == EGL_NO_CONTEXT)
        throw InputError(fmt::format("OpenGL 4.5 was not found: {}",
                                     troubles.empty() ? "EGL has neither the surfaceless nor the device platform"
                                                      : fmt::format("{}", fmt::join(troubles, "; "))));
    eglMakeCurrent(best.display, EGL_NO_SURFACE, EGL_NO_SURFACE, best.context);
    return best;
}

void GLAPIENTRY keepMessage(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                            const void* list) {
    if (type != GL_DEBUG_TYPE_ERROR && severity != GL_DEBUG_SEVERITY_HIGH && severity != GL_DEBUG_SEVERITY_MEDIUM)
        return;
    auto& messages = *static_cast<std::vector<std::string>*>(const_cast<void*>(list));
    constexpr size_t most = 100; // a broken frame may repeat itself without end
    if (messages.size() < most) messages.emplace_back(text, static_cast<size_t>(length));
}

} // namespace

HeadlessContext::HeadlessContext() : messages_(std::make_unique<std::vector<std::string>>()) {
    const Opened opened = openBest();
    display_ = opened.display;
    context_ = opened.context;
    rendererName_ = opened.renderer;
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(keepMessage, messages_.get());
}

HeadlessContext::~HeadlessContext() { close({display_, context_, {}}); }

} // namespace penumbra
