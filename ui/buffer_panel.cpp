// SPDX-License-Identifier: MIT
#include "ui/buffer_panel.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace penumbra {

namespace {

// Reading stalls the renderer: at most four times a second, and at most a tenth of the time.
constexpr double shortestReadInterval = 0.25; // [s]
constexpr double readShare = 0.1;

constexpr std::string_view colourNames[] = {"r", "g", "b", "a"};

std::string_view channelName(const ImageSpec& spec, int channel) {
    const size_t index = static_cast<size_t>(channel);
    return index < spec.channels.size() ? spec.channels[index].name : colourNames[index];
}

ShortText valueText(float value, std::string_view unit) {
    if (std::isnan(value)) return ShortText("NaN");
    return ShortText("{:.6g}{}{}", value, unit.empty() || unit == "°" ? "" : " ", unit);
}

} // namespace

void BufferPanel::draw(const Renderer& renderer, uint64_t frame, float pixelsPerUnit) {
    const Flow& flow = renderer.flow();
    std::optional<Image> image = flow.find(picked_);
    if (!image) {
        image = renderer.shadow();
        pick(flow, *image);
    }
    const float em = ImGui::GetFontSize(), available = ImGui::GetContentRegionAvail().x;
    const float side = std::min(17 * em, 0.3f * available);
    ImGui::BeginChild("images", {std::min(19 * em, 0.32f * available), 0}, false);
    list(flow);
    ImGui::EndChild();
    if (const auto now = flow.find(picked_)) image = now;
    const ImageSpec& spec = flow.spec(*image);
    layer_ = std::min(layer_, spec.extent.layers - 1);
    level_ = std::min(level_, spec.extent.levels - 1);
    channel_ = std::min(channel_, info(spec.format).channels - 1);
    readBack(renderer, *image, frame);

    ImGui::SameLine();
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    ImGui::BeginChild("view", {std::max(ImGui::GetContentRegionAvail().x - side - gap, 1.0f), 0}, false,
                      ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    view(spec, pixelsPerUnit);
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("controls", {0, 0}, false);
    controls(flow, spec);
    ImGui::EndChild();
}

void BufferPanel::pick(const Flow& flow, Image image) {
    picked_ = flow.label(image);
    const ImageSpec& spec = flow.spec(image);
    const bool colours = spec.channels.empty() && info(spec.format).channels >= 3;
    channel_ = colours ? -1 : 0;
    layer_ = level_ = 0;
    mode_ = !spec.channels.empty() && spec.channels[0].min < spec.channels[0].max ? RangeMode::Stated
                                                                                  : RangeMode::Automatic;
    zoom_.reset();
    frameRead_.reset();
}

void BufferPanel::list(const Flow& flow) {
    const auto& images = flow.images();
    std::optional<Stage> stage;
    for (size_t i = 0; i < images.size(); ++i) {
        // The rounds of a repeat share one label: the last stands for all.
        const bool again = std::any_of(images.begin() + static_cast<ptrdiff_t>(i) + 1, images.end(),
                                       [&](const Flow::ImageNode& later) { return later.label == images[i].label; });
        if (again) continue;
        const Stage own = flow.passes()[static_cast<size_t>(images[i].pass)].stage;
        if (stage != own) subtitle(stageName(own));
        stage = own;
        const std::string& label = flow.label(images[i].label);
        if (ImGui::Selectable(label.c_str(), label == picked_)) pick(flow, flow.image(static_cast<int>(i)));
        const ImageSpec& spec = images[i].spec;
        tooltip(ShortText("{}\n{}  {}  {}", label, extentText(spec.extent).view(), info(spec.format).name,
                          bytesText(spec.bytes()).view())
                    .view());
    }
}

void BufferPanel::readBack(const Renderer& renderer, Image image, uint64_t frame) {
    const double now = ImGui::GetTime();
    if (frameRead_ && (*frameRead_ == frame || now < nextRead_)) return;
    const auto start = std::chrono::steady_clock::now();
    try {
        pixels_ = renderer.read(image, layer_, level_);
        bad_ = countBadTexels(pixels_);
        trouble_.clear();
    } catch (const InputError& error) {
        pixels_ = {};
        trouble_ = error.what();
    }
    frameRead_ = frame;
    updateRange(renderer.flow().spec(image));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    nextRead_ = now + std::max(shortestReadInterval, seconds / readShare);
}

void BufferPanel::updateRange(const ImageSpec& spec) {
    if (pixels_.values.empty()) return;
    const size_t shown = static_cast<size_t>(std::max(channel_, 0));
    const bool stated = shown < spec.channels.size() && spec.channels[shown].min < spec.channels[shown].max;
    if (mode_ == RangeMode::Stated && !stated) mode_ = RangeMode::Automatic;
    switch (mode_) {
    case RangeMode::Typed: range_ = typed_; break;
    case RangeMode::Stated: range_ = {spec.channels[shown].min, spec.channels[shown].max}; break;
    case RangeMode::Automatic:
        range_ = quantileRange(pixels_, static_cast<int>(shown), 0.01, 0.99, scratch_);
        if (channel_ < 0)
            for (int c = 1; c < 3; ++c) {
                const ValueRange other = quantileRange(pixels_, c, 0.01, 0.99, scratch_);
                range_ = {std::min(range_.min, other.min), std::max(range_.max, other.max)};
            }
        break;
    }
}

void BufferPanel::controls(const Flow& flow, const ImageSpec& spec) {
    const FormatInfo& format = info(spec.format);
    wrappedText(picked_);
    wrappedText(
        colour::muted,
        ShortText("{}  {}  {}", extentText(spec.extent).view(), format.name, bytesText(spec.bytes()).view()).view());
    if (flow.find(picked_) && flow.node(*flow.find(picked_)).kept) text(colour::muted, "kept for the next frame");
    if (bad_.nan || bad_.infinite)
        wrappedText(colour::error,
                    ShortText("{} NaN (magenta), {} infinite (cyan) texels", bad_.nan, bad_.infinite).view());
    ImGui::Spacing();

    bool changed = false;
    row("Channel");
    const auto name = [&](int channel) {
        return channel < 0 ? ShortText("rgb") : ShortText("{}", channelName(spec, channel));
    };
    if (ImGui::BeginCombo("##channel", name(channel_).begin())) {
        for (int c = format.channels >= 3 ? -1 : 0; c < format.channels; ++c)
            if (ImGui::Selectable(name(c).begin(), c == channel_)) {
                channel_ = c;
                changed = true;
            }
        ImGui::EndCombo();
    }
    if (channel_ >= 0 && static_cast<size_t>(channel_) < spec.channels.size())
        tooltip(spec.channels[static_cast<size_t>(channel_)].meaning);
    const auto whole = [&](const char* label, const char* id, int& value, int count) {
        if (count <= 1) return;
        row(label);
        if (ImGui::SliderInt(id, &value, 0, count - 1, "%d", ImGuiSliderFlags_AlwaysClamp)) frameRead_.reset();
    };
    whole("Layer", "##layer", layer_, spec.extent.layers);
    whole("Level", "##level", level_, spec.extent.levels);

    static constexpr const char* modes[] = {"automatic", "stated", "typed"};
    static constexpr std::string_view meanings[] = {"From the 1st to the 99th percentile of the values",
                                                    "As the technique states it for this channel", "As typed below"};
    row("Range");
    if (ImGui::BeginCombo("##range", modes[static_cast<size_t>(mode_)])) {
        for (size_t i = 0; i < std::size(modes); ++i) {
            if (ImGui::Selectable(modes[i], static_cast<size_t>(mode_) == i)) {
                mode_ = static_cast<RangeMode>(i);
                typed_ = range_;
                changed = true;
            }
            tooltip(meanings[i]);
        }
        ImGui::EndCombo();
    }
    ValueRange edited = range_;
    const float speed = 0.002f * std::min(range_.max - range_.min, 1e30f);
    row("Limits");
    if (ImGui::DragFloat2("##ends", &edited.min, speed, 0, 0, "%.4g") && std::isfinite(edited.min) &&
        std::isfinite(edited.max) && edited.min < edited.max) {
        mode_ = RangeMode::Typed;
        typed_ = edited;
        changed = true;
    }
    tooltip("The values shown as black and as white. Drag, or Ctrl+click to type.");
    if (changed) updateRange(spec);

    ImGui::Spacing();
    if (toggleButton("Fit", !zoom_)) zoom_.reset();
    ImGui::SameLine();
    if (toggleButton("1:1", zoom_ == 1.0)) {
        if (!zoom_) centreX_ = pixels_.width / 2.0, centreY_ = pixels_.height / 2.0;
        zoom_ = 1.0;
    }
    ImGui::SameLine();
    text(colour::muted, "wheel zooms");
}

double BufferPanel::unitsPerTexel(ImVec2 size) const {
    if (zoom_) return *zoom_;
    return std::min(static_cast<double>(size.x) / pixels_.width, static_cast<double>(size.y) / pixels_.height);
}

void BufferPanel::view(const ImageSpec& spec, float pixelsPerUnit) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size = ImGui::GetContentRegionAvail();
    if (!trouble_.empty()) wrappedText(colour::error, trouble_);
    if (size.x < 2 || size.y < 2 || pixels_.values.empty()) return;
    ImGui::InvisibleButton("image", size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
    navigate(corner, size);
    drawPixels(corner, size, pixelsPerUnit);
    if (ImGui::IsItemHovered()) probe(spec, corner);
}

void BufferPanel::navigate(ImVec2 corner, ImVec2 size) {
    const ImGuiIO& io = ImGui::GetIO();
    const double scale = unitsPerTexel(size);
    if (!zoom_) centreX_ = pixels_.width / 2.0, centreY_ = pixels_.height / 2.0;
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        zoom_.reset();
        return;
    }
    if (ImGui::IsItemActive() && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
        zoom_ = scale;
        centreX_ -= io.MouseDelta.x / scale;
        centreY_ -= io.MouseDelta.y / scale;
    }
    if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
        // The texel under the pointer stays there.
        const double x = io.MousePos.x - corner.x - size.x / 2, y = io.MousePos.y - corner.y - size.y / 2;
        const double wanted = std::clamp(scale * std::pow(1.25, io.MouseWheel), 1.0 / 64, 256.0);
        centreX_ += x / scale - x / wanted;
        centreY_ += y / scale - y / wanted;
        zoom_ = wanted;
    }
    centreX_ = std::clamp(centreX_, 0.0, static_cast<double>(pixels_.width));
    centreY_ = std::clamp(centreY_, 0.0, static_cast<double>(pixels_.height));
}

