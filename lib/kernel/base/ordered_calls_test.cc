// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <thread>

namespace ispace {
namespace ordered_calls_test {

TEST(OrderedCalls, CallsWaitForThoseBeforeThem) {
    std::vector<int> called;
    OrderedCalls order(3);
    const auto note = [&called](int i) { return [&called, i] { called.push_back(i); }; };
    order.add(2, note(2));
    order.add(1, note(1));
    EXPECT_TRUE(called.empty());
    order.add(0, note(0));
    EXPECT_EQ(called, (std::vector<int>{0, 1, 2}));
}

TEST(OrderedCalls, SameOrderFromSeveralThreads) {
    constexpr std::size_t kCount = 3000, kThreads = 3;
    std::vector<std::size_t> called;
    OrderedCalls order(kCount);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < kThreads; ++t)
        threads.emplace_back([&, t] {
            for (std::size_t i = t; i < kCount; i += kThreads)
                order.add(i, [&called, i] { called.push_back(i); });
        });
    for (std::thread& thread : threads) thread.join();
    std::vector<std::size_t> all(kCount);
    std::iota(all.begin(), all.end(), std::size_t{0});
    EXPECT_EQ(called, all);
}

TEST(OrderedCalls, WhatThrowsIsTheLast) {
    int called = 0;
    OrderedCalls order(2);
    EXPECT_THROW(order.add(0, [] { throw std::runtime_error("full"); }), std::runtime_error);
    order.add(1, [&called] { ++called; });
    EXPECT_EQ(called, 0);
}

}  // namespace ordered_calls_test
}  // namespace ispace
