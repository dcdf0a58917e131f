// SPDX-License-Identifier: MIT
// Files as a whole: small ones read at once, and written so that a reader finds the old file or the new one.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace penumbra {

// Throws InputError with the system's reason, or if the file holds more than `limit` bytes.
std::string readFile(const std::filesystem::path& file, size_t limit);

// Writes a temporary file beside `file` and renames it. Throws InputError with the system's reason; what was there
// stays then.
void writeFileAtomically(const std::filesystem::path& file, std::string_view bytes);

// Throws what writeFileAtomically would throw for this place, as far as it can be known before there is anything to
// write.
void checkWritable(const std::filesystem::path& file);

} // namespace penumbra
