// SPDX-License-Identifier: MIT
#include "ui/motion_panel.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr float controlsWidth = 23; // font heights
constexpr int mostFrames = 512;
constexpr int framesBefore = 4; // of the rest that the chart shows
constexpr int sizeShare = 2;    // of the view's width and height that is measured: a truth a frame is dear
// Rougher than that of a still view; the error of a ghost is far above it.
constexpr TruthSettings roughTruth{
    .leastSamples = 64, .mostSamples = 1024, .wantedStandardError = 0.004, .background = true};

struct EventText {
    const char *label, *help;
};
constexpr EventText eventTexts[] = { // in the order of MotionEvent
    {"The camera pans", "By a pixel of the view's middle a frame, on and on"},
    {"The camera jumps", "By 20° round its target, once"},
    {"Casters move", "The animation starts to play, 1/60 s a frame"},
    {"Casters stop", "The animation has played, and stands still from the event on"},
    {"The light moves", "For 8 frames, by 2 % of its distance a frame"},
    {"The light grows", "For 8 frames, by 5 % a frame"}};

} // namespace

void MotionPanel::begin(const Session& session) {
    std::vector<Setting> settings;
    const auto add = [&](const TechniqueShelf& shelf, std::string_view which) {
        Setting& setting = settings.emplace_back(shelf.card(), shelf.parameters());
        courses_.push_back({fmt::format("{}{}", which, shelf.card().title), setting.text(), {}, {}, {}});
    };
    const bool two = session.comparison.against == Against::Technique;
    courses_.clear();
    add(session.techniques, two ? "A  " : "");
    if (two) add(session.rival, "B  ");
    Session view = stillView(session);
    view.size = glm::max(view.size / sizeShare, 1);
    measured_ = fmt::format("{}, {}, {} × {}, truth ± {:g}", session.scene->name, motionNames()[size_t(event_)],
                            view.size.x, view.size.y, roughTruth.wantedStandardError);
    TruthSettings truth = roughTruth;
    truth.cache = cache_;
    measurement_.move(std::move(view), std::move(settings), static_cast<MotionEvent>(event_), eventFrame + frames_,
                      truth);
}

std::string MotionPanel::poll() {
    const auto hear = [&] {
        for (const BackgroundMeasurement::MovedFrame& moved : measurement_.takeFrames()) {
            Course& course = courses_[moved.setting];
            course.all.push_back(moved.rmse);
            course.penumbra.push_back(moved.penumbraRmse);
        }
    };
    hear();
    try {
        const std::optional<BackgroundMeasurement::End> end = measurement_.poll();
        if (!end) return {};
        hear();
        std::string line;
        for (const SettingResult& result : measurement_.take()) {
            if (!result.errors && !result.trouble.empty()) line = result.trouble;
            courses_[result.setting.place].flicker = result.flicker;
        }
        return !line.empty() ? line : end->complete ? "" : "Stopped; what was measured is kept";
    } catch (const std::exception& error) {
        return error.what();
    }
}

void MotionPanel::draw(const Session& session, bool busy) {
    const float em = ImGui::GetFontSize();
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float right = std::min(controlsWidth * em, 0.5f * room.x);
    chart({std::max(room.x - right - ImGui::GetStyle().ItemSpacing.x, 1.0f), std::max(room.y, 1.0f)});
    ImGui::SameLine();
    if (ImGui::BeginChild("motion controls", {0, 0})) controls(session, busy);
    ImGui::EndChild();
}

void MotionPanel::chart(ImVec2 size) const {
    std::vector<double> shown;
    size_t longest = 0;
    for (const Course& course : courses_) {
        const std::vector<double>& errors = errorsOf(course);
        const size_t first = std::min<size_t>(eventFrame - framesBefore, errors.size());
        shown.insert(shown.end(), errors.begin() + static_cast<std::ptrdiff_t>(first), errors.end());
        longest = std::max(longest, errors.size());
    }
    const int most = std::max(static_cast<int>(longest) - 1 - eventFrame, frames_ - 1);
    const Plot plot{ImGui::GetCursorScreenPos(),
                    size,
                    {-double(framesBefore), double(std::max(most, 1)), false},
                    fitAxis(shown, false),
                    "Frames since the event",
                    error_ == Error::All ? "RMSE of ψ, all pixels" : "RMSE of ψ, penumbrae"};
    ImGui::Dummy(size);
    plot.drawPaper();
    if (!plot.drawable()) return;
    plot.drawAxes();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float em = ImGui::GetFontSize(), line = 0.12f * em;
    list.AddLine(plot.at(0, 0), {plot.at(0, 0).x, plot.high().y}, faded(colour::text, 0.45f), 0.08f * em);
    for (size_t i = courses_.size(); i-- > 0;) {
        const std::vector<double>& errors = errorsOf(courses_[i]);
        const ImVec4 ink = lineColour(i);
        const auto point = [&](size_t frame) { return plot.at(double(frame) - eventFrame, errors[frame]); };
        for (size_t frame = eventFrame - framesBefore; frame < errors.size(); ++frame) {
            if (frame > eventFrame - framesBefore)
                list.AddLine(point(frame - 1), point(frame), ImGui::GetColorU32(ink), line);
            list.AddCircleFilled(point(frame), 0.16f * em, ImGui::GetColorU32(ink));
        }
        if (errors.size() <= eventFrame) continue;
        // Where the ghost has lost half of its height.
        const Ghost ghost = ghostOf(std::span(errors).subspan(eventFrame));
        list.AddLine(plot.at(0, ghost.settled), plot.at(most, ghost.settled), faded(ink, 0.35f), 0.08f * em);
        if (!ghost.halfLife) continue;
        const auto peak = std::max_element(errors.begin() + eventFrame, errors.end());
        const size_t at = static_cast<size_t>(peak - errors.begin()) + static_cast<size_t>(*ghost.halfLife);
        list.AddCircle(point(at), 0.38f * em, ImGui::GetColorU32(ink), 0, 0.1f * em);
    }
    if (longest > eventFrame - framesBefore) return;
    const std::string_view hint = measuring() ? "the view rests…" : "Nothing is measured yet";
    const ImVec2 from = plot.low(), to = plot.high();
    list.AddText({(from.x + to.x - widthOf(hint)) / 2, (from.y + to.y) / 2 - em}, ImGui::GetColorU32(colour::muted),
                 hint.data(), hint.data() + hint.size());
}

