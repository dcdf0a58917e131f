// SPDX-License-Identifier: MIT
#include "ui/buffer_view.h"

#include "ui/colours.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace penumbra {

using glm::dvec2;
using glm::ivec2;

namespace {

constexpr double shortestInterval = 0.25; // between two measurings [s]
constexpr float texelForValues = 4.6f;    // font heights that a texel must be wide for its value to be printed
constexpr double smallestMagnification = 0.25, largestTexel = 256; // [pixels]

constexpr std::string_view colourNames[] = {"r", "g", "b", "a"};
constexpr std::string_view markNames[] = {"NaN", "Infinite", "Negative", "Out of range"};

const Channel* channelOf(const ImageSpec& spec, int channel) {
    const size_t index = static_cast<size_t>(channel);
    return channel >= 0 && index < spec.channels.size() ? &spec.channels[index] : nullptr;
}

// What whole numbers of a channel stand for, or nothing.
std::span<const std::string_view> kindsOf(const ImageSpec& spec, int channel) {
    const Channel* known = channelOf(spec, channel);
    return known ? known->names : std::span<const std::string_view>();
}

std::string_view kindOf(const ImageSpec& spec, int channel, float value) {
    const auto kinds = kindsOf(spec, channel);
    const float number = std::round(value);
    return number >= 0 && number < static_cast<float>(kinds.size()) ? kinds[static_cast<size_t>(number)]
                                                                    : std::string_view();
}

std::string_view unitOf(const ImageSpec& spec, int channel) {
    const Channel* known = channelOf(spec, channel);
    return known ? unitName(known->unit) : std::string_view();
}

ImU32 markInk(size_t mark) {
    const auto& c = markColours[mark];
    return ImGui::GetColorU32(ImVec4(c[0], c[1], c[2], 1));
}

ShortText countText(int64_t count) {
    if (count < 1000) return ShortText("{}", count);
    if (count < 1000000) return ShortText("{} {:03}", count / 1000, count % 1000);
    return ShortText("{} {:03} {:03}", count / 1000000, count / 1000 % 1000, count % 1000);
}

// White on a dark plate: it lies on any colour.
void plateText(ImDrawList& list, ImVec2 at, std::string_view line, ImVec2 size) {
    const float margin = 0.2f * ImGui::GetFontSize();
    list.AddRectFilled({at.x - margin, at.y}, {at.x + size.x + margin, at.y + size.y}, IM_COL32(0, 0, 0, 150), margin);
    list.AddText(at, IM_COL32_WHITE, line.data(), line.data() + line.size());
}

} // namespace

ShortText valueText(float value, std::string_view unit) {
    if (std::isnan(value)) return ShortText("NaN");
    const char* gap = unit.empty() || unit == "°" ? "" : " ";
    if (std::isinf(value)) return ShortText("{}∞{}{}", value < 0 ? "−" : "", gap, unit);
    return ShortText("{:.6g}{}{}", value, gap, unit);
}

std::string_view channelName(const ImageSpec& spec, int channel) {
    const Channel* known = channelOf(spec, channel);
    return known ? known->name : colourNames[static_cast<size_t>(channel)];
}

bool hasStatedRange(const ImageSpec& spec, int channel) {
    const Channel* known = channelOf(spec, std::max(channel, 0));
    return known && known->min < known->max;
}

Look firstLook(const ImageSpec& spec) {
    Look look;
    const bool colours = info(spec.format).channels >= 3 && (spec.channels.empty() || spec.channels[0].name == "red");
    look.channel = colours ? -1 : 0;
    if (hasStatedRange(spec, look.channel)) {
        look.range = {spec.channels[0].min, spec.channels[0].max};
        look.marks |= bit(Mark::OutOfRange);
    }
    if (!kindsOf(spec, look.channel).empty()) look.map = ColourMap::Flags;
    return look;
}

void BufferView::pick(const Flow& flow, std::string_view label) {
    const std::optional<Image> image = flow.find(label);
    ensure(image.has_value(), "an image was picked that is not there");
    label_ = label;
    spec_ = flow.spec(*image);
    look_ = firstLook(spec_);
    mode_ = hasStatedRange(spec_, look_.channel) ? RangeMode::Stated : RangeMode::Automatic;
    layer_ = level_ = sample_ = 0;
    frozen_.reset();
    freeze_ = false;
    pin_.reset();
    measured_.reset();
}

Source BufferView::source() const {
    return {frozen_ ? frozen_->texture : *texture_, spec_.channels, layer_, level_, sample_};
}

