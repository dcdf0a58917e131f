// SPDX-License-Identifier: MIT
#include "ui/timings_panel.h"

#include <algorithm>

namespace penumbra {

namespace {

constexpr ImGuiTableFlags tableFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH |
                                       ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollY |
                                       ImGuiTableFlags_PadOuterX;

void headers(std::initializer_list<std::string_view> names) {
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (const std::string_view& name : names) {
        ImGui::TableNextColumn();
        if (&name == names.begin())
            text(colour::muted, name);
        else {
            ImGui::PushStyleColor(ImGuiCol_Text, colour::muted);
            rightText(name);
            ImGui::PopStyleColor();
        }
    }
}

void timeRow(std::string_view name, double milliseconds, double frame) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    text(name);
    tooltip(name); // the column may be too narrow for it
    ImGui::TableNextColumn();
    rightText(ShortText("{:.3f}", milliseconds).view());
    ImGui::TableNextColumn();
    if (frame > 0) rightText(ShortText("{:.1f}", 100 * milliseconds / frame).view());
}

void numberColumns(float widthInEms, std::initializer_list<const char*> names) {
    for (const char* name : names)
        ImGui::TableSetupColumn(name, ImGuiTableColumnFlags_WidthFixed, widthInEms * ImGui::GetFontSize());
}

} // namespace

void MedianWindow::add(double value) {
    values_[next_] = value;
    next_ = (next_ + 1) % length;
    count_ = std::min(count_ + 1, length);
}

double MedianWindow::median() const {
    if (count_ == 0) return 0;
    std::array<double, length> sorted = values_;
    const auto middle = sorted.begin() + static_cast<ptrdiff_t>(count_ / 2);
    std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<ptrdiff_t>(count_));
    return *middle;
}

void TimingsPanel::add(const FlowRunner& runner) {
    if (runner.timer().frameMilliseconds() <= 0) return;
    frame_.add(runner.timer().frameMilliseconds());
    for (Row& row : rows_) row.seen = false;
    for (size_t i = 0; i < runner.timer().times().size(); ++i) {
        const PassTime& time = runner.timer().times()[i];
        auto found = std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) { return row.label == time.label; });
        if (found == rows_.end())
            found = rows_.insert(rows_.begin() + static_cast<ptrdiff_t>(std::min(i, rows_.size())),
                                 Row{time.stage, time.label, {}, false});
        found->milliseconds.add(time.milliseconds);
        found->seen = true;
    }
    std::erase_if(rows_, [](const Row& row) { return !row.seen; });
}

void TimingsPanel::forget() {
    rows_.clear();
    frame_ = {};
}

void TimingsPanel::draw(const Renderer& renderer, bool approximate) const {
    text(colour::muted,
         ShortText("Median of the last 60 frames{}  {}", approximate ? ", approximate" : "", renderer.driver()).view());
    // Names are long: where there is little room, the passes get more of it, and the images say less.
    const float width = ImGui::GetContentRegionAvail().x;
    const float share = (width > 50 * ImGui::GetFontSize() ? 0.44f : 0.54f) * width;
    ImGui::BeginChild("times", {share, 0});
    passTable(renderer.flow());
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("bytes", {0, 0});
    imageTable(renderer.flow());
    ImGui::EndChild();
}

void TimingsPanel::passTable(const Flow& flow) const {
    if (!ImGui::BeginTable("passes", 3, tableFlags)) return;
    ImGui::TableSetupColumn("Pass", ImGuiTableColumnFlags_WidthStretch);
    numberColumns(4, {"ms", "%"});
    ImGui::TableSetupScrollFreeze(0, 1);
    headers({"Pass", "ms", "% frame"});
    const double frame = frame_.median();
    ImGui::PushStyleColor(ImGuiCol_Text, colour::accent);
    timeRow("Frame", frame, frame);
    ImGui::PopStyleColor();
    for (size_t i = 0; i < rows_.size(); ++i) {
        const Stage stage = rows_[i].stage;
        const auto ofStage = [&](const Row& row) { return row.stage == stage; };
        const auto upTo = rows_.begin() + static_cast<ptrdiff_t>(i);
        if (std::any_of(rows_.begin(), upTo, ofStage)) continue;
        double sum = 0;
        for (const Row& row : rows_)
            if (ofStage(row)) sum += row.milliseconds.median();
        ImGui::PushStyleColor(ImGuiCol_Text, colour::muted);
        timeRow(stageName(stage), sum, frame);
        ImGui::PopStyleColor();
        for (const Row& row : rows_)
            if (ofStage(row)) timeRow(flow.label(row.label), row.milliseconds.median(), frame);
    }
    ImGui::EndTable();
}

void imageTable(const Flow& flow) {
    // A narrow table keeps names and bytes; size and format are in the tooltip.
    const bool wide = ImGui::GetContentRegionAvail().x > 27 * ImGui::GetFontSize();
    if (!ImGui::BeginTable("images", wide ? 4 : 2, tableFlags)) return;
    ImGui::TableSetupColumn("Image", ImGuiTableColumnFlags_WidthStretch);
    if (wide) numberColumns(6, {"Size"});
    if (wide) numberColumns(7.5f, {"Format"});
    numberColumns(4.5f, {"Memory"});
    ImGui::TableSetupScrollFreeze(0, 1);
    if (wide)
        headers({"Image", "Size", "Format", "Memory"});
    else
        headers({"Image", "Memory"});
    const auto line = [&](std::string_view name, std::string_view size, std::string_view format, uint64_t bytes) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        text(name);
        tooltip(ShortText("{}  {}  {}", name, size, format).view());
        if (wide) {
            ImGui::TableNextColumn();
            rightText(size);
            ImGui::TableNextColumn();
            rightText(format);
        }
        ImGui::TableNextColumn();
        rightText(bytesText(bytes).view());
    };
    ImGui::PushStyleColor(ImGuiCol_Text, colour::accent);
    line("All", "", "", flow.bytes());
    ImGui::PopStyleColor();
    for (const Flow::ImageNode& image : flow.images()) {
        if (image.repeat > 1) continue;
        // Frames of a kept image take turns between two textures.
        line(flow.label(image.label), extentText(image.spec.extent).view(), info(image.spec.format).name,
             image.spec.bytes() * (image.kept ? 2 : 1));
    }
    ImGui::EndTable();
}

} // namespace penumbra
