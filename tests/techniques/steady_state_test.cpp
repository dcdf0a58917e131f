// SPDX-License-Identifier: MIT
// A frame that is like the last one allocates nothing of ours. Not under the address sanitizer, whose own allocator it
// would replace.
#ifndef __SANITIZE_ADDRESS__
#include "tests/catch.h"
#include "tests/support/scenes.h"

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
            Session s = session(wavingScene(), card->id);
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

#endif