bool BufferView::update(const Renderer& renderer, Inspector& inspector, uint64_t frame, double share) {
    const std::optional<Image> image = renderer.flow().find(label_);
    if (freeze_ && !frozen_ && image) try {
            frozen_ = {renderer.runner().texture(renderer.flow(), *image).copy("ui.frozen"), frame};
        } catch (const InputError& error) {
            freeze_ = false;
            trouble_ = error.what();
        }
    if (!freeze_) frozen_.reset();
    if (!frozen_) {
        texture_ = image ? &renderer.runner().texture(renderer.flow(), *image) : nullptr;
        if (!texture_) return false;
        spec_ = renderer.flow().spec(*image);
        // What is as large as the geometry buffer shows what it does.
        const Extent& geometry = renderer.flow().spec(renderer.depth()).extent;
        margin_ =
            spec_.extent == geometry ? (ivec2(geometry.width, geometry.height) - renderer.view().size) / 2 : ivec2(0);
    }
    const Extent& extent = spec_.extent;
    layer_ = std::min(layer_, extent.layers - 1);
    level_ = std::min(level_, extent.levels - 1);
    sample_ = std::min(sample_, extent.samples - 1);
    const int channels = info(spec_.format).channels;
    look_.channel = std::min(look_.channel, channels - 1);
    if (channels < 3) look_.channel = std::max(look_.channel, 0);
    version_ = {frozen_ ? frozen_->frame : frame, &source().texture, layer_, level_, sample_};
    try {
        measure(inspector, share);
        followPin(inspector);
        trouble_.clear();
    } catch (const std::exception& error) { // a shader that does not compile
        trouble_ = error.what();
    }
    return true;
}

void BufferView::measure(Inspector& inspector, double share) {
    const double now = ImGui::GetTime();
    const Source from = source();
    const bool again = !measured_ || (version_ != *measured_ && now >= nextMeasuring_);
    if (again) {
        const auto start = std::chrono::steady_clock::now();
        automatic_ = nonEmpty(inspector.range(from, look_.channel).value_or(ValueRange()));
        settleRange();
        const ValueRange domain = widened(hull(automatic_, look_.range), 0.05);
        inspector.measure(from, look_.channel, domain, 0, statistics_);
        turn_ = 1;
        measured_ = version_;
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        nextMeasuring_ = now + std::max(shortestInterval, seconds / share);
    } else if (version_ == *measured_ && turn_ < Inspector::turns(from)) {
        inspector.measure(from, look_.channel, statistics_.domain, turn_++, statistics_);
    }
}

void BufferView::settleRange() {
    if (mode_ == RangeMode::Stated && !hasStatedRange(spec_, look_.channel)) mode_ = RangeMode::Automatic;
    const Channel* known = channelOf(spec_, std::max(look_.channel, 0));
    switch (mode_) {
    case RangeMode::Automatic: look_.range = automatic_; break;
    case RangeMode::Stated: look_.range = {known->min, known->max}; break;
    case RangeMode::Typed: look_.range = typed_; break;
    }
}

void BufferView::pin(dvec2 place) {
    const ivec2 size = source().size();
    pin_.emplace();
    pin_->texel = glm::clamp(ivec2(glm::floor(place * dvec2(size))), ivec2(0), size - 1);
}

void BufferView::followPin(Inspector& inspector) {
    if (!pin_) return;
    const Source from = source();
    if (glm::any(glm::greaterThanEqual(pin_->texel, from.size()))) return pin_.reset();
    if (pin_->count > 0 && pin_->frame == version_.frame) return;
    inspector.read(from, pin_->texel, {1, 1}, pinValues_);
    for (size_t c = 0; c < pinValues_.size(); ++c) pin_->values[c][pin_->next] = pinValues_[c];
    pin_->next = (pin_->next + 1) % pinLength;
    pin_->count = std::min(pin_->count + 1, pinLength);
    pin_->frame = version_.frame;
}

const float* BufferView::texelUnder(Inspector& inspector, ivec2 texel) {
    if (!underPointer_.fresh(version_, texel, {1, 1})) {
        inspector.read(source(), texel, {1, 1}, underPointer_.values);
        underPointer_.version = version_;
        underPointer_.corner = texel;
        underPointer_.size = {1, 1};
    }
    return underPointer_.values.data();
}

void BufferView::release() {
    painting_ = {};
    painted_ = {};
    texture_ = nullptr;
}

// --- the image -----------------------------------------------------------------------------------------------------

