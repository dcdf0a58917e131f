// SPDX-License-Identifier: MIT
#include "ui/tradeoff_panel.h"

#include "renderer/core/csv.h"
#include "renderer/core/hash.h"
#include "ui/plot.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr float controlsWidth = 21; // font heights

// Hues a golden angle apart: neighbours in the catalogue differ most.
ImVec4 colourOf(const Card* card) {
    const auto cards = catalogue();
    const auto place = static_cast<float>(std::find(cards.begin(), cards.end(), card) - cards.begin());
    ImVec4 colour{0, 0, 0, 1};
    ImGui::ColorConvertHSVtoRGB(std::fmod(0.58f + 0.381966f * place, 1.0f), 0.5f, 0.95f, colour.x, colour.y, colour.z);
    return colour;
}

TruthSettings besideWindow(TruthCache* cache) { return {.background = true, .cache = cache}; }

// A narrower row than the side panel's.
void field(std::string_view label) {
    ImGui::AlignTextToFramePadding();
    text(label);
    ImGui::SameLine(6 * ImGui::GetFontSize());
}

bool radio(const char* label, bool on) { return ImGui::RadioButton(label, on) && !on; }

// "search-taps 16, filter-taps 32", or that nothing was changed.
std::string changesOf(const Setting& setting) {
    std::string text;
    for (const Parameter* parameter : setting.parameters().all())
        if (parameter->changed())
            text += fmt::format("{}{} {}", text.empty() ? "" : "\n", parameter->label(), parameter->text());
    return text.empty() ? "default values" : text;
}

} // namespace

// --- what there is -------------------------------------------------------------------------------------------------

// Of all that decides what is seen and where its shadows fall.
uint64_t TradeOffPanel::viewOf(const Session& session) {
    if (hashedScene_ != session.scene.get()) {
        hashedScene_ = session.scene.get();
        Hash hash;
        hash.addBytes(hashedScene_->name.data(), hashedScene_->name.size());
        hash.addBytes(hashedScene_->positions.data(),
                      hashedScene_->positions.size() * sizeof(hashedScene_->positions[0]));
        hash.add(hashedScene_->indices);
        sceneHash_ = hash.value();
    }
    Hash hash;
    static_assert(sizeof(Camera) == 10 * sizeof(float) && sizeof(AreaLight) == 13 * sizeof(float));
    hash.add(sceneHash_);
    hash.addBytes(&session.camera, sizeof(session.camera));
    hash.addBytes(&session.light, sizeof(session.light));
    hash.add(session.ground);
    hash.add(session.clip);
    hash.add(session.time);
    hash.add(session.seed);
    hash.addBytes(&session.size, sizeof(session.size));
    return hash.value();
}

bool TradeOffPanel::isCurrent(const MeasuredPoint& point, const Session& session) const {
    return point.setting.parameters() == session.techniques.parametersOf(point.setting.card->id);
}

void TradeOffPanel::add(SettingResult result) {
    if (!result.errors) return;
    MeasuredPoint point{.setting = std::move(result.setting),
                        .view = measuredView_,
                        .scene = measuredScene_,
                        .size = measuredSize_,
                        .cost = summarise(result.costs),
                        .rmse = result.errors->all.rmse,
                        .penumbraRmse = result.errors->penumbra.rmse,
                        .bytes = result.bytes,
                        .maps = result.maps};
    stale_ = true;
    for (MeasuredPoint& known : points_)
        if (known.view == point.view && known.setting.parameters() == point.setting.parameters()) {
            // Longer measurements say more.
            if (point.cost.count >= known.cost.count) known = std::move(point);
            return;
        }
    points_.push_back(std::move(point));
}

std::string TradeOffPanel::poll() {
    const bool was = measuring();
    for (SettingResult& result : measurement_.take()) {
        ++tried_;
        add(std::move(result));
    }
    std::string line;
    try {
        if (std::optional<BackgroundMeasurement::End> end = measurement_.poll()) {
            for (SettingResult& result : measurement_.take()) add(std::move(result));
            if (end->search) found_ = std::move(end->search);
            if (!end->complete) line = "Stopped; what was measured is kept";
        }
    } catch (const std::exception& error) {
        line = error.what();
    }
    if (was && !measuring()) stale_ = true;
    return line;
}

