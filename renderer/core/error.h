// SPDX-License-Identifier: MIT
// Two kinds of trouble: InputError is the world's fault (a file, a flag, a value) and becomes one line on stderr and
// exit code 2; a broken `ensure` is our own bug and carries the place where it was noticed.
#pragma once

#include <source_location>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace penumbra {

// Bad input. The message is one line that names the file or option, the place in it, and what was expected.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Throws std::logic_error with the source place if an invariant of our own does not hold.
inline void ensure(bool condition, std::string_view message,
                   std::source_location where = std::source_location::current()) {
    if (!condition)
        throw std::logic_error(std::string(where.file_name()) + ":" + std::to_string(where.line()) + ": " +
                               std::string(message));
}

// The entry of `names` with the smallest edit distance to `name`; empty if nothing is near (over half of it differs).
std::string_view nearestName(std::string_view name, std::span<const std::string_view> names);

// "; did you mean 'x'?" or nothing.
std::string suggestion(std::string_view name, std::span<const std::string_view> names);

} // namespace penumbra
