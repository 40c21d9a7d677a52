// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/last_words.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>

namespace ispace {

namespace {

constexpr std::string_view kNoMemory = ": error: not enough memory for this input";

/// The first part of `text` that is fit for one line.
std::string_view firstLine(std::string_view text) { return text.substr(0, text.find('\n')); }

/// True where no piece of memory worth mentioning is to be had.
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
    if (!is_told.test_and_set()) sayLine({tool, kNoMemory});
}

}  // namespace ispace
