// SPDX-License-Identifier: MIT
// What accuracy costs: a chart of everything that was measured, cost across and error up, and the search for the best
// setting within a budget.
#pragma once

#include "ui/chart_scale.h"
#include "ui/widgets.h"

#include "renderer/measure/background_measurement.h"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace penumbra {

// A setting that was measured, and in which view. Errors compare only within one view.
struct MeasuredPoint {
    Setting setting;
    uint64_t view;
    std::string scene;
    glm::ivec2 size;
    TimeSummary cost; // [ms]; count 0: not known
    double rmse, penumbraRmse;
    uint64_t bytes = 0;
    int maps = 0;
};

class TradeOffPanel {
public:
    TradeOffPanel(SideContext::MakeCurrent makeCurrent, TruthCache* cache)
        : measurement_(std::move(makeCurrent))
        , cache_(cache) {}

    // What a hand asked for that the panel cannot do alone.
    struct Requests {
        bool savePicture = false, saveTable = false;
        bool restart = false;     // the technique or its values are others
        std::string trouble = {}; // bad input, for a dialog
    };
    // Draws into the current ImGui window. `clean`: without what a hand or a pointer brings up, for a picture. `busy`:
    // something else is measured, which would disturb this.
    Requests draw(Session& session, bool clean, bool busy);
    // Takes in what was measured meanwhile; call it every frame, whether the panel is drawn or not. A line to say, or
    // nothing.
    std::string poll();

    bool measuring() const { return measurement_.progress() != nullptr; }
    // Of the chart, as drawn last: its corner and size.
    ImVec2 chartCorner() const { return corner_; }
    ImVec2 chartSize() const { return size_; }
    std::string csv(const Session& session, std::string_view driver) const;

private:
    enum class Error { All, Penumbra };
    struct Dot { // of a point on the chart
        size_t point;
        ImVec2 place;
        bool here;    // measured in the view that is shown
        bool current; // of the values that its technique has now
    };

    uint64_t viewOf(const Session& session);
    double errorOf(const MeasuredPoint& point) const { return error_ == Error::All ? point.rmse : point.penumbraRmse; }
    bool isCurrent(const MeasuredPoint& point, const Session& session) const;
    void add(SettingResult result);
    void arrange();
    void begin(const Session& session, uint64_t view);
    void measureAll(const Session& session, uint64_t view);
    void search(const Session& session, uint64_t view);

    void chart(Session& session, ImVec2 size, bool clean, Requests& requests);
    void dots(const Session& session, ImVec2 from, ImVec2 to);
    void names(ImVec2 from, ImVec2 to) const;
    void describe(const MeasuredPoint& point) const;
    void controls(Session& session, Requests& requests);
    void progress();
    void budgetForm(Session& session, Requests& requests);
    void freeList();
    void freeRow(const Parameter& parameter);
    void proposal(Session& session, Requests& requests);

    BackgroundMeasurement measurement_;
    TruthCache* cache_;
    std::vector<MeasuredPoint> points_;

    // Of the view: what it was hashed from last, and the scene's own part.
    const Scene* hashedScene_ = nullptr;
    uint64_t sceneHash_ = 0, view_ = 0;
    std::optional<uint64_t> several_; // the views of the last search, if they are several: they are shown
    // Of what runs, or ran last.
    uint64_t measuredView_ = 0;
    std::string measuredScene_;
    glm::ivec2 measuredSize_{0};
    size_t tried_ = 0;

    // The points that are shown, arranged anew when one comes or the view is another.
    std::vector<size_t> shown_, elsewhere_; // of this view, and of others
    std::vector<size_t> frontLine_;
    ChartAxis costAxis_, errorAxis_;
    uint64_t arrangedView_ = 0;
    bool stale_ = true;
    std::vector<Dot> dots_;
    ImVec2 corner_{0, 0}, size_{0, 0};
    std::optional<size_t> pointed_; // among the points

    bool busy_ = false;
    Error error_ = Error::All;
    bool logCost_ = true, logError_ = false;
    Bound bound_ = Bound::Cost;
    float mostMilliseconds_ = 5, mostError_ = 0.05f;
    std::vector<FreeParameter> free_; // by qualified name, with both ends of their ranges
    std::set<std::string> left_;      // techniques that are left out
    std::vector<Session> views_;      // kept for searches
    std::vector<uint64_t> viewHashes_;
    Budget asked_;
    std::optional<BudgetSearch> found_; // and neither applied nor dismissed yet
};

} // namespace penumbra
