// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/run_tool.h"

#include <fcntl.h>
#include <gmp.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/run_files.h"
#include "base/utf8.h"
#include "cli/last_words.h"

namespace ispace {

namespace {

enum Status { kDone = 0, kFailed = 1, kUsage = 2, kUnmet = 3 };

void say(const std::string& tool, const std::string& line) {
    sayLine({tool, ": ", printable(line)});
}

/// "house.glb: error: No such file or directory" from what() = "house.glb: No such file …".
std::string systemErrorText(const std::system_error& error) {
    const std::string message = error.code().message();
    const std::string what = error.what();
    const std::string tail = ": " + message;
    if (what.size() > tail.size() && what.ends_with(tail))
        return what.substr(0, what.size() - tail.size()) + ": error: " + message;
    return "error: " + what;
}

/// A file opened later must not get the number of a standard stream that the parent closed. What
/// stands in for it refuses every read or write, so that a lost product is an error.
void occupyStandardStreams() {
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(fd, F_GETFD) < 0 && errno == EBADF)
            (void)::open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

/// Without this the process ends where a file would grow beyond `ulimit -f`; with it writing fails.
/// A handler, unlike a signal that is ignored, is not passed on to other programs.
void refuseLargeFiles() {
    struct sigaction action = {};
    action.sa_handler = [](int) {};
    ::sigaction(SIGXFSZ, &action, nullptr);
}

void* orThrow(void* memory) {
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

/// Without this GMP (exact geometry) ends the process by an abort where memory is out.
void letNumbersThrow() {
    mp_set_memory_functions(
        [](std::size_t size) { return orThrow(std::malloc(size)); },
        [](void* old, std::size_t, std::size_t size) { return orThrow(std::realloc(old, size)); },
        [](void* memory, std::size_t) { std::free(memory); });
}

/// Says what was thrown. \pre within a handler
Status sayException(const std::string& tool) {
    try {
        throw;
    } catch (const UsageError& error) {
        say(tool, std::string("error: ") + error.what());
        return kUsage;
    } catch (const UnmetError& error) {
        say(tool, std::string("error: ") + error.what());
        return kUnmet;
    } catch (const FormatError& error) {
        for (const Diagnostic& diagnostic : error.diagnostics()) say(tool, diagnostic.text());
    } catch (const std::system_error& error) {
        say(tool, systemErrorText(error));
    } catch (const std::bad_alloc&) {
        sayMemoryIsOut(tool);
    } catch (const std::length_error&) {
        sayMemoryIsOut(tool);
    } catch (const std::exception& error) {
        say(tool, std::string("error: ") + error.what());
    }
    return kFailed;
}

}  // namespace

int runTool(const std::string& tool, const std::function<void()>& body) {
    occupyStandardStreams();
    std::signal(SIGPIPE, SIG_DFL);  // a parent may have it ignored: filters end silently
    std::signal(SIGCHLD, SIG_DFL);  // likewise: how a child ended could not be asked
    refuseLargeFiles();
    letNumbersThrow();
    try {
        try {
            const RunFiles files;
            body();
        } catch (const TextRequested& request) {
            writeAll("-", request.text);
        }
        return kDone;
    } catch (...) {
        try {
            return sayException(tool);
        } catch (const std::exception&) {  // not even memory for a message
            sayMemoryIsOut(tool);
        }
    }
    return kFailed;
}

}  // namespace ispace
