// SPDX-License-Identifier: MIT
#include "ui/workspace.h"

#include <algorithm>
#include <span>

namespace penumbra {

namespace {

constexpr ImGuiWindowFlags fixedWindow = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                         ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                         ImGuiWindowFlags_NoBringToFrontOnFocus;
// In font heights:
constexpr float sideWidth = 27;
constexpr float narrowWidth = 64;
constexpr float lowestDrawer = 8;
constexpr float firstTimings = 19, firstBuffers = 29, firstTradeOff = 27, firstMotion = 22, firstProbe = 22;
constexpr double step = 1.0 / 60;   // of time, by the step button [s]
constexpr double smooth = 1.0 / 60; // between two frames of a bar that fills [s]
constexpr double idle = 0.1;        // between two frames of a window with nothing new to show [s]
constexpr double whileMeasuring = 0.25;
constexpr float longestFrame = 0.25f; // [s]; after a pause of the program time does not jump further

bool beginFixed(const char* name, ImVec2 corner, ImVec2 size, ImGuiWindowFlags flags = 0) {
    ImGui::SetNextWindowPos(corner);
    ImGui::SetNextWindowSize({std::max(size.x, 1.0f), std::max(size.y, 1.0f)});
    return ImGui::Begin(name, nullptr, fixedWindow | flags);
}

// A dialog in the middle of the window, wide enough for prose but never wider than the window.
bool beginDialog(const char* title, float widest = 36) { // font heights
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float width = std::min(widest * ImGui::GetFontSize(), 0.95f * screen.x);
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, 0.95f * screen.y});
    ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    return ImGui::BeginPopupModal(
        title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
}

void keyTable(const char* id, std::span<const KeyHelp> lines) {
    if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingStretchProp)) return;
    ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthStretch, 0.44f);
    ImGui::TableSetupColumn("meaning", ImGuiTableColumnFlags_WidthStretch, 0.56f);
    for (const KeyHelp& help : lines) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        if (help.meaning.empty()) {
            ImGui::Spacing();
            text(colour::muted, help.keys);
            continue;
        }
        wrappedText(help.keys);
        ImGui::TableNextColumn();
        wrappedText(help.meaning);
    }
    ImGui::EndTable();
}

} // namespace

Workspace::Workspace(Session& session, Renderer& renderer, SceneLoader& loader, Actions actions)
    : session_(session)
    , renderer_(renderer)
    , loader_(loader)
    , actions_(std::move(actions))
    , facts_(session.scene)
    , yardstick_(actions_.truthCache)
    , tradeOff_(actions_.measuringContext, actions_.truthCache)
    , motion_(actions_.motionContext, actions_.truthCache) {
    playback_.playing = session.timeStep != 0;
    side_.setPresetNames(actions_.presetNames());
}

template <class Action> bool Workspace::attempt(Action&& action) {
    try {
        action();
        return true;
    } catch (const InputError& error) {
        error_ = error.what();
        openError_ = true;
        return false;
    }
}

void Workspace::openScene(SceneRequest request) {
    attempt([&] {
        actions_.readPicture(request);
        loader_.start(findScene(request.nameOrFile), request.choice);
        loading_ = std::move(request);
    });
}

void Workspace::say(std::string message) {
    message_ = std::move(message);
    messageSeconds_ = 6;
}

double Workspace::patience() const {
    if (viewport_.renderedNow() || viewport_.busy() || playback_.playing || windowPictureIn_ > 0 ||
        chartPictureIn_ > 0 || drawer_ == Drawer::Timings)
        return 0;
    if (measuring()) return whileMeasuring; // what is measured shall have the machine
    return loader_.progress() || messageSeconds_ > 0 || pictureWanted_ || !saving_.empty() ? smooth : idle;
}

Timing Workspace::timing() const {
    return renderer_.softwareRenderer() && drawer_ == Drawer::Timings ? Timing::Finish : Timing::Queries;
}

