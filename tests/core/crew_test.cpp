#include "core/crew.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "carom/error.hpp"

namespace carom::detail {
namespace {

TEST(Crew, SharesCoverAllThingsOnce) {
    Barrier barrier(1);
    for (const int workers : {1, 2, 3, 7}) {
        for (const std::size_t count : {0u, 1u, 5u, 64u, 1001u}) {
            for (const std::size_t least : {1u, 4u, 100u}) {
                std::size_t next = 0;
                int busy = 0;
                for (int i = 0; i < workers; ++i) {
                    const Part part = Crew(i, workers, barrier).part(count, least);
                    EXPECT_EQ(part.begin, next);
                    next = part.end;
                    busy += part.size() > 0;
                }
                EXPECT_EQ(next, count);
                EXPECT_LE(static_cast<std::size_t>(busy) * least, std::max(count, least));
            }
        }
    }
}

/// Nobody passes the barrier before all have come: what the others wrote before it is there after it.
TEST(Crew, WorkersMeet) {
    for (const int threads : {1, 2, 4, 8}) {
        const auto pool = make_thread_pool(threads);
        ASSERT_EQ(pool->workers(), threads);
        std::vector<int> counts(static_cast<std::size_t>(threads) * 16, 0);
        std::atomic<int> wrong{0};
        int arrived = 0;
        run_crew(pool.get(), false, [&](const Crew& crew) {
            const std::size_t own = crew.part(static_cast<std::size_t>(threads)).begin;
            for (int round = 1; round <= 200; ++round) {
                counts[own * 16] = round;
                crew.meet();
                for (std::size_t i = 0; i < static_cast<std::size_t>(threads); ++i)
                    wrong += counts[i * 16] != round;
                crew.meet();
            }
            if (crew.is_first()) ++arrived;
        });
        EXPECT_EQ(wrong, 0);
        EXPECT_EQ(arrived, 1);
    }
}

TEST(ThreadPool, ARangeIsCoveredOnce) {
    for (const int threads : {1, 2, 5}) {
        const auto pool = make_thread_pool(threads);
        for (const std::size_t count : {0u, 1u, 99u, 10000u}) {
            std::vector<std::atomic<int>> seen(count);
            run_range(pool.get(), count, 10, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) ++seen[i];
            });
            for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(seen[i], 1) << i;
        }
    }
}

TEST(ThreadPool, WhatACallThrowsReachesTheCaller) {
    const auto pool = make_thread_pool(3);
    for (const std::size_t bad : {0u, 500u, 999u}) {
        const auto task = [&](std::size_t begin, std::size_t end) {
            if (begin <= bad && bad < end) throw Error("no");
        };
        EXPECT_THROW(pool->run_range(1000, 10, task), Error) << bad;
    }
    std::atomic<int> sum{0};
    pool->run_on_all([&](int) { ++sum; });
    EXPECT_EQ(sum, 3) << "and the pool goes on";
}

TEST(ThreadPool, ManyJobsOneAfterTheOther) {
    const auto pool = make_thread_pool(3);
    std::atomic<int> sum{0};
    for (int i = 0; i < 2000; ++i) {
        pool->run_on_all([&](int worker) { sum += worker + 1; });
        ASSERT_EQ(sum, 6 * (i + 1));
    }
}

TEST(ThreadPool, ASillyNumberOfThreadsIsRefused) {
    for (const int threads : {-1, 0, 257}) {
        try {
            make_thread_pool(threads);
            ADD_FAILURE() << threads;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()),
                      "threads: " + std::to_string(threads) + " is not between 1 and 256");
        }
    }
}

}  // namespace
}  // namespace carom::detail
