// SPDX-License-Identifier: MIT
#include "app/json_text.h"

#include "renderer/core/error.h"

#include <algorithm>

namespace penumbra {

Json parseJson(std::string_view text) {
    try {
        return Json::parse(text);
    } catch (const Json::exception& error) {
        // "[json.exception.parse_error.101] parse error at line 3, column 5: ..."
        const std::string_view message = error.what();
        const size_t bracket = message.find("] ");
        throw InputError(std::string(bracket == std::string_view::npos ? message : message.substr(bracket + 2)));
    }
}

const Json* findKey(const Json& object, std::string_view key) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

std::string briefText(const Json& value) {
    constexpr size_t longest = 60; // bytes
    if (value.is_string() && value.get_ref<const std::string&>().size() > longest) return "a long text";
    const auto isStructured = [](const Json& element) { return element.is_structured(); };
    const bool brief = value.is_array() && value.size() <= 4 && std::none_of(value.begin(), value.end(), isStructured);
    if (value.is_structured() && !brief) return value.type_name();
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

} // namespace penumbra
