// SPDX-License-Identifier: MIT
#include "ui/parameter_panel.h"

#include "renderer/core/slider_scale.h"

#include <algorithm>

namespace penumbra {

namespace {

constexpr const char* resetSign = "↺";

float resetWidth() { return ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x; }

// "30 texels", "12°"
ShortText valueText(const Parameter& parameter) {
    const std::string_view unit = unitName(parameter.spec().unit);
    const char* gap = unit.empty() || parameter.spec().unit == Unit::Degrees ? "" : " ";
    if (parameter.type() == Parameter::Type::Integer)
        return ShortText("{}{}{}", static_cast<long long>(parameter.value()), gap, unit);
    return ShortText("{:.6g}{}{}", parameter.value(), gap, unit);
}

// What ImGui is to print as it stands: percent signs doubled.
ShortText asFormat(std::string_view line) {
    char doubled[256];
    size_t size = 0;
    for (const char c : line) {
        if (size + 2 > sizeof(doubled)) break;
        doubled[size++] = c;
        if (c == '%') doubled[size++] = c;
    }
    return ShortText("{}", std::string_view(doubled, size));
}

void help(const Parameter& parameter) {
    const Spec& spec = parameter.spec();
    beginHelp();
    text(parameter.label());
    text(colour::muted, parameter.qualifiedName());
    if (!parameter.active()) {
        ImGui::Spacing();
        text(colour::warning, ShortText("Without effect at the moment: {}", spec.inactiveReason).view());
    }
    ImGui::Spacing();
    if (!spec.help.empty()) text(spec.help);
    ImGui::Spacing();
    const auto line = [](std::string_view name, std::string_view value) {
        if (value.empty()) return;
        text(colour::muted, name);
        ImGui::SameLine(5 * ImGui::GetFontSize());
        text(colour::muted, value);
    };
    line("Symbol", spec.symbol);
    line("Unit", unitName(spec.unit));
    line("Range", parameter.rangeText());
    line("Default", parameter.textOf(parameter.defaultValue()));
    line("Source", spec.source);
    endHelp();
}

bool resetButton() {
    ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0, 0, 0, 0));
    const bool pressed = ImGui::Button(resetSign, {ImGui::GetFrameHeight(), 0});
    ImGui::PopStyleColor();
    return pressed;
}

} // namespace

void ParameterPanel::draw(ParameterSet& set) {
    if (set.all().empty()) {
        text(colour::muted, "This technique has nothing to tune.");
        return;
    }
    ImGui::PushID(&set);
    const auto all = set.all();
    group(set, {});
    // Groups in the order in which their first member was declared.
    for (size_t i = 0; i < all.size(); ++i) {
        const auto sameGroup = [&](const Parameter* p) { return p->group() == all[i]->group(); };
        if (!all[i]->group().empty() && std::none_of(all.begin(), all.begin() + static_cast<ptrdiff_t>(i), sameGroup))
            group(set, all[i]->group());
    }
    ImGui::Spacing();
    const bool changed = std::any_of(all.begin(), all.end(), [](const Parameter* p) { return p->changed(); });
    ImGui::BeginDisabled(!changed);
    if (ImGui::Button("Reset all")) set.reset();
    ImGui::EndDisabled();
    ImGui::PopID();
}

void ParameterPanel::group(ParameterSet& set, std::string_view title) {
    ImGui::PushID(ShortText("{}", title).begin());
    bool changed = false;
    bool any = false;
    for (const Parameter* p : set.all()) {
        any |= p->group() == title;
        changed |= p->group() == title && p->changed();
    }
    if (any) {
        // The row is as high with the button as without.
        const float right = ImGui::GetWindowContentRegionMax().x - ImGui::GetFrameHeight();
        subtitle(title.empty() ? "Technique" : title, resetWidth());
        ImGui::SameLine(right);
        if (!changed) ImGui::Dummy({ImGui::GetFrameHeight(), ImGui::GetFrameHeight()});
        if (changed && resetButton())
            for (Parameter* p : set.all())
                if (p->group() == title) p->reset();
        if (changed) tooltip("Give this group its defaults again");
    }
    for (Parameter* p : set.all())
        if (p->group() == title) parameterRow(*p);
    ImGui::PopID();
}