BufferView::Events BufferView::draw(Inspector& inspector, ImVec2 size, float pixelsPerUnit, Sight& sight,
                                    std::optional<dvec2> pointer, bool chosen) {
    Events events;
    const float captionHeight = ImGui::GetTextLineHeightWithSpacing();
    const ImVec2 top = ImGui::GetCursorScreenPos(), area{size.x, size.y - captionHeight};
    pointed_.reset();
    if (!texture_ && !frozen_) {
        caption(std::nullopt, size.x, chosen);
        if (picked()) wrappedText(colour::muted, "is not part of this frame");
        return events;
    }
    if (area.x < 2 || area.y < 2) return events;
    // On the screen's grid, or texels would be drawn half on two pixels.
    const ImVec2 corner{std::round(top.x * pixelsPerUnit) / pixelsPerUnit,
                        std::round((top.y + captionHeight) * pixelsPerUnit) / pixelsPerUnit};
    const ivec2 texels = source().size();
    const double fit = std::min(double{area.x} / texels.x, double{area.y} / texels.y);
    fitScale_ = fit * pixelsPerUnit;

    ImGui::SetCursorScreenPos(corner);
    ImGui::InvisibleButton("image", area,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                               ImGuiButtonFlags_MouseButtonRight);
    navigate(sight, events, corner, area, fit * sight.magnification);
    const double unitsPerTexel = fit * sight.magnification;
    window_ = {sight.centre.x * texels.x - area.x / 2 / unitsPerTexel,
               sight.centre.y * texels.y - area.y / 2 / unitsPerTexel, 1 / (unitsPerTexel * pixelsPerUnit)};
    if (ImGui::IsItemHovered()) {
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        const dvec2 place =
            (dvec2(window_.left, window_.top) + dvec2(mouse.x - corner.x, mouse.y - corner.y) / unitsPerTexel) /
            dvec2(texels);
        if (glm::all(glm::greaterThanEqual(place, dvec2(0))) && glm::all(glm::lessThan(place, dvec2(1))))
            events.pointedAt = place;
        pointer = events.pointedAt;
    }
    if (pointer) pointed_ = glm::clamp(ivec2(glm::floor(*pointer * dvec2(texels))), ivec2(0), texels - 1);

    try {
        paint(inspector, area, pixelsPerUnit);
        ImDrawList& list = *ImGui::GetWindowDrawList();
        list.PushClipRect(corner, {corner.x + area.x, corner.y + area.y}, true);
        list.AddImage(textureId(painting_.name()), corner, {corner.x + area.x, corner.y + area.y});
        if (unitsPerTexel >= texelForValues * ImGui::GetFontSize()) printValues(inspector, corner, area, unitsPerTexel);
        if (margin_ != ivec2(0)) drawPictureEdge(corner, unitsPerTexel);
        if (pointed_ && !events.pointedAt) drawPlace(corner, *pointed_, unitsPerTexel, IM_COL32_WHITE);
        if (pin_) drawPlace(corner, pin_->texel, unitsPerTexel, ImGui::GetColorU32(colour::accent));
        list.PopClipRect();
        list.AddRect(corner, {corner.x + area.x, corner.y + area.y},
                     ImGui::GetColorU32(chosen ? colour::accent : ImGui::GetStyleColorVec4(ImGuiCol_Separator)));
        if (pointed_) texelUnder(inspector, *pointed_);
    } catch (const std::exception& error) { // a shader that does not compile, or no memory for the view
        trouble_ = error.what();
    }
    if (!trouble_.empty()) {
        ImGui::SetCursorScreenPos(corner);
        wrappedText(colour::error, trouble_);
    }
    ImGui::SetCursorScreenPos(top);
    caption(pointed_, size.x, chosen);
    return events;
}

void BufferView::navigate(Sight& sight, Events& events, ImVec2 corner, ImVec2 size, double unitsPerTexel) {
    const ImGuiIO& io = ImGui::GetIO();
    const dvec2 texels(source().size());
    const dvec2 fromMiddle(io.MousePos.x - corner.x - size.x / 2, io.MousePos.y - corner.y - size.y / 2);
    const auto place = [&] { return sight.centre + fromMiddle / unitsPerTexel / texels; };
    if (ImGui::IsItemActivated()) events.touched = true;
    const float still = io.MouseDragThreshold * io.MouseDragThreshold;
    if (ImGui::IsItemActive()) {
        const bool dragged = std::max(io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left],
                                      io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Middle]) > still;
        if (dragged && !ImGui::IsMouseDown(ImGuiMouseButton_Right))
            sight.centre -= dvec2(io.MouseDelta.x, io.MouseDelta.y) / unitsPerTexel / texels;
    }
    if (ImGui::IsItemHovered()) {
        const dvec2 at = place();
        const bool inside = glm::all(glm::greaterThanEqual(at, dvec2(0))) && glm::all(glm::lessThan(at, dvec2(1)));
        if (ImGui::IsMouseReleased(ImGuiMouseButton_Left) && ImGui::IsItemDeactivated() && inside &&
            io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] <= still)
            events.pinned = at;
        if (ImGui::IsMouseReleased(ImGuiMouseButton_Right) && ImGui::IsItemDeactivated()) events.unpinned = true;
        if (io.MouseWheel != 0) {
            events.touched = true;
            const double fit = unitsPerTexel / sight.magnification;
            const double largest = std::max(largestTexel / fit, smallestMagnification);
            const double wanted =
                std::clamp(sight.magnification * std::pow(1.25, io.MouseWheel), smallestMagnification, largest);
            // What is under the pointer stays there; what fits comes back to the middle.
            const dvec2 anchor = glm::clamp(at, dvec2(0), dvec2(1));
            sight.centre = anchor + (sight.centre - anchor) * (sight.magnification / wanted);
            sight.magnification = wanted;
            if (wanted <= 1) sight.centre = dvec2(0.5);
        }
    }
    sight.centre = glm::clamp(sight.centre, dvec2(0), dvec2(1));
}

