// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace penumbra {

using Json = nlohmann::ordered_json;

// Throws InputError with the line and column of what is wrong.
Json parseJson(std::string_view text);

// The value of a key of an object; null if it has none. Files of others may nest deeply, and copying recurses: look at
// them through pointers.
const Json* findKey(const Json& object, std::string_view key);

// A value in a message: as it is written if it is short, else what sort it is.
std::string briefText(const Json& value);

} // namespace penumbra