void MotionPanel::progress() {
    const Progress& state = *measurement_.progress();
    if (progressWithCancel(state)) measurement_.stop();
    tooltip("Stop here; what is measured is kept");
    text(colour::muted, state.cancelled() ? "stopping" : state.doing());
}

void MotionPanel::controls(const Session& session, bool busy) {
    const bool animated = session.scene->duration(session.clip) > 0;
    const auto possible = [&](int event) { return animated || !movesCasters(static_cast<MotionEvent>(event)); };
    constexpr const char* still = "Nothing in this scene is animated.";
    row("Event");
    if (beginCombo("##event", eventTexts[event_].label, ImGuiComboFlags_HeightLarge)) {
        for (int i = 0; i < static_cast<int>(std::size(eventTexts)); ++i) {
            if (ImGui::Selectable(eventTexts[i].label, i == event_, possible(i) ? 0 : ImGuiSelectableFlags_Disabled))
                event_ = i;
            tooltip(possible(i) ? eventTexts[i].help : still);
        }
        ImGui::EndCombo();
    }
    tooltip(eventTexts[event_].help);
    row("Frames");
    ImGui::DragInt("##frames", &frames_, 0.25f, 4, mostFrames, "%d from then on", ImGuiSliderFlags_AlwaysClamp);
    tooltip("How many frames are measured from the event on. Each has a truth of its own, which takes a while.");
    if (measuring()) {
        progress();
    } else {
        ImGui::BeginDisabled(busy || !possible(event_));
        if (ImGui::Button("Measure", {-FLT_MIN, 0})) begin(session);
        ImGui::EndDisabled();
        tooltip(busy ? "The trade-off is being measured."
                : !possible(event_)
                    ? still
                    : "The present view at half its size rests for 16 frames, then it happens. Measured "
                      "are the technique that is shown and technique B, if there is one.");
        text(colour::muted, measured_.empty() ? std::string_view("Against traced rays, frame by frame") : measured_);
    }
    row("Error of");
    if (ImGui::RadioButton("penumbrae", error_ == Error::Penumbra)) error_ = Error::Penumbra;
    tooltip("Root mean square of ψ − ψ* over the pixels whose true ψ* is between 0.01 and 0.99");
    ImGui::SameLine();
    if (ImGui::RadioButton("all", error_ == Error::All)) error_ = Error::All;
    tooltip("Over all pixels that face the whole light");
    numbers();
}

void MotionPanel::numbers() const {
    for (size_t i = 0; i < courses_.size(); ++i) {
        const Course& course = courses_[i];
        const std::vector<double>& errors = errorsOf(course);
        ImGui::Spacing();
        wrappedText(lineColour(i), course.name);
        if (!course.values.empty()) wrappedText(colour::muted, course.values);
        if (errors.size() <= eventFrame) continue;
        const Ghost ghost = ghostOf(std::span(errors).subspan(eventFrame));
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::BeginTable("of a course", 2, ImGuiTableFlags_SizingStretchProp)) {
            const auto line = [](std::string_view name, const ShortText& value, const char* help) {
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                text(colour::muted, name);
                tooltip(help);
                ImGui::TableNextColumn();
                rightText(value.view());
            };
            line("At rest", ShortText("{:.4f}", errors[eventFrame - 1]), "RMSE of the last frame before the event");
            line("Peak", ShortText("{:.4f}", ghost.peak), "The largest RMSE from the event on");
            line("Settled", ShortText("{:.4f}", ghost.settled), "Mean RMSE of the last quarter of the frames");
            line("Half-life",
                 ghost.halfLife ? ShortText("{} frame{}", *ghost.halfLife, *ghost.halfLife == 1 ? "" : "s")
                                : ShortText("–"),
                 "Frames from the peak until the RMSE is half way to where it settles (ringed); – where there is "
                 "nothing to get over, or it is not reached");
            line("Flicker", course.flicker ? ShortText("{:.4f}", *course.flicker) : ShortText("–"),
                 "Mean change of ψ from frame to frame beyond that of the truth, over the second half of all frames; "
                 "not for "
                 "a camera that pans");
            ImGui::EndTable();
        }
        ImGui::PopID();
    }
}

} // namespace penumbra
