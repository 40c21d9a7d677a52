// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/run_tool.h"

#include <fcntl.h>
#include <gmp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/run_files.h"

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

constexpr std::string_view kNoMemory = "error: not enough memory for this input";

/// Says what was thrown. \pre within a handler
int sayException(const std::string& tool) {
    try {
        throw;
    } catch (const std::bad_alloc&) {
        sayMemoryIsOut(tool);
    } catch (const std::length_error&) {
        sayMemoryIsOut(tool);
    } catch (...) {
        const ToolFailure failure = currentFailure();
        for (const std::string& line : failure.lines) say(tool, line);
        return failure.status;
    }
    return kFailed;
}

}  // namespace

ToolFailure currentFailure() {
    try {
        throw;
    } catch (const UsageError& error) {
        return {kUsage, {std::string("error: ") + error.what()}};
    } catch (const UnmetError& error) {
        return {kUnmet, {std::string("error: ") + error.what()}};
    } catch (const FormatError& error) {
        ToolFailure failure{kFailed};
        for (const Diagnostic& diagnostic : error.diagnostics())
            failure.lines.push_back(diagnostic.text());
        return failure;
    } catch (const std::system_error& error) {
        return {kFailed, {systemErrorText(error)}};
    } catch (const std::bad_alloc&) {
        return {kFailed, {std::string(kNoMemory)}};
    } catch (const std::length_error&) {
        return {kFailed, {std::string(kNoMemory)}};
    } catch (const std::exception& error) {
        return {kFailed, {std::string("error: ") + error.what()}};
    }
}

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

namespace {

/// The first part of `text` that is fit for one line.
std::string_view firstLine(std::string_view text) { return text.substr(0, text.find('\n')); }

/// True where hardly any memory can be allocated.
bool isMemoryOut() {
    constexpr std::size_t kSome = std::size_t{1} << 20U;
    void* const some = std::malloc(kSome);
    std::free(some);
    return some == nullptr;
}

/// Says why, and leaves; returns where there is no reason but a mistake in the program.
void sayWhy(std::string_view tool) {
    if (std::current_exception()) {
        try {
            throw;
        } catch (const std::bad_alloc&) {
            return sayMemoryIsOut(tool);
        } catch (const std::length_error&) {
            return sayMemoryIsOut(tool);
        } catch (const std::exception& error) {
            return sayLine({tool, ": error: ", firstLine(error.what())});
        } catch (...) {
            std::abort();
        }
    }
    // The runtime had no memory to throw with, or nobody threw anything.
    if (!isMemoryOut()) std::abort();
    sayMemoryIsOut(tool);
}

[[noreturn]] void onTerminate() {
    static std::atomic_flag is_told = ATOMIC_FLAG_INIT;
    if (is_told.test_and_set())
        while (true) ::pause();  // another thread is about to end the process
    sayWhy(::program_invocation_short_name);
    ::_exit(EXIT_FAILURE);
}

/// Of a program, and so run before what libraries do at their start.
using AtStart = void (*)(int, char**, char**);
[[gnu::used, gnu::section(".preinit_array")]] const AtStart kAtStart = [](int, char**, char**) {
    std::set_terminate(onTerminate);
};

}  // namespace

void sayLine(std::initializer_list<std::string_view> pieces) noexcept {
    std::array<char, 4096> line;
    std::size_t size = 0;
    for (const std::string_view piece : pieces)
        size += piece.copy(line.data() + size, line.size() - 1 - size);
    line[size++] = '\n';
    const char* rest = line.data();
    while (size > 0) {
        const ssize_t n = ::write(STDERR_FILENO, rest, size);
        if (n >= 0) {
            rest += n;
            size -= static_cast<std::size_t>(n);
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            pollfd ready{STDERR_FILENO, POLLOUT, 0};
            static_cast<void>(::poll(&ready, 1, -1));
        } else if (errno != EINTR) {
            return;
        }
    }
}

void sayMemoryIsOut(std::string_view tool) noexcept {
    static std::atomic_flag is_told = ATOMIC_FLAG_INIT;
    if (!is_told.test_and_set()) sayLine({tool, ": ", kNoMemory});
}

namespace {

constexpr int kSignals[] = {SIGTERM, SIGINT};
/// What the handler tells; it reaches nothing but what is global.
std::atomic<int> last_signal = 0;
std::atomic<int> event = -1;
static_assert(std::atomic<int>::is_always_lock_free);

void handle(int signal, void (*handler)(int)) {
    struct sigaction action = {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    ::sigaction(signal, &action, nullptr);
}

void onSignal(int signal) {
    const int error = errno;
    last_signal = signal;
    static_cast<void>(!::eventfd_write(event, 1));
    // A person who presses the keys again does not want to wait.
    if (signal == SIGINT) handle(signal, SIG_DFL);
    errno = error;
}

}  // namespace

StopSignals::StopSignals() : descriptor_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
    last_signal = 0;
    event = descriptor_;
    // Also where they were ignored, as shells do for INT in the background: what is asked of this
    // process is meant.
    for (const int signal : kSignals) handle(signal, onSignal);
}

StopSignals::~StopSignals() {
    for (const int signal : kSignals) handle(signal, SIG_IGN);
    event = -1;
    ::close(descriptor_);
}

int StopSignals::signal() const { return last_signal; }

}  // namespace ispace