void Workspace::draw(const Keys& keys, float seconds, float pixelsPerUnit) {
    takeLoaded();
    for (std::string line : {tradeOff_.poll(), motion_.poll()})
        if (!line.empty()) say(std::move(line));
    viewport_.rest(measuring());
    strokes(keys);
    sinceAdvance_ += seconds;
    if (!viewport_.busy()) { // a picture that is under way is of the time when it began
        advanceTime(std::min(sinceAdvance_, longestFrame));
        sinceAdvance_ = 0;
    }

    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float em = ImGui::GetFontSize();
    const float barHeight = ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().FramePadding.y;
    const float side = std::min(sideWidth * em, 0.5f * screen.x), left = screen.x - side;
    const float below = std::max(screen.y - barHeight, 1.0f), highest = 0.75f * below;
    // In a narrow window the drawer runs below the side panel too.
    const bool narrow = screen.x < narrowWidth * em;
    float drawerHeight = 0;
    if (drawer_ != Drawer::Closed) {
        const float first = drawer_ == Drawer::Buffers    ? firstBuffers
                            : drawer_ == Drawer::TradeOff ? firstTradeOff
                            : drawer_ == Drawer::Motion   ? firstMotion
                            : drawer_ == Drawer::Probe    ? firstProbe
                                                          : firstTimings;
        drawerHeight = std::min(drawerHeight_ ? *drawerHeight_ * em : std::min(first * em, 0.6f * below), highest);
    }
    const float viewHeight = below - drawerHeight, sideHeight = narrow ? viewHeight : below;
    const float drawerWidth = narrow ? screen.x : left;

    bar({screen.x, barHeight});
    Requests requests;
    if (beginFixed("side", {left, barHeight}, {side, sideHeight}, ImGuiWindowFlags_AlwaysVerticalScrollbar))
        requests = side_.draw(session_, facts_, playback_, view_, history_, historyLength());
    ImGui::End();

    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    if (beginFixed("view", {0, barHeight}, {left, viewHeight},
                   ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse)) {
        const bool probing = drawer_ == Drawer::Probe && probe_.probe.following();
        renderer_.inspect({.images = drawer_ == Drawer::Buffers || probing,
                           .probe = probing ? probe_.probe.pixel(session_.size) : std::nullopt});
        viewport_.draw(session_, renderer_, facts_, keys, view_, history_, timing(), drawer_ == Drawer::Timings,
                       pixelsPerUnit);
        yardstick_.snapshotsWanted = view_.rulerShown;
        yardstick_.update(session_, renderer_, viewport_.frames(), viewport_.upToDate());
        if (renderer_.hasFrame())
            compare_.overlay(session_, yardstick_, view_, {0, barHeight}, {left, viewHeight}, costs());
        if (drawer_ == Drawer::Probe) followProbe({0, barHeight}, {left, viewHeight});
        if (history_.frozen()) frozenHint({0, barHeight}, left);
        if (loader_.progress())
            loadingBar({0, barHeight + viewHeight}, left, keys.escape);
        else
            message({0, barHeight + viewHeight}, left);
    }
    ImGui::End();
    ImGui::PopStyleVar();
    noteTimes();

    if (drawer_ != Drawer::Closed) {
        if (beginFixed("drawer", {0, screen.y - drawerHeight}, {drawerWidth, drawerHeight},
                       ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse)) {
            splitter({0, screen.y - drawerHeight}, drawerWidth, drawerHeight / em, highest / em);
            drawer(pixelsPerUnit);
        }
        ImGui::End();
    }
    if (drawer_ != Drawer::Buffers) buffers_.close();
    carryOut(requests);
    pictureWanted_ = pictureWanted_ || keys.picture;
    if (pictureWanted_ && !viewport_.busy()) takePicture();
    if (keys.windowPicture) windowPictureIn_ = 2;
    collectSaved();
    dialogs(keys);
    messageSeconds_ -= seconds;
}

