// SPDX-License-Identifier: MIT
#include "ui/probe_panel.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr float besideWidth = 15; // font heights
constexpr int fewestFrames = 16;  // that the chart shows

const ImVec4 truthInk = colour::text;

std::span<const ProbePlot> plotsOf(const Session& session) { return session.techniques.technique().probePlots(); }

// Calls with each plot that is drawn from samples, and its first column among them.
template <class Visit> void forColumns(std::span<const ProbePlot> plots, Visit&& visit) {
    size_t column = 0;
    for (const ProbePlot& plot : plots) {
        if (plot.kind == ProbePlot::Kind::Around || plot.kind == ProbePlot::Kind::Curves) continue;
        visit(plot, column);
        column += plot.series.size();
    }
}

// Lines have colours of their own; a band that of the line before it.
ImVec4 inkOf(const ProbePlot& plot, size_t series) {
    if (plot.series[series].mark == ProbeMark::Dots) return colour::muted;
    size_t line = 0;
    for (size_t i = 0; i < series; ++i) line += plot.series[i].mark == ProbeMark::Line;
    return lineColour(plot.series[series].mark == ProbeMark::Band && line > 0 ? line - 1 : line);
}

const ProbePlot* curvesOf(std::span<const ProbePlot> plots) {
    const auto found =
        std::find_if(plots.begin(), plots.end(), [](const ProbePlot& p) { return p.kind == ProbePlot::Kind::Curves; });
    return found == plots.end() ? nullptr : &*found;
}

// The rows of a plot of curves: one value a series for every place of the first.
struct Curves {
    const ProbePlot& plot;
    std::span<const float> row;
    size_t count() const { return row.size() / plot.series.size(); }
    float at(size_t place, size_t series) const { return row[place * plot.series.size() + series]; }
    // Of a series at an abscissa between the places.
    float valueAt(float x, size_t series) const {
        for (size_t k = 1; k < count(); ++k) {
            if (at(k, 0) < x) continue;
            const float share = (x - at(k - 1, 0)) / std::max(at(k, 0) - at(k - 1, 0), 1e-30f);
            return plot.series[series].mark == ProbeMark::Step ? at(k - 1, series)
                                                               : std::lerp(at(k - 1, series), at(k, series), share);
        }
        return at(count() - 1, series);
    }
};

ImVec4 curveInk(const ProbePlot& plot, size_t series) {
    switch (plot.series[series].mark) {
    case ProbeMark::Step: return colour::text;
    case ProbeMark::Upright: return colour::muted;
    default: break;
    }
    size_t line = 0;
    for (size_t i = 1; i < series; ++i)
        line += plot.series[i].mark != ProbeMark::Step && plot.series[i].mark != ProbeMark::Upright;
    return lineColour(line);
}

std::optional<float> truthAt(const Session& session, glm::ivec2 pixel) {
    const TruthImage* truth = session.currentTruth();
    if (!truth) return std::nullopt;
    const size_t texel =
        static_cast<size_t>(pixel.y) * static_cast<size_t>(session.size.x) + static_cast<size_t>(pixel.x);
    return (*truth->texels)[2 * texel];
}

} // namespace

void ProbePanel::draw(const Session& session) {
    const std::span<const ProbePlot> plots = plotsOf(session);
    if (plots.empty())
        return wrappedText(
            colour::muted,
            ShortText("{} has nothing to tell of single pixels.", session.techniques.card().title).view());
    if (!probe.following())
        return wrappedText(colour::muted, "Click a pixel of the view to follow it; a right click lets it go.");
    const float em = ImGui::GetFontSize();
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float beside = std::min(besideWidth * em, 0.45f * room.x);
    ImGui::BeginGroup();
    const ImVec2 chart{std::max(room.x - beside - ImGui::GetStyle().ItemSpacing.x, 1.0f), std::max(room.y, 1.0f)};
    course(session, chart);
    curves(plots, chart);
    ImGui::EndGroup();
    ImGui::SameLine();
    if (ImGui::BeginChild("probe beside", {0, 0})) {
        numbers(session, truthAt(session, *probe.pixel(session.size)));
        forColumns(plots, [&](const ProbePlot& plot, size_t column) {
            if (plot.kind == ProbePlot::Kind::Places) places(plot, column, ImGui::GetContentRegionAvail().x);
        });
    }
    ImGui::EndChild();
}