void BufferView::paint(Inspector& inspector, ImVec2 size, float pixelsPerUnit) {
    const ivec2 pixels(std::max(static_cast<int>(std::lround(size.x * pixelsPerUnit)), 1),
                       std::max(static_cast<int>(std::lround(size.y * pixelsPerUnit)), 1));
    const Painted wanted{version_, look_, window_, pixels};
    if (wanted == painted_) return;
    if (!painting_.name() || painting_.extent().width != pixels.x || painting_.extent().height != pixels.y)
        painting_ = Texture("ui.buffer-view", Format::RGBA8, {.width = pixels.x, .height = pixels.y});
    inspector.paint(source(), look_, window_, painting_, {0, 0}, pixels);
    painted_ = wanted;
}

void BufferView::printValues(Inspector& inspector, ImVec2 corner, ImVec2 size, double unitsPerTexel) {
    const ivec2 texels = source().size();
    const dvec2 first(window_.left, window_.top);
    const ivec2 from = glm::clamp(ivec2(glm::floor(first)), ivec2(0), texels);
    const ivec2 to = glm::clamp(ivec2(glm::ceil(first + dvec2(size.x, size.y) / unitsPerTexel)), ivec2(0), texels),
                extent = to - from;
    if (extent.x <= 0 || extent.y <= 0) return;
    if (!printed_.fresh(version_, from, extent)) {
        inspector.read(source(), from, extent, printed_.values);
        printed_.version = version_;
        printed_.corner = from;
        printed_.size = extent;
    }
    const int channels = info(spec_.format).channels;
    const int shownFirst = std::max(look_.channel, 0), lines = look_.channel < 0 ? 3 : 1;
    const float line = ImGui::GetTextLineHeight();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float* values = printed_.values.data();
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x, values += channels) {
            const ImVec2 middle(corner.x + static_cast<float>((x + 0.5 - first.x) * unitsPerTexel),
                                corner.y + static_cast<float>((y + 0.5 - first.y) * unitsPerTexel));
            for (int i = 0; i < lines; ++i) {
                const float value = values[shownFirst + i];
                const ShortText number = std::isfinite(value) ? ShortText("{:.4g}", value) : valueText(value, {});
                const ImVec2 lineSize = ImGui::CalcTextSize(number.begin(), number.end());
                plateText(list, {middle.x - lineSize.x / 2, middle.y + (static_cast<float>(i) - 0.5f * lines) * line},
                          number.view(), lineSize);
            }
        }
}

// Where the picture ends and what a technique wants to know beyond it begins.
void BufferView::drawPictureEdge(ImVec2 corner, double unitsPerTexel) const {
    const auto at = [&](ivec2 texel) {
        return ImVec2(corner.x + static_cast<float>((texel.x - window_.left) * unitsPerTexel),
                      corner.y + static_cast<float>((texel.y - window_.top) * unitsPerTexel));
    };
    const float width = 0.09f * ImGui::GetFontSize();
    const ImVec2 low = at(margin_), high = at(source().size() - margin_);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRect(low, high, IM_COL32(0, 0, 0, 160), 0, 0, 3 * width);
    list.AddRect(low, high, IM_COL32(255, 255, 255, 220), 0, 0, width);
}

void BufferView::drawPlace(ImVec2 corner, ivec2 texel, double unitsPerTexel, ImU32 ink) const {
    const float em = ImGui::GetFontSize(), half = std::max(static_cast<float>(unitsPerTexel) / 2, 0.3f * em);
    const ImVec2 middle(corner.x + static_cast<float>((texel.x + 0.5 - window_.left) * unitsPerTexel),
                        corner.y + static_cast<float>((texel.y + 0.5 - window_.top) * unitsPerTexel));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 low{middle.x - half, middle.y - half}, high{middle.x + half, middle.y + half};
    list.AddRect(low, high, IM_COL32(0, 0, 0, 200), 0, 0, 0.25f * em);
    list.AddRect(low, high, ink, 0, 0, 0.12f * em);
}

