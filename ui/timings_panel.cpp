// SPDX-License-Identifier: MIT
#include "ui/timings_panel.h"

#include "renderer/core/csv.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr ImGuiTableFlags tableFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH |
                                       ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollY |
                                       ImGuiTableFlags_PadOuterX;

bool isCost(Stage stage) { return stage == Stage::ShadowMap || stage == Stage::Prefilter || stage == Stage::Resolve; }

// The cost in warm colours, the rest in cool ones; told apart by brightness too.
ImVec4 stageColour(Stage stage) {
    switch (stage) {
    case Stage::Scene: return {0.34f, 0.46f, 0.62f, 1};
    case Stage::ShadowMap: return {0.78f, 0.42f, 0.30f, 1};
    case Stage::Prefilter: return {0.89f, 0.60f, 0.32f, 1};
    case Stage::Resolve: return {0.95f, 0.80f, 0.47f, 1};
    case Stage::Lighting: return {0.45f, 0.62f, 0.60f, 1};
    case Stage::Display: return {0.62f, 0.66f, 0.74f, 1};
    }
    return colour::muted;
}

float swatchSide() { return 0.62f * ImGui::GetFontSize(); }

void swatch(Stage stage) {
    const float side = swatchSide();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float top = at.y + (ImGui::GetTextLineHeight() - side) / 2;
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, top}, {at.x + side, top + side},
                                              ImGui::GetColorU32(stageColour(stage)), 0.15f * side);
    ImGui::Dummy({side, ImGui::GetTextLineHeight()});
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
}

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

ShortText millisecondsText(double milliseconds) { return ShortText("{:.3f}", milliseconds); }

void timeColumns(const Recent& times, size_t frames, double frame) {
    if (frames == 0) return;
    const double median = times.quantile(0.5, frames);
    ImGui::TableNextColumn();
    rightText(millisecondsText(median).view());
    ImGui::TableNextColumn();
    rightText(millisecondsText(times.quantile(0.95, frames)).view());
    ImGui::TableNextColumn();
    if (frame > 0) rightText(ShortText("{:.1f}", 100 * median / frame).view());
}

void numberColumns(float widthInEms, std::initializer_list<const char*> names) {
    for (const char* name : names)
        ImGui::TableSetupColumn(name, ImGuiTableColumnFlags_WidthFixed, widthInEms * ImGui::GetFontSize());
}

// The least of 1, 1.5, 2, 3, 5, 8, 10, 15 ... that is not below `value`.
double roundedUp(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(std::max(value, 1e-3))));
    for (const double digit : {1.0, 1.5, 2.0, 3.0, 5.0, 8.0})
        if (digit * power >= value) return digit * power;
    return 10 * power;
}

// Frames of a kept image take turns between two textures.
uint64_t bytesOf(const Flow::ImageNode& image) { return image.spec.bytes() * (image.kept ? 2 : 1); }

void imageTable(const Flow& flow) {
    // A narrow table keeps names and bytes; size and format are in the tooltip.
    const bool wide = ImGui::GetContentRegionAvail().x > 30 * ImGui::GetFontSize();
    if (!ImGui::BeginTable("images", wide ? 4 : 2, tableFlags)) return;
    ImGui::TableSetupColumn("Image", ImGuiTableColumnFlags_WidthStretch);
    if (wide) numberColumns(6, {"Size"});
    if (wide) numberColumns(7.3f, {"Format"});
    numberColumns(4.3f, {"Memory"});
    ImGui::TableSetupScrollFreeze(0, 1);
    if (wide)
        headers({"Image", "Size", "Format", "Memory"});
    else
        headers({"Image", "Memory"});
    const auto line = [&](std::string_view name, std::string_view size, std::string_view format, uint64_t bytes) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        text(name);
        tooltip(ShortText("{}\n{}  {}\n{} bytes", name, size, format, bytes).view());
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
    for (const Flow::ImageNode& image : flow.images())
        if (image.repeat <= 1)
            line(flow.label(image.label), extentText(image.spec.extent).view(), info(image.spec.format).name,
                 bytesOf(image));
    ImGui::EndTable();
}

} // namespace

void Recent::add(double value) {
    values_[next_] = value;
    next_ = (next_ + 1) % length;
    count_ = std::min(count_ + 1, length);
}

double Recent::ago(size_t frames) const { return values_[(next_ + 2 * length - 1 - frames) % length]; }

