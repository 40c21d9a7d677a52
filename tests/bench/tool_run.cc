// SPDX-License-Identifier: GPL-3.0-or-later
#include "tool_run.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace ispace::bench {

void Spent::keepQuicker(const Spent& other) {
    wall = std::min(wall, other.wall);
    processor = std::min(processor, other.processor);
    memory = std::min(memory, other.memory);
}

Spent runTool(std::vector<std::string> words, const std::string& output) {
    const std::string tool = words.front();
    words.insert(words.begin(), ISPACE_SPENT);
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    int report[2];
    if (::pipe2(report, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    constexpr int kReport = 3;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, report[1], kReport);
    pid_t child = 0;
    const int error =
        posix_spawn(&child, words.front().c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(report[1]);
    std::FILE* in = ::fdopen(report[0], "r");
    Spent spent;
    double kilobytes = 0;
    const int read = std::fscanf(in, "%lf %lf %lf", &spent.wall, &spent.processor, &kilobytes);
    std::fclose(in);
    int status = 0;
    if (error != 0 || waitpid(child, &status, 0) != child || status != 0 || read != 3)
        throw std::runtime_error(tool + " failed");
    spent.memory = kilobytes * 1024e-6;
    return spent;
}

}  // namespace ispace::bench
