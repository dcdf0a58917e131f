// SPDX-License-Identifier: MIT
#include "ui/compare_panel.h"

#include "ui/colours.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr float numbersWidth = 17, twoNumbersWidth = 22; // font heights
constexpr float smallView = 28;                          // font heights
constexpr std::array gains{1.0f, 10.0f, 100.0f};

std::string_view other(const Session& session) {
    return session.comparison.against == Against::Technique ? session.rival.card().title : "truth";
}

// On dark paper. `align` 0: the text begins at x, 1: it ends there; brief where it would be wider than `room`.
void label(float x, float y, float align, const ShortText& whole, std::string_view brief, float room) {
    const float padding = 0.4f * ImGui::GetFontSize();
    const bool fits = ImGui::CalcTextSize(whole.begin(), whole.end()).x + 2 * padding <= room;
    const ShortText line("{}", fits ? whole.view() : brief);
    const ImVec2 extent = ImGui::CalcTextSize(line.begin(), line.end());
    const ImVec2 from{std::round(x - align * (extent.x + 2 * padding)), std::round(y)};
    ImVec4 paper = ImGui::GetStyleColorVec4(ImGuiCol_PopupBg);
    paper.w = 0.85f;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(from, {from.x + extent.x + 2 * padding, from.y + extent.y + padding}, ImGui::GetColorU32(paper),
                       0.3f * ImGui::GetFontSize());
    list.AddText({from.x + padding, from.y + padding / 2}, ImGui::GetColorU32(colour::text), line.begin(), line.end());
}

// The colours of the error map and what they stand for.
void legend(ImVec2 corner, float gain) {
    const float em = ImGui::GetFontSize(), width = 12 * em, height = 0.7f * em;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImVec4 paper = ImGui::GetStyleColorVec4(ImGuiCol_PopupBg);
    paper.w = 0.85f;
    const float pad = 0.5f * em;
    list.AddRectFilled(corner, {corner.x + width + 2 * pad, corner.y + height + 2.5f * em + pad},
                       ImGui::GetColorU32(paper), 0.3f * em);
    const ImVec2 at{corner.x + pad, corner.y + pad};
    constexpr int steps = 32;
    for (int i = 0; i < steps; ++i) {
        const auto colourAt = [&](int k) { return divergingColour(2.0f * static_cast<float>(k) / steps - 1); };
        const auto x = [&](int k) { return at.x + width * static_cast<float>(k) / steps; };
        const ImU32 left = colourAt(i), right = colourAt(i + 1);
        list.AddRectFilledMultiColor({x(i), at.y}, {x(i + 1), at.y + height}, left, right, right, left);
    }
    const ImU32 ink = ImGui::GetColorU32(colour::text), muted = ImGui::GetColorU32(colour::muted);
    const auto write = [&](float align, float y, ImU32 colour, const ShortText& line) {
        const float extent = ImGui::CalcTextSize(line.begin(), line.end()).x;
        list.AddText({at.x + align * (width - extent), y}, colour, line.begin(), line.end());
    };
    const float first = at.y + height + 0.15f * em, second = first + 1.2f * em;
    write(0, first, ink, ShortText("−{:g}", 1 / gain));
    write(0.5f, first, ink, ShortText("0"));
    write(1, first, ink, ShortText("+{:g}", 1 / gain));
    write(0, second, muted, ShortText("too light"));
    write(1, second, muted, ShortText("too dark"));
}

// A panel in the lower right corner of what is left above `bottom`; the caller ends it.
bool beginCorner(const char* id, float right, float& bottom, ImVec2 size) {
    const float gap = 0.6f * ImGui::GetFontSize();
    bottom -= size.y + gap;
    ImGui::SetCursorScreenPos({right - size.x - gap, bottom});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {gap, gap});
    ImVec4 paper = ImGui::GetStyleColorVec4(ImGuiCol_PopupBg);
    paper.w = 0.9f;
    ImGui::PushStyleColor(ImGuiCol_ChildBg, paper);
    return ImGui::BeginChild(id, size, true, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_AlwaysUseWindowPadding);
}
void endCorner() {
    ImGui::EndChild();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
}

} // namespace

void ComparePanel::compare(Session& session, Yardstick& yardstick, Against against) {
    session.comparison.against = against;
    if (against != Against::Nothing) last_ = against;
    if (against == Against::Truth) wantTruth(session, yardstick, true);
}

