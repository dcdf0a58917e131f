// SPDX-License-Identifier: MIT
#include "ui/side_panel.h"

#include "ui/numbers.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

Requests SidePanel::draw(Session& session, const SceneFacts& facts, Playback& playback, ViewSettings& view,
                         HistoryControl& history, int historyLength) {
    Requests requests;
    if (section("Scene", true)) {
        ImGui::PushID("scene");
        scene(session, facts, requests);
        timeControls(session, playback);
        ImGui::PopID();
    }
    const bool two = session.comparison.against == Against::Technique;
    if (section("Technique", true)) {
        if (two) chooseEdited(session);
        technique(shelf(session), requests);
        historyControls(history, historyLength, requests);
    }
    if (section("Parameters", true)) parameters_.draw(shelf(session).parameters());
    if (section("Presets", false)) {
        if (two && editsRival_)
            wrappedText(colour::muted, "Presets are those of technique A.");
        else
            presets(session, requests);
    }
    if (section("Light", true)) {
        ImGui::PushID("light");
        light_.draw(session, facts, view);
        ImGui::PopID();
    }
    if (section("Camera", false)) {
        ImGui::PushID("camera");
        camera_.draw(session, facts, view);
        ImGui::PopID();
    }
    if (section("Display", true)) displayControls(session.display);
    return requests;
}

void SidePanel::scene(Session& session, const SceneFacts& facts, Requests& requests) {
    const Scene& scene = *session.scene;
    if (shownScene_ != &scene) {
        shownScene_ = &scene;
        path_.set(scene.file.string());
    }
    row("Scene");
    if (beginCombo("##built-in", scene.name.c_str())) {
        for (const std::string& name : builtIns_)
            if (ImGui::Selectable(name.c_str(), name == scene.name)) requests.openScene = SceneRequest{name};
        ImGui::EndCombo();
    }
    tooltip("The scenes that come with the program");
    row("File");
    const float open = ImGui::CalcTextSize("Open…").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(
        std::max(ImGui::GetContentRegionAvail().x - open - ImGui::GetStyle().ItemInnerSpacing.x, 1.0f));
    if (path_.edit("##path", ".gltf or .glb", ImGuiInputTextFlags_EnterReturnsTrue) && !path_.view().empty())
        requests.openScene = SceneRequest{std::string(path_.view())};
    tooltip(ShortText("{}\n\nType the path of a .gltf or .glb file and press Enter, or drop a file on the window",
                      path_.view())
                .view());
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    requests.chooseFile = ImGui::Button("Open…");
    choices(scene, requests);
    if (!scene.description.empty()) wrappedText(colour::muted, scene.description);
    row("Triangles");
    text(ShortText("{}", facts.triangles).view());
    row("Size");
    text(ShortText("{:.3g} m across", facts.size).view());
    row("Ground");
    ImGui::Checkbox("##ground", &session.ground);
    tooltip("A plane below the scene that receives shadows, for scenes without a floor");
    if (!scene.notes.empty() &&
        ImGui::TreeNode("notes", "%s", ShortText("{} notes on this file", scene.notes.size()).begin())) {
        for (const std::string& note : scene.notes) wrappedText(colour::muted, note);
        ImGui::TreePop();
    }
}

// What the file itself offers to choose from.
void SidePanel::choices(const Scene& scene, Requests& requests) {
    const auto reopen = [&](ImportChoice choice) {
        requests.openScene = SceneRequest{scene.file.string(), std::move(choice), true};
    };
    const auto nameOf = [](const std::vector<std::string>& names, int index) {
        return index < 0 || static_cast<size_t>(index) >= names.size() ? std::string()
                                                                       : names[static_cast<size_t>(index)];
    };
    const ImportChoice chosen{nameOf(scene.sceneNames, scene.chosenScene),
                              nameOf(scene.variantNames, scene.chosenVariant)};
    if (scene.sceneNames.size() > 1) {
        row("Part");
        if (beginCombo("##part", chosen.scene.c_str())) {
            for (const std::string& name : scene.sceneNames)
                if (ImGui::Selectable(name.c_str(), name == chosen.scene)) reopen({name, chosen.variant});
            ImGui::EndCombo();
        }
        tooltip("The scenes that the file holds");
    }
    if (!scene.variantNames.empty()) {
        constexpr const char* none = "as modelled";
        row("Variant");
        if (beginCombo("##variant", chosen.variant.empty() ? none : chosen.variant.c_str())) {
            if (ImGui::Selectable(none, chosen.variant.empty())) reopen({chosen.scene, ""});
            for (const std::string& name : scene.variantNames)
                if (ImGui::Selectable(name.c_str(), name == chosen.variant)) reopen({chosen.scene, name});
            ImGui::EndCombo();
        }
        tooltip("The variants of its materials that the file holds");
    }
}

