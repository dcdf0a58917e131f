// SPDX-License-Identifier: MIT
#include "renderer/truth/crew.h"

#include <algorithm>

#include <sys/resource.h>
#include <unistd.h>

namespace penumbra {

int crewSize(int wanted) {
    return wanted > 0 ? wanted : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void stepBack() {
    // Linux weighs nice 15 with 36 against 1024 of others, and takes the number of one thread for `who`.
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), 15);
}

Crew::Crew(int threads) {
    for (int i = 1; i < threads; ++i)
        threads_.emplace_back([this] {
            uint64_t seen = 0;
            std::unique_lock lock(mutex_);
            while (true) {
                begun_.wait(lock, [&] { return over_ || round_ != seen; });
                if (over_) return;
                seen = round_;
                lock.unlock();
                takePieces();
                lock.lock();
                if (--busy_ == 0) done_.notify_one();
            }
        });
}

Crew::~Crew() {
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    begun_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void Crew::takePieces() {
    while (true) {
        const size_t begin = next_.fetch_add(piece_);
        if (begin >= count_) return;
        (*work_)(begin, std::min(begin + piece_, count_));
    }
}

void Crew::shareOut(size_t count, size_t piece, const std::function<void(size_t, size_t)>& work) {
    {
        const std::lock_guard lock(mutex_);
        work_ = &work;
        count_ = count;
        piece_ = piece;
        next_ = 0;
        busy_ = threads_.size();
        ++round_;
    }
    begun_.notify_all();
    takePieces();
    std::unique_lock lock(mutex_);
    done_.wait(lock, [&] { return busy_ == 0; });
}

} // namespace penumbra
