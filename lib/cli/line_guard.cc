// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/line_guard.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>

namespace ispace {

namespace {

[[noreturn]] void fail(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
}

/// Descriptors of those files that are regular ones, for reading and cutting.
std::vector<int> openRegular(const std::vector<std::string>& files) {
    std::vector<int> open;
    open.reserve(files.size());
    for (const std::string& file : files) {
        // Where a link was put meanwhile is another file.
        const int fd = ::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
        struct stat info = {};
        if (fd >= 0 && ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode))
            open.push_back(fd);
        else if (fd >= 0)
            ::close(fd);
    }
    return open;
}

// Below here runs in a copy of a process that has threads: system calls only, no memory.

/// The number of bytes up to the last newline, that included.
off_t wholeLines(int fd, off_t size) {
    std::array<char, 4096> block;
    while (size > 0) {
        const off_t begin =
            (size - 1) / static_cast<off_t>(block.size()) * static_cast<off_t>(block.size());
        const ssize_t count =
            ::pread(fd, block.data(), static_cast<std::size_t>(size - begin), begin);
        if (count < 0 && errno == EINTR) continue;
        if (count != size - begin) return -1;
        for (; size > begin; --size)
            if (block[static_cast<std::size_t>(size - begin - 1)] == '\n') return size;
    }
    return 0;
}

void cutTornLine(int fd) {
    const off_t size = ::lseek(fd, 0, SEEK_END);
    const off_t whole = wholeLines(fd, size);
    if (whole >= 0 && whole < size) static_cast<void>(!::ftruncate(fd, whole));
}

/// Closes all but `kept`, which ascend: what the other process serves must end with it, and whoever
/// reads what it says must not wait for this one.
void closeOthers(const std::vector<int>& kept) {
    unsigned int first = 0;
    for (const int fd : kept) {
        const auto next = static_cast<unsigned int>(fd);
        if (next > first) ::close_range(first, next - 1, 0);
        first = next + 1;
    }
    ::close_range(first, ~0U, 0);
}

[[noreturn]] void guard(int life, const std::vector<int>& files, const std::vector<int>& kept) {
    ::setsid();
    // Not to be taken for the process it guards by who kills by name.
    ::prctl(PR_SET_NAME, "line-guard");
    closeOthers(kept);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGPIPE}) ::signal(signal, SIG_IGN);
    char nothing = 0;
    while (::read(life, &nothing, 1) < 0 && errno == EINTR) continue;
    for (const int fd : files) cutTornLine(fd);
    ::_exit(0);
}

}  // namespace

LineGuard::LineGuard(const std::vector<std::string>& files, int lock) {
    const std::vector<int> open = openRegular(files);
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) fail("pipe to the guard of the records");
    std::vector<int> kept = open;
    kept.push_back(ends[0]);
    if (lock >= 0) kept.push_back(lock);
    std::sort(kept.begin(), kept.end());
    guard_ = ::fork();
    if (guard_ == 0) guard(ends[0], open, kept);
    const int error = errno;
    ::close(ends[0]);
    for (const int fd : open) ::close(fd);
    life_ = ends[1];
    if (guard_ < 0) {
        ::close(life_);
        errno = error;
        fail("guard of the records");
    }
}

LineGuard::~LineGuard() {
    ::close(life_);
    while (::waitpid(guard_, nullptr, 0) < 0 && errno == EINTR) continue;
}

}  // namespace ispace
