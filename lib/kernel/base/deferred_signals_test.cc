// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/run_files.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <thread>

namespace ispace {
namespace deferred_signals_test {

std::atomic<int> taken;

TEST(DeferredSignals, HandlersGetTheirsAfterwards) {
    taken = 0;
    const auto before = std::signal(SIGTERM, [](int) { ++taken; });
    {
        const DeferredSignals held;
        std::raise(SIGTERM);
        // A signal goes to any thread that takes it.
        std::thread([] { std::raise(SIGTERM); }).join();
        EXPECT_EQ(taken, 0);
    }
    EXPECT_EQ(taken, 2);
    std::raise(SIGTERM);
    EXPECT_EQ(taken, 3) << "the handler is back";
    std::signal(SIGTERM, before);
}

TEST(DeferredSignals, WhatIsIgnoredStaysIgnored) {
    const auto before = std::signal(SIGHUP, SIG_IGN);
    {
        const DeferredSignals held;
        std::raise(SIGHUP);
    }
    EXPECT_EQ(std::signal(SIGHUP, before), SIG_IGN);
}

TEST(DeferredSignals, EndAProcessAfterwards) {
    int pipe[2];
    ASSERT_EQ(::pipe(pipe), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        {
            const DeferredSignals held;
            std::raise(SIGINT);
            static_cast<void>(!::write(pipe[1], "x", 1));
        }
        ::_exit(0);
    }
    ::close(pipe[1]);
    char byte = 0;
    EXPECT_EQ(::read(pipe[0], &byte, 1), 1) << "it lived on";
    ::close(pipe[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT);
}

}  // namespace deferred_signals_test
}  // namespace ispace
