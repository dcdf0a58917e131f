// SPDX-License-Identifier: MIT
// The column on the right: scene, technique, parameters, presets, light, camera, display.
#pragma once

#include "ui/camera_panel.h"
#include "ui/history_control.h"
#include "ui/light_panel.h"
#include "ui/parameter_panel.h"
#include "ui/scene_facts.h"

#include <functional>
#include <optional>

namespace penumbra {

// How time passes in the window.
struct Playback {
    bool playing = false;
    bool stepOnce = false; // one frame forward, then still
    float speed = 1;       // seconds of the clip a second
};

// A scene to open. With `keepView` the camera, the light and the ground stay as they are.
struct SceneRequest {
    std::string nameOrFile;
    ImportChoice choice = {};
    bool keepView = false;
    // What a picture tells besides its scene, for a session that has the scene; a line to say about it, or nothing.
    std::function<std::string(Session&)> restore = {};
};

// Presets as "technique/name".
struct PresetNames {
    std::vector<std::string> own, builtIn;
};

// What a hand asked for that needs more than the session: the workspace carries it out.
struct Requests {
    std::optional<SceneRequest> openScene;
    std::optional<std::string> loadPreset;                           // "technique/name"
    std::optional<std::string> savePreset, deletePreset;             // names of the chosen technique's presets
    std::optional<std::pair<std::string, std::string>> renamePreset; // from, to
    bool chooseFile = false;
    bool listPresets = false;
    bool restart = false; // forget all history
};

class SidePanel {
public:
    // Draws into the current ImGui window.
    // `historyLength`: of the frame that is shown; 0: its techniques keep none.
    Requests draw(Session& session, const SceneFacts& facts, Playback& playback, ViewSettings& view,
                  HistoryControl& history, int historyLength);

    void setPresetNames(PresetNames names) { presetNames_ = std::move(names); }
    // The values are now those of this preset of the chosen technique; an empty name: of none.
    void takePreset(const TechniqueShelf& techniques, std::string_view name);
    void renamePreset(std::string_view name) { preset_ = name; } // the chosen one
    LightPanel& light() { return light_; }
    CameraPanel& camera() { return camera_; }

private:
    void scene(Session& session, const SceneFacts& facts, Requests& requests);
    void choices(const Scene& scene, Requests& requests);
    TechniqueShelf& shelf(Session& session) const; // of the technique that is edited
    void chooseEdited(Session& session);
    void technique(TechniqueShelf& shelf, Requests& requests);
    void historyControls(HistoryControl& history, int length, Requests& requests);
    void presets(const Session& session, Requests& requests);

    bool editsRival_ = false; // technique B, while there is one
    ParameterPanel parameters_;
    LightPanel light_;
    CameraPanel camera_;
    std::vector<std::string> builtIns_ = builtInScenes();
    PresetNames presetNames_;
    std::string presetOf_, preset_;      // technique and name of the preset taken last
    std::vector<uint32_t> presetValues_; // what it gave the parameters
    const Scene* shownScene_ = nullptr;  // whose path stands in the path field
    TextField<4096> path_;
    TextField<101> presetName_;
};

void timeControls(Session& session, Playback& playback);
void displayControls(DisplaySettings& display);

} // namespace penumbra
