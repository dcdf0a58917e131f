// SPDX-License-Identifier: MIT
// Writes the built-in scenes as binary glTF: make-scenes [FOLDER]. The same files come out on every machine.
#include "assets/make_scenes/scenes.h"

#include <cstdio>
#include <exception>
#include <filesystem>

int main(int argc, char** argv) {
    using namespace make_scenes;
    try {
        const std::filesystem::path folder = argc > 1 ? argv[1] : "assets/scenes";
        std::filesystem::create_directories(folder);
        for (const auto& make :
             {courtyard, overlappingOccluders, largePenumbra, contact, elongated, thinSlab, slantingSlab, twoDepths,
              overStairs, movingCaster, twoBoxes, halfPlane, rectangle, ball})
            make().save(folder);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make-scenes: %s\n", error.what());
        return 2;
    }
}
