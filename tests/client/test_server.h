// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <vector>

/// A simrun of a test, on a port that the system gave; ended with the object.
class TestServer {
  public:
    /// \param arguments scene and options
    explicit TestServer(const std::vector<std::string>& arguments) {
        int ends[2];
        if (pipe(ends) != 0) throw std::runtime_error("no pipe");
        std::vector<std::string> words = {ISPACE_SIMRUN_TOOL};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        argv.reserve(words.size() + 1);
        for (std::string& word : words) argv.push_back(&word[0]);
        argv.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
        posix_spawn_file_actions_addclose(&actions, ends[0]);
        const int error = posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        close(ends[1]);
        if (error != 0) throw std::runtime_error("simrun cannot be started");
        // {"schema":"ispace-simrun/1","listen":"127.0.0.1:7001",…
        std::string line;
        for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) line += c;
        close(ends[0]);
        const std::string key = "\"listen\":\"";
        const std::size_t begin = line.find(key);
        if (begin == std::string::npos) {
            end();
            throw std::runtime_error("simrun does not listen: " + line);
        }
        const std::size_t at = begin + key.size();
        address_ = line.substr(at, line.find('"', at) - at);
    }
    ~TestServer() { end(); }
    TestServer(const TestServer&) = delete;
    TestServer& operator=(const TestServer&) = delete;

    [[nodiscard]] const std::string& address() const { return address_; }
    /// Waits for a server that ends by itself. \return its exit status
    int wait() {
        int status = 0;
        waitpid(pid_, &status, 0);
        pid_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

  private:
    void end() {
        if (pid_ == 0) return;
        kill(pid_, SIGTERM);
        wait();
    }

    pid_t pid_ = 0;
    std::string address_;
};