void TradeOffPanel::arrange() {
    const uint64_t view = several_.value_or(view_);
    if (!stale_ && arrangedView_ == view) return;
    stale_ = false;
    arrangedView_ = view;
    shown_.clear();
    elsewhere_.clear();
    std::vector<double> costs, errors;
    std::vector<TradeOff> all;
    for (size_t i = 0; i < points_.size(); ++i) {
        const MeasuredPoint& point = points_[i];
        if (point.cost.count == 0) continue;
        // The axes hold the points of all views, so that they stay where they are when the camera moves.
        for (const double cost : {point.cost.median, point.cost.interval.low, point.cost.interval.high})
            costs.push_back(cost);
        errors.push_back(errorOf(point));
        if (point.view != view) {
            elsewhere_.push_back(i);
            continue;
        }
        shown_.push_back(i);
        all.push_back({point.cost.median, errorOf(point)});
    }
    costAxis_ = fitAxis(costs, logCost_);
    errorAxis_ = fitAxis(errors, logError_);
    const std::vector<bool> front = tradeOffFront(all);
    frontLine_.clear();
    for (size_t i = 0; i < shown_.size(); ++i)
        if (front[i]) frontLine_.push_back(shown_[i]);
    std::sort(frontLine_.begin(), frontLine_.end(),
              [&](size_t a, size_t b) { return points_[a].cost.median < points_[b].cost.median; });
}

// --- work ----------------------------------------------------------------------------------------------------------

void TradeOffPanel::begin(const Session& session, uint64_t view) {
    measuredView_ = view;
    measuredScene_ = session.scene->name;
    measuredSize_ = session.size;
    tried_ = 0;
    asked_ = {};
    found_.reset();
    several_.reset();
}

void TradeOffPanel::measureAll(const Session& session, uint64_t view) {
    begin(session, view);
    std::vector<Setting> settings;
    for (const Card* card : catalogue()) settings.emplace_back(*card, session.techniques.parametersOf(card->id));
    measurement_.measure(stillView(session), std::move(settings), besideWindow(cache_));
}

void TradeOffPanel::search(const Session& session, uint64_t view) {
    BackgroundMeasurement::Question question;
    for (const Card* card : catalogue())
        if (!left_.contains(std::string(card->id)))
            question.starts.emplace_back(*card, session.techniques.parametersOf(card->id));
    for (const FreeParameter& free : free_)
        if (!left_.contains(free.name.substr(0, free.name.find('.')))) question.free.push_back(free);
    question.budget =
        bound_ == Bound::Cost ? Budget{bound_, double(mostMilliseconds_)} : Budget{bound_, double(mostError_)};
    std::vector<Session> views;
    for (const Session& kept : views_) views.push_back(stillView(kept));
    if (views.empty()) views.push_back(stillView(session));
    if (views_.size() == 1) view = viewHashes_[0];
    if (views_.size() > 1) {
        Hash hash;
        hash.add(viewHashes_);
        view = hash.value();
    }
    begin(session, view);
    asked_ = question.budget;
    if (view != view_) several_ = view;
    measurement_.search(std::move(views), std::move(question), besideWindow(cache_));
}

// --- the panel -----------------------------------------------------------------------------------------------------

TradeOffPanel::Requests TradeOffPanel::draw(Session& session, bool clean, bool busy) {
    Requests requests;
    busy_ = busy;
    view_ = viewOf(session);
    arrange();
    const float em = ImGui::GetFontSize();
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float right = std::min(controlsWidth * em, 0.5f * room.x);
    chart(session, {room.x - right - ImGui::GetStyle().ItemSpacing.x, room.y}, clean, requests);
    ImGui::SameLine();
    if (ImGui::BeginChild("trade-off controls", {0, 0})) controls(session, requests);
    ImGui::EndChild();
    return requests;
}

