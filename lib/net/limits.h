// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>

#include "sim/simulation.h"

namespace ispace {

/// How often something may be asked for: `rate` a second in the long run, `burst` at once.
struct RationLimits {
    double rate = 0;
    double burst = 0;
};

/// Limits that keep one client from harming the others.
struct ServerLimits {
    std::size_t clients = 256;  ///< the next one is answered ERR 429 and closed
    std::size_t line = 4096;    ///< bytes of a request without its end; else ERR 413
    std::size_t pending = std::size_t{1} << 18;  ///< replies in bytes a client may leave unread
                                                 ///< before its requests have to wait
    /// What all clients together may leave unread, in bytes: replies and scans that are no longer
    /// the newest. Beyond it the slowest of those that hold more than an equal share have to go.
    std::size_t unread = std::size_t{1} << 27;
    /// For a connection that is to end to read what it was told.
    std::chrono::nanoseconds patience = std::chrono::seconds(10);
    /// A connection without a role ends this long after its last request (or its begin), and makes
    /// room for a new one as soon as `roleless_grace` after it when all places are taken.
    std::chrono::nanoseconds roleless = std::chrono::seconds(60);
    std::chrono::nanoseconds roleless_grace = std::chrono::seconds(1);
    /// PAUSE, and RESUME where there is nothing to resume: of one client, and of all together.
    RationLimits pauses = {100, 100}, all_pauses = {200, 200};
    /// The same where others have used up what all have: what one client may have all the same.
    RationLimits spare_pauses = {1, 1};
    bool shutdown = true;  ///< clients may end the run
};

/// What is left of something that may be asked for only so often: a bucket of tokens.
class Ration {
  public:
    /// Full. \pre rate > 0, burst >= 1
    explicit Ration(const RationLimits& limits) : limits_(limits), left_(limits.burst) {}
    /// Empty at that time.
    Ration(const RationLimits& limits, WallTime now) : limits_(limits), filled_(now) {}
    /// True if one can be taken now.
    bool has(WallTime now);
    /// \pre has(now)
    void take() { left_ -= 1; }

  private:
    RationLimits limits_;
    double left_ = 0;
    WallTime filled_{};  // when left_ was right
};

}  // namespace ispace
