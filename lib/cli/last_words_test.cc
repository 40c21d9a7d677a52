// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/last_words.h"

#include <gtest/gtest.h>

#include <csignal>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>

namespace ispace {
namespace {

/// Throws where nobody can catch it.
template <typename Error>
void throwInThread(const Error& error) {
    std::thread([&error] { throw error; }).join();
}

TEST(LastWords, SayALineOfAnyLength) {
    testing::internal::CaptureStderr();
    sayLine({"tool", ": ", "error"});
    sayLine({"tool: ", std::string(100000, 'x')});
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(said.starts_with("tool: error\ntool: xxx"));
    EXPECT_TRUE(said.ends_with("x\n"));
}

TEST(LastWordsDeathTest, WhatCannotBeCaughtEndsWithStatusOne) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(throwInThread(std::bad_alloc()), testing::ExitedWithCode(1),
                "cli_test: error: not enough memory for this input\n");
    EXPECT_EXIT(throwInThread(std::length_error("x")), testing::ExitedWithCode(1),
                "cli_test: error: not enough memory for this input\n");
    EXPECT_EXIT(throwInThread(std::runtime_error("pthread_create has failed")),
                testing::ExitedWithCode(1), "cli_test: error: pthread_create has failed\n");
}

TEST(LastWordsDeathTest, MemoryIsSaidToBeOutOnce) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            sayMemoryIsOut("tool");
            throwInThread(std::bad_alloc());
        },
        testing::ExitedWithCode(1), "^tool: error: not enough memory for this input\n$");
}

TEST(LastWordsDeathTest, AMistakeInTheProgramStaysAnAbort) {
    EXPECT_EXIT(std::terminate(), testing::KilledBySignal(SIGABRT), "");
}

}  // namespace
}  // namespace ispace