void TradeOffPanel::chart(Session& session, ImVec2 size, bool clean, Requests& requests) {
    const float em = ImGui::GetFontSize();
    size = {std::max(size.x, 1.0f), std::max(size.y, 1.0f)};
    corner_ = ImGui::GetCursorScreenPos();
    size_ = size;
    ImGui::InvisibleButton("chart", size);
    const bool hovered = ImGui::IsItemHovered() && !clean, clicked = ImGui::IsItemClicked();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 end{corner_.x + size.x, corner_.y + size.y};
    const Plot plot{corner_,
                    size,
                    costAxis_,
                    errorAxis_,
                    "Cost: map + prefilter + resolve  [ms]",
                    error_ == Error::All ? "Error: RMSE of ψ, all pixels" : "Error: RMSE of ψ, penumbrae"};
    plot.drawPaper();
    if (!plot.drawable()) return;
    const ImVec2 from{plot.low().x, plot.high().y}, to{plot.high().x, plot.low().y};
    list.PushClipRect(corner_, end, true);
    if (!shown_.empty() || !elsewhere_.empty()) plot.drawAxes();
    dots(session, from, to);

    pointed_.reset();
    if (hovered) {
        float nearest = 0.8f * em;
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        for (const Dot& dot : dots_) {
            // Dots of this view lie above those of others, and of what is chosen above them all.
            const float head = dot.current ? 0.4f : dot.here ? 0.2f : 0;
            const float distance = std::hypot(dot.place.x - mouse.x, dot.place.y - mouse.y) - head * em;
            if (distance < nearest) nearest = distance, pointed_ = dot.point;
        }
    }
    names(from, to);
    if (shown_.empty()) {
        const char* line = measuring() ? "Measuring…" : "Nothing is measured in this view yet";
        const ImVec2 extent = ImGui::CalcTextSize(line);
        list.AddText({(from.x + to.x - extent.x) / 2, (from.y + to.y - extent.y) / 2},
                     ImGui::GetColorU32(colour::muted), line);
    }
    list.PopClipRect();
    if (!pointed_) return;
    const MeasuredPoint& point = points_[*pointed_];
    ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    describe(point);
    if (clicked) {
        session.techniques.take(point.setting.parameters());
        requests.restart = true;
    }
}