void ComparePanel::wantTruth(Session& session, Yardstick& yardstick, bool wanted) {
    yardstick.truthWanted = wanted;
    if (wanted) yardstick.resume();
    if (!wanted && session.comparison.against == Against::Truth) session.comparison.against = Against::Nothing;
}

void ComparePanel::strokes(const Keys& keys, Session& session, Yardstick& yardstick, ViewSettings& view) {
    Comparison& comparison = session.comparison;
    const auto choose = [&](CompareAs as) { // whether it was chosen already
        const bool chosen = comparison.against != Against::Nothing && comparison.as == as;
        comparison.as = as;
        if (!chosen) compare(session, yardstick, last_);
        return chosen;
    };
    if (keys.truth) wantTruth(session, yardstick, !yardstick.truthWanted);
    if (keys.ruler) view.rulerShown = !view.rulerShown;
    if (keys.alone) compare(session, yardstick, Against::Nothing);
    if (keys.wipe) choose(CompareAs::Wipe);
    if (keys.flip && choose(CompareAs::Flip)) comparison.exchanged = !comparison.exchanged;
    if (keys.sideBySide) choose(CompareAs::SideBySide);
    if (keys.errorMap && choose(CompareAs::Error))
        comparison.gain = comparison.gain < 10 ? 10.0f : comparison.gain < 100 ? 100.0f : 1.0f;
    if (keys.exchange) comparison.exchanged = !comparison.exchanged;
}

void ComparePanel::button(Session& session, Yardstick& yardstick, ViewSettings& view) {
    const bool on = session.comparison.against != Against::Nothing || yardstick.truthWanted || view.rulerShown;
    if (toggleButton("Compare", on)) ImGui::OpenPopup("compare");
    tooltip("The technique beside the truth or beside another technique (1 2 3 4), errors (Y), penumbra ruler (U)");
    const float screen = ImGui::GetIO().DisplaySize.x, width = std::min(30 * ImGui::GetFontSize(), 0.95f * screen);
    ImGui::SetNextWindowPos({std::min(ImGui::GetItemRectMin().x, screen - width),
                             ImGui::GetItemRectMax().y + ImGui::GetStyle().FramePadding.y});
    ImGui::SetNextWindowSize({width, 0});
    if (!beginPopup("compare")) return;
    popup(session, yardstick, view);
    ImGui::EndPopup();
}

void ComparePanel::popup(Session& session, Yardstick& yardstick, ViewSettings& view) {
    Comparison& comparison = session.comparison;
    row("Truth ψ*");
    bool wanted = yardstick.truthWanted;
    if (ImGui::Checkbox("traced rays (Y)", &wanted)) wantTruth(session, yardstick, wanted);
    tooltip(
        "Traces, in the background, for every pixel the share of the light that its surface does not see, and shows "
        "how far the technique is from it");
    const auto against = [&](const char* name, Against value, const char* help) {
        if (ImGui::RadioButton(name, comparison.against == value)) compare(session, yardstick, value);
        tooltip(help);
    };
    row("Show A beside");
    against("nothing (0)", Against::Nothing, "The technique alone");
    row("");
    against("the truth", Against::Truth, "The same picture with the truth as its shadows");
    row("");
    against("technique B", Against::Technique,
            "Another technique, or the same one with other values. The panel then shows A or B");
    ImGui::BeginDisabled(comparison.against == Against::Nothing);
    const auto as = [&](const char* name, CompareAs value, const char* help) {
        if (ImGui::RadioButton(name, comparison.as == value)) comparison.as = value;
        tooltip(help);
    };
    row("As");
    as("wipe (1)", CompareAs::Wipe, "A left and B right of a line to drag");
    row("");
    as("flip (2)", CompareAs::Flip, "One at a time; X or 2 flips");
    row("");
    as("side by side (3)", CompareAs::SideBySide, "Two pictures from one camera");
    row("");
    as("error map (4)", CompareAs::Error,
       "ψ of A minus that of B: red where A is too dark, blue where it is too light");
    row("Errors times");
    for (const float gain : gains) {
        if (gain != gains[0]) ImGui::SameLine();
        if (ImGui::RadioButton(ShortText("{:g}", gain).begin(), comparison.gain == gain)) comparison.gain = gain;
    }
    row("Places");
    ImGui::Checkbox("exchanged (X)", &comparison.exchanged);
    tooltip("B where A was, and A where B was");
    ImGui::EndDisabled();
    row("Penumbra ruler");
    ImGui::Checkbox("shown (U)", &view.rulerShown);
    tooltip("A line to drag across a shadow's edge: ψ along it, and the width of the penumbra");
}