void BufferPanel::drawPixels(ImVec2 corner, ImVec2 size, float pixelsPerUnit) {
    const int width = std::max(static_cast<int>(size.x * pixelsPerUnit), 1);
    const int height = std::max(static_cast<int>(size.y * pixelsPerUnit), 1);
    const double scale = unitsPerTexel(size);
    Drawn wanted;
    wanted.frame = *frameRead_;
    wanted.window = {centreX_ - size.x / 2 / scale, centreY_ - size.y / 2 / scale, scale * pixelsPerUnit};
    wanted.channels = channel_ < 0 ? ShownChannels{0, 1, 2} : ShownChannels{channel_, channel_, channel_};
    wanted.range = range_;
    wanted.width = width;
    wanted.height = height;
    if (wanted != drawn_) {
        if (texture_.extent().width != width || texture_.extent().height != height || !texture_.name())
            texture_ = Texture("ui.buffer-view", Format::RGBA8, {.width = width, .height = height});
        mapToRgba(pixels_, wanted.window, wanted.channels, wanted.range, width, height, rgba_);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glTextureSubImage2D(texture_.name(), 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba_.data());
        drawn_ = wanted;
    }
    ImGui::GetWindowDrawList()->AddImage(textureId(texture_.name()), corner, {corner.x + size.x, corner.y + size.y});
}

