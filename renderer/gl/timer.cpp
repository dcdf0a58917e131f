// SPDX-License-Identifier: MIT
#include "renderer/gl/timer.h"

#include <algorithm>

namespace penumbra {
namespace {

double milliseconds(std::chrono::steady_clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

} // namespace

void PassTimer::stamp(Round& round, size_t index) {
    if (index == round.queries.size()) {
        GLuint name = 0;
        glCreateQueries(GL_TIMESTAMP, 1, &name);
        round.queries.push_back(name);
    }
    glQueryCounter(round.queries[index], GL_TIMESTAMP);
}

void PassTimer::collect(Round& round) {
    GLint ready = 0;
    glGetQueryObjectiv(round.queries[round.marks.size()], GL_QUERY_RESULT_AVAILABLE, &ready);
    if (!ready) return;
    newest_.passes.clear();
    GLuint64 first = 0, before = 0, now = 0;
    glGetQueryObjectui64v(round.queries[0], GL_QUERY_RESULT, &first);
    before = first;
    double elsewhere = 0;
    for (size_t i = 0; i < round.marks.size(); ++i) {
        glGetQueryObjectui64v(round.queries[i + 1], GL_QUERY_RESULT, &now);
        const double ms = static_cast<double>(now - before) * 1e-6;
        if (round.marks[i].label < 0)
            elsewhere += ms;
        else
            add(round.marks[i].stage, round.marks[i].label, ms);
        before = now;
    }
    newest_.milliseconds = static_cast<double>(before - first) * 1e-6 - elsewhere;
    newest_.number = round.frame;
    round.pending = false;
}

void PassTimer::add(Stage stage, int label, double ms) {
    const auto known =
        std::find_if(newest_.passes.begin(), newest_.passes.end(), [&](const PassTime& t) { return t.label == label; });
    if (known != newest_.passes.end())
        known->milliseconds += ms;
    else
        newest_.passes.push_back({stage, label, ms});
}

void PassTimer::beginFrame(Timing timing) {
    timing_ = timing;
    ++frame_;
    if (timing == Timing::Queries) {
        poll();
        round_ = (round_ + 1) % rounds_.size();
        rounds_[round_].marks.clear();
        rounds_[round_].frame = frame_;
        stamp(rounds_[round_], 0);
    } else if (timing == Timing::Finish) {
        glFinish();
        newest_.passes.clear();
        frameStart_ = passStart_ = Clock::now();
        elsewhere_ = {};
    }
}

void PassTimer::resume() {
    if (timing_ == Timing::Queries) {
        Round& round = rounds_[round_];
        round.marks.push_back({Stage::Scene, -1});
        stamp(round, round.marks.size());
    } else if (timing_ == Timing::Finish) {
        const Clock::time_point now = Clock::now();
        elsewhere_ += now - passStart_;
        passStart_ = now;
    }
}

void PassTimer::poll() {
    for (size_t i = 1; i <= rounds_.size(); ++i) { // oldest first
        Round& round = rounds_[(round_ + i) % rounds_.size()];
        if (round.pending) collect(round);
    }
}

void PassTimer::endPass(Stage stage, int label) {
    if (timing_ == Timing::Queries) {
        Round& round = rounds_[round_];
        round.marks.push_back({stage, label});
        stamp(round, round.marks.size());
    } else if (timing_ == Timing::Finish) {
        glFinish();
        const Clock::time_point now = Clock::now();
        add(stage, label, milliseconds(now - passStart_));
        passStart_ = now;
    }
}

void PassTimer::endFrame() {
    if (timing_ == Timing::Queries) rounds_[round_].pending = true;
    if (timing_ == Timing::Finish) {
        newest_.milliseconds = milliseconds(Clock::now() - frameStart_ - elsewhere_);
        newest_.number = frame_;
    }
}

} // namespace penumbra