double Recent::quantile(double fraction, size_t last) const {
    const size_t count = std::min(count_, last);
    if (count == 0) return 0;
    std::array<double, length> sorted;
    for (size_t i = 0; i < count; ++i) sorted[i] = ago(i);
    const double place = fraction * static_cast<double>(count - 1);
    const auto below = static_cast<size_t>(place), above = std::min(below + 1, count - 1);
    std::sort(sorted.begin(), sorted.begin() + static_cast<ptrdiff_t>(count));
    return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

double costOf(const TimedFrame& timed, const Flow& flow, std::string_view instance) {
    const auto belongs = [&](int label) {
        const std::string_view text = flow.label(label);
        return text.size() > instance.size() && text.starts_with(instance) && text[instance.size()] == '/';
    };
    // The pass of an image that has a name of the instance's, too.
    const auto shared = [&](int label) {
        return std::any_of(flow.aliases().begin(), flow.aliases().end(), [&](const std::pair<int, int>& alias) {
            const Flow::ImageNode& image = flow.images()[static_cast<size_t>(alias.second)];
            return belongs(alias.first) && flow.passes()[static_cast<size_t>(image.pass)].label == label;
        });
    };
    double sum = 0;
    for (const PassTime& time : timed.passes)
        if (isCost(time.stage) && (belongs(time.label) || shared(time.label))) sum += time.milliseconds;
    return sum;
}

void TimingsPanel::add(const TimedFrame& timed, uint64_t rendered, std::span<const uint32_t> work) {
    if (!std::equal(work.begin(), work.end(), work_.begin(), work_.end())) {
        work_.assign(work.begin(), work.end());
        firstFrame_ = rendered;
        frames_ = 0;
        rows_.clear();
    }
    if (timed.number == lastFrame_) return;
    lastFrame_ = timed.number;
    std::array<double, stageCount> sums{};
    double cost = 0;
    for (const PassTime& time : timed.passes) {
        sums[static_cast<size_t>(time.stage)] += time.milliseconds;
        if (isCost(time.stage)) cost += time.milliseconds;
    }
    for (size_t i = 0; i < stageCount; ++i) stages_[i].add(sums[i]);
    frame_.add(timed.milliseconds);
    cost_.add(cost);
    if (lastFrame_ < firstFrame_) return; // timer queries come late
    frames_ = std::min(frames_ + 1, Recent::length);
    for (Row& row : rows_) row.seen = false;
    for (size_t i = 0; i < timed.passes.size(); ++i) {
        const PassTime& time = timed.passes[i];
        auto found = std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) { return row.label == time.label; });
        if (found == rows_.end())
            found = rows_.insert(rows_.begin() + static_cast<ptrdiff_t>(std::min(i, rows_.size())),
                                 Row{time.stage, time.label, {}, false});
        found->milliseconds.add(time.milliseconds);
        found->seen = true;
    }
    std::erase_if(rows_, [](const Row& row) { return !row.seen; });
}

void TimingsPanel::forget() { *this = TimingsPanel(); }

bool TimingsPanel::holds(Stage stage) const {
    return std::any_of(rows_.begin(), rows_.end(), [&](const Row& row) { return row.stage == stage; });
}

