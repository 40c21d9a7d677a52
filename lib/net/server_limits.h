// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>

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

}  // namespace ispace