void ParameterPanel::parameterRow(Parameter& parameter) {
    const Spec& spec = parameter.spec();
    ImGui::PushID(&parameter);
    const bool changed = parameter.changed(), active = parameter.active();
    ImGui::PushStyleColor(ImGuiCol_Text, !active ? colour::muted : changed ? colour::accent : colour::text);
    const std::string label = parameter.label();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    row(spec.symbol.empty() ? ShortText("{}", label).view() : ShortText("{}  {}", label, spec.symbol).view(),
        resetWidth());
    ImGui::PopStyleColor();
    ImGui::BeginDisabled(!active);
    control(parameter);
    ImGui::EndDisabled();
    const ImVec2 opposite{ImGui::GetItemRectMax().x, ImGui::GetCursorScreenPos().y - ImGui::GetStyle().ItemSpacing.y};
    const bool pointed = ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(corner, opposite);
    if (typed_ != &parameter && pointed && !ImGui::IsMouseDown(ImGuiMouseButton_Left)) help(parameter);
    if (changed) {
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::GetFrameHeight());
        if (resetButton()) parameter.reset();
        tooltip(ShortText("Back to {}", parameter.textOf(parameter.defaultValue())).view());
    }
    if (refused_ == &parameter) wrappedText(colour::error, refusal_);
    ImGui::PopID();
}

void ParameterPanel::control(Parameter& parameter) {
    switch (parameter.type()) {
    case Parameter::Type::Flag: {
        bool on = parameter.value() != 0;
        if (ImGui::Checkbox("##flag", &on)) parameter.set(on ? 1 : 0);
        break;
    }
    case Parameter::Type::Choice: {
        const auto choices = parameter.spec().choices;
        if (!beginCombo("##choice", ShortText("{}", parameter.text()).begin())) break;
        for (size_t i = 0; i < choices.size(); ++i)
            if (ImGui::Selectable(ShortText("{}", choices[i]).begin(), parameter.value() == static_cast<double>(i)))
                parameter.set(static_cast<double>(i));
        ImGui::EndCombo();
        break;
    }
    case Parameter::Type::Real:
    case Parameter::Type::Integer:
        if (typed_ == &parameter)
            typeIn(parameter);
        else
            slider(parameter);
        break;
    }
}

void ParameterPanel::slider(Parameter& parameter) {
    const Spec& spec = parameter.spec();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 opposite{corner.x + ImGui::CalcItemWidth(), corner.y + ImGui::GetFrameHeight()};
    const bool over = ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(corner, opposite) && parameter.active();
    const bool twice = over && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
    // The first click of two has moved the slider.
    if (twice && pressed_ == &parameter) beforePress_ ? parameter.set(*beforePress_) : parameter.reset();
    if (over && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        pressed_ = &parameter;
        beforePress_ = parameter.changed() ? std::optional(parameter.value()) : std::nullopt;
    }
    if (twice || (over && ImGui::GetIO().KeyCtrl && ImGui::IsMouseClicked(ImGuiMouseButton_Left))) {
        typed_ = &parameter;
        focusTyped_ = true;
        typing_.set(parameter.text());
        typeIn(parameter);
        return;
    }
    float position = static_cast<float>(sliderPosition(spec, parameter.value()));
    const ShortText shown = asFormat(valueText(parameter).view());
    if (ImGui::SliderFloat("##slider", &position, 0, 1, shown.begin(),
                           ImGuiSliderFlags_NoInput | ImGuiSliderFlags_NoRoundToFormat)) {
        double value = sliderValue(spec, position);
        if (spec.step == 0) value = roundForHand(spec, value);
        parameter.set(parameter.nearest(value));
        refused_ = nullptr;
    }
}

void ParameterPanel::typeIn(Parameter& parameter) {
    if (focusTyped_) ImGui::SetKeyboardFocusHere();
    const bool entered = typing_.edit("##typed", "",
                                      ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll |
                                          ImGuiInputTextFlags_CharsScientific);
    const bool left = !focusTyped_ && ImGui::IsItemDeactivated();
    focusTyped_ = false;
    if (!entered && !left) return;
    typed_ = nullptr;
    refused_ = nullptr;
    if (!entered && !ImGui::IsItemDeactivatedAfterEdit()) return;
    try {
        parameter.setText(typing_.view());
    } catch (const InputError& error) {
        refused_ = &parameter;
        refusal_ = error.what();
    }
}

} // namespace penumbra
