// SPDX-License-Identifier: MIT
// The whole content of the window: bar, view, side panel, drawer, dialogs. Knows no window system.
#pragma once

#include "ui/buffer_panel.h"
#include "ui/compare_panel.h"
#include "ui/file_chooser.h"
#include "ui/motion_panel.h"
#include "ui/probe_panel.h"
#include "ui/side_panel.h"
#include "ui/timings_panel.h"
#include "ui/tradeoff_panel.h"
#include "ui/viewport.h"

#include "renderer/scene_loader.h"

#include <filesystem>
#include <functional>
#include <future>
#include <optional>

namespace penumbra {

// What the panels ask of the program around them. All may throw InputError and have changed nothing then.
struct Actions {
    // Turns the request for a picture that tells how it was made into one for its scene and the rest.
    std::function<void(SceneRequest& request)> readPicture;
    std::function<PresetNames()> presetNames;
    std::function<void(const std::string& fullName)> loadPreset;          // "technique/name"
    std::function<void(const std::string&name)> savePreset, deletePreset; // of the chosen technique
    std::function<void(const std::string& name, const std::string& newName)> renamePreset;
    // Of the last frame, or of the whole window as it stands in the back buffer; where it is, once it is written.
    std::function<std::future<std::filesystem::path>(bool wholeWindow)> savePicture;
    std::function<std::filesystem::path(const BufferShot&)> saveBuffer;
    std::function<std::filesystem::path(const std::string& csv)> saveTimings; // where it is
    // Of a part of the back buffer, in units of the window.
    std::function<std::filesystem::path(ImVec2 corner, ImVec2 size)> saveChart;
    std::function<std::filesystem::path(const std::string& csv)> saveTradeOff;
    std::function<std::filesystem::path()> picturesFolder;
    std::function<void(const std::filesystem::path& folder)> setPicturesFolder; // from now on
    SideContext::MakeCurrent measuringContext, motionContext;                   // for threads that measure
    TruthCache* truthCache = nullptr;                                           // of truths that are known already
};

class Workspace {
public:
    Workspace(Session& session, Renderer& renderer, SceneLoader& loader, Actions actions);

    // Builds one ImGui frame and renders the view. `seconds` since the last one; `pixelsPerUnit`: the framebuffer's
    // scale.
    void draw(const Keys& keys, float seconds, float pixelsPerUnit);

    // To be called when the frame stands in the back buffer: takes the picture of the whole window if one was asked
    // for.
    void drawn();

    // Loads it beside what is shown; a bad file shows a message and changes nothing.
    void openScene(SceneRequest request);
    void say(std::string message); // a line that fades
    // How long the next frame may wait for input [s]; 0 where it brings something new without any.
    double patience() const;

private:
    enum class Drawer { Closed, Buffers, Timings, TradeOff, Motion, Probe };

    void strokes(const Keys& keys);
    void advanceTime(float seconds);
    int historyLength() const;
    void frozenHint(ImVec2 corner, float width) const;
    void bar(ImVec2 size);
    void status();
    void drawer(float pixelsPerUnit);
    void splitter(ImVec2 corner, float width, float height, float highest);
    void carryOut(Requests& requests);
    void takeLoaded();
    void loadingBar(ImVec2 corner, float width, bool cancel);
    void takePicture();
    void pictureMenu();
    void collectSaved();
    void noteTimes();
    std::array<double, 2> costs() const;
    void exportTimings();
    void drawTradeOff();
    void drawMotion();
    void openProbe();
    void followProbe(ImVec2 corner, ImVec2 size);
    bool measuring() const { return tradeOff_.measuring() || motion_.measuring(); }
    void dialogs(const Keys& keys);
    void helpDialog(bool close);
    void errorDialog(bool close);
    void message(ImVec2 corner, float width);
    void toggle(Drawer drawer) { drawer_ = drawer_ == drawer ? Drawer::Closed : drawer; }
    Timing timing() const;

    // Runs what may meet bad input; an InputError becomes a dialog.
    template <class Action> bool attempt(Action&& action);

    Session& session_;
    Renderer& renderer_;
    SceneLoader& loader_;
    Actions actions_;
    SceneFacts facts_;
    Playback playback_;
    ViewSettings view_;
    HistoryControl history_;
    SidePanel side_;
    Viewport viewport_;
    Yardstick yardstick_;
    ComparePanel compare_;
    std::array<Recent, 2> costs_; // of A and B, where there are two [ms]
    uint64_t costsFrame_ = 0;     // of the timer, that they were taken from last
    BufferPanel buffers_;
    TimingsPanel timings_;
    TradeOffPanel tradeOff_;
    MotionPanel motion_;
    ProbePanel probe_;
    FileChooser chooser_, folderChooser_{FileChooser::Pick::Folder};

    Drawer drawer_ = Drawer::Closed;
    std::optional<float> drawerHeight_; // in font heights, once it was dragged
    Timing timedHow_ = Timing::Off;     // how the times that the timings panel has gathered were measured
    std::vector<uint32_t> work_;        // what decides how much a frame has to do
    int windowPictureIn_ = 0;           // frames until the picture of the whole window is taken; 0: none is
    int chartPictureIn_ = 0;            // and that of the chart
    std::vector<std::future<std::filesystem::path>> saving_; // pictures on their way

    SceneRequest loading_; // what the loader is at
    std::string error_;
    bool openError_ = false, openHelp_ = false;
    std::string message_;
    float messageSeconds_ = 0; // how long it stays
    float sinceAdvance_ = 0;   // since time was advanced [s]
    bool pictureWanted_ = false;
};

} // namespace penumbra
