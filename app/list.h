// SPDX-License-Identifier: MIT
#pragma once

namespace penumbra {

struct Options;

// `penumbra list`: techniques, their parameters and buffers, scenes and presets, on stdout. Needs no GPU.
void list(const Options& options);

} // namespace penumbra