void Workspace::strokes(const Keys& keys) {
    if (keys.help) openHelp_ = true;
    if (keys.restart) viewport_.restart();
    if (keys.show) session_.display.show = session_.display.show == Show::Lit ? Show::Shadow : Show::Lit;
    if (keys.play) playback_.playing = !playback_.playing;
    if (keys.freeze || keys.step || keys.runTo) {
        if (historyLength() == 0)
            say(fmt::format("{} keeps no history to hold still", session_.techniques.card().title));
        else if (keys.freeze)
            history_.freeze(!history_.frozen());
        else if (keys.step)
            history_.step();
        else if (history_.runToTarget(historyLength()))
            viewport_.restart();
    }
    compare_.strokes(keys, session_, yardstick_, view_);
    if (keys.buffers) toggle(Drawer::Buffers);
    if (keys.timings) toggle(Drawer::Timings);
    if (keys.tradeOff) toggle(Drawer::TradeOff);
    if (keys.motion) toggle(Drawer::Motion);
    if (keys.probe) openProbe();
    if (keys.next) say(keys.light ? side_.light().next(session_, facts_) : side_.camera().next(session_, facts_));
    if (keys.open) chooser_.open(facts_.scene->file.parent_path());
}

void Workspace::advanceTime(float seconds) {
    session_.timeStep = 0;
    if (session_.scene->duration(session_.clip) <= 0) playback_.playing = playback_.stepOnce = false;
    if (playback_.playing && history_.frozen()) // time stands, too; frame by frame it goes on in steps of its own
        session_.timeStep = history_.counting() ? step * static_cast<double>(playback_.speed) : 0;
    else if (playback_.playing)
        session_.timeStep = seconds * playback_.speed;
    else if (playback_.stepOnce)
        session_.timeStep = step;
    playback_.stepOnce = false;
    session_.time += session_.timeStep;
}

int Workspace::historyLength() const { return renderer_.hasFrame() ? renderer_.flow().historyLength() : 0; }

// Lest anybody wonders why nothing goes on.
void Workspace::frozenHint(ImVec2 corner, float width) const {
    const int length = historyLength();
    const float em = ImGui::GetFontSize(), padding = 0.4f * em;
    const ShortText line = history_.counting() ? ShortText("frame {}", length)
                                               : ShortText("frozen after {} frame{}", length, length == 1 ? "" : "s");
    const ImVec2 extent = ImGui::CalcTextSize(line.begin(), line.end());
    const ImVec2 from{corner.x + width - extent.x - 2 * padding - 0.6f * em, corner.y + 0.6f * em};
    ImVec4 paper = ImGui::GetStyleColorVec4(ImGuiCol_PopupBg);
    paper.w = 0.85f;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(from, {from.x + extent.x + 2 * padding, from.y + extent.y + padding}, ImGui::GetColorU32(paper),
                       0.3f * em);
    list.AddText({from.x + padding, from.y + padding / 2}, ImGui::GetColorU32(colour::accent), line.begin(),
                 line.end());
}

void Workspace::bar(ImVec2 size) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                        ImVec2(ImGui::GetStyle().ItemSpacing.x, ImGui::GetStyle().FramePadding.y));
    // All buttons shall be there with large text, too.
    const bool narrow = size.x < narrowWidth * ImGui::GetFontSize();
    const ImVec2 spacing = ImGui::GetStyle().ItemSpacing;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(narrow ? 0.45f * spacing.x : spacing.x, spacing.y));
    if (beginFixed("bar", {0, 0}, size, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse)) {
        if (ImGui::Button("Open…")) chooser_.open(facts_.scene->file.parent_path());
        tooltip("Ctrl+O");
        ImGui::SameLine();
        if (ImGui::Button("Picture")) pictureWanted_ = true;
        tooltip("Save what the view shows as a PNG (F12)");
        ImGui::SameLine(0, 1);
        pictureMenu();
        ImGui::SameLine();
        if (toggleButton("Buffers", drawer_ == Drawer::Buffers)) toggle(Drawer::Buffers);
        tooltip("Look into every image of the frame (B)");
        ImGui::SameLine();
        if (toggleButton("Timings", drawer_ == Drawer::Timings)) toggle(Drawer::Timings);
        tooltip("What each pass costs (T)");
        ImGui::SameLine();
        compare_.button(session_, yardstick_, view_);
        ImGui::SameLine();
        if (toggleButton("Trade-off", drawer_ == Drawer::TradeOff)) toggle(Drawer::TradeOff);
        tooltip("Cost and error of every technique, and the best within a budget (M)");
        ImGui::SameLine();
        if (toggleButton("Motion", drawer_ == Drawer::Motion)) toggle(Drawer::Motion);
        tooltip("How long a technique drags a ghost behind when something moves (J)");
        ImGui::SameLine();
        if (toggleButton("Probe", drawer_ == Drawer::Probe)) openProbe();
        tooltip("What a technique tells of one pixel, over the frames (P)");
        ImGui::SameLine();
        if (ImGui::Button("Help")) openHelp_ = true;
        tooltip("Keys and mouse (H)");
        ImGui::SameLine();
        status();
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
}

