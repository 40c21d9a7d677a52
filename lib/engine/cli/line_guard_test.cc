// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/run_tool.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "base/file.h"
#include "support/test_folder.h"

namespace ispace {

namespace line_guard_test {

namespace fs = std::filesystem;

class LineGuardTest : public ::testing::Test {
  protected:
    [[nodiscard]] std::string file(const std::string& name) const { return folder_.file(name); }
    testing::TestFolder folder_;
};

TEST_F(LineGuardTest, CutsATornLineAtTheEnd) {
    const std::string long_line(10000, 'x');
    writeAll(file("torn"), "one\ntwo\nthr");
    writeAll(file("whole"), "one\ntwo\n");
    writeAll(file("long"), "one\n" + long_line);
    writeAll(file("page"), std::string(4095, 'y') + "\nz");
    writeAll(file("only"), long_line);
    writeAll(file("empty"), "");
    {
        const LineGuard guard({file("torn"), file("whole"), file("long"), file("page"),
                               file("only"), file("empty"), file("missing"), "/dev/null"});
        EXPECT_EQ(readAll(file("torn")), "one\ntwo\nthr");
    }
    EXPECT_EQ(readAll(file("torn")), "one\ntwo\n");
    EXPECT_EQ(readAll(file("whole")), "one\ntwo\n");
    EXPECT_EQ(readAll(file("long")), "one\n");
    EXPECT_EQ(readAll(file("page")), std::string(4095, 'y') + "\n");
    EXPECT_EQ(readAll(file("only")), "");
    EXPECT_EQ(readAll(file("empty")), "");
    EXPECT_FALSE(fs::exists(file("missing")));
}

TEST_F(LineGuardTest, CutsNothingBehindALink) {
    writeAll(file("other"), "one\ntw");
    fs::create_symlink(file("other"), file("link"));
    { const LineGuard guard({file("link")}); }
    EXPECT_EQ(readAll(file("other")), "one\ntw");
}

TEST_F(LineGuardTest, HoldsNothingElseOpen) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    writeAll(file("lines"), "one\n");
    const LineGuard guard({file("lines")});
    ::close(ends[1]);
    char nothing = 0;
    EXPECT_EQ(::read(ends[0], &nothing, 1), 0);  // the guard would keep the pipe from ending
    ::close(ends[0]);
}

TEST_F(LineGuardTest, OutlivesAKilledProcess) {
    writeAll(file("lines"), "one\ntw");
    const pid_t child = ::fork();
    if (child == 0) {
        const LineGuard guard({file("lines")});
        ::kill(::getpid(), SIGKILL);
        ::_exit(1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (readAll(file("lines")) != "one\n") {
        ASSERT_LT(std::chrono::steady_clock::now(), deadline);
        std::this_thread::yield();
    }
}

}  // namespace line_guard_test

}  // namespace ispace
