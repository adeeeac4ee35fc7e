#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>

#include "carom/scheduler.hpp"

namespace carom::detail {

/// A hint to the processor that a loop waits.
inline void pause_a_little() {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
}

/// Where workers wait for one another. Each arrival counts; the last one lets all go on. Waiting is spinning,
/// as the work between two meetings takes microseconds, and yields after a while for machines with fewer
/// processors than workers.
class Barrier {
  public:
    explicit Barrier(int count) : count_(count) {}

    void wait() {
        if (count_ == 1) return;
        const int round = round_.load(std::memory_order_relaxed);
        if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == count_) {
            arrived_.store(0, std::memory_order_relaxed);
            round_.store(round + 1, std::memory_order_release);
            return;
        }
        for (int turns = 0; round_.load(std::memory_order_acquire) == round; ++turns) {
            turns < 300 ? pause_a_little() : std::this_thread::yield();
        }
    }

  private:
    int count_;
    alignas(64) std::atomic<int> arrived_{0};
    alignas(64) std::atomic<int> round_{0};
};

/// A stretch of some things.
struct Part {
    std::size_t begin = 0, end = 0;
    std::size_t size() const { return end - begin; }
};

/// One of several workers that run through the same code side by side.
class Crew {
  public:
    /// The only worker.
    Crew() = default;
    Crew(int index, int count, Barrier& barrier) : index_(index), count_(count), barrier_(&barrier) {}

    /// This worker's share of `count` things, of which `least` at least are worth one. Depends on nothing but
    /// the numbers.
    Part part(std::size_t count, std::size_t least = 1) const {
        const auto workers = std::clamp<std::size_t>(count / least, 1, static_cast<std::size_t>(count_));
        const auto i = std::min<std::size_t>(static_cast<std::size_t>(index_), workers);
        return {count * i / workers, count * std::min(i + 1, workers) / workers};
    }
    /// Waits until all workers have come here.
    void meet() const {
        if (barrier_) barrier_->wait();
    }
    bool is_first() const { return index_ == 0; }
    /// The first worker does this, while the others wait for it.
    template <class Work>
    void alone(Work&& work) const {
        if (is_first()) work();
        meet();
    }

  private:
    int index_ = 0, count_ = 1;
    Barrier* barrier_ = nullptr;
};

/// Runs `work(crew)` on all workers of the scheduler, or on this thread alone.
template <class Work>
void run_crew(Scheduler* scheduler, bool alone, Work&& work) {
    const int workers = alone || !scheduler ? 1 : scheduler->workers();
    if (workers == 1) return work(Crew());
    Barrier barrier(workers);
    const auto task = [&](int worker) { work(Crew(worker, workers, barrier)); };
    scheduler->run_on_all(std::ref(task));
}

/// Runs `work(begin, end)` over 0 … count; stretches shorter than `grain` are not worth a worker.
template <class Work>
void run_range(Scheduler* scheduler, std::size_t count, std::size_t grain, Work&& work) {
    if (!scheduler || count < 2 * grain) return work(std::size_t{0}, count);
    scheduler->run_range(count, grain, std::ref(work));
}

}  // namespace carom::detail
