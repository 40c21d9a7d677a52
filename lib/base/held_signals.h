// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <csignal>
#include <mutex>

namespace ispace {

/// Delays TERM, INT and HUP, whichever thread they reach, until its end: for the few system calls
/// between which a process must not end. Handlers then get their signals; ignored signals stay
/// ignored. One lives at a time; others wait.
class HeldSignals {
  public:
    HeldSignals();
    ~HeldSignals();
    HeldSignals(const HeldSignals&) = delete;
    HeldSignals& operator=(const HeldSignals&) = delete;

  private:
    static constexpr int kSignals[] = {SIGTERM, SIGINT, SIGHUP};

    std::lock_guard<std::mutex> one_at_a_time_;
    struct sigaction before_[std::size(kSignals)] = {};
};

}  // namespace ispace
