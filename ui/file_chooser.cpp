// SPDX-License-Identifier: MIT
#include "ui/file_chooser.h"

#include <algorithm>
#include <tuple>

namespace penumbra {

namespace fs = std::filesystem;

namespace {

bool isScene(const fs::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    return ending == ".gltf" || ending == ".glb";
}

} // namespace

void FileChooser::open(const fs::path& folder) {
    std::error_code ignored;
    enter(folder.empty() ? fs::current_path(ignored) : fs::absolute(folder, ignored));
    opening_ = true;
}

void FileChooser::enter(const fs::path& folder) {
    folder_ = folder.lexically_normal();
    if (!folder_.has_filename() && folder_.has_relative_path()) folder_ = folder_.parent_path(); // no slash at the end
    typed_.set(folder_.string());
    entries_.clear();
    trouble_.clear();
    std::error_code error, ignored;
    for (fs::directory_iterator i(folder_, fs::directory_options::skip_permission_denied, error), end;
         !error && i != end; i.increment(error)) {
        const std::string name = i->path().filename().string();
        const bool isFolder = i->is_directory(ignored);
        if (!name.starts_with('.') && (isFolder || (pick_ == Pick::Scene && isScene(i->path()))))
            entries_.push_back({name, isFolder});
    }
    if (error) trouble_ = error.message();
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return std::tuple(!a.folder, std::string_view(a.name)) < std::tuple(!b.folder, std::string_view(b.name));
    });
}

std::optional<fs::path> FileChooser::draw(bool cancelled) {
    const bool folders = pick_ == Pick::Folder;
    const char* title = folders ? "Folder for pictures and tables" : "Open a scene";
    if (opening_) ImGui::OpenPopup(title);
    cancelled = cancelled && !opening_;
    opening_ = false;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float em = ImGui::GetFontSize();
    ImGui::SetNextWindowSize({std::min(46 * em, 0.95f * screen.x), std::min(30 * em, 0.9f * screen.y)});
    ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove))
        return std::nullopt;

    std::optional<fs::path> chosen;
    const float up = ImGui::CalcTextSize("Up").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(-up - ImGui::GetStyle().ItemSpacing.x);
    if (typed_.edit("##folder", folders ? "folder" : "folder or file", ImGuiInputTextFlags_EnterReturnsTrue)) {
        const fs::path typed(typed_.view());
        std::error_code ignored;
        if (fs::is_directory(typed, ignored))
            enter(typed);
        else
            chosen = typed;
    }
    ImGui::SameLine();
    if (ImGui::Button("Up")) enter(folder_.parent_path());

    std::optional<fs::path> entered;
    ImGui::BeginChild("entries", {0, -ImGui::GetFrameHeightWithSpacing()}, true);
    if (!trouble_.empty())
        wrappedText(colour::error, trouble_);
    else if (entries_.empty())
        text(colour::muted, folders ? "No folders here." : "No folders and no .gltf or .glb files here.");
    for (const Entry& entry : entries_) {
        const ShortText line("{}{}", entry.name, entry.folder ? "/" : "");
        if (entry.folder) ImGui::PushStyleColor(ImGuiCol_Text, colour::muted);
        const bool picked = ImGui::Selectable(line.begin());
        if (entry.folder) ImGui::PopStyleColor();
        if (!picked) continue;
        if (entry.folder)
            entered = folder_ / entry.name;
        else
            chosen = folder_ / entry.name;
    }
    ImGui::EndChild();
    if (entered) enter(*entered);
    if (folders) {
        if (ImGui::Button("Take this folder")) chosen = fs::path(typed_.view());
        ImGui::SameLine();
    }
    if (ImGui::Button("Cancel") || cancelled || chosen) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return chosen;
}

} // namespace penumbra
