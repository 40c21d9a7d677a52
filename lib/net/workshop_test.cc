// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/workshop.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <stdexcept>
#include <string>

namespace ispace {
namespace {

using Control = tbb::global_control;

TEST(Workshop, DoesJobsInOrderInAnotherThread) {
    const Control two(Control::max_allowed_parallelism, 2);
    std::atomic<int> wakes = 0;
    Workshop workshop([&wakes] { ++wakes; });
    std::string worked, delivered;
    const auto owner = std::this_thread::get_id();
    for (const char name : {'a', 'b', 'c'})
        workshop.give({[&worked, name, owner] {
                           EXPECT_NE(std::this_thread::get_id(), owner);
                           worked += name;
                       },
                       [&delivered, name, owner](const std::exception_ptr& failure) {
                           EXPECT_EQ(std::this_thread::get_id(), owner);
                           EXPECT_FALSE(failure);
                           delivered += name;
                       }});
    EXPECT_EQ(workshop.open(), 3U);
    workshop.collectAll();
    EXPECT_EQ(workshop.open(), 0U);
    EXPECT_EQ(worked, "abc");
    EXPECT_EQ(delivered, "abc");
    EXPECT_FALSE(workshop.collect());
}

TEST(Workshop, DeliversWhatAJobThrows) {
    Workshop workshop([] {});
    std::string told;
    workshop.give({[] { throw std::runtime_error("no paper"); },
                   [&told](const std::exception_ptr& failure) {
                       try {
                           std::rethrow_exception(failure);
                       } catch (const std::runtime_error& error) {
                           told = error.what();
                       }
                   }});
    workshop.collectAll();
    EXPECT_EQ(told, "no paper");
}

TEST(Workshop, GivesJobsWhileDelivering) {
    Workshop workshop([] {});
    int left = 5;
    std::function<void(const std::exception_ptr&)> again = [&](const std::exception_ptr&) {
        if (--left > 0) workshop.give({[] {}, again});
    };
    workshop.give({[] {}, again});
    workshop.collectAll();
    EXPECT_EQ(left, 0);
}

TEST(Workshop, DoesJobsItselfWhereNoOtherThreadIsAllowed) {
    const Control one(Control::max_allowed_parallelism, 1);
    int wakes = 0, delivered = 0;
    Workshop workshop([&wakes] { ++wakes; });
    const auto owner = std::this_thread::get_id();
    workshop.give({[owner] {
                       EXPECT_EQ(std::this_thread::get_id(), owner);
                       throw std::runtime_error("no paper");
                   },
                   [&delivered](const std::exception_ptr& failure) {
                       EXPECT_TRUE(failure);
                       ++delivered;
                   }});
    EXPECT_EQ(workshop.open(), 1U);
    EXPECT_EQ(delivered, 0);
    EXPECT_EQ(wakes, 1);
    EXPECT_TRUE(workshop.collect());
    EXPECT_EQ(delivered, 1);
    EXPECT_EQ(workshop.open(), 0U);
}

TEST(Workshop, DropsWhatIsNotBegun) {
    const Control two(Control::max_allowed_parallelism, 2);
    std::atomic<bool> begun = false, may_end = false;
    std::atomic<int> worked = 0;
    {
        Workshop workshop([] {});
        const auto nothing = [](const std::exception_ptr&) { FAIL(); };
        workshop.give({[&] {
                           begun = true;
                           while (!may_end) std::this_thread::yield();
                           ++worked;
                       },
                       nothing});
        while (!begun) std::this_thread::yield();
        workshop.give({[&worked] { ++worked; }, nothing});
        std::thread([&may_end] {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            may_end = true;
        }).detach();
    }
    EXPECT_EQ(worked, 1);
}

}  // namespace
}  // namespace ispace