// What it is on the left, the value under the pointer on the right, which has precedence.
void BufferView::caption(std::optional<ivec2> texel, float width, bool chosen) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float em = ImGui::GetFontSize();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    float right = at.x + width;
    if (texel && !underPointer_.values.empty()) {
        const int first = std::max(look_.channel, 0);
        const float* v = underPointer_.values.data() + first;
        const std::string_view unit = unitOf(spec_, first);
        const std::string_view kind = kindOf(spec_, look_.channel, *v);
        const ShortText number = !kind.empty()       ? ShortText("{:g}  {}", *v, kind)
                                 : look_.channel < 0 ? ShortText("{:.4g}  {:.4g}  {:.4g}", v[0], v[1], v[2])
                                                     : valueText(*v, unit);
        const ShortText line("{}, {}   {}", texel->x, texel->y, number.view());
        const auto widthOf = [](std::string_view words) {
            return ImGui::CalcTextSize(words.data(), words.data() + words.size()).x;
        };
        const std::string_view shown = widthOf(line.view()) <= width ? line.view() : number.view();
        right -= widthOf(shown);
        list.AddText({right, at.y}, ImGui::GetColorU32(colour::text), shown.data(), shown.data() + shown.size());
    }
    const float room = right - 0.6f * em - at.x;
    const std::string_view label = picked() ? std::string_view(label_) : "nothing picked";
    const ShortText channel = look_.channel < 0 ? ShortText("rgb") : ShortText("{}", channelName(spec_, look_.channel));
    const ShortText whole("{}{}  {}", frozen_ ? "frozen: " : "", label, picked() ? channel.view() : std::string_view());
    const std::string_view own = label.substr(label.rfind('.') + 1); // all of it where there is no dot
    const std::string_view name = ImGui::CalcTextSize(whole.begin(), whole.end()).x <= room ? whole.view() : own;
    const ImVec4 clip(at.x, at.y, std::max(at.x + room, at.x), at.y + ImGui::GetTextLineHeight());
    list.AddText(ImGui::GetFont(), em, at, ImGui::GetColorU32(chosen ? colour::accent : colour::muted), name.data(),
                 name.data() + name.size(), 0, &clip);
}

// --- the controls --------------------------------------------------------------------------------------------------

std::optional<BufferShot> BufferView::drawControls(Inspector& inspector, Sight& sight) {
    const Extent& extent = spec_.extent;
    wrappedText(label_);
    wrappedText(colour::muted, ShortText("{}{}  {}  {}", extentText(extent).view(),
                                         extent.samples > 1 ? ShortText(", {} samples", extent.samples).view() : "",
                                         info(spec_.format).name, bytesText(spec_.bytes()).view())
                                   .view());
    if (margin_ != ivec2(0))
        wrappedText(colour::muted,
                    ShortText("{} and {} texels beyond the picture, which is framed", margin_.x, margin_.y).view());
    const std::optional<BufferShot> shot = keepRow(inspector, sight);
    imageRows();
    rangeRows(inspector);
    markRows(sight);
    valueTable();
    pinRows();
    return shot;
}

void BufferView::imageRows() {
    const FormatInfo& format = info(spec_.format);
    const Extent& extent = spec_.extent;
    const Look before = look_;
    row("Channel");
    const auto name = [&](int channel) {
        return channel < 0 ? ShortText("rgb") : ShortText("{}", channelName(spec_, channel));
    };
    if (beginCombo("##channel", name(look_.channel).begin())) {
        for (int c = format.channels >= 3 ? -1 : 0; c < format.channels; ++c) {
            if (ImGui::Selectable(name(c).begin(), c == look_.channel)) look_.channel = c;
            if (const Channel* known = channelOf(spec_, c)) tooltip(known->meaning);
        }
        ImGui::EndCombo();
    }
    if (const Channel* known = channelOf(spec_, look_.channel)) tooltip(known->meaning);
    const auto whole = [&](const char* label, const char* id, int& value, int count, std::string_view help) {
        if (count <= 1) return;
        row(label);
        if (ImGui::SliderInt(id, &value, 0, count - 1, "%d", ImGuiSliderFlags_AlwaysClamp)) {
            measured_.reset();
            if (pin_) pin_->count = 0;
        }
        tooltip(help);
    };
    whole("Layer", "##layer", layer_, extent.layers, "Which image of the array");
    whole("Mip level", "##level", level_, extent.levels, "0 is the image itself, every further level half as large");
    whole("Sample", "##sample", sample_, extent.samples, "Which of a texel's samples");
    if (look_.channel != before.channel) {
        mode_ = hasStatedRange(spec_, look_.channel) ? RangeMode::Stated : RangeMode::Automatic;
        const bool kinds = !kindsOf(spec_, look_.channel).empty();
        if (kinds || !kindsOf(spec_, before.channel).empty()) look_.map = kinds ? ColourMap::Flags : ColourMap::Grey;
        measured_.reset();
    }
}

