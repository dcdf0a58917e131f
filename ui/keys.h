// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace penumbra {

// What the keyboard says in one frame, free of any window system. Held keys are true as long as they are down, the
// others in the frame of the stroke only.
struct Keys {
    // held
    bool light = false;                                              // L
    bool forward = false, back = false, left = false, right = false; // W S A D
    bool up = false, down = false;                                   // E Q
    bool shift = false;
    // struck
    bool help = false;          // H, F1
    bool frameScene = false;    // F
    bool restart = false;       // R
    bool show = false;          // V
    bool play = false;          // space
    bool buffers = false;       // B
    bool timings = false;       // T
    bool open = false;          // Ctrl+O
    bool picture = false;       // F12: of the view
    bool windowPicture = false; // Shift+F12: of the whole window
    bool escape = false;
};

struct KeyHelp {
    std::string_view keys, meaning; // no meaning: a title
};
inline constexpr KeyHelp keyHelp[] = {
    {"Camera, in the view", ""},
    {"left drag", "orbit round the target"},
    {"middle drag, Shift + left drag", "pan"},
    {"wheel", "nearer or further"},
    {"right drag", "look around; with W A S D fly, E up, Q down"},
    {"wheel while flying", "speed"},
    {"F", "frame the scene"},
    {"Light, in the view", ""},
    {"L + left drag", "turn the light round its target"},
    {"L + wheel", "move it nearer or further"},
    {"Images, in the buffers", ""},
    {"wheel, left drag", "zoom, move"},
    {"click, right click", "pin a texel, let it go"},
    {"Values", ""},
    {"Ctrl + click, double click", "type a number"},
    {"Window", ""},
    {"V", "lit picture or shadow ψ"},
    {"R", "restart: forget all history"},
    {"Space", "play or pause the animation"},
    {"B,  T", "buffers, timings"},
    {"Ctrl + O", "open a scene"},
    {"F12,  Shift + F12", "save a picture of the view, of the whole window"},
    {"H,  F1", "this help"},
    {"Ctrl + Q", "quit"},
};

} // namespace penumbra
