// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <csignal>
#include <mutex>

namespace ispace {

/// TERM, INT and HUP wait while it lives, whichever thread they reach, and arrive at its end: for
/// the few system calls between which a process must not end. Handlers get what was meant for
/// them; signals that are ignored stay ignored. Those who want it at the same time wait for each
/// other.
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
