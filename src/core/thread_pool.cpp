#include <atomic>
#include <cstdint>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "carom/error.hpp"
#include "carom/scheduler.hpp"
#include "core/crew.hpp"

namespace carom {

namespace {

/// Workers wait for the number of the job to change: at first they look again and again, as a step has many
/// jobs that follow one another closely, then they sleep.
class ThreadPool : public Scheduler {
  public:
    explicit ThreadPool(int threads) {
        for (int worker = 1; worker < threads; ++worker)
            threads_.emplace_back([this, worker] { serve(worker); });
    }
    ~ThreadPool() override {
        begin(nullptr);
        for (std::thread& thread : threads_) thread.join();
    }

    int workers() const override { return static_cast<int>(threads_.size()) + 1; }

    void run_range(std::size_t count, std::size_t grain,
                   const std::function<void(std::size_t, std::size_t)>& task) override {
        const std::size_t most = (count + grain - 1) / std::max<std::size_t>(grain, 1);
        if (threads_.empty() || most < 2) return task(0, count);
        // A few stretches a worker, so that one that is late does not keep the others waiting.
        const std::size_t stretches = std::min(most, 4 * static_cast<std::size_t>(workers()));
        std::atomic<std::size_t> next{0};
        std::atomic<bool> failed{false};
        std::exception_ptr error;
        const auto work = [&](int) {
            try {
                for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < stretches;)
                    task(count * i / stretches, count * (i + 1) / stretches);
            } catch (...) {
                if (!failed.exchange(true)) error = std::current_exception();
            }
        };
        run_on_all(std::ref(work));
        if (error) std::rethrow_exception(error);
    }

    void run_on_all(const std::function<void(int)>& task) override {
        if (threads_.empty()) return task(0);
        left_.store(static_cast<int>(threads_.size()), std::memory_order_relaxed);
        begin(&task);
        task(0);
        for (int turns = 0; left_.load(std::memory_order_acquire) > 0; ++turns)
            turns < patience ? detail::pause_a_little() : std::this_thread::yield();
    }

  private:
    static constexpr int patience = 20000;  // looks: about a millisecond

    void begin(const std::function<void(int)>* task) {
        task_ = task;
        job_.fetch_add(1, std::memory_order_release);
        job_.notify_all();
    }

    void serve(int worker) {
        for (std::uint32_t done = 0;;) {
            for (int turns = 0; job_.load(std::memory_order_acquire) == done && turns < patience; ++turns)
                detail::pause_a_little();
            job_.wait(done, std::memory_order_acquire);
            ++done;
            if (!task_) return;
            (*task_)(worker);
            left_.fetch_sub(1, std::memory_order_release);
        }
    }

    std::vector<std::thread> threads_;
    const std::function<void(int)>* task_ = nullptr;
    alignas(64) std::atomic<std::uint32_t> job_{0};
    alignas(64) std::atomic<int> left_{0};
};

}  // namespace

std::shared_ptr<Scheduler> make_thread_pool(int threads) {
    if (threads < 1 || threads > 256)
        throw Error("threads: " + std::to_string(threads) + " is not between 1 and 256");
    return std::make_shared<ThreadPool>(threads);
}

}  // namespace carom
