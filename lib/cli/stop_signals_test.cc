// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/stop_signals.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <thread>

namespace ispace {

namespace {

TEST(StopSignals, AskToEndAndAreIgnoredAfterwards) {
    for (int round = 0; round < 2; ++round) {
        for (const int signal : {SIGTERM, SIGINT}) std::signal(signal, SIG_DFL);
        std::atomic<int> asked = 0, last = 0;
        {
            const StopSignals signals([&asked, &last](int signal) {
                last = signal;
                ++asked;
            });
            for (const int signal : {SIGTERM, SIGINT, SIGTERM}) {
                const int before = asked;
                std::raise(signal);
                while (asked == before) std::this_thread::yield();
                EXPECT_EQ(last, signal);
            }
            EXPECT_EQ(asked, 3);
        }
        std::raise(SIGTERM);
        std::raise(SIGINT);
        EXPECT_EQ(asked, 3);
    }
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGINT, SIG_DFL);
}

TEST(StopSignals, ASecondIntEndsTheProcess) {
    const pid_t child = ::fork();
    if (child == 0) {
        const StopSignals signals([](int) {});
        std::raise(SIGTERM);
        std::raise(SIGTERM);
        std::raise(SIGINT);
        std::raise(SIGINT);
        ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << status;
    EXPECT_EQ(WTERMSIG(status), SIGINT);
}

TEST(StopSignals, EndsWithoutASignal) {
    int asked = 0;
    {
        const StopSignals signals([&asked](int) { ++asked; });
    }
    EXPECT_EQ(asked, 0);
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGINT, SIG_DFL);
}

}  // namespace

}  // namespace ispace