void ComparePanel::overlay(const Session& session, Yardstick& yardstick, const ViewSettings& view, ImVec2 corner,
                           ImVec2 size, std::array<double, 2> costs) {
    const Comparison& comparison = session.comparison;
    const float em = ImGui::GetFontSize(), gap = 0.6f * em, right = corner.x + size.x;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect(corner, {right, corner.y + size.y}, true);
    const ShortText a("A  {}", session.techniques.card().title), b("B  {}", other(session));
    const std::string_view brief[] = {comparison.exchanged ? "B" : "A", comparison.exchanged ? "A" : "B"};
    const ShortText &first = comparison.exchanged ? b : a, &second = comparison.exchanged ? a : b;
    const float top = corner.y + gap;
    if (comparison.against == Against::Truth && !session.comparing()) {
        label(
            corner.x + gap, top, 0,
            ShortText("{}    {}", a.view(),
                      yardstick.tracing().running ? "the truth is on its way" : "the truth comes when the view rests"),
            "A", size.x);
    } else if (comparison.against != Against::Nothing) {
        switch (comparison.as) {
        case CompareAs::Wipe: {
            const float x = std::round(corner.x + comparison.line * size.x);
            list.AddLine({x, corner.y}, {x, corner.y + size.y}, IM_COL32(0, 0, 0, 130), 0.3f * em);
            list.AddLine({x, corner.y}, {x, corner.y + size.y}, IM_COL32(255, 255, 255, 230), 0.1f * em);
            label(x - gap, top, 1, first, brief[0], x - gap - corner.x);
            label(x + gap, top, 0, second, brief[1], right - x - gap);
            break;
        }
        case CompareAs::Flip: label(corner.x + gap, top, 0, first, brief[0], size.x); break;
        case CompareAs::SideBySide: {
            const float x = std::round(corner.x + size.x / 2);
            list.AddLine({x, corner.y}, {x, corner.y + size.y}, IM_COL32(0, 0, 0, 255), 0.15f * em);
            label(corner.x + gap, top, 0, first, brief[0], size.x / 2 - gap);
            label(x + gap, top, 0, second, brief[1], size.x / 2 - gap);
            break;
        }
        case CompareAs::Error:
            label(corner.x + gap, top, 0,
                  ShortText("A − B    {} minus {}", session.techniques.card().title, other(session)), "A − B", size.x);
            legend({corner.x + gap, top + 1.9f * em}, comparison.gain);
            break;
        }
    }
    list.PopClipRect();

    const bool two = comparison.against == Against::Technique;
    float bottom = corner.y + size.y;
    const float most = std::max(size.x - 2 * gap, 1.0f), line = ImGui::GetTextLineHeightWithSpacing();
    const float wide = std::min((two ? twoNumbersWidth : numbersWidth) * em, most);
    const bool small = size.y < smallView * em, folded = folded_.value_or(small);
    if (yardstick.truthWanted || two) {
        float height = ImGui::GetTextLineHeight() + 2 * gap;
        if (!folded) {
            const float rows = (yardstick.truthWanted ? 5.0f : 1.0f) + (two ? 1.0f : 0.0f);
            height = rows * (ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y) + line + 2 * gap;
            if (yardstick.truthWanted) height += ImGui::GetFrameHeightWithSpacing() + line;
        }
        if (beginCorner("numbers", right, bottom, {wide, height})) numbers(session, yardstick, costs, folded);
        endCorner();
    }
    if (view.rulerShown) {
        const ImVec2 extent{wide, RulerPlot::height(yardstick, small) + 2 * gap};
        if (beginCorner("ruler", right, bottom, extent)) plot_.draw(view.ruler, yardstick, small);
        endCorner();
    }
}