void Workspace::status() {
    const bool approximate = renderer_.softwareRenderer() && timedHow_ == Timing::Queries;
    const double frame = timings_.frameMedian(), cost = timings_.costMedian();
    const ShortText costText = session_.comparison.against == Against::Technique
                                   ? ShortText("cost {:.2f} + {:.2f} ms", costs()[0], costs()[1])
                                   : ShortText("cost {:.2f} ms", cost);
    const ShortText time =
        frame > 0 ? ShortText("{}    frame {:.2f} ms{}", costText.view(), frame, approximate ? "  approximate" : "")
                  : ShortText("– ms");
    ImGui::AlignTextToFramePadding();
    const float room = ImGui::GetContentRegionAvail().x;
    ImGui::PushStyleColor(ImGuiCol_Text, colour::muted);
    for (const ShortText& line : {ShortText("{} × {}    {}", session_.size.x, session_.size.y, time.view()), time,
                                  ShortText("{:.2f} ms", frame), ShortText("")})
        if (ImGui::CalcTextSize(line.begin(), line.end()).x <= room) {
            rightText(line.view());
            break;
        }
    ImGui::PopStyleColor();
    tooltip(approximate ? "The view's pixels, the technique's cost and the frame's time. Timer queries of a software "
                          "renderer leave work out; open the timings for honest numbers."
                        : "The view's pixels, the technique's cost and the frame's time on the renderer");
}

void Workspace::splitter(ImVec2 corner, float width, float height, float highest) {
    const float em = ImGui::GetFontSize(), thickness = 0.5f * em;
    const ImVec2 contentStart = ImGui::GetCursorPos();
    ImGui::SetCursorScreenPos(corner);
    ImGui::InvisibleButton("splitter", {std::max(width, 1.0f), thickness});
    const bool grabbed = ImGui::IsItemActive();
    if (grabbed)
        drawerHeight_ = std::clamp(height - ImGui::GetIO().MouseDelta.y / em, std::min(lowestDrawer, highest), highest);
    if (grabbed || ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeNS);
    ImGui::GetWindowDrawList()->AddLine(corner, {corner.x + width, corner.y},
                                        ImGui::GetColorU32(grabbed ? ImGuiCol_SeparatorActive : ImGuiCol_Separator),
                                        0.12f * em);
    ImGui::SetCursorPos(contentStart);
}

void Workspace::drawer(float pixelsPerUnit) {
    if (!renderer_.hasFrame()) return;
    if (drawer_ == Drawer::Buffers) {
        if (const auto shot = buffers_.draw(renderer_, viewport_.frames(), pixelsPerUnit))
            attempt([&] { say(fmt::format("Saved {}", actions_.saveBuffer(*shot).string())); });
    } else if (drawer_ == Drawer::TradeOff) {
        drawTradeOff();
    } else if (drawer_ == Drawer::Motion) {
        drawMotion();
    } else if (drawer_ == Drawer::Probe) {
        probe_.draw(session_);
    } else if (timings_.draw(renderer_, renderer_.softwareRenderer() && timedHow_ == Timing::Queries)) {
        exportTimings();
    }
}

void Workspace::drawTradeOff() {
    const bool idle = !tradeOff_.measuring();
    const TradeOffPanel::Requests requests = tradeOff_.draw(session_, chartPictureIn_ > 0, motion_.measuring());
    if (idle && tradeOff_.measuring()) playback_.playing = false; // a still view is measured
    if (requests.restart) viewport_.restart();
    if (requests.savePicture) chartPictureIn_ = 3;
    if (requests.saveTable)
        attempt([&] {
            const std::string table = tradeOff_.csv(session_, renderer_.driver());
            say(fmt::format("Saved {}", actions_.saveTradeOff(table).string()));
        });
}

