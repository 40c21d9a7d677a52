// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/per_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace ispace {
namespace per_thread_test {

std::atomic<int> alive = 0;

struct Counted {
    Counted() { ++alive; }
    ~Counted() { --alive; }
    Counted(const Counted&) = delete;
    Counted& operator=(const Counted&) = delete;
    int value = 0;
};

TEST(PerThread, HasOneOfEachTagInEachThread) {
    Counted& own = perThread<Counted, struct First>();
    own.value = 7;
    EXPECT_EQ(&(perThread<Counted, struct First>()), &own);
    EXPECT_NE(&(perThread<Counted, struct Second>()), &own);
    const int before = alive;
    std::thread([&] {
        EXPECT_EQ((perThread<Counted, struct First>().value), 0);
        EXPECT_EQ(alive, before + 1);
    }).join();
    EXPECT_EQ(alive, before) << "destroyed with its thread";
    EXPECT_EQ((perThread<Counted, struct First>().value), 7);
}

}  // namespace per_thread_test
}  // namespace ispace
