// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace penumbra {

// A field of comma-separated values (RFC 4180): quoted if it must be.
inline std::string csvField(std::string_view text) {
    if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
    std::string field(1, '"');
    for (const char c : text) {
        if (c == '"') field += '"';
        field += c;
    }
    return field + '"';
}

} // namespace penumbra
