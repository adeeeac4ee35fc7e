#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace carom {

/// Where a world does its work. The library has a pool of threads of its own (`make_thread_pool`); a game
/// that has a scheduler already gives it this face instead. Results are the same bits whatever the scheduler
/// and however many workers it has.
class Scheduler {
  public:
    virtual ~Scheduler() = default;

    /// How many workers there are, the calling thread included: at least 1.
    virtual int workers() const = 0;

    /// Calls `task(begin, end)` for stretches that cover 0 … count once, on any workers and in any order, and
    /// returns when all calls have returned. Stretches shorter than `grain` are not worth a worker. A pool
    /// throws what one of the calls threw; those that a step makes throw nothing.
    virtual void run_range(std::size_t count, std::size_t grain,
                           const std::function<void(std::size_t begin, std::size_t end)>& task) = 0;

    /// Calls `task(worker)` once for each worker 0 … workers() − 1, all at the same time, and returns when
    /// all calls have returned. They wait for one another, so each needs a thread of its own.
    virtual void run_on_all(const std::function<void(int worker)>& task) = 0;
};

/// A pool of `threads` threads, the calling one included; 1 … 256, else throws `Error`. Threads that have
/// nothing to do sleep. A pool may serve several worlds, one at a time.
std::shared_ptr<Scheduler> make_thread_pool(int threads);

}  // namespace carom
