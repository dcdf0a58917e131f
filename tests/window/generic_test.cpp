// SPDX-License-Identifier: MIT
// Panels and verbs loop over the catalogue: their text names no technique.
#include "tests/catch.h"

#include "renderer/core/technique.h"

#include <filesystem>
#include <fstream>
#include <regex>

using namespace penumbra;

TEST_CASE("ui/ and app/ name no technique") {
    int files = 0;
    for (const char* room : {"ui", "app"})
        for (const auto& entry : std::filesystem::directory_iterator(std::string(PENUMBRA_SOURCE_FOLDER "/") + room)) {
            if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
            ++files;
            std::ifstream stream(entry.path());
            int number = 0;
            for (std::string line; std::getline(stream, line);) {
                ++number;
                const std::string code = std::regex_replace(line, std::regex("//.*"), "");
                for (const Card* card : catalogue()) {
                    const std::string id(card->id);
                    // "none" and "hard" are English too: as a string of their own only. The others: as any word.
                    const bool english = id == "none" || id == "hard";
                    const std::regex name(english ? "\"" + id + "\"" : "\\b" + id + "\\b", std::regex::icase);
                    CAPTURE(entry.path().filename().string(), number, code, id);
                    CHECK_FALSE(std::regex_search(code, name));
                }
            }
        }
    CHECK(files > 10);
}