// The colours of a channel's kinds, and which share of the texels is of each.
void BufferView::kindRows() const {
    const auto kinds = kindsOf(spec_, look_.channel);
    if (kinds.empty() || look_.map != ColourMap::Flags) return;
    const ValueRange& domain = statistics_.domain;
    const auto bins = statistics_.bins(0);
    const float side = 0.75f * ImGui::GetFontSize();
    for (size_t kind = 0; kind < kinds.size(); ++kind) {
        uint64_t count = 0;
        for (size_t i = 0; i < bins.size(); ++i) {
            const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(bins.size());
            if (std::lround(std::lerp(double{domain.min}, double{domain.max}, t)) == static_cast<long>(kind))
                count += bins[i];
        }
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float top = at.y + (ImGui::GetTextLineHeight() - side) / 2;
        ImGui::GetWindowDrawList()->AddRectFilled({at.x, top}, {at.x + side, top + side},
                                                  flagColour(static_cast<int>(kind)), 0.15f * side);
        ImGui::Dummy({side, side});
        ImGui::SameLine();
        text(count > 0 ? colour::text : colour::muted, kinds[kind]);
        if (count == 0) continue;
        ImGui::SameLine();
        ImGui::PushStyleColor(ImGuiCol_Text, colour::muted);
        rightText(ShortText("{:.2g} %", 100.0 * static_cast<double>(count) / std::max(statistics_.measured.looked, 1u))
                      .view());
        ImGui::PopStyleColor();
    }
}

void BufferView::rangeRows(Inspector& inspector) {
    const bool together = look_.channel < 0;
    row("Colours");
    const size_t map = static_cast<size_t>(look_.map);
    ImGui::BeginDisabled(together);
    if (beginCombo("##colours", together ? "as they are" : colourMapNames[map].data())) {
        for (size_t i = 0; i < std::size(colourMapNames); ++i) {
            if (ImGui::Selectable(colourMapNames[i].data(), i == map)) look_.map = static_cast<ColourMap>(i);
            tooltip(colourMapHelp[i]);
        }
        ImGui::EndCombo();
    }
    ImGui::EndDisabled();
    tooltip(together ? "Three channels together are red, green and blue." : colourMapHelp[map]);

    kindRows();
    ValueRange edited = look_.range;
    bool typed = histogram_.draw(inspector, statistics_, look_, spec_.channels, edited);
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float half = (ImGui::GetContentRegionAvail().x - gap) / 2;
    const auto end = [&](const char* id, float& value, float& entered, std::string_view help) {
        ImGui::SetNextItemWidth(half);
        float number = value;
        if (ImGui::InputFloat(id, &number, 0, 0, "%.5g")) entered = number;
        if (ImGui::IsItemActivated()) entered = value;
        if (ImGui::IsItemDeactivatedAfterEdit() && std::isfinite(entered)) {
            value = entered;
            typed = true;
        }
        tooltip(help);
    };
    end("##low", edited.min, entered_[0], "The value at the dark end of the colours");
    ImGui::SameLine(0, gap);
    end("##high", edited.max, entered_[1], "The value at the bright end of the colours");
    if (typed && edited.min > edited.max) std::swap(edited.min, edited.max);
    if (typed) {
        mode_ = RangeMode::Typed;
        typed_ = look_.range = nonEmpty(edited);
        const ValueRange& domain = statistics_.domain;
        if (typed_.min < domain.min || typed_.max > domain.max) measured_.reset();
    }
    const auto choose = [&](const char* label, RangeMode mode, std::string_view help) {
        if (toggleButton(label, mode_ == mode)) {
            mode_ = mode;
            measured_.reset();
        }
        tooltip(help);
    };
    choose("auto", RangeMode::Automatic, "From the 1st to the 99th percentile of the values, anew for every look");
    ImGui::SameLine(0, gap);
    ImGui::BeginDisabled(!hasStatedRange(spec_, look_.channel));
    choose("as stated", RangeMode::Stated, "The range that belongs to this channel by its meaning");
    ImGui::EndDisabled();
    if (mode_ == RangeMode::Typed) {
        ImGui::SameLine(0, 2 * gap);
        ImGui::AlignTextToFramePadding();
        text(colour::accent, "typed");
    }
}