bool TimingsPanel::draw(const Renderer& renderer, bool approximate) const {
    ImGui::AlignTextToFramePadding();
    text(colour::muted, ShortText("Median and 95th percentile of the last {} frames", frames_).view());
    tooltip("Of frames with the same technique, parameters and sizes, 120 at most");
    if (approximate) {
        ImGui::SameLine();
        text(colour::warning, "approximate");
        tooltip("Timer queries of a software renderer leave out the work that it defers");
    }
    const char* exportLabel = "Export CSV";
    const ImGuiStyle& style = ImGui::GetStyle();
    const float button = ImGui::CalcTextSize(exportLabel).x + 2 * style.FramePadding.x;
    const float right = ImGui::GetWindowContentRegionMax().x - button;
    ImGui::SameLine();
    const std::string_view driver = renderer.driver();
    const float room = right - ImGui::GetCursorPosX() - 2 * style.ItemSpacing.x;
    const auto widthOf = [](std::string_view line) {
        return ImGui::CalcTextSize(line.data(), line.data() + line.size()).x;
    };
    // The whole name, or its first words, or nothing.
    const std::string_view brief = driver.substr(0, std::min(driver.find(" ("), driver.find(',')));
    if (widthOf(driver) < room)
        text(colour::muted, driver);
    else if (widthOf(brief) < room)
        text(colour::muted, brief);
    else
        text("");
    tooltip(driver);
    ImGui::SameLine(right);
    ImGui::BeginDisabled(frames_ == 0);
    const bool wanted = ImGui::Button(exportLabel);
    ImGui::EndDisabled();
    tooltip("Write these numbers as a table into the folder of pictures");

    // Names are long: where there is little room, the passes get more of it, and the images say less.
    const float width = ImGui::GetContentRegionAvail().x, em = ImGui::GetFontSize();
    const float share = width > 56 * em ? std::min(0.5f * width, width - 31.4f * em) : 0.6f * width;
    ImGui::BeginChild("times", {share, 0});
    passTable(renderer.flow());
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("graph and bytes", {0, 0});
    const ImVec2 rest = ImGui::GetContentRegionAvail();
    graph({rest.x, std::clamp(0.4f * rest.y, 3 * em, 9 * em)});
    imageTable(renderer.flow());
    ImGui::EndChild();
    return wanted;
}

void TimingsPanel::passTable(const Flow& flow) const {
    if (!ImGui::BeginTable("passes", 4, tableFlags)) return;
    ImGui::TableSetupColumn("Pass", ImGuiTableColumnFlags_WidthStretch);
    numberColumns(3.9f, {"median", "p95"});
    numberColumns(2.6f, {"%"});
    ImGui::TableSetupScrollFreeze(0, 1);
    headers({"Pass", "ms", "95 % ms", "%"});
    const double frame = frameMedian();
    const auto name = [](std::string_view line, std::string_view help, float indent) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + indent);
        text(line);
        tooltip(help); // the column may be too narrow for the line
    };
    ImGui::PushStyleColor(ImGuiCol_Text, colour::accent);
    name("Frame", "From the first pass to the end of the last one", 0);
    timeColumns(frame_, frames_, frame);
    name("Cost", "Cost of the technique: ShadowMap + Prefilter + Resolve", 0);
    timeColumns(cost_, frames_, frame);
    ImGui::PopStyleColor();
    for (size_t s = 0; s < stageCount; ++s) {
        const Stage stage = static_cast<Stage>(s);
        if (!holds(stage)) continue;
        ImGui::PushStyleColor(ImGuiCol_Text, colour::muted);
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        swatch(stage);
        text(stageName(stage));
        timeColumns(stages_[s], frames_, frame);
        ImGui::PopStyleColor();
        for (const Row& row : rows_) {
            if (row.stage != stage) continue;
            name(flow.label(row.label), flow.label(row.label), swatchSide() + ImGui::GetStyle().ItemInnerSpacing.x);
            timeColumns(row.milliseconds, frames_, frame);
        }
    }
    ImGui::EndTable();
}