void ProbePanel::course(const Session& session, ImVec2 size) {
    const auto& samples = probe.samples();
    const std::optional<float> truth = truthAt(session, *probe.pixel(session.size));
    forColumns(plotsOf(session), [&](const ProbePlot& shown, size_t column) {
        if (shown.kind != ProbePlot::Kind::Course) return;
        ImGui::AlignTextToFramePadding();
        text(colour::muted, shown.title);
        tooltip(shown.help);
        ImGui::SameLine();
        ImGui::Checkbox("fit", &fitted_);
        tooltip("Let the lines fill the chart, instead of all of ψ from 0 to 1");
        ImGui::SameLine();
        ImGui::Checkbox("log frames", &logarithmic_);
        tooltip("Frames on a logarithmic axis");
        const int first = samples.empty() ? 1 : samples.front().frame;
        const int last = std::max(samples.empty() ? 1 : samples.back().frame, first + fewestFrames - 1);
        ChartAxis up{-0.06, 1.06, false};
        if (fitted_) {
            float least = truth.value_or(1e9f), most = truth.value_or(-1e9f);
            for (const Probe::Sample& sample : samples)
                for (size_t i = 0; i < shown.series.size(); ++i)
                    if (const float v = sample.values[column + i];
                        shown.series[i].mark == ProbeMark::Line && std::isfinite(v))
                        least = std::min(least, v), most = std::max(most, v);
            if (least <= most) {
                const double margin = std::max(0.08 * double(most - least), 0.005);
                up = {least - margin, most + margin, false};
            }
        }
        const float heading = ImGui::GetFrameHeightWithSpacing();
        const Plot plot{ImGui::GetCursorScreenPos(),
                        {size.x, std::max(size.y - heading, 1.0f)},
                        {logarithmic_ ? std::max(0.9 * first, 0.9) : first - 0.5, last + 0.5, logarithmic_},
                        up,
                        "Frames of the history",
                        "ψ"};
        ImGui::Dummy(plot.size);
        plot.drawPaper();
        if (!plot.drawable()) return;
        plot.drawAxes();
        ImDrawList& list = *ImGui::GetWindowDrawList();
        list.PushClipRect({plot.low().x, plot.high().y - 2}, {plot.high().x + 2, plot.low().y}, true);
        drawCourse(plot, shown, column, truth);
        list.PopClipRect();
    });
}

void ProbePanel::curves(std::span<const ProbePlot> plots, ImVec2 size) const {
    const ProbePlot* const shown = curvesOf(plots);
    if (!shown) return;
    ImGui::AlignTextToFramePadding();
    text(colour::muted, shown->title);
    tooltip(shown->help);
    const Curves curves{*shown, probe.row()};
    const bool known = curves.count() > 1;
    const float heading = ImGui::GetFrameHeightWithSpacing();
    const Plot plot{ImGui::GetCursorScreenPos(),
                    {size.x, std::max(size.y - heading, 1.0f)},
                    {known ? curves.at(0, 0) : 0.0, known ? curves.at(curves.count() - 1, 0) : 1.0, false},
                    {-0.06, 1.06, false},
                    shown->across,
                    shown->up};
    ImGui::Dummy(plot.size);
    plot.drawPaper();
    if (!plot.drawable()) return;
    plot.drawAxes();
    if (!known) return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float em = ImGui::GetFontSize(), width = 0.12f * em;
    list.PushClipRect({plot.low().x, plot.high().y}, {plot.high().x, plot.low().y}, true);
    for (size_t i = 1; i < shown->series.size(); ++i) {
        const ImU32 ink = ImGui::GetColorU32(curveInk(*shown, i));
        const auto point = [&](size_t k) { return plot.at(curves.at(k, 0), curves.at(k, i)); };
        const ProbeMark mark = shown->series[i].mark;
        if (mark == ProbeMark::Upright) {
            const float x = plot.at(curves.at(0, i), 0).x;
            list.AddLine({x, plot.low().y}, {x, plot.high().y}, ink, width);
            continue;
        }
        constexpr size_t dash = 4; // places
        for (size_t k = 1; k < curves.count(); ++k) {
            if (mark == ProbeMark::Dashed && k / dash % 2 == 1) continue;
            const ImVec2 from = point(k - 1), to = point(k);
            if (mark == ProbeMark::Step) {
                list.AddLine(from, {to.x, from.y}, ink, 1.6f * width);
                list.AddLine({to.x, from.y}, to, ink, 1.6f * width);
            } else {
                list.AddLine(from, to, ink, mark == ProbeMark::Heavy ? 2 * width : width);
            }
        }
    }
    list.PopClipRect();
}

