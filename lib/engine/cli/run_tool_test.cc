// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/run_tool.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace ispace {

namespace run_tool_test {

/// Throws outside of any handler.
template <typename Error>
void throwInThread(const Error& error) {
    std::thread([&error] { throw error; }).join();
}

TEST(LastWords, SayALineOfAnyLength) {
    ::testing::internal::CaptureStderr();
    writeErrorLine({"tool", ": ", "error"});
    writeErrorLine({"tool: ", std::string(100000, 'x')});
    const std::string said = ::testing::internal::GetCapturedStderr();
    EXPECT_EQ(said, "tool: error\ntool: " + std::string(100000, 'x') + "\n");
}

TEST(LastWordsDeathTest, WhatCannotBeCaughtEndsWithStatusOne) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(throwInThread(std::bad_alloc()), ::testing::ExitedWithCode(1),
                "cli_test: error: not enough memory for this input\n");
    EXPECT_EXIT(throwInThread(std::length_error("x")), ::testing::ExitedWithCode(1),
                "cli_test: error: not enough memory for this input\n");
    EXPECT_EXIT(throwInThread(std::runtime_error("pthread_create has failed")),
                ::testing::ExitedWithCode(1), "cli_test: error: pthread_create has failed\n");
}

TEST(LastWordsDeathTest, MemoryIsSaidToBeOutOnce) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            sayMemoryIsOut("tool");
            throwInThread(std::bad_alloc());
        },
        ::testing::ExitedWithCode(1), "^tool: error: not enough memory for this input\n$");
}

TEST(LastWordsDeathTest, AMistakeInTheProgramStaysAnAbort) {
    EXPECT_EXIT(std::terminate(), ::testing::KilledBySignal(SIGABRT), "");
}

TEST(Failure, NamesTheFileOfTheFilesystem) {
    try {
        throw std::filesystem::filesystem_error("status", "dark/room.env",
                                                std::make_error_code(std::errc::permission_denied));
    } catch (const std::exception&) {
        EXPECT_EQ(currentFailure().lines(),
                  std::vector<std::string>{"dark/room.env: error: Permission denied"});
    }
}

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

}  // namespace run_tool_test

}  // namespace ispace