void timeControls(Session& session, Playback& playback) {
    const std::vector<Animation>& clips = session.scene->animations;
    if (clips.empty()) return;
    if (clips.size() > 1) {
        row("Clip");
        if (beginCombo("##clip", clips[session.clip].name.c_str(), ImGuiComboFlags_HeightLarge)) {
            for (size_t i = 0; i < clips.size(); ++i) {
                ImGui::PushID(static_cast<int>(i));
                if (ImGui::Selectable(clips[i].name.c_str(), i == session.clip)) {
                    session.clip = i;
                    session.time = 0;
                }
                ImGui::PopID();
            }
            ImGui::EndCombo();
        }
        tooltip("The animations that the file holds");
    }
    const double first = 0, duration = session.scene->duration(session.clip);
    if (duration <= 0) return;
    row("Time");
    double now = std::fmod(session.time, duration);
    if (ImGui::SliderScalar("##time", ImGuiDataType_Double, &now, &first, &duration, "%.3f s",
                            ImGuiSliderFlags_AlwaysClamp))
        session.time = now;
    tooltip("Where the animation is. Drag to scrub.");
    row("");
    if (ImGui::Button(playback.playing ? "Pause" : "Play")) playback.playing = !playback.playing;
    tooltip("Space");
    ImGui::SameLine();
    if (ImGui::Button("Step")) {
        playback.playing = false;
        playback.stepOnce = true;
    }
    tooltip("One frame of 1/60 s");
    row("Speed");
    ImGui::SliderFloat("##speed", &playback.speed, 0.05f, 4, "%.2f ×",
                       ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
    tooltip("How fast the animation plays. Double click: as fast as it was made.");
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) playback.speed = 1;
}

TechniqueShelf& SidePanel::shelf(Session& session) const {
    return session.comparison.against == Against::Technique && editsRival_ ? session.rival : session.techniques;
}

void SidePanel::chooseEdited(Session& session) {
    if (toggleButton("  A  ", !editsRival_)) editsRival_ = false;
    tooltip("Show and edit technique A");
    ImGui::SameLine(0, 1);
    if (toggleButton("  B  ", editsRival_)) editsRival_ = true;
    tooltip("Show and edit technique B");
    ImGui::SameLine();
    if (ImGui::Button("Swap")) std::swap(session.techniques, session.rival);
    tooltip("A becomes B and B becomes A, with all values");
    ImGui::SameLine();
    if (ImGui::Button("Copy A to B")) session.rival.take(session.techniques.parameters());
    tooltip("Technique B becomes A with its values, to change one of them");
}

void SidePanel::technique(TechniqueShelf& shelf, Requests& requests) {
    const Card& card = shelf.card();
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (beginCombo("##technique", ShortText("{}", card.title).begin(), ImGuiComboFlags_HeightLarge)) {
        for (const Card* other : catalogue()) {
            if (ImGui::Selectable(ShortText("{}", other->title).begin(), other == &card) && other != &card) {
                shelf.choose(other->id);
                requests.restart = true;
            }
            tooltip(other->idea);
        }
        ImGui::EndCombo();
    }
    if (card.year != 0)
        wrappedText(
            colour::muted,
            ShortText("{}, {}{}{}", card.authors, card.year, card.venue.empty() ? "" : ", ", card.venue).view());
    wrappedText(card.idea);
    if ((!card.assumes.empty() || !card.fails.empty()) && ImGui::TreeNode("Assumes and fails")) {
        if (!card.assumes.empty()) {
            text(colour::muted, "Assumes");
            wrappedText(card.assumes);
        }
        if (!card.fails.empty()) {
            text(colour::muted, "Fails");
            wrappedText(card.fails);
        }
        ImGui::TreePop();
    }
}

void SidePanel::historyControls(HistoryControl& history, int length, Requests& requests) {
    constexpr const char* none = "This technique keeps nothing from frame to frame: there is no history to hold still.";
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x, padding = 2 * ImGui::GetStyle().FramePadding.x;
    if (ImGui::Button("Restart")) requests.restart = true;
    tooltip("Forget all history and start again at the first frame (R)");
    ImGui::BeginDisabled(length == 0);
    ImGui::SameLine(0, gap);
    if (toggleButton("Freeze", history.frozen())) history.freeze(!history.frozen());
    tooltip(length == 0 ? none
                        : "Hold the history still, or let it go on (K). What else is changed meanwhile is drawn with "
                          "the same past.");
    ImGui::SameLine(0, gap);
    if (ImGui::Button("Step")) history.step();
    tooltip(length == 0 ? none : "One frame more (N). An animation that plays goes on by 1/60 s.");
    ImGui::SameLine(0, gap);
    if (ImGui::Button("Run to")) requests.restart = history.runToTarget(length) || requests.restart;
    tooltip(length == 0 ? none
                        : "Go on until the history is of so many frames, or start anew if it is longer, then freeze "
                          "(Shift + N)");
    ImGui::SameLine(0, gap);
    ImGui::SetNextItemWidth(ImGui::CalcTextSize("9999").x + padding);
    ImGui::DragInt("##frames", &history.target, 0.25f, 1, HistoryControl::mostFrames, "%d",
                   ImGuiSliderFlags_AlwaysClamp);
    tooltip(length == 0 ? none : "Frames of the history. Drag, or Ctrl + click to type.");
    ImGui::EndDisabled();
}