void BufferView::markRows(Sight& sight) {
    subtitle(statistics_.complete()
                 ? std::string_view("Marked texels")
                 : ShortText("Marked in {:.0f} % of the texels",
                             100.0 * statistics_.measured.looked / static_cast<double>(statistics_.texels()))
                       .view());
    const float em = ImGui::GetFontSize();
    const bool stated = hasStatedRange(spec_, look_.channel);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(ImGui::GetStyle().FramePadding.x, 0.1f * em));
    for (size_t i = 0; i < std::size(markNames); ++i) {
        const Mark mark = static_cast<Mark>(i);
        const bool possible = mark != Mark::OutOfRange || stated;
        ImGui::PushID(static_cast<int>(i));
        ImGui::BeginDisabled(!possible);
        bool on = look_.marks & bit(mark);
        ImGui::PushStyleColor(ImGuiCol_CheckMark, markInk(i));
        if (ImGui::Checkbox(markNames[i].data(), &on)) look_.marks ^= bit(mark);
        ImGui::PopStyleColor();
        static constexpr std::string_view help[] = {
            "Not a number: painted magenta", "Painted cyan", "Below zero: painted blue",
            "Outside of the range that is stated for the channel: painted orange"};
        tooltip(possible ? help[i] : "No range is stated for this channel.");
        ImGui::EndDisabled();
        const int64_t count = statistics_.count(mark);
        if (possible) {
            const ShortText number = countText(count);
            const float width = ImGui::CalcTextSize(number.begin(), number.end()).x;
            ImGui::SameLine(std::max(ImGui::GetWindowContentRegionMax().x - width, 0.0f));
            if (const auto first = statistics_.first(mark)) {
                ImGui::PushStyleColor(ImGuiCol_Text,
                                      i < 2 || mark == Mark::OutOfRange ? colour::warning : colour::text);
                text(number.view());
                ImGui::PopStyleColor();
                tooltip(ShortText("{:.3g} % of the texels. Click to go to the first, column {}, row {}.",
                                  100.0 * static_cast<double>(count) / std::max(statistics_.measured.looked, 1u),
                                  first->x, first->y)
                            .view());
                if (ImGui::IsItemClicked()) {
                    const ivec2 size = source().size();
                    sight.centre = (dvec2(*first) + 0.5) / dvec2(size);
                    sight.magnification = std::max(sight.magnification, 12 / std::max(fitScale_, 1e-3));
                    pin(sight.centre);
                }
            } else {
                text(colour::muted, number.view());
            }
        }
        ImGui::PopID();
    }
    ImGui::PopStyleVar();
    if (statistics_.measured.elsewhere > 0)
        wrappedText(colour::warning, ShortText("{} texels are NaN or infinite in a channel that is not shown",
                                               countText(statistics_.measured.elsewhere).view())
                                         .view());
}

