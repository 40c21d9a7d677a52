// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/held_signals.h"

#include <unistd.h>

#include <atomic>

namespace ispace {

namespace {

std::mutex guard;

/// How often each has come; a handler reaches nothing but what is global.
std::atomic<int> came[NSIG];
static_assert(std::atomic<int>::is_always_lock_free);

void note(int signal) { ++came[signal]; }

bool isIgnored(const struct sigaction& action) {
    return (action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

HeldSignals::HeldSignals() : one_at_a_time_(guard) {
    // To block them would hold them up in one thread only; the others would take them.
    struct sigaction noting = {};
    noting.sa_handler = note;
    noting.sa_flags = SA_RESTART;
    for (std::size_t i = 0; i < std::size(kSignals); ++i) {
        ::sigaction(kSignals[i], nullptr, &before_[i]);
        if (!isIgnored(before_[i])) ::sigaction(kSignals[i], &noting, &before_[i]);
    }
}

HeldSignals::~HeldSignals() {
    for (std::size_t i = 0; i < std::size(kSignals); ++i)
        if (!isIgnored(before_[i])) ::sigaction(kSignals[i], &before_[i], nullptr);
    for (const int signal : kSignals)
        for (int times = came[signal].exchange(0); times > 0; --times) ::kill(::getpid(), signal);
}

}  // namespace ispace