void TradeOffPanel::dots(const Session& session, ImVec2 from, ImVec2 to) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float em = ImGui::GetFontSize();
    const auto placeOf = [&](const MeasuredPoint& point) {
        return ImVec2(std::lerp(from.x, to.x, static_cast<float>(costAxis_.position(point.cost.median))),
                      std::lerp(to.y, from.y, static_cast<float>(errorAxis_.position(errorOf(point)))));
    };
    dots_.clear();
    for (const size_t i : elsewhere_) {
        const ImVec2 place = placeOf(points_[i]);
        dots_.push_back({.point = i, .place = place, .here = false, .current = false});
        list.AddCircle(place, 0.2f * em, faded(colour::muted, 0.5f), 0, 0.08f * em);
    }
    for (const size_t i : shown_) {
        const MeasuredPoint& point = points_[i];
        dots_.push_back({.point = i, .place = placeOf(point), .here = true, .current = isCurrent(point, session)});
    }
    // Up to the next cheapest everything costs what the one before does: a staircase.
    const ImU32 line = faded(colour::accent, 0.75f);
    for (size_t i = 0; i + 1 < frontLine_.size(); ++i) {
        const ImVec2 a = placeOf(points_[frontLine_[i]]), b = placeOf(points_[frontLine_[i + 1]]);
        list.AddLine(a, {b.x, a.y}, line, 0.1f * em);
        list.AddLine({b.x, a.y}, b, line, 0.1f * em);
    }
    // The bound that a search was asked for.
    if (found_ || (measuring() && asked_.limit > 0)) {
        const ImU32 bound = faded(colour::warning, 0.6f);
        if (asked_.bound == Bound::Cost) {
            const float x = std::lerp(from.x, to.x, static_cast<float>(costAxis_.position(asked_.limit)));
            list.AddLine({x, from.y}, {x, to.y}, bound, 0.1f * em);
        } else if (error_ == Error::All) {
            const float y = std::lerp(to.y, from.y, static_cast<float>(errorAxis_.position(asked_.limit)));
            list.AddLine({from.x, y}, {to.x, y}, bound, 0.1f * em);
        }
    }
    for (const bool current : {false, true})
        for (const Dot& dot : dots_) {
            if (!dot.here || dot.current != current) continue;
            const MeasuredPoint& point = points_[dot.point];
            const ImVec4 ink = colourOf(point.setting.card);
            if (current) {
                // How far the noise leaves the median open.
                const auto x = [&](double cost) {
                    return std::lerp(from.x, to.x, static_cast<float>(costAxis_.position(cost)));
                };
                list.AddLine({x(point.cost.interval.low), dot.place.y}, {x(point.cost.interval.high), dot.place.y},
                             faded(ink, 0.6f), 0.12f * em);
                list.AddCircleFilled(dot.place, 0.38f * em, ImGui::GetColorU32(ink));
                if (point.setting.card == &session.techniques.card())
                    list.AddCircle(dot.place, 0.58f * em, ImGui::GetColorU32(colour::text), 0, 0.11f * em);
            } else {
                list.AddCircleFilled(dot.place, 0.24f * em, faded(ink, 0.45f));
            }
        }
    if (found_ && found_->proposal)
        for (const Dot& dot : dots_)
            if (dot.here &&
                points_[dot.point].setting.parameters() == found_->trials[*found_->proposal].setting.parameters())
                list.AddCircle(dot.place, 0.78f * em, ImGui::GetColorU32(colour::warning), 0, 0.14f * em);
}

// Of the techniques, beside their dots where they hide no other.
void TradeOffPanel::names(ImVec2 from, ImVec2 to) const {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float em = ImGui::GetFontSize(), gap = 0.45f * em, height = ImGui::GetTextLineHeight();
    FixedVector<ImVec4, 64> taken; // left, top, right, bottom
    const auto overlaps = [](const ImVec4& a, const ImVec4& b) {
        return a.x < b.z && b.x < a.z && a.y < b.w && b.y < a.w;
    };
    for (const Dot& dot : dots_)
        if (dot.current && taken.size() < 32)
            taken.push_back(
                {dot.place.x - 0.4f * em, dot.place.y - 0.4f * em, dot.place.x + 0.4f * em, dot.place.y + 0.4f * em});
    for (const Dot& dot : dots_) {
        if (!dot.current) continue;
        const Card& card = *points_[dot.point].setting.card;
        const float width = widthOf(card.id);
        // Lines run across and down from the dots.
        const float above = dot.place.y - height - 0.25f * em, below = dot.place.y + 0.25f * em;
        const ImVec2 corners[] = {{dot.place.x + gap, above},
                                  {dot.place.x - gap - width, above},
                                  {dot.place.x - gap - width, below},
                                  {dot.place.x + gap, below}};
        for (const ImVec2 corner : corners) {
            const ImVec4 box{corner.x, corner.y, corner.x + width, corner.y + height};
            if (box.x < from.x || box.z > to.x + 0.8f * em || box.y < from.y - height || box.w > to.y) continue;
            if (std::any_of(taken.begin(), taken.end(), [&](const ImVec4& other) { return overlaps(box, other); }))
                continue;
            if (taken.size() < 64) taken.push_back(box);
            list.AddText(corner, ImGui::GetColorU32(colourOf(&card)), card.id.data(), card.id.data() + card.id.size());
            break;
        }
    }
}