void BufferPanel::probe(const ImageSpec& spec, ImVec2 corner) {
    const ImVec2 pointer = ImGui::GetIO().MousePos;
    const double pixels = drawn_.window.pixelsPerTexel,
                 perUnit = drawn_.width / std::max(ImGui::GetItemRectSize().x, 1.0f);
    const double x = drawn_.window.left + (pointer.x - corner.x) * perUnit / pixels;
    const double y = drawn_.window.top + (pointer.y - corner.y) * perUnit / pixels;
    if (x < 0 || y < 0 || x >= pixels_.width || y >= pixels_.height) return;
    const int column = static_cast<int>(x), line = static_cast<int>(y);
    const float* values =
        pixels_.values.data() + (static_cast<size_t>(line) * pixels_.width + column) * pixels_.channels;
    beginHelp();
    text(colour::muted, ShortText("column {}, row {} from the upper left", column, line).view());
    for (int c = 0; c < pixels_.channels; ++c) {
        const size_t index = static_cast<size_t>(c);
        const bool known = index < spec.channels.size();
        const std::string_view unit = known ? unitName(spec.channels[index].unit) : std::string_view();
        const std::string_view symbol = known ? spec.channels[index].symbol : std::string_view();
        text(ShortText("{}{}{} = {}", channelName(spec, c), symbol.empty() ? "" : "  ", symbol,
                       valueText(values[c], unit).view())
                 .view());
        if (known && !spec.channels[index].meaning.empty()) text(colour::muted, spec.channels[index].meaning);
    }
    endHelp();
}

} // namespace penumbra