void Workspace::drawMotion() {
    const bool idle = !motion_.measuring();
    motion_.draw(session_, tradeOff_.measuring());
    if (idle && motion_.measuring()) playback_.playing = false; // it starts from a moment
}

// Of the pixel under the pointer, where none is followed yet.
void Workspace::openProbe() {
    toggle(Drawer::Probe);
    if (drawer_ == Drawer::Probe && !probe_.probe.following() && viewport_.pointed())
        probe_.probe.follow(*viewport_.pointed());
}

void Workspace::followProbe(ImVec2 corner, ImVec2 size) {
    if (viewport_.clicked()) probe_.probe.follow(*viewport_.clicked());
    if (viewport_.rightClicked()) probe_.probe.letGo();
    if (viewport_.renderedNow()) {
        const bool two = session_.comparison.against == Against::Technique;
        probe_.probe.look(renderer_, session_.techniques.technique().probePlots(),
                          ShortText("{}{}", two ? "a/" : "", session_.techniques.card().id).view());
    }
    probe_.probe.take();
    const int panes = session_.comparison.sideBySide() ? 2 : 1;
    for (int i = 0; i < panes; ++i)
        probe_.overlay(session_, {corner.x + static_cast<float>(i) * size.x / static_cast<float>(panes), corner.y},
                       {size.x / static_cast<float>(panes), size.y});
}

void Workspace::carryOut(Requests& requests) {
    if (requests.restart) viewport_.restart();
    if (requests.chooseFile) chooser_.open(facts_.scene->file.parent_path());
    if (requests.openScene) openScene(std::move(*requests.openScene));
    if (requests.loadPreset && attempt([&] { actions_.loadPreset(*requests.loadPreset); })) {
        side_.takePreset(session_.techniques, requests.loadPreset->substr(requests.loadPreset->find('/') + 1));
        viewport_.restart();
    }
    if (requests.savePreset && attempt([&] { actions_.savePreset(*requests.savePreset); })) {
        side_.takePreset(session_.techniques, *requests.savePreset);
        say(fmt::format("Preset {} saved", *requests.savePreset));
    }
    if (requests.renamePreset) {
        const auto& [name, newName] = *requests.renamePreset;
        if (attempt([&] { actions_.renamePreset(name, newName); })) {
            side_.renamePreset(newName);
            say(fmt::format("Preset {} is now {}", name, newName));
        }
    }
    if (requests.deletePreset && attempt([&] { actions_.deletePreset(*requests.deletePreset); })) {
        side_.takePreset(session_.techniques, "");
        say(fmt::format("Preset {} deleted", *requests.deletePreset));
    }
    if (requests.listPresets || requests.savePreset || requests.renamePreset || requests.deletePreset)
        side_.setPresetNames(actions_.presetNames());
}

void Workspace::takeLoaded() {
    std::optional<LoadedScene> loaded;
    if (!attempt([&] { loaded = loader_.poll(); }) || !loaded) return;
    if (loading_.keepView) {
        loaded->opened.camera = session_.camera;
        loaded->opened.light = session_.light;
        loaded->opened.furtherLights = session_.furtherLights;
        loaded->opened.ground = session_.ground;
    }
    session_.setScene(std::move(loaded->opened));
    renderer_.take(std::move(loaded->prepared));
    const std::string note = loading_.restore ? loading_.restore(session_) : std::string();
    facts_ = SceneFacts(session_.scene);
    if (session_.comparison.against == Against::Truth) yardstick_.truthWanted = true;
    playback_ = {};
    viewport_.invalidate();
    viewport_.restart();
    timings_.forget();
    say(note.empty() ? fmt::format("{}: {} triangles", session_.scene->name, facts_.triangles) : note);
}

