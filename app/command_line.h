// SPDX-License-Identifier: MIT
// From the words of the command line to a session.
#pragma once

#include "app/session_facts.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

enum class Verb { Window, Capture, Measure, List };

// The command line as it was written. Empty options were not given.
struct Options {
    Verb verb = Verb::Window;
    std::optional<std::string> scene, like, sceneName, variant, clip;
    std::optional<std::string> technique, preset, size, seed;
    std::vector<std::string> assignments; // --set
    std::optional<std::string> camera, light, lightShape, lightSize, ground;
    std::vector<std::string> furtherLights;
    std::optional<std::string> time, show, exposure, ambient, textureLimit;
    std::optional<std::string> output, buffer, truth; // capture
    std::optional<std::string> view;
    std::optional<int> frames;
    std::optional<int> layer, level;                                            // of the buffer
    std::optional<std::string> techniques, path, motion, error, against, shard; // measure
    std::optional<std::string> budgetMs, budgetRmse, free;
    std::vector<std::string> sweeps, merged;
    std::optional<int> repeat, samples;
    bool csv = false;
    bool play = false;
    bool json = false;
};

// Throws InputError. Nothing if the command line asked for help or the version, which is printed.
std::optional<Options> parseCommandLine(int argc, const char* const* argv);

// In this order: scene with its own camera and light, the picture to be like, preset, technique, parameters, the rest.
// The session's time is that of the last frame of `shot`. Throws InputError.
Session makeSession(const Options& options, Shot& shot);

} // namespace penumbra
