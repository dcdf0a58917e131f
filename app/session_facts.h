// SPDX-License-Identifier: MIT
// What decides a picture, as JSON that the picture's file carries, and a session made from it again. session_facts.cpp
// names each fact once, for writing and for reading.
#pragma once

#include "app/json_text.h"
#include "renderer/session.h"

#include <filesystem>
#include <string>

namespace penumbra {

// What of a session a picture shows.
struct Shot {
    int frames = 1;     // since the last reset; the last of them, at session.time, is the picture
    std::string buffer; // empty: what the window shows
    int layer = 0, level = 0;
    bool panels = false; // the whole window
};

// Program, driver, scene with its checksum, technique with all parameters, camera, light, display, time, size ...
Json factsOf(const Session& session, const Shot& shot, const std::string& driver);

// What else a picture tells.
struct Origin {
    std::string program, driver;
    struct {
        std::string name, file, checksum; // a built-in scene's file is its name
        std::string scene, variant, clip; // chosen of the file; empty: its default
    } scene;
};

// What a picture's file tells of the session that it shows.
class PictureFacts {
public:
    // Throws InputError if the file holds no such facts, or one that is unknown or out of range.
    explicit PictureFacts(const std::filesystem::path& picture);

    // A file, or the name of a built-in scene. Throws InputError if there is no such scene any more.
    std::filesystem::path scene() const;
    ImportChoice choice() const { return {origin_.scene.scene, origin_.scene.variant}; }
    // Gives a session, whose scene is set, everything else.
    Shot restore(Session& session) const;

    // A line for people if this is not the scene, or not the driver, that the picture was made with; else empty.
    std::string doubtAboutScene(const Scene& scene) const;
    std::string doubtAboutDriver(const std::string& driver) const;

private:
    std::string picture_;
    Json facts_;
    Origin origin_;
};

// Whether a file's name is that of a picture that may hold facts.
bool mayHoldFacts(const std::filesystem::path& file);

} // namespace penumbra