void TradeOffPanel::describe(const MeasuredPoint& point) const {
    beginHelp();
    text(colourOf(point.setting.card), point.setting.card->title);
    text(colour::muted, changesOf(point.setting));
    if (ImGui::BeginTable("of a point", 2, ImGuiTableFlags_SizingFixedFit)) {
        const auto line = [](std::string_view name, const ShortText& value) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            text(name);
            ImGui::TableNextColumn();
            text(value.view());
        };
        line("Cost", ShortText("{:.3g} ms  ({:.3g} to {:.3g})", point.cost.median, point.cost.interval.low,
                               point.cost.interval.high));
        line("RMSE", ShortText("{:.4f}", point.rmse));
        line("in penumbrae", ShortText("{:.4f}", point.penumbraRmse));
        line("Textures", bytesText(point.bytes));
        if (point.view != arrangedView_)
            line("Of another view", ShortText("{}, {} × {}", point.scene, point.size.x, point.size.y));
        if (point.maps > 1) line("Shadow maps", ShortText("{}", point.maps));
        if (const auto reads = point.setting.technique->readsPerPixel())
            line("Reads a pixel", reads->least == reads->most ? ShortText("{}", reads->most)
                                                              : ShortText("{} to {}", reads->least, reads->most));
        ImGui::EndTable();
    }
    text(colour::muted, "Click to take these values");
    endHelp();
}

// --- beside the chart ----------------------------------------------------------------------------------------------

void TradeOffPanel::progress() {
    const Progress& state = *measurement_.progress();
    if (progressWithCancel(state)) measurement_.stop();
    tooltip("Stop here; what is measured is kept");
    text(colour::muted, state.cancelled() ? ShortText("stopping").view()
                        : tried_ > 0      ? ShortText("{}; {} measured", state.doing(), tried_).view()
                                          : std::string_view(state.doing()));
}

void TradeOffPanel::controls(Session& session, Requests& requests) {
    if (measuring()) {
        progress();
    } else {
        ImGui::BeginDisabled(busy_);
        if (ImGui::Button("Measure all", {-FLT_MIN, 0})) measureAll(session, view_);
        ImGui::EndDisabled();
        tooltip(busy_
                    ? "A motion is being measured."
                    : "Measure the cost and the error of every technique with its present values, in the present view, "
                      "against traced rays");
        if (!elsewhere_.empty())
            text(colour::muted,
                 ShortText("{} measured; rings: {} in other views", shown_.size(), elsewhere_.size()).view());
        else
            text(colour::muted, ShortText("{} settings measured", shown_.size()).view());
        tooltip("Errors compare only within one view: the same scene, camera, light, time and size of the picture. "
                "Times beside a window are rougher than those of 'penumbra measure'.");
    }

    field("Error of");
    if (radio("all pixels", error_ == Error::All)) error_ = Error::All, stale_ = true;
    tooltip("Root mean square of ψ − ψ* over the pixels that face the whole light");
    ImGui::SameLine();
    if (radio("penumbrae", error_ == Error::Penumbra)) error_ = Error::Penumbra, stale_ = true;
    tooltip("Over those pixels alone whose true ψ* is between 0.01 and 0.99");
    field("Logarithmic");
    if (ImGui::Checkbox("cost", &logCost_)) stale_ = true;
    ImGui::SameLine();
    if (ImGui::Checkbox("error", &logError_)) stale_ = true;
    field("Save as");
    ImGui::BeginDisabled(shown_.empty());
    if (ImGui::Button("PNG")) requests.savePicture = true;
    tooltip("The chart as it is drawn, into the folder of pictures");
    ImGui::SameLine();
    if (ImGui::Button("CSV")) requests.saveTable = true;
    tooltip("Everything that was measured, of other views too, into the folder of pictures");
    ImGui::EndDisabled();
    budgetForm(session, requests);
}

