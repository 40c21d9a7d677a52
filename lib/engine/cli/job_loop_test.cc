// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job_loop.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "cli/common_options.h"

namespace ispace {
namespace job_loop_test {

using Delivery = std::function<void()>;

/// Runs the jobs 0, 1, ..., count - 1.
void runInOrder(std::size_t count, const std::function<Delivery(std::size_t)>& work,
                LoopThreads threads = LoopThreads::All) {
    std::size_t next = 0;
    runJobs(threads, [&]() -> std::optional<LoopJob> {
        if (next == count) return std::nullopt;
        return LoopJob{.work = [&work, i = next++] { return work(i); }};
    });
}

TEST(JobLoop, DeliversInOrderAndFewAtATime) {
    for (const int threads : {1, 2, 8}) {
        limitThreads(threads);
        std::atomic<int> waiting = 0, most = 0;
        std::vector<std::size_t> order;
        runInOrder(500, [&](std::size_t i) -> std::function<void()> {
            const int now = ++waiting;
            for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
            }
            return [&, i] {
                --waiting;
                order.push_back(i);
            };
        });
        ASSERT_EQ(order.size(), 500U);
        for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
        EXPECT_LE(most, 2 * threads);
    }
}

TEST(JobLoop, EndsWithWhatIsThrown) {
    std::size_t delivered = 0;
    const auto work = [&](std::size_t i) -> std::function<void()> {
        if (i == 7) throw std::runtime_error("seven");
        return [&] { ++delivered; };
    };
    EXPECT_THROW(runInOrder(1000, work), std::runtime_error);
    EXPECT_LT(delivered, 1000U);
    runInOrder(0, work);
    EXPECT_THROW(runInOrder(3,
                            [](std::size_t) -> std::function<void()> {
                                return [] { throw std::runtime_error("full disk"); };
                            }),
                 std::runtime_error);
}

TEST(JobLoop, AnErrorLeavesOtherJobsWhole) {
    limitThreads(2);
    std::atomic<bool> has_begun = false, has_thrown = false;
    std::atomic<int> done = 0;
    const auto wait_for = [](const std::atomic<bool>& event) {
        for (int k = 0; k < 2000 && !event; ++k)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    const auto work = [&](std::size_t i) -> std::function<void()> {
        if (i == 0)
            return [&] {
                wait_for(has_begun);
                has_thrown = true;
                throw std::runtime_error("full disk");
            };
        has_begun = true;
        wait_for(has_thrown);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        tbb::parallel_for(0, 1000, [&](int) { ++done; });
        return [] {};
    };
    EXPECT_THROW(runInOrder(2, work), std::runtime_error);
    EXPECT_EQ(done, has_begun ? 1000 : 0);
}

/// As a server needs it: each request is read after the answer to the one before it.
TEST(JobLoop, TakesOneAfterTheOther) {
    std::vector<int> steps;
    int job = 0;
    const auto next = [&]() -> std::optional<LoopJob> {
        steps.push_back(job);
        if (job == 3) return std::nullopt;
        return LoopJob{.work = [&, i = job++]() -> Delivery {
            steps.push_back(10 + i);
            return [&, i] { steps.push_back(20 + i); };
        }};
    };
    runJobs(LoopThreads::One, next);
    EXPECT_EQ(steps, (std::vector<int>{0, 10, 20, 1, 11, 21, 2, 12, 22, 3}));
}

TEST(JobLoop, AnEmptyDeliveryEndsIt) {
    std::size_t delivered = 0;
    const auto work = [&](std::size_t i) -> Delivery {
        if (i == 2) return {};
        return [&] { ++delivered; };
    };
    runInOrder(5, work, LoopThreads::One);
    EXPECT_EQ(delivered, 2U);
}

}  // namespace job_loop_test
}  // namespace ispace
