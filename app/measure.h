// SPDX-License-Identifier: MIT
// `penumbra measure`.
#pragma once

namespace penumbra {

struct Options;

// Measures, or joins what was measured, and prints it. Returns the exit code: 1 if it was interrupted, after what was
// done is printed.
int measure(const Options& options);

} // namespace penumbra