void ComparePanel::numbers(const Session& session, Yardstick& yardstick, std::array<double, 2> costs, bool folded) {
    const bool two = session.comparison.against == Against::Technique;
    const auto& errors = yardstick.errors();
    const bool one = folded && yardstick.truthWanted && errors[0];
    const ShortText title =
        one && !two ? ShortText("RMSE {:.4f}   in penumbrae {:.4f}", errors[0]->all.rmse, errors[0]->penumbra.rmse)
        : one && errors[1]
            ? ShortText("RMSE   A {:.4f}   B {:.4f}", errors[0]->all.rmse, errors[1]->all.rmse)
            : ShortText("{}{}", two ? "A and B" : "A", yardstick.truthWanted ? " against the truth" : "");
    if (ImGui::Selectable("##fold")) folded_ = !folded;
    tooltip(folded ? "Show all numbers" : "Fold to one line");
    ImGui::SameLine(ImGui::GetStyle().WindowPadding.x);
    text(title.view());
    ImGui::SameLine();
    rightText(folded ? "▸" : "▾");
    if (folded) return;
    if (ImGui::BeginTable("numbers", two ? 3 : 2, ImGuiTableFlags_SizingStretchProp)) {
        ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch, 1.3f);
        const auto line = [&](std::string_view name, const char* help, auto&& value) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            text(colour::muted, name);
            tooltip(help);
            for (size_t i = 0; i < (two ? 2u : 1u); ++i) {
                ImGui::TableNextColumn();
                rightText(value(i).view());
            }
        };
        const auto error = [&](std::string_view name, const char* help, auto&& figure) {
            line(name, help, [&](size_t i) { return errors[i] ? figure(*errors[i]) : ShortText("–"); });
        };
        if (two) line("", "", [&](size_t i) { return ShortText("{}", i ? "B" : "A"); });
        if (yardstick.truthWanted) {
            error("RMSE", "Root of the mean squared error over all pixels that face the whole light",
                  [](const Errors& e) { return ShortText("{:.4f}", e.all.rmse); });
            error("in penumbrae", "The same over pixels whose truth lies between 0.01 and 0.99", [](const Errors& e) {
                return e.penumbraPixels ? ShortText("{:.4f}", e.penumbra.rmse) : ShortText("no penumbra");
            });
            error("bias", "Mean error over all of them: positive where shadows are too dark",
                  [](const Errors& e) { return ShortText("{:+.4f}", e.all.bias); });
            error("99th percentile", "Ninety-nine of a hundred pixels are not farther from the truth",
                  [](const Errors& e) { return ShortText("{:.4f}", e.all.p99); });
        }
        line("cost", "Milliseconds for shadow maps, prefilters and the technique itself",
             [&](size_t i) { return costs[i] > 0 ? ShortText("{:.2f} ms", costs[i]) : ShortText("– ms"); });
        ImGui::EndTable();
    }
    if (yardstick.truthWanted) truthLine(session, yardstick);
}

// How good the truth is, and how far it has come.
void ComparePanel::truthLine(const Session& session, Yardstick& yardstick) {
    const Truth* truth = yardstick.truth();
    const BackgroundTruth::State state = yardstick.tracing();
    if (truth) {
        text(ShortText("ψ* ± {:.4f}", truth->meanPenumbraStandardError).view());
        tooltip("The truth's own standard error, the mean over penumbrae");
        ImGui::SameLine();
        rightText(ShortText("{:.0f} rays a pixel", truth->samplesMean).view());
    } else {
        text(colour::muted, "ψ*");
    }
    const char* button = yardstick.cancelled() ? "Go on" : "Cancel";
    const float width = ImGui::CalcTextSize(button).x + 2 * ImGui::GetStyle().FramePadding.x;
    const auto buttonHere = [&] {
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - width);
        return ImGui::Button(button);
    };
    if (!state.error.empty()) {
        text(colour::error, state.error);
        tooltip(state.error);
    } else if (state.running) {
        const ShortText left = state.secondsLeft < 0 ? ShortText("{:.0f} %", 100 * state.share)
                                                     : ShortText("{:.0f} %, {:.0f} s left", 100 * state.share,
                                                                 std::ceil(state.secondsLeft));
        ImGui::PushStyleColor(ImGuiCol_PlotHistogram, ImVec4(0.45f, 0.36f, 0.22f, 1)); // words lie over it
        ImGui::ProgressBar(static_cast<float>(state.share), {-width - ImGui::GetStyle().ItemSpacing.x, 0},
                           left.begin());
        ImGui::PopStyleColor();
        if (buttonHere()) yardstick.cancel();
        tooltip("Leave the truth as good as it is");
    } else if (yardstick.cancelled()) {
        ImGui::AlignTextToFramePadding();
        text(colour::muted, "cancelled");
        if (buttonHere()) yardstick.resume();
    } else {
        ImGui::AlignTextToFramePadding();
        text(colour::muted, truth && truth->complete ? (truth->fromCache ? "done before" : "done")
                            : session.timeStep != 0  ? "waits until time stands still"
                                                     : "waits until the view rests");
    }
}

} // namespace penumbra