void TradeOffPanel::budgetForm(Session& session, Requests& requests) {
    subtitle("Best within a budget");
    field("At most");
    const float em = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(5 * em);
    if (bound_ == Bound::Cost)
        ImGui::DragFloat("##most", &mostMilliseconds_, 0.02f, 0.01f, 10000, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    else
        ImGui::DragFloat("##most", &mostError_, 0.0005f, 0.0001f, 1, "%.4f", ImGuiSliderFlags_AlwaysClamp);
    tooltip(bound_ == Bound::Cost ? "The least error at a cost of at most this is looked for"
                                  : "The least cost at an RMSE over all pixels of at most this is looked for");
    ImGui::SameLine();
    if (radio("ms", bound_ == Bound::Cost)) bound_ = Bound::Cost;
    ImGui::SameLine();
    if (radio("RMSE", bound_ == Bound::Error)) bound_ = Bound::Error;
    field("Free");
    const size_t techniques = catalogue().size() - left_.size();
    if (ImGui::Button(ShortText("{} parameters of {} techniques###free", free_.size(), techniques).begin(),
                      {-FLT_MIN, 0}))
        ImGui::OpenPopup("free");
    tooltip("Which techniques are looked at, and which of their parameters may be turned. The others keep the values "
            "that they have now.");
    freeList();
    field("Views");
    if (ImGui::Button(views_.empty() ? "Keep this one" : "+ this one")) {
        views_.push_back(stillView(session));
        viewHashes_.push_back(view_);
    }
    tooltip("Search over several views at once: move the camera or the light and add each. The dearest view gives the "
            "cost, the worst the error.");
    ImGui::SameLine();
    if (views_.empty()) {
        text(colour::muted, "the present one");
    } else {
        text(ShortText("{} kept", views_.size()).view());
        ImGui::SameLine();
        if (ImGui::SmallButton("×")) views_.clear(), viewHashes_.clear();
        tooltip("Forget them: search in the present view");
    }
    const bool ready = !measuring() && !busy_ && techniques > 0 &&
                       std::any_of(free_.begin(), free_.end(), [&](const FreeParameter& f) {
                           return !left_.contains(f.name.substr(0, f.name.find('.')));
                       });
    ImGui::BeginDisabled(!ready);
    if (ImGui::Button("Search", {-FLT_MIN, 0})) search(session, view_);
    ImGui::EndDisabled();
    tooltip(busy_ ? "A motion is being measured."
            : !ready && !measuring()
                ? "Mark at least one parameter as free"
                : "A coarse grid of the free parameters, then smaller and smaller steps from the best of it");
    proposal(session, requests);
}

void TradeOffPanel::freeList() {
    const float em = ImGui::GetFontSize();
    ImGui::SetNextWindowSizeConstraints({27 * em, 0}, {FLT_MAX, 30 * em});
    if (!beginPopup("free")) return;
    static const TechniqueShelf shelf; // of declarations
    text(colour::muted, "Techniques to look at; below each what may be turned, and how far");
    for (const Card* card : catalogue()) {
        ImGui::PushID(card);
        const std::string id(card->id);
        bool searched = !left_.contains(id);
        if (ImGui::Checkbox(ShortText("{}", card->title).begin(), &searched)) {
            if (searched)
                left_.erase(id);
            else
                left_.insert(id);
        }
        tooltip("Look at this technique");
        if (searched) {
            ImGui::Indent();
            for (const Parameter* parameter : shelf.parametersOf(id).all()) freeRow(*parameter);
            ImGui::Unindent();
        }
        ImGui::PopID();
    }
    ImGui::EndPopup();
}

void TradeOffPanel::freeRow(const Parameter& parameter) {
    const Spec& spec = parameter.spec();
    const std::string name = parameter.qualifiedName();
    const auto found = std::find_if(free_.begin(), free_.end(), [&](const FreeParameter& f) { return f.name == name; });
    bool free = found != free_.end();
    ImGui::PushID(&parameter);
    const bool turned = ImGui::Checkbox(parameter.label().c_str(), &free);
    tooltip(ShortText("{}\n{}", name, parameter.rangeText()).view());
    const bool number = parameter.type() == Parameter::Type::Real || parameter.type() == Parameter::Type::Integer;
    if (turned && free) {
        free_.push_back({name, spec.min, spec.max});
    } else if (turned) {
        free_.erase(found);
    } else if (free && number) {
        const float em = ImGui::GetFontSize();
        const auto end = [&](const char* label, double& value, double least, double most) {
            ImGui::SetNextItemWidth(5 * em);
            ImGui::InputDouble(label, &value, 0, 0, "%.6g");
            if (ImGui::IsItemDeactivatedAfterEdit()) value = parameter.nearest(std::clamp(value, least, most));
            tooltip(ShortText("From where to where it is searched{}{}", unitName(spec.unit).empty() ? "" : ", in ",
                              unitName(spec.unit))
                        .view());
        };
        ImGui::SameLine(16 * em);
        end("##from", *found->from, spec.min, *found->to);
        ImGui::SameLine();
        text(colour::muted, "to");
        ImGui::SameLine();
        end("##to", *found->to, *found->from, spec.max);
    }
    ImGui::PopID();
}

void TradeOffPanel::proposal(Session& session, Requests& requests) {
    if (!found_) return;
    if (!found_->proposal) {
        wrappedText(colour::warning,
                    ShortText("None of {} settings that were tried keeps the budget.", found_->trials.size()).view());
        if (ImGui::Button("Dismiss")) found_.reset(), several_.reset();
        return;
    }
    const Trial& best = found_->trials[*found_->proposal];
    wrappedText(ShortText("{} of {} tried: {}", found_->complete ? "Best" : "Best so far", found_->trials.size(),
                          best.setting.card->title)
                    .view());
    std::string values;
    for (const Parameter* parameter : best.setting.parameters().all())
        if (std::any_of(free_.begin(), free_.end(),
                        [&](const FreeParameter& f) { return f.name == parameter->qualifiedName(); }))
            values += fmt::format("{}{} {}", values.empty() ? "" : ", ", parameter->label(), parameter->text());
    wrappedText(colour::accent, values);
    wrappedText(ShortText("{:.3g} ms ({:.3g} to {:.3g}), RMSE {:.4f}{}", best.outcome.cost, best.outcome.interval.low,
                          best.outcome.interval.high, best.outcome.error,
                          found_->certain ? "" : "; within the noise of the bound")
                    .view());
    if (ImGui::Button("Apply")) {
        session.techniques.take(best.setting.parameters());
        requests.restart = true;
        found_.reset();
        several_.reset();
        return;
    }
    tooltip("Take this technique with these values");
    ImGui::SameLine();
    if (ImGui::Button("Dismiss")) found_.reset(), several_.reset();
    tooltip("Keep the values that there are; the dots stay");
}

std::string TradeOffPanel::csv(const Session& session, std::string_view driver) const {
    std::string table = "technique,parameters,cost_ms,cost_low_ms,cost_high_ms,timed_frames,rmse,penumbra_rmse,bytes,"
                        "maps,current,front,scene,width,height,view,driver\n";
    for (size_t i = 0; i < points_.size(); ++i) {
        const MeasuredPoint& point = points_[i];
        std::string parameters;
        for (const Parameter* parameter : point.setting.parameters().all())
            if (parameter->changed())
                parameters +=
                    fmt::format("{}{}={}", parameters.empty() ? "" : "; ", parameter->spec().id, parameter->text());
        const bool front = std::find(frontLine_.begin(), frontLine_.end(), i) != frontLine_.end();
        const std::string cost = point.cost.count == 0
                                     ? ",,,0"
                                     : fmt::format("{:.6g},{:.6g},{:.6g},{}", point.cost.median,
                                                   point.cost.interval.low, point.cost.interval.high, point.cost.count);
        table += fmt::format("{},{},{},{:.6g},{:.6g},{},{},{},{},{},{},{},{:016x},{}\n", point.setting.card->id,
                             csvField(parameters), cost, point.rmse, point.penumbraRmse, point.bytes, point.maps,
                             isCurrent(point, session), front, csvField(point.scene), point.size.x, point.size.y,
                             point.view, csvField(driver));
    }
    return table;
}

} // namespace penumbra
