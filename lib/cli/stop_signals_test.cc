// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/stop_signals.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace ispace {

namespace {

bool isReadable(int fd) {
    pollfd ready{fd, POLLIN, 0};
    return ::poll(&ready, 1, 0) == 1;
}

TEST(StopSignals, AskToEndAndAreIgnoredAfterwards) {
    for (int round = 0; round < 2; ++round) {
        for (const int signal : {SIGTERM, SIGINT}) std::signal(signal, SIG_DFL);
        {
            const StopSignals signals;
            EXPECT_EQ(signals.signal(), 0);
            EXPECT_FALSE(isReadable(signals.descriptor()));
            for (const int signal : {SIGTERM, SIGINT, SIGTERM}) {
                std::raise(signal);
                EXPECT_EQ(signals.signal(), signal);
                EXPECT_TRUE(isReadable(signals.descriptor()));
            }
        }
        std::raise(SIGTERM);
        std::raise(SIGINT);
    }
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGINT, SIG_DFL);
}

TEST(StopSignals, ASecondIntEndsTheProcess) {
    const pid_t child = ::fork();
    if (child == 0) {
        const StopSignals signals;
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

}  // namespace

}  // namespace ispace
