// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/stop_signals.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

namespace ispace {

namespace {

constexpr int kSignals[] = {SIGTERM, SIGINT};
constexpr char kQuit = 0;  ///< no signal has this number
/// Where the handler tells the listener; a handler reaches nothing but what is global.
std::atomic<int> write_end = -1;
static_assert(std::atomic<int>::is_always_lock_free);

void tell(char word) {
    // It does not wait: a full pipe holds enough words already.
    static_cast<void>(!::write(write_end, &word, 1));
}

void handle(int signal, void (*handler)(int)) {
    struct sigaction action = {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    ::sigaction(signal, &action, nullptr);
}

void onSignal(int signal) {
    const int error = errno;
    tell(static_cast<char>(signal));
    // A person who presses the keys again does not want to wait.
    if (signal == SIGINT) handle(signal, SIG_DFL);
    errno = error;
}

char nextWord(int fd) {
    char word = kQuit;
    while (::read(fd, &word, 1) < 0 && errno == EINTR) continue;
    return word;
}

}  // namespace

StopSignals::StopSignals(std::function<void(int)> stop) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe for signals");
    read_end_ = ends[0];
    write_end = ends[1];
    ::fcntl(write_end, F_SETFL, O_NONBLOCK);
    listener_ = std::thread([fd = read_end_, stop = std::move(stop)] {
        for (char signal = nextWord(fd); signal != kQuit; signal = nextWord(fd)) stop(signal);
    });
    // Also where they were ignored, as shells do for INT in the background: what is asked of this
    // process is meant.
    for (const int signal : kSignals) handle(signal, onSignal);
}

StopSignals::~StopSignals() {
    for (const int signal : kSignals) handle(signal, SIG_IGN);
    // Waits, unlike a handler: without this word the listener would not end.
    ::fcntl(write_end, F_SETFL, 0);
    tell(kQuit);
    listener_.join();
    ::close(write_end.exchange(-1));
    ::close(read_end_);
}

}  // namespace ispace
