// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace penumbra {

// Threads that share out work; whoever calls shareOut() is one of them. They have the priority of the thread that made
// the crew.
class Crew {
public:
    explicit Crew(int threads);
    ~Crew();
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

    // Runs work(begin, end) for pieces of [0, count), each at most `piece` long, on all threads, and waits. `work` must
    // not throw.
    void shareOut(size_t count, size_t piece, const std::function<void(size_t begin, size_t end)>& work);

private:
    void takePieces();

    std::mutex mutex_;
    std::condition_variable begun_, done_;
    const std::function<void(size_t, size_t)>* work_ = nullptr;
    size_t count_ = 0, piece_ = 1;
    std::atomic<size_t> next_{0};
    uint64_t round_ = 0;
    size_t busy_ = 0;
    bool over_ = false;
    std::vector<std::thread> threads_;
};

// All cores, or as many as were asked for.
int crewSize(int wanted);

// Gives the calling thread, and those that it will start, about a tenth of a core that others want too.
void stepBack();

} // namespace penumbra
