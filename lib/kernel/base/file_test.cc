// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <thread>
#include <vector>

#include "base/error.h"
#include "support/test_folder.h"

namespace ispace {
namespace file_test {

namespace fs = std::filesystem;

/// A temporary folder for each test.
class FileTest : public ::testing::Test {
  protected:
    [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const auto& entry : fs::directory_iterator(folder_.path()))
            all.push_back(entry.path().filename());
        std::sort(all.begin(), all.end());
        return all;
    }
    static mode_t modeOf(const std::string& file) {
        struct stat info {};
        EXPECT_EQ(::stat(file.c_str(), &info), 0);
        return info.st_mode & 07777;
    }
    testing::TestFolder folder_;
};

/// The error code of what `action` throws; it names `file`.
template <typename Action>
int errorOf(Action action, const std::string& file) {
    try {
        action();
    } catch (const std::system_error& error) {
        EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
        return error.code().value();
    }
    return 0;
}

/// A pipe of which one end does not block.
struct Pipe {
    explicit Pipe(int non_blocking) {
        EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0);
        EXPECT_EQ(::fcntl(ends[non_blocking], F_SETFL, O_NONBLOCK), 0);
    }
    int ends[2] = {-1, -1};
};

/// Restores the standard stream `fd` at the end of the scope.
class Redirected {
  public:
    Redirected(int fd, int to) : fd_(fd), saved_(::dup(fd)) { ::dup2(to, fd); }
    ~Redirected() {
        ::dup2(saved_, fd_);
        ::close(saved_);
    }
    Redirected(const Redirected&) = delete;
    Redirected& operator=(const Redirected&) = delete;

  private:
    int fd_, saved_;
};

TEST_F(FileTest, AFullNonBlockingPipeIsWaitedFor) {
    Pipe pipe(1);
    const std::string bytes(1 << 20, 'x');
    std::thread reader([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        std::string all(bytes.size(), '\0');
        std::size_t size = 0;
        for (ssize_t n = 1; n > 0 && size < all.size(); size += static_cast<std::size_t>(n))
            n = std::max<ssize_t>(::read(pipe.ends[0], all.data() + size, all.size() - size), 0);
        EXPECT_EQ(all, bytes);
    });
    {
        const Redirected out(STDOUT_FILENO, pipe.ends[1]);
        EXPECT_EQ(errorOf([&] { writeAll("-", bytes); }, "stdout"), 0);
    }
    ::close(pipe.ends[1]);
    reader.join();
    ::close(pipe.ends[0]);
}

TEST_F(FileTest, AnEmptyNonBlockingPipeIsWaitedFor) {
    for (const bool whole : {true, false}) {
        Pipe pipe(0);
        std::thread writer([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            EXPECT_EQ(::write(pipe.ends[1], "late", 4), 4);
            ::close(pipe.ends[1]);
        });
        const Redirected in(STDIN_FILENO, pipe.ends[0]);
        std::string bytes;
        EXPECT_EQ(errorOf(
                      [&] {
                          if (whole) {
                              bytes = readAll("-");
                          } else {
                              InputFile file("-");
                              while (file.read(bytes)) continue;
                          }
                      },
                      "stdin"),
                  0);
        EXPECT_EQ(bytes, "late");
        writer.join();
        ::close(pipe.ends[0]);
    }
}

TEST_F(FileTest, LinksInACircleAreAnErrorAndStay) {
    fs::create_symlink("b", path("a"));
    fs::create_symlink("a", path("b"));
    fs::create_symlink("self", path("self"));
    const std::vector<std::string> before = names();
    for (const char* name : {"a", "self"}) {
        EXPECT_EQ(errorOf([&] { writeAll(path(name), "x"); }, path(name)), ELOOP);
        EXPECT_EQ(errorOf([&] { mustBeWritable(path(name)); }, path(name)), ELOOP);
        EXPECT_TRUE(fs::is_symlink(path(name)));
    }
    EXPECT_EQ(names(), before);
}

TEST_F(FileTest, CommitPutsTheFileInItsPlace) {
    OutputFile file(path("a"));
    file.write("one ");
    file.write("");
    file.write("two");
    EXPECT_EQ(names(), std::vector<std::string>{}) << "seen before commit";
    file.commit();
    EXPECT_EQ(names(), std::vector<std::string>{"a"});
    EXPECT_EQ(readAll(path("a")), "one two");
}

TEST_F(FileTest, NewFilesFollowTheUmask) {
    const mode_t before = ::umask(027);
    writeAll(path("a"), "x");
    ::umask(before);
    EXPECT_EQ(modeOf(path("a")), 0640U);
}

