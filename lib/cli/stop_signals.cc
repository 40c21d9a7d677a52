// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/stop_signals.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <system_error>

namespace ispace {

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
