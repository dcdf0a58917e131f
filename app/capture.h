// SPDX-License-Identifier: MIT
#pragma once

namespace penumbra {

struct Options;

// `penumbra capture`: renders a session without a window and writes a picture of it, or of one of its buffers.
void capture(const Options& options);

} // namespace penumbra
