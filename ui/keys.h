// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace penumbra {

// What the keyboard says in one frame, and of the mouse its double click, free of any window system.
struct Keys {
    // How long each was down in this frame [s], so that slow frames move as far as fast ones. The first frame of a
    // stroke counts a little more: a tap moves a little.
    float forward = 0, back = 0, left = 0, right = 0, rise = 0, sink = 0; // W S A D E Q
    float arrowLeft = 0, arrowRight = 0, arrowUp = 0, arrowDown = 0;      // arrow keys
    float nearer = 0, further = 0, smaller = 0, larger = 0, slow = 0,
          fast = 0; // Page Up, Page Down, comma, period, − +
    // Whether they are down.
    bool light = false; // L
    bool shift = false, control = false;
    // Whether they were struck in this frame.
    bool help = false;          // H, F1
    bool frameScene = false;    // F
    bool reset = false;         // Home
    bool next = false;          // C
    bool handles = false;       // G
    bool restart = false;       // R
    bool show = false;          // V
    bool play = false;          // space
    bool buffers = false;       // B
    bool timings = false;       // T
    bool tradeOff = false;      // M
    bool motion = false;        // J
    bool probe = false;         // P
    bool freeze = false;        // K
    bool step = false;          // N
    bool runTo = false;         // Shift+N
    bool truth = false;         // Y
    bool ruler = false;         // U
    bool exchange = false;      // X
    bool alone = false;         // 0
    bool wipe = false;          // 1
    bool flip = false;          // 2
    bool sideBySide = false;    // 3
    bool errorMap = false;      // 4
    bool open = false;          // Ctrl+O
    bool picture = false;       // F12: of the view
    bool windowPicture = false; // Shift+F12: of the whole window
    bool escape = false;
    bool doubleClick = false; // of the left button
};

struct KeyHelp {
    std::string_view keys, meaning; // no meaning: a title
};
inline constexpr std::string_view keyHelpSecondHalf = "Compare"; // that far the left half goes
inline constexpr KeyHelp keyHelp[] = {
    {"Camera, in the view", ""},
    {"left drag,  arrow keys", "orbit round the target"},
    {"middle or Shift + left drag,  Shift + arrows", "pan"},
    {"wheel, Ctrl + left drag,  Page Up, Page Down", "nearer or further"},
    {"right drag,  Ctrl + arrows", "look around"},
    {"W A S D,  E up,  Q down", "fly; Shift: four times as fast"},
    {"+  −,  wheel during a right drag", "faster or slower"},
    {"double click", "orbit round the surface under the pointer"},
    {"F,  Home", "frame the scene; back to the scene's own camera"},
    {"C", "next camera of the scene"},
    {"Light, in the view", ""},
    {"hold L", "all of these move the light instead: turn it round its target, shift both, nearer or further, fly; "
               "double click aims it, Home resets it, C takes the next light of the scene"},
    {"comma, period", "smaller or larger"},
    {"G", "show or hide its handles: drag centre, target or edge"},
    {"Techniques with a history", ""},
    {"K", "freeze it, let it go on; frozen, all else can be changed and is drawn with the same past"},
    {"N,  Shift + N", "one frame; up to the number of frames beside Run to; then it is frozen"},
    {"R", "restart: forget all history"},
    {"P,  click", "probe: a pixel's numbers over the frames; right click lets it go"},
    {"Compare", ""},
    {"1  2  3  4",
     "technique A beside the truth or B: wipe with a line to drag, flip, side by side, error map; 2 again "
     "flips, 4 again: × 10, × 100, × 1"},
    {"0", "the technique alone"},
    {"X", "A and B change places"},
    {"Y", "trace the truth, show the errors"},
    {"U", "penumbra ruler: drag its ends across a shadow's edge"},
    {"Images, in the buffers", ""},
    {"wheel, left drag", "zoom, move"},
    {"click, right click", "pin a texel, let it go"},
    {"Values", ""},
    {"Ctrl + click, double click", "type a number"},
    {"Window", ""},
    {"V", "lit picture or shadow ψ"},
    {"Space", "play or pause the animation"},
    {"B,  T,  M,  J", "buffers, timings, trade-off of cost and error, motion"},
    {"Ctrl + O", "open a scene"},
    {"F12,  Shift + F12", "save a picture of the view, of the whole window"},
    {"Ctrl + plus, minus, 0", "larger or smaller text, as at first"},
    {"H,  F1", "this help"},
    {"Ctrl + Q", "quit"},
};

} // namespace penumbra
