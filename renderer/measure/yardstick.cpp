// SPDX-License-Identifier: MIT
#include "renderer/measure/yardstick.h"

#include "renderer/renderer.h"
#include "renderer/truth/crew.h"

#include <algorithm>

namespace penumbra {
namespace {

using namespace std::chrono_literals;

constexpr auto quiet = 200ms;         // without a change before a truth is begun
constexpr auto snapshotPause = 100ms; // between two shots at least

// Row 0 at the top instead of below.
template <class T> void turnOver(std::vector<T>& texels, int width) {
    const auto row = static_cast<std::ptrdiff_t>(width);
    for (auto low = texels.begin(), high = texels.end() - row; low < high; low += row, high -= row)
        std::swap_ranges(low, low + row, high);
}

} // namespace

std::shared_ptr<const TruthImage> imageOf(const Truth& truth, const TruthKey& key) {
    auto texels = std::make_shared<std::vector<float>>(2 * truth.psi.size());
    const auto width = static_cast<size_t>(truth.width), height = static_cast<size_t>(truth.height);
    float* to = texels->data();
    for (size_t y = height; y-- > 0;)
        for (size_t i = y * width; i < (y + 1) * width; ++i) {
            *to++ = truth.psi[i];
            *to++ = truth.classes[i] == PixelClass::FacesWholeLight ? 1.0f : 0.0f;
        }
    return std::make_shared<const TruthImage>(TruthImage{key, std::move(texels)});
}

Yardstick::~Yardstick() {
    if (measuring_.valid()) measuring_.wait();
}

void Yardstick::cancel() {
    background_.cancel();
    cancelled_ = true;
    started_ = false;
}

// The view is another one.
void Yardstick::forget(Session& session) {
    background_.cancel();
    started_ = cancelled_ = false;
    truth_.reset();
    session.truth.reset();
    coming_.reset();
    snapshot_.reset();
    errors_ = {};
}

void Yardstick::update(Session& session, const Renderer& renderer, uint64_t frames, bool current) {
    if (!truthWanted && !snapshotsWanted) {
        if (key_) forget(session);
        key_.reset();
        return;
    }
    if (TruthKey key = session.truthKey(); key_ != key) {
        forget(session);
        key_ = std::move(key);
        changed_ = Clock::now();
    }
    trace(session, renderer, current);
    shoot(session, renderer, frames, current);
    measure();
}

void Yardstick::trace(Session& session, const Renderer& renderer, bool current) {
    if (!truthWanted) {
        if (started_ || truth_) background_.cancel();
        started_ = cancelled_ = false;
        truth_.reset();
        session.truth.reset();
        errors_ = {};
        return;
    }
    if (!started_ && !cancelled_ && current && Clock::now() - changed_ >= quiet) {
        background_.start(readTruthInput(renderer, session), {.background = true, .cache = cache_});
        started_ = true;
    }
    if (!started_) return;
    const std::shared_ptr<const Truth> newest = background_.latest();
    if (!newest || newest == truth_) return;
    truth_ = newest;
    session.truth = imageOf(*truth_, *key_);
}

void Yardstick::shoot(const Session& session, const Renderer& renderer, uint64_t frames, bool current) {
    if (coming_) {
        const auto take = [&](ReadBack& back, std::vector<float>& values) {
            if (!back.underWay()) return true;
            if (!back.take(values)) return false;
            turnOver(values, coming_->view.size.x);
            return true;
        };
        bool all = take(depthBack_, coming_->depth);
        for (size_t i = 0; i < shadowBack_.size(); ++i) all = take(shadowBack_[i], coming_->shadow[i]) && all;
        if (!all) return;
        snapshot_ = std::move(coming_);
        coming_.reset();
    }
    const bool due = !snapshot_ || (frames != snapshotFrame_ && Clock::now() - snapshotTime_ >= snapshotPause);
    if (!due || !current || !renderer.hasFrame() || renderer.view().size != session.size) return;
    const auto start = [&](ReadBack& back, Image image) {
        back.start(renderer.runner().texture(renderer.flow(), image));
    };
    coming_ = std::make_shared<Snapshot>();
    coming_->view = renderer.view();
    start(depthBack_, renderer.depth());
    start(shadowBack_[0], renderer.shadow());
    shadowBack_[1].forget();
    if (renderer.rival()) start(shadowBack_[1], *renderer.rival());
    snapshotFrame_ = frames;
    snapshotTime_ = Clock::now();
}

void Yardstick::measure() {
    if (measuring_.valid()) {
        if (measuring_.wait_for(0s) != std::future_status::ready) return;
        measured_ = measuring_.get();
        // Of an older view or of one that is not wanted any more?
        if (measured_.truth && truth_ && measured_.truth->hash == truth_->hash) errors_ = measured_.errors;
    }
    if (!snapshot_ || !truth_ || (measured_.snapshot == snapshot_ && measured_.truth == truth_)) return;
    measuring_ = std::async(std::launch::async, [snapshot = snapshot_, truth = truth_] {
        stepBack();
        Measured measured{snapshot, truth, {}};
        for (size_t i = 0; i < snapshot->shadow.size(); ++i)
            if (!snapshot->shadow[i].empty()) measured.errors[i] = errorsOf(snapshot->shadow[i], *truth);
        return measured;
    });
}

} // namespace penumbra