void ProbePanel::drawCourse(const Plot& plot, const ProbePlot& course, size_t column,
                            std::optional<float> truth) const {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const auto& samples = probe.samples();
    const float em = ImGui::GetFontSize(), width = 0.12f * em;
    const auto value = [&](size_t k, size_t series) { return samples[k].values[column + series]; };
    const auto clear = [&](double y) { return y >= plot.up.from && y <= plot.up.to; };
    // Bands below, then dots, then lines.
    for (size_t i = 1; i < course.series.size(); ++i) {
        if (course.series[i].mark != ProbeMark::Band) continue;
        const ImU32 ink = faded(inkOf(course, i), 0.2f);
        const auto edge = [&](size_t k, float sign) {
            return plot.at(samples[k].frame, double{value(k, i - 1)} + sign * value(k, i));
        };
        for (size_t k = 1; k < samples.size(); ++k)
            if (std::isfinite(value(k - 1, i)) && std::isfinite(value(k, i)))
                list.AddQuadFilled(edge(k - 1, -1), edge(k - 1, 1), edge(k, 1), edge(k, -1), ink);
    }
    if (truth && clear(*truth)) {
        const ImVec2 from{plot.low().x, plot.at(1, *truth).y}, to{plot.high().x, from.y};
        list.AddLine(from, to, faded(truthInk, 0.85f), width);
    }
    for (size_t i = 0; i < course.series.size(); ++i) {
        const ImU32 ink = ImGui::GetColorU32(inkOf(course, i));
        if (course.series[i].mark == ProbeMark::Dots)
            for (size_t k = 0; k < samples.size(); ++k)
                if (clear(value(k, i)))
                    list.AddCircleFilled(plot.at(samples[k].frame, value(k, i)), 0.14f * em, ink, 8);
        if (course.series[i].mark != ProbeMark::Line) continue;
        for (size_t k = 1; k < samples.size(); ++k)
            if (std::isfinite(value(k - 1, i)) && std::isfinite(value(k, i)))
                list.AddLine(plot.at(samples[k - 1].frame, value(k - 1, i)), plot.at(samples[k].frame, value(k, i)),
                             ink, width);
        if (samples.size() == 1) list.AddCircleFilled(plot.at(samples[0].frame, value(0, i)), 0.2f * em, ink);
    }
}

void ProbePanel::places(const ProbePlot& plot, size_t column, float side) const {
    const float em = ImGui::GetFontSize();
    subtitle(plot.title);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    side = std::min(side, std::max(ImGui::GetContentRegionAvail().y, 6 * em));
    ImGui::Dummy({side, side});
    tooltip(plot.help);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, {corner.x + side, corner.y + side}, ImGui::GetColorU32(ImGuiCol_FrameBg), 0.25f * em);
    const float half = side / 2 - 0.5f * em;
    const ImVec2 middle{corner.x + side / 2, corner.y + side / 2};
    list.AddRect({middle.x - half, middle.y - half}, {middle.x + half, middle.y + half},
                 ImGui::GetColorU32(ImGuiCol_Separator));
    const auto& samples = probe.samples();
    const ImU32 ink = ImGui::GetColorU32(colour::accent);
    const float radius =
        std::clamp(1.6f * half / std::sqrt(static_cast<float>(samples.size()) + 1) / 2, 0.08f * em, 0.28f * em);
    for (size_t k = 0; k < samples.size(); ++k) {
        const float *v = samples[k].values.data() + column, x = v[0], y = v[1];
        if (!std::isfinite(x) || !std::isfinite(y)) continue;
        const ImVec2 at{middle.x + half * x, middle.y - half * y};
        if (v[2] > 0.5f)
            list.AddCircleFilled(at, radius, ink, 12);
        else
            list.AddCircle(at, radius, faded(colour::text, 0.8f), 12, 0.07f * em);
        if (k + 1 == samples.size())
            list.AddCircle(at, radius + 0.25f * em, ImGui::GetColorU32(colour::text), 0, 0.1f * em);
    }
}

