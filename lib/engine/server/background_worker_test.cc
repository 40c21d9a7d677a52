// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/background_worker.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <stdexcept>
#include <string>

namespace ispace {
namespace background_worker_test {

using Control = tbb::global_control;

TEST(BackgroundWorker, DoesJobsInOrderInAnotherThread) {
    const Control two(Control::max_allowed_parallelism, 2);
    std::atomic<int> wakes = 0;
    BackgroundWorker workshop([&wakes] { ++wakes; });
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

TEST(BackgroundWorker, DeliversWhatAJobThrows) {
    BackgroundWorker workshop([] {});
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

TEST(BackgroundWorker, KeepsTheDeliveriesBehindOneThatThrows) {
    const Control two(Control::max_allowed_parallelism, 2);
    std::atomic<int> finished = 0;
    BackgroundWorker workshop([&finished] { ++finished; });
    std::string delivered;
    for (const char name : {'a', 'b', 'c'})
        workshop.give({[] {},
                       [&delivered, name](const std::exception_ptr&) {
                           if (name == 'a') throw std::runtime_error("no paper");
                           delivered += name;
                       }});
    while (finished < 3) std::this_thread::yield();
    EXPECT_THROW(workshop.collect(), std::runtime_error);
    EXPECT_EQ(workshop.open(), 2U);
    EXPECT_EQ(finished, 4) << "the owner hears that there is more to collect";
    EXPECT_TRUE(workshop.collect());
    EXPECT_EQ(delivered, "bc");
    EXPECT_EQ(workshop.open(), 0U);
}

TEST(BackgroundWorker, GivesJobsWhileDelivering) {
    BackgroundWorker workshop([] {});
    int left = 5;
    std::function<void(const std::exception_ptr&)> again = [&](const std::exception_ptr&) {
        if (--left > 0) workshop.give({[] {}, again});
    };
    workshop.give({[] {}, again});
    workshop.collectAll();
    EXPECT_EQ(left, 0);
}

/// Whose clients would wait for a picture otherwise.
TEST(BackgroundWorker, HasItsThreadWhereOneAloneMayCompute) {
    const Control one(Control::max_allowed_parallelism, 1);
    BackgroundWorker workshop([] {});
    const auto owner = std::this_thread::get_id();
    bool is_delivered = false;
    workshop.give({[owner] { EXPECT_NE(std::this_thread::get_id(), owner); },
                   [&](const std::exception_ptr&) { is_delivered = true; }});
    while (!is_delivered) workshop.collectWithin(std::chrono::milliseconds(20));
    EXPECT_EQ(workshop.open(), 0U);
}

TEST(BackgroundWorker, DropsWhatIsNotBegun) {
    const Control two(Control::max_allowed_parallelism, 2);
    std::atomic<bool> begun = false, may_end = false;
    std::atomic<int> worked = 0;
    {
        BackgroundWorker workshop([] {});
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

}  // namespace background_worker_test
}  // namespace ispace
