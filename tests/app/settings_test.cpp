// SPDX-License-Identifier: MIT
#include "app/settings.h"

#include "tests/app/program.h"
#include "tests/catch.h"

#include <cstdlib>

using namespace penumbra;
using namespace penumbra::test;

TEST_CASE("settings are kept, and damaged ones are refused by file and key") {
    const TemporaryFolder folder;
    ::setenv("PENUMBRA_CONFIG_DIR", (folder / "new").c_str(), 1);
    CHECK(loadSettings().pictures == defaultSettings().pictures);
    saveSettings({folder / "my pictures"});
    CHECK(loadSettings().pictures == folder / "my pictures");
    for (const char* text : {"", "[]", R"({"pictures": 7})", R"({"pictures": "relative"})"}) {
        writeAll(folder / "new" / "settings.json", text);
        const std::string message = refusal([] { loadSettings(); });
        INFO(message);
        CHECK(message.starts_with((folder / "new" / "settings.json").string() + ": "));
    }
    ::unsetenv("PENUMBRA_CONFIG_DIR");
}