TEST_F(FileTest, WithoutCommitTheOldFileStaysAndNothingIsLeft) {
    writeAll(path("a"), "old");
    {
        OutputFile file(path("a"));
        file.write("new");
        EXPECT_EQ(readAll(path("a")), "old");
    }
    { const OutputFile never(path("b")); }
    EXPECT_EQ(readAll(path("a")), "old");
    EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(FileTest, ReplacesAsAWholeAndKeepsTheMode) {
    writeAll(path("a"), "a long old text");
    ASSERT_EQ(::chmod(path("a").c_str(), 0604), 0);
    std::ifstream reader(path("a"));
    writeAll(path("a"), "new");
    EXPECT_EQ(readAll(path("a")), "new");
    EXPECT_EQ(modeOf(path("a")), 0604U);
    std::string seen;
    std::getline(reader, seen);
    EXPECT_EQ(seen, "a long old text") << "who reads the old file goes on reading it";
}

TEST_F(FileTest, LinksStay) {
    fs::create_directory(path("sub"));
    writeAll(path("sub/real"), "old");
    fs::create_symlink("sub/real", path("link"));
    fs::create_symlink(path("link"), path("link2"));
    writeAll(path("link2"), "new");
    EXPECT_TRUE(fs::is_symlink(path("link")));
    EXPECT_TRUE(fs::is_symlink(path("link2")));
    EXPECT_EQ(readAll(path("sub/real")), "new");
}

TEST_F(FileTest, ALinkToNothingGetsItsTarget) {
    fs::create_symlink("later", path("link"));
    writeAll(path("link"), "new");
    EXPECT_TRUE(fs::is_symlink(path("link")));
    EXPECT_EQ(readAll(path("later")), "new");
}

TEST_F(FileTest, AStandInOfAKilledProcessIsNoHindrance) {
    const std::string left = path(".ispace.tmp." + std::to_string(::getpid()) + ".0");
    std::ofstream(left) << "left";
    writeAll(path("a"), "new");
    EXPECT_EQ(readAll(path("a")), "new");
    EXPECT_EQ(readAll(left), "left");
    EXPECT_EQ(names().size(), 2U);
}

TEST_F(FileTest, TakesTheLongestNames) {
    const std::string name(255, 'x');
    writeAll(path(name), "new");
    EXPECT_EQ(readAll(path(name)), "new");
    EXPECT_EQ(errorOf([&] { writeAll(path(name + 'x'), "new"); }, "xxx"), ENAMETOOLONG);
}

TEST_F(FileTest, DevicesAreWrittenDirectly) {
    writeAll("/dev/null", "gone");
    struct stat info {};
    ASSERT_EQ(::stat("/dev/null", &info), 0);
    EXPECT_TRUE(S_ISCHR(info.st_mode));
    EXPECT_EQ(errorOf([] { writeAll("/dev/full", "x"); }, "/dev/full"), ENOSPC);
}

TEST_F(FileTest, RefusesFoldersAndWhatCannotBeMade) {
    const auto write = [&](const std::string& name) {
        return errorOf([&] { const OutputFile file(name); }, name);
    };
    EXPECT_EQ(write(folder_.path().string()), EISDIR);
    EXPECT_EQ(write(folder_.path().string() + '/'), EISDIR);
    EXPECT_EQ(write(path("new/")), EISDIR);
    EXPECT_EQ(write(path("no/such/folder")), ENOENT);
    EXPECT_EQ(write(""), ENOENT);
    writeAll(path("file"), "x");
    EXPECT_EQ(write(path("file/below")), ENOTDIR);
    EXPECT_NE(write("/proc/ispace"), 0);
    EXPECT_EQ(names(), std::vector<std::string>{"file"});
}

TEST_F(FileTest, RefusesWhatMayNotBeWritten) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may write everything";
    writeAll(path("a"), "old");
    ASSERT_EQ(::chmod(path("a").c_str(), 0444), 0);
    EXPECT_EQ(errorOf([&] { const OutputFile file(path("a")); }, path("a")), EACCES);
    ASSERT_EQ(::chmod(folder_.path().c_str(), 0555), 0);
    EXPECT_EQ(errorOf([&] { const OutputFile file(path("b")); }, path("b")), EACCES);
}

TEST_F(FileTest, ReadsEverything) {
    std::string bytes(300000, 'x');
    bytes[7] = '\0';
    bytes[8] = '\n';
    writeAll(path("a"), bytes);
    EXPECT_EQ(readAll(path("a")), bytes);
    writeAll(path("empty"), "");
    EXPECT_EQ(readAll(path("empty")), "");
    EXPECT_NE(readAll("/proc/self/status").find("Name:"), std::string::npos);
    EXPECT_EQ(errorOf([&] { (void)readAll(path("none")); }, path("none")), ENOENT);
    EXPECT_EQ(errorOf([&] { (void)readAll(folder_.path()); }, folder_.path()), EISDIR);
}