void Workspace::loadingBar(ImVec2 corner, float width, bool cancel) {
    const Progress& progress = *loader_.progress();
    const float em = ImGui::GetFontSize(), padding = 0.6f * em;
    const float height = ImGui::GetTextLineHeightWithSpacing() + ImGui::GetFrameHeight() + 2 * padding;
    const ImVec2 size{std::min(30 * em, std::max(width - 2 * padding, 1.0f)), height};
    ImGui::SetCursorScreenPos({corner.x + padding, corner.y - size.y - padding});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {padding, padding});
    ImGui::PushStyleColor(ImGuiCol_ChildBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
    if (ImGui::BeginChild("loading", size, true,
                          ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_AlwaysUseWindowPadding)) {
        const std::string name = std::filesystem::path(loading_.nameOrFile).filename().string();
        text(ShortText("Loading {}: {}", name, progress.doing()).view());
        cancel = progressWithCancel(progress) || cancel;
        tooltip("Keep the scene that is shown (Esc)");
    }
    ImGui::EndChild();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
    if (cancel) {
        loader_.cancel();
        say("Loading cancelled");
    }
}

// Of what the session says, which the last picture may not yet show.
void Workspace::takePicture() {
    if (renderer_.hasFrame() && !viewport_.upToDate()) return;
    pictureWanted_ = false;
    if (!renderer_.hasFrame()) return say("There is no picture to save yet");
    attempt([&] { saving_.push_back(actions_.savePicture(false)); });
}

void Workspace::drawn() {
    if (chartPictureIn_ > 0 && --chartPictureIn_ == 0)
        attempt([&] {
            const auto file = actions_.saveChart(tradeOff_.chartCorner(), tradeOff_.chartSize());
            say(fmt::format("Saved {}", file.string()));
        });
    if (windowPictureIn_ == 0 || (renderer_.hasFrame() && !viewport_.upToDate())) return;
    // The first frame closes menus and tooltips; no message shall lie over the view.
    messageSeconds_ = 0;
    if (--windowPictureIn_ == 0) attempt([&] { saving_.push_back(actions_.savePicture(true)); });
}

void Workspace::collectSaved() {
    for (size_t i = 0; i < saving_.size();) {
        if (saving_[i].wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
            ++i;
            continue;
        }
        std::future<std::filesystem::path> saved = std::move(saving_[i]);
        saving_.erase(saving_.begin() + static_cast<ptrdiff_t>(i));
        attempt([&] { say(fmt::format("Saved {}", saved.get().string())); });
    }
}

void Workspace::pictureMenu() {
    if (ImGui::ArrowButton("picture menu", ImGuiDir_Down)) ImGui::OpenPopup("pictures");
    tooltip("What to save, and where");
    const ImVec2 button = ImGui::GetItemRectMin();
    ImGui::SetNextWindowPos({button.x, ImGui::GetItemRectMax().y + ImGui::GetStyle().FramePadding.y});
    if (!beginPopup("pictures")) return;
    if (ImGui::MenuItem("The view", "F12")) pictureWanted_ = true;
    if (ImGui::MenuItem("The whole window, with its panels", "Shift+F12")) windowPictureIn_ = 2;
    ImGui::Separator();
    text(colour::muted, "Into");
    ImGui::SameLine();
    text(actions_.picturesFolder().string());
    if (ImGui::MenuItem("Another folder…")) folderChooser_.open(actions_.picturesFolder());
    ImGui::EndPopup();
}

void Workspace::noteTimes() {
    if (!renderer_.hasFrame()) return;
    if (viewport_.renderedNow() && timedHow_ != timing()) {
        timings_.forget();
        timedHow_ = timing();
    }
    renderer_.pollTimes();
    const ParameterSet& parameters = session_.techniques.parameters();
    work_.clear();
    for (const char c : session_.techniques.card().id) work_.push_back(static_cast<unsigned char>(c));
    for (const Parameter* parameter : parameters.all()) work_.push_back(parameter->bits());
    work_.push_back(static_cast<uint32_t>(session_.size.x));
    work_.push_back(static_cast<uint32_t>(session_.size.y));
    const PassTimer& timer = renderer_.runner().timer();
    timings_.add(timer.newest(), timer.frame(), work_);
    if (timer.newest().number == costsFrame_) return;
    costsFrame_ = timer.newest().number;
    for (size_t i = 0; i < costs_.size(); ++i)
        costs_[i].add(costOf(timer.newest(), renderer_.flow(), i == 0 ? "a" : "b"));
}