// Columns of the last frames, the newest on the right, stacked by stage from below in the order of the frame.
void TimingsPanel::graph(ImVec2 size) const {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("graph", {std::max(size.x, 1.0f), std::max(size.y, 1.0f)});
    const bool hovered = ImGui::IsItemHovered();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float em = ImGui::GetFontSize(), bottom = corner.y + size.y;
    list.AddRectFilled(corner, {corner.x + size.x, bottom}, ImGui::GetColorU32(ImGuiCol_FrameBg), 0.25f * em);
    if (frame_.count() == 0) return;

    // A few slow frames do not press the others flat: they are cut, with a mark.
    const double top = roundedUp(1.15 * frame_.quantile(0.95));
    const float column = size.x / static_cast<float>(Recent::length);
    const auto height = [&](double milliseconds) {
        return static_cast<float>(std::min(milliseconds / top, 1.0)) * size.y;
    };
    for (size_t i = 0; i < frame_.count(); ++i) {
        const float right = corner.x + size.x - static_cast<float>(i) * column, left = right - column;
        double sum = 0;
        for (size_t s = 0; s < stageCount; ++s) {
            const double from = sum;
            sum += stages_[s].ago(i);
            if (sum > from)
                list.AddRectFilled({left, bottom - height(sum)}, {right, bottom - height(from)},
                                   ImGui::GetColorU32(stageColour(static_cast<Stage>(s))));
        }
        if (frame_.ago(i) > top)
            list.AddRectFilled({left, corner.y}, {right, corner.y + 0.2f * em}, ImGui::GetColorU32(colour::error));
    }
    const ImU32 line = ImGui::GetColorU32(ImGuiCol_Text, 0.18f);
    list.AddLine({corner.x, bottom - size.y / 2}, {corner.x + size.x, bottom - size.y / 2}, line);
    const auto label = [&](double milliseconds, float y) {
        const ShortText words("{:g} ms", milliseconds);
        const ImVec2 at{corner.x + 0.35f * em, y}, extent = ImGui::CalcTextSize(words.begin());
        list.AddRectFilled({at.x - 0.2f * em, at.y}, {at.x + extent.x + 0.2f * em, at.y + extent.y},
                           ImGui::GetColorU32(ImGuiCol_FrameBg, 0.75f), 0.2f * em);
        list.AddText(at, ImGui::GetColorU32(colour::text), words.begin());
    };
    label(top, corner.y + 0.1f * em);
    if (size.y > 4 * em) label(top / 2, bottom - size.y / 2 + 0.1f * em);
    if (!hovered) return;

    const auto frame = static_cast<size_t>(
        std::clamp((corner.x + size.x - ImGui::GetIO().MousePos.x) / column, 0.0f, float(Recent::length - 1)));
    if (frame >= frame_.count()) return;
    const float x = corner.x + size.x - (static_cast<float>(frame) + 0.5f) * column;
    list.AddLine({x, corner.y}, {x, bottom}, ImGui::GetColorU32(ImGuiCol_Text, 0.8f));
    beginHelp();
    text(colour::muted, frame == 0 ? ShortText("the newest frame").view() : ShortText("{} frames ago", frame).view());
    if (ImGui::BeginTable("of a frame", 2, ImGuiTableFlags_SizingFixedFit)) {
        const auto row = [&](std::string_view name, double milliseconds, const Stage* stage) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            if (stage) swatch(*stage);
            text(name);
            ImGui::TableNextColumn();
            rightText(ShortText("{:9.3f} ms", milliseconds).view());
        };
        row("Frame", frame_.ago(frame), nullptr);
        row("Cost", cost_.ago(frame), nullptr);
        for (size_t s = stageCount; s-- > 0;) // as they lie
            if (const Stage stage = static_cast<Stage>(s); stages_[s].ago(frame) > 0)
                row(stageName(stage), stages_[s].ago(frame), &stage);
        ImGui::EndTable();
    }
    endHelp();
}

std::string TimingsPanel::csv(const Flow& flow, std::string_view technique, std::string_view driver,
                              std::string_view method) const {
    std::string table = "technique,kind,stage,name,median_ms,p95_ms,width,height,layers,levels,samples,format,bytes,"
                        "frames,method,driver\n";
    const std::string end = fmt::format("{},{},{}\n", frames_, csvField(method), csvField(driver));
    const auto timeLine = [&](std::string_view kind, std::string_view stage, std::string_view name,
                              const Recent& times) {
        table += fmt::format("{},{},{},{},{:.6g},{:.6g},,,,,,,,{}", technique, kind, stage, csvField(name),
                             times.quantile(0.5, frames_), times.quantile(0.95, frames_), end);
    };
    timeLine("frame", "", "frame", frame_);
    timeLine("cost", "", "cost", cost_);
    for (size_t s = 0; s < stageCount; ++s) {
        const std::string_view stage = stageName(static_cast<Stage>(s));
        if (holds(static_cast<Stage>(s))) timeLine("stage", stage, stage, stages_[s]);
    }
    for (const Row& row : rows_) timeLine("pass", stageName(row.stage), flow.label(row.label), row.milliseconds);
    for (const Flow::ImageNode& image : flow.images()) {
        if (image.repeat > 1) continue; // rounds of a repeat share their labels
        const Extent& extent = image.spec.extent;
        table += fmt::format("{},image,{},{},,,{},{},{},{},{},{},{},{}", technique,
                             stageName(flow.passes()[static_cast<size_t>(image.pass)].stage),
                             csvField(flow.label(image.label)), extent.width, extent.height, extent.layers,
                             extent.levels, extent.samples, info(image.spec.format).name, bytesOf(image), end);
    }
    return table;
}

} // namespace penumbra