TEST_F(FileTest, FilesThatBelongTogetherAreAllNewOrAllOld) {
    writeAll(path("a"), "old a");
    for (const bool fails : {true, false}) {
        OutputFile a(path("a")), fresh(path("fresh")), last(path("last"));
        a.write("new a");
        fresh.write("new");
        last.write("new");
        if (fails) fs::create_directories(path("last/full"));
        OutputFile* const files[] = {&a, &fresh, &last};
        const auto commit = [&] { OutputFile::commitTogether(files); };
        EXPECT_EQ(errorOf(commit, path("last")), fails ? EISDIR : 0);
        EXPECT_EQ(readAll(path("a")), fails ? "old a" : "new a");
        EXPECT_EQ(names(), fails ? (std::vector<std::string>{"a", "last"})
                                 : (std::vector<std::string>{"a", "fresh", "last"}));
        if (fails) fs::remove_all(path("last"));
    }
}

TEST_F(FileTest, ASetOnDevicesIsWrittenToThem) {
    writeTogether(std::vector<NamedBytes>{{"/dev/null", "gone"}, {path("a"), "new"}});
    EXPECT_EQ(readAll(path("a")), "new");
    EXPECT_EQ(
        errorOf(
            [&] {
                writeTogether(std::vector<NamedBytes>{{path("a"), "newer"}, {"/dev/full", "x"}});
            },
            "/dev/full"),
        ENOSPC);
    EXPECT_EQ(readAll(path("a")), "new");
}

/// TERM at any moment of a process that writes again and again.
TEST_F(FileTest, ASignalLeavesNothingBehind) {
    const std::string a(5000, 'a'), b(5000, 'b');
    writeAll(path("one"), a);
    writeAll(path("two"), a);
    constexpr int kSignals[] = {SIGTERM, SIGINT, SIGHUP};
    for (int i = 0; i < 300; ++i) {
        const pid_t child = ::fork();
        if (child == 0) {
            for (const int signal : kSignals) std::signal(signal, SIG_DFL);
            while (true)
                for (const std::string& text : {b, a})
                    writeTogether(
                        std::vector<NamedBytes>{{path("one"), text}, {path("two"), text}});
        }
        ::usleep(static_cast<useconds_t>(2000 + 37 * (i % 50)));
        ASSERT_EQ(::kill(child, kSignals[i % 3]), 0);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFSIGNALED(status));
        ASSERT_EQ(names(), (std::vector<std::string>{"one", "two"})) << "after " << i;
        ASSERT_EQ(readAll(path("one")), readAll(path("two"))) << "one old, one new";
    }
}

TEST_F(FileTest, WhetherAFileCanBeMadeIsToldEarly) {
    const testing::TestFolder temporary;
    const std::string folder = temporary.file("");
    mustBeWritable("-");
    mustBeWritable("");
    mustBeWritable("/dev/null");
    const std::string file = folder + "must_be_writable.txt";
    mustBeWritable(file);
    EXPECT_FALSE(std::filesystem::exists(file)) << "nothing is left behind";
    writeAll(file, "old");
    mustBeWritable(file);
    EXPECT_EQ(readAll(file), "old");
    EXPECT_THROW(mustBeWritable(folder + "missing/folder/out"), std::system_error);
    EXPECT_THROW(mustBeWritable(folder), std::system_error);
}

/// Returns the message of readAll for a file; "" if it is read.
std::string refusalOf(const std::string& file) {
    try {
        readAll(file);
    } catch (const FormatError& error) {
        return error.what();
    }
    return "";
}

TEST_F(FileTest, InputsHaveABound) {
    // A sparse file: refused by its size, not read.
    writeAll(path("huge"), "x");
    ASSERT_EQ(::truncate(path("huge").c_str(), 6'000'000'000), 0);
    EXPECT_NE(refusalOf(path("huge")).find("more than 4294967296 bytes"), std::string::npos);
    ASSERT_EQ(::truncate(path("huge").c_str(), 100'000), 0);
    EXPECT_EQ(readAll(path("huge")).size(), 100'000U) << "zeros in a file may mean something";
}

TEST_F(FileTest, EndlessStreamsEnd) {
    EXPECT_NE(refusalOf("/dev/zero").find("64 KiB of zeros"), std::string::npos);
    EXPECT_EQ(readAll("/dev/null"), "");
    // A pipe that never ends and does not begin with zeros.
    const std::string pipe = path("pipe");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::thread writer([&pipe] {
        std::signal(SIGPIPE, SIG_IGN);
        const std::string text(1 << 20, 'x');
        const int fd = ::open(pipe.c_str(), O_WRONLY | O_CLOEXEC);
        while (::write(fd, text.data(), text.size()) > 0) continue;
        ::close(fd);
    });
    const std::string refusal = refusalOf(pipe);
    writer.join();
    EXPECT_NE(refusal.find("more than 1073741824 bytes"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("a file may have 4294967296"), std::string::npos) << refusal;
}

}  // namespace file_test
}  // namespace ispace