// Medians of A and B [ms].
std::array<double, 2> Workspace::costs() const {
    if (session_.comparison.against != Against::Technique) return {timings_.costMedian(), 0};
    constexpr size_t newest = 15; // frames
    return {costs_[0].quantile(0.5, newest), costs_[1].quantile(0.5, newest)};
}

void Workspace::exportTimings() {
    const std::string_view method = timedHow_ == Timing::Finish    ? "glFinish and clock"
                                    : renderer_.softwareRenderer() ? "timer queries, approximate"
                                                                   : "timer queries";
    attempt([&] {
        const std::string table =
            timings_.csv(renderer_.flow(), session_.techniques.card().id, renderer_.driver(), method);
        say(fmt::format("Saved {}", actions_.saveTimings(table).string()));
    });
}

void Workspace::message(ImVec2 corner, float width) {
    if (messageSeconds_ <= 0 || message_.empty()) return;
    const float padding = 0.6f * ImGui::GetFontSize(), wrap = std::max(width - 4 * padding, 1.0f);
    const char* first = message_.data();
    const char* last = first + message_.size();
    const ImVec2 extent = ImGui::CalcTextSize(first, last, false, wrap);
    const float opacity = std::min(messageSeconds_, 1.0f);
    const ImVec2 from{corner.x + padding, corner.y - extent.y - 2 * padding};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImVec4 paper = ImGui::GetStyleColorVec4(ImGuiCol_PopupBg), ink = colour::text;
    paper.w = 0.92f * opacity;
    ink.w = opacity;
    list.AddRectFilled(from, {from.x + extent.x + 2 * padding, from.y + extent.y + padding}, ImGui::GetColorU32(paper),
                       0.3f * ImGui::GetFontSize());
    list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), {from.x + padding, from.y + padding / 2},
                 ImGui::GetColorU32(ink), first, last, wrap);
}

void Workspace::dialogs(const Keys& keys) {
    if (const auto file = chooser_.draw(keys.escape)) openScene({file->string()});
    if (const auto folder = folderChooser_.draw(keys.escape))
        if (attempt([&] { actions_.setPicturesFolder(*folder); }))
            say(fmt::format("Pictures go into {}", actions_.picturesFolder().string()));
    helpDialog(keys.escape && !openHelp_);
    errorDialog(keys.escape && !openError_);
}

void Workspace::helpDialog(bool close) {
    constexpr const char* title = "Keys and mouse";
    if (openHelp_) ImGui::OpenPopup(title);
    openHelp_ = false;
    if (!beginDialog(title, 78)) return;
    // The view's keys and the others side by side where there is room.
    const auto others = std::find_if(std::begin(keyHelp), std::end(keyHelp),
                                     [](const KeyHelp& help) { return help.keys == keyHelpSecondHalf; });
    const bool wide = ImGui::GetContentRegionAvail().x > 60 * ImGui::GetFontSize();
    if (ImGui::BeginTable("halves", wide ? 2 : 1, ImGuiTableFlags_SizingStretchProp)) {
        if (wide) {
            ImGui::TableSetupColumn("view", ImGuiTableColumnFlags_WidthStretch, 0.57f);
            ImGui::TableSetupColumn("others", ImGuiTableColumnFlags_WidthStretch, 0.43f);
        }
        ImGui::TableNextColumn();
        keyTable("view", std::span(std::begin(keyHelp), others));
        ImGui::TableNextColumn();
        keyTable("others", std::span(others, std::end(keyHelp)));
        ImGui::EndTable();
    }
    ImGui::Spacing();
    if (ImGui::Button("Close") || close) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void Workspace::errorDialog(bool close) {
    constexpr const char* title = "That did not work";
    if (openError_) ImGui::OpenPopup(title);
    openError_ = false;
    if (!beginDialog(title)) return;
    wrappedText(error_);
    ImGui::Spacing();
    if (ImGui::Button("Close") || close) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

} // namespace penumbra