void SidePanel::takePreset(const TechniqueShelf& techniques, std::string_view name) {
    presetOf_ = techniques.card().id;
    preset_ = name;
    presetName_.set(name);
    presetValues_.clear();
    for (const Parameter* parameter : techniques.parameters().all()) presetValues_.push_back(parameter->bits());
}

void SidePanel::presets(const Session& session, Requests& requests) {
    const std::string_view id = session.techniques.card().id;
    // "technique/name" → name; nothing for other techniques' presets.
    const auto nameOf = [&](std::string_view full) {
        const bool ours = full.size() > id.size() + 1 && full.starts_with(id) && full[id.size()] == '/';
        return ours ? full.substr(id.size() + 1) : std::string_view();
    };
    const auto among = [&](const std::vector<std::string>& names, std::string_view name) {
        return std::any_of(names.begin(), names.end(), [&](const std::string& full) { return nameOf(full) == name; });
    };
    const bool chosen = presetOf_ == id && !preset_.empty();
    const auto all = session.techniques.parameters().all();
    const bool changed = chosen && !std::equal(all.begin(), all.end(), presetValues_.begin(), presetValues_.end(),
                                               [](const Parameter* p, uint32_t bits) { return p->bits() == bits; });

    row("Preset");
    if (changed) ImGui::PushStyleColor(ImGuiCol_Text, colour::accent);
    const bool open =
        beginCombo("##presets", chosen ? ShortText("{}{}", preset_, changed ? ", changed" : "").begin() : "choose…",
                   ImGuiComboFlags_HeightLarge);
    if (changed) ImGui::PopStyleColor();
    if (open) {
        requests.listPresets = ImGui::IsWindowAppearing();
        bool any = false;
        const auto list = [&](const char* title, const std::vector<std::string>& names) {
            bool first = true;
            ImGui::PushID(title);
            for (const std::string& full : names) {
                if (nameOf(full).empty()) continue;
                if (first) text(colour::muted, title);
                first = false;
                any = true;
                const bool hidden = &names == &presetNames_.builtIn && among(presetNames_.own, nameOf(full));
                if (!hidden && ImGui::Selectable(full.c_str() + id.size() + 1, chosen && nameOf(full) == preset_))
                    requests.loadPreset = full;
            }
            ImGui::PopID();
        };
        list("Yours", presetNames_.own);
        list("Of the papers", presetNames_.builtIn);
        if (!any) text(colour::muted, "none for this technique yet");
        ImGui::EndCombo();
    }
    row("Name");
    const bool entered = presetName_.edit("##name", "to save the values under", ImGuiInputTextFlags_EnterReturnsTrue);
    const std::string_view name = presetName_.view();
    const bool exists = among(presetNames_.own, name), own = chosen && among(presetNames_.own, preset_);

    const ImGuiStyle& style = ImGui::GetStyle();
    const float width = ImGui::CalcTextSize("Overwrite").x + 2 * style.FramePadding.x;
    ImGui::BeginDisabled(name.empty());
    if ((ImGui::Button(exists ? "Overwrite###save" : "Save###save", {width, 0}) || entered) && !name.empty())
        requests.savePreset = std::string(name);
    ImGui::EndDisabled();
    tooltip("Keep the values that differ from the defaults under this name");
    ImGui::SameLine();
    ImGui::BeginDisabled(!own || name.empty() || name == preset_);
    if (ImGui::Button("Rename", {width, 0})) requests.renamePreset = {preset_, std::string(name)};
    ImGui::EndDisabled();
    tooltip(own ? "Give the chosen preset this name" : "Choose a preset of yours, then type its new name");
    ImGui::SameLine();
    ImGui::BeginDisabled(!own);
    if (ImGui::Button("Delete", {width, 0})) ImGui::OpenPopup("delete preset");
    ImGui::EndDisabled();
    const ImVec2 below{ImGui::GetItemRectMin().x, ImGui::GetItemRectMax().y + style.FramePadding.y};
    tooltip(own ? "Delete the file of the chosen preset" : "Only presets of yours can be deleted");
    ImGui::SetNextWindowPos(below);
    if (beginPopup("delete preset")) {
        text(ShortText("Delete the preset '{}'?", preset_).view());
        if (ImGui::Button("Delete it")) {
            requests.deletePreset = preset_;
            ImGui::CloseCurrentPopup();
        }
        ImGui::SameLine();
        if (ImGui::Button("Keep it")) ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
    }
}

void displayControls(DisplaySettings& display) {
    row("Show");
    if (ImGui::RadioButton("lit", display.show == Show::Lit)) display.show = Show::Lit;
    tooltip("The scene in its light (V)");
    ImGui::SameLine();
    if (ImGui::RadioButton("shadows  1 − ψ", display.show == Show::Shadow)) display.show = Show::Shadow;
    tooltip("The shadow image as a picture: white sees all of the light, black none of it (V)");
    row("Exposure");
    dragNumber("##exposure", display.exposure, 0.02f, limits::exposure, "%+.2f stops");
    row("Ambient");
    dragNumber("##ambient", display.ambient, 0.005f, limits::ambient, "%.3f");
    tooltip("Light from everywhere, relative to the light's irradiance");
}

} // namespace penumbra
