// SPDX-License-Identifier: GPL-3.0-or-later
// spent WORDS…: runs a program and writes its use to file descriptor 3: seconds, seconds of
// processor time, maximum kilobytes of memory. A separate process, because a program's maximum
// includes the memory of the process that started it.
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

namespace {

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

int main(int argc, char** argv) {
    constexpr int kReport = 3;
    if (argc < 2) return 2;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addclose(&actions, kReport);
    const auto start = std::chrono::steady_clock::now();
    pid_t child = 0;
    if (posix_spawn(&child, argv[1], &actions, nullptr, argv + 1, environ) != 0) return 2;
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    rusage usage{};
    if (wait4(child, &status, 0, &usage) != child || status != 0) return 1;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    return dprintf(kReport, "%.9f %.6f %ld\n", wall.count(),
                   seconds(usage.ru_utime) + seconds(usage.ru_stime), usage.ru_maxrss) < 0;
}
