// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/search_watch.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

namespace ispace {
namespace {

TEST(SearchWatch, EndsAtItsLimit) {
    const SearchWatch none(std::make_unique<SilentProgress>(), std::nullopt);
    EXPECT_FALSE(none.stopped());
}

TEST(SearchWatch, NoTimeIsNoTime) {
    const SearchWatch watch(std::make_unique<SilentProgress>(), 0);
    EXPECT_TRUE(watch.stopped());
    EXPECT_EQ(watch.signal(), 0);
}

TEST(SearchWatch, LongLimitsDoNotOverflow) {
    const SearchWatch watch(std::make_unique<SilentProgress>(), 1e300);
    EXPECT_FALSE(watch.stopped());
}

TEST(SearchWatch, ASignalStopsItAndTheProcessCanEndByIt) {
    const pid_t child = ::fork();
    if (child == 0) {
        int signal = 0;
        {
            const SearchWatch watch(std::make_unique<SilentProgress>(), std::nullopt);
            std::raise(SIGTERM);
            while (!watch.stopped()) std::this_thread::yield();
            signal = watch.signal();
        }
        if (signal != SIGTERM) ::_exit(1);
        endBySignal(signal);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << status;
    EXPECT_EQ(WTERMSIG(status), SIGTERM);
}

}  // namespace
}  // namespace ispace
