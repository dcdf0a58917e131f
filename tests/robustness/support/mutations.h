// SPDX-License-Identifier: MIT
// Takes glTF files apart and together again, so that a change of one part leaves the rest readable.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra::test {

// The two chunks of a .glb (glTF 2.0 specification, 4.4).
struct Glb {
    std::string json;
    std::vector<uint8_t> binary;
};
std::optional<Glb> splitGlb(std::span<const uint8_t> bytes); // nothing if it is not a .glb of that kind
std::vector<uint8_t> joinGlb(const Glb& glb);                // with the lengths that its chunks have

// The numbers of a JSON text, as (offset, length).
std::vector<std::pair<size_t, size_t>> numbersOf(std::string_view json);

// What to put into their place: limits of the types that a reader might use, glTF's own constants, and no numbers.
std::span<const std::string_view> awkwardValues();

} // namespace penumbra::test