void ProbePanel::numbers(const Session& session, std::optional<float> truth) const {
    const glm::ivec2 fromBelow = *probe.pixel(session.size);
    const auto& samples = probe.samples();
    text(colour::muted, ShortText("Pixel {}, {}{}", fromBelow.x, session.size.y - 1 - fromBelow.y,
                                  samples.empty() ? "" : ShortText("   frame {}", samples.back().frame).view())
                            .view());
    if (!ImGui::BeginTable("probed", 2, ImGuiTableFlags_SizingStretchProp)) return;
    const auto line = [](ImVec4 ink, std::string_view name, const ShortText& value) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        text(ink, name);
        ImGui::TableNextColumn();
        rightText(value.view());
    };
    forColumns(plotsOf(session), [&](const ProbePlot& plot, size_t column) {
        if (plot.kind != ProbePlot::Kind::Course || samples.empty()) return;
        for (size_t i = 0; i < plot.series.size(); ++i)
            line(inkOf(plot, i), plot.series[i].name, ShortText("{:.4g}", samples.back().values[column + i]));
    });
    if (const ProbePlot* const shown = curvesOf(plotsOf(session))) {
        const Curves curves{*shown, probe.row()};
        const auto fragment = std::find_if(shown->series.begin(), shown->series.end(),
                                           [](const ProbeSeries& s) { return s.mark == ProbeMark::Upright; });
        if (curves.count() > 1 && fragment != shown->series.end()) {
            const auto upright = static_cast<size_t>(fragment - shown->series.begin());
            const float x = curves.at(0, upright);
            for (size_t i = 1; i < shown->series.size(); ++i)
                line(curveInk(*shown, i), shown->series[i].name,
                     ShortText("{:.4f}", i == upright ? x : curves.valueAt(x, i)));
        }
    }
    if (truth) line(truthInk, "truth ψ*", ShortText("{:.4f}", *truth));
    ImGui::EndTable();
    if (!truth) text(colour::muted, "no truth yet (Y)");
}

void ProbePanel::overlay(const Session& session, ImVec2 corner, ImVec2 size) const {
    if (!probe.following()) return;
    const glm::ivec2 pixel = *probe.pixel(session.size);
    const float em = ImGui::GetFontSize();
    const float unit = size.x / static_cast<float>(session.size.x); // window units a pixel
    const ImVec2 at{corner.x + (static_cast<float>(pixel.x) + 0.5f) * unit,
                    corner.y + size.y - (static_cast<float>(pixel.y) + 0.5f) * unit};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, true);
    const ImU32 ink = ImGui::GetColorU32(colour::accent), dark = IM_COL32(0, 0, 0, 170);
    for (const ProbePlot& plot : plotsOf(session)) {
        if (plot.kind != ProbePlot::Kind::Around) continue;
        const std::vector<float>& around = probe.row();
        for (size_t i = 0; i + 2 < around.size(); i += 3) {
            if (around[i + 2] < 0) continue;
            const ImVec2 place{at.x + around[i] * unit, at.y - around[i + 1] * unit};
            const float radius = 0.2f * em;
            list.AddCircleFilled(place, radius + 0.08f * em, dark, 12);
            if (around[i + 2] > 0)
                list.AddCircleFilled(place, radius, ink, 12);
            else
                list.AddCircle(place, radius, IM_COL32_WHITE, 12, 0.1f * em);
        }
    }
    const float inner = 0.35f * em, outer = 0.9f * em;
    for (const auto& [width, colour] : {std::pair(0.26f * em, dark), std::pair(0.1f * em, IM_COL32_WHITE)}) {
        list.AddLine({at.x - outer, at.y}, {at.x - inner, at.y}, colour, width);
        list.AddLine({at.x + inner, at.y}, {at.x + outer, at.y}, colour, width);
        list.AddLine({at.x, at.y - outer}, {at.x, at.y - inner}, colour, width);
        list.AddLine({at.x, at.y + inner}, {at.x, at.y + outer}, colour, width);
    }
    list.PopClipRect();
}

} // namespace penumbra