void BufferView::valueTable() {
    subtitle("Values");
    if (!ImGui::BeginTable("values", 3, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_NoPadOuterX)) return;
    const float em = ImGui::GetFontSize();
    ImGui::TableSetupColumn("channel", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("pointer", ImGuiTableColumnFlags_WidthFixed, 5.2f * em);
    ImGui::TableSetupColumn("pin", ImGuiTableColumnFlags_WidthFixed, 5.2f * em);
    const auto place = [](std::optional<ivec2> texel, const char* none) {
        ImGui::TableNextColumn();
        ImGui::PushStyleColor(ImGuiCol_Text, colour::muted);
        rightText(texel ? ShortText("{}, {}", texel->x, texel->y).view() : std::string_view(none));
        ImGui::PopStyleColor();
    };
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    place(pointed_, "pointer");
    tooltip("Under the pointer: column and row from the upper left, and the values");
    place(pin_ ? std::optional(pin_->texel) : std::nullopt, "pin");
    tooltip("Click a texel to pin it, right-click to let go.");
    const size_t pinLast = pin_ ? (pin_->next + pinLength - 1) % pinLength : 0;
    for (int c = 0; c < info(spec_.format).channels; ++c) {
        const Channel* known = channelOf(spec_, c);
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const std::string_view symbol = known ? known->symbol : std::string_view(), unit = unitOf(spec_, c);
        text(look_.channel < 0 || c == look_.channel ? colour::text : colour::muted,
             ShortText("{}{}{}", channelName(spec_, c), symbol.empty() ? "" : "  ", symbol).view());
        if (known)
            tooltip(
                ShortText("{}{}{}{}", known->meaning, unit.empty() ? "" : " [", unit, unit.empty() ? "" : "]").view());
        ImGui::TableNextColumn();
        if (pointed_ && underPointer_.values.size() > static_cast<size_t>(c))
            rightText(valueText(underPointer_.values[static_cast<size_t>(c)], {}).view());
        ImGui::TableNextColumn();
        if (pin_ && pin_->count > 0) rightText(valueText(pin_->values[static_cast<size_t>(c)][pinLast], {}).view());
    }
    ImGui::EndTable();
    const int first = std::max(look_.channel, 0);
    if (const Channel* known = channelOf(spec_, first)) {
        const std::string_view unit = unitOf(spec_, first);
        wrappedText(colour::muted, ShortText("{}{}{}", known->meaning, unit.empty() ? "" : "; unit: ", unit).view());
    }
}

void BufferView::pinRows() {
    if (!pin_ || pin_->count == 0) return;
    const float em = ImGui::GetFontSize();
    const int first = std::max(look_.channel, 0), channels = look_.channel < 0 ? 3 : 1;
    std::optional<ValueRange> seen;
    const auto value = [&](int channel, size_t i) {
        return pin_->values[static_cast<size_t>(channel)][(pin_->next + pinLength - pin_->count + i) % pinLength];
    };
    for (int c = first; c < first + channels; ++c)
        for (size_t i = 0; i < pin_->count; ++i)
            if (const float v = value(c, i); std::isfinite(v)) seen = seen ? hull(*seen, {v, v}) : ValueRange{v, v};
    subtitle(ShortText("Pin, last {} frames", pinLength).view());
    const ImVec2 from = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, 3.2f * em};
    if (size.x < 1) return;
    ImGui::Dummy(size);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(from, {from.x + size.x, from.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg));
    if (seen) {
        const ValueRange range = nonEmpty(*seen);
        static constexpr ImU32 inks[] = {IM_COL32(235, 90, 80, 255), IM_COL32(90, 200, 100, 255),
                                         IM_COL32(90, 140, 245, 255)};
        const float margin = 0.25f * em;
        const auto point = [&](int c, size_t i) {
            const double t = (double{value(c, i)} - range.min) / (double{range.max} - range.min);
            return ImVec2(from.x + size.x * static_cast<float>(i + pinLength - pin_->count) / (pinLength - 1),
                          from.y + size.y - margin - static_cast<float>(t) * (size.y - 2 * margin));
        };
        for (int c = first; c < first + channels; ++c)
            for (size_t i = 0; i < pin_->count; ++i) {
                if (!std::isfinite(value(c, i))) continue;
                const ImU32 ink = channels == 1 ? ImGui::GetColorU32(colour::accent) : inks[c];
                const ImVec2 here = point(c, i);
                if (i > 0 && std::isfinite(value(c, i - 1)))
                    list.AddLine(point(c, i - 1), here, ink, 0.1f * em);
                else
                    list.AddRectFilled({here.x - 1, here.y - 1}, {here.x + 1, here.y + 1}, ink);
            }
    }
    tooltip(
        "The pinned texel's value in the last frames, the newest on the right. Click a texel to pin it, right-click "
        "to let go.");
    if (seen) {
        text(colour::muted, ShortText("{:.5g}", seen->min).view());
        ImGui::SameLine();
        ImGui::PushStyleColor(ImGuiCol_Text, colour::muted);
        rightText(ShortText("to {:.5g}", seen->max).view());
        ImGui::PopStyleColor();
    }
}

std::optional<BufferShot> BufferView::keepRow(Inspector& inspector, const Sight& sight) {
    if (toggleButton("Freeze", freeze_)) freeze_ = !freeze_;
    tooltip("Keep this frame's image while the rest goes on");
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    std::optional<BufferShot> shot;
    ImGui::SameLine(0, gap);
    if (ImGui::Button("Save PNG")) shot = shotAsSeen(inspector, sight);
    tooltip("As seen: with these colours and marks. The whole image at its own size, or what is visible where it is "
            "zoomed.");
    ImGui::SameLine(0, gap);
    if (ImGui::Button("EXR")) shot = shotRaw(inspector);
    tooltip("All channels as they are, in 32-bit floats under their names");
    return shot;
}

BufferShot BufferView::shotAsSeen(Inspector& inspector, const Sight& sight) const {
    const Source from = source();
    const ivec2 texels = from.size();
    ImageWindow window;
    ivec2 pixels = texels;
    if (sight.magnification != 1) {
        const auto pixel = [&](double texel, double first) { return (texel - first) / window_.texelsPerPixel; };
        const ivec2 low = glm::max(ivec2(std::lround(pixel(0, window_.left)), std::lround(pixel(0, window_.top))), 0);
        const ivec2 high =
            glm::min(ivec2(std::lround(pixel(texels.x, window_.left)), std::lround(pixel(texels.y, window_.top))),
                     painted_.size);
        pixels = glm::max(high - low, 1);
        window = {window_.left + low.x * window_.texelsPerPixel, window_.top + low.y * window_.texelsPerPixel,
                  window_.texelsPerPixel};
    }
    return {label_, inspector.picture(from, look_, window, pixels), false};
}

BufferShot BufferView::shotRaw(Inspector& inspector) const {
    const ivec2 size = source().size();
    BufferShot shot{label_, {size.x, size.y, {}, {}}, true};
    inspector.read(source(), {0, 0}, size, shot.picture.values);
    for (int c = 0; c < info(spec_.format).channels; ++c) shot.picture.channels.emplace_back(channelName(spec_, c));
    return shot;
}

} // namespace penumbra
