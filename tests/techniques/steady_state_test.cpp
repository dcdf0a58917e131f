// SPDX-License-Identifier: MIT
// A frame that is like the last one allocates nothing of ours. Not under the address sanitizer, whose own allocator it
// would replace.
#ifndef __SANITIZE_ADDRESS__
#include "tests/catch.h"
#include "tests/support/scenes.h"
#include "ui/buffer_panel.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<bool> counting{false};
std::atomic<int> allocations{0};

} // namespace

// Our own and the libraries' C++ allocations; the driver's C ones are its own business.
void* operator new(std::size_t bytes) {
    if (counting) ++allocations;
    if (void* memory = std::malloc(bytes ? bytes : 1)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

using namespace penumbra;
using namespace penumbra::test;

TEST_CASE("the steady state allocates nothing per frame, with a scene that is bent and bulges too") {
    for (const Card* card : catalogue())
        for (const Timing timing : {Timing::Off, Timing::Queries}) {
            Session s = quickSession(wavingScene(), card->id);
            s.display.show = Show::Lit;
            const auto frame = [&] {
                s.camera.eye.x += 0.01f;
                s.time += 0.01;
                renderer().render(s, timing);
            };
            for (int i = 0; i < 8; ++i) frame();
            allocations = 0;
            counting = true;
            for (int i = 0; i < 4; ++i) frame();
            counting = false;
            CAPTURE(card->id, int(timing));
            CHECK(allocations == 0);
        }
}

TEST_CASE("looking into buffers allocates nothing per frame either") {
    Session s = session(SceneBuilder().floor(2).box({-1, 0, -1}, {0, 1, 0}).build(), "hard");
    s.display.show = Show::Lit;
    s.size = {320, 240};
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {1000, 600};
    io.DeltaTime = 0.3f; // longer than the panel waits between two looks
    loadFont(15);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    applyTheme(1);
    {
        BufferPanel panel;
        uint64_t frames = 0;
        const auto frame = [&](float x, float y, bool pressed) {
            s.camera.eye.x += 0.01f;
            renderer().render(s, Timing::Off);
            io.MousePos = {x, y};
            io.MouseDown[0] = pressed;
            ImGui::NewFrame();
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize(io.DisplaySize);
            ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoTitleBar);
            CHECK_FALSE(panel.draw(renderer(), ++frames, 1).has_value());
            ImGui::End();
            ImGui::Render();
        };
        // On the image, with a pinned texel, far enough in for values to be printed.
        for (const bool pressed : {false, true, false}) frame(450, 320, pressed);
        const int verticesBefore = ImGui::GetDrawData()->TotalVtxCount;
        for (int i = 0; i < 24; ++i) {
            io.MouseWheel = 1;
            frame(450, 320, false);
        }
        io.MouseWheel = 0;
        for (int i = 0; i < 8; ++i) frame(450 + static_cast<float>(i % 2), 320, false);
        CHECK(ImGui::GetDrawData()->TotalVtxCount > verticesBefore + 500); // the values
        allocations = 0;
        counting = true;
        for (int i = 0; i < 4; ++i) frame(450 + static_cast<float>(i % 2), 320, false);
        counting = false;
        CHECK(allocations == 0);
    }
    ImGui::DestroyContext();
}

#endif
