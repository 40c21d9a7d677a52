// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>

#include "net/server_limits.h"
#include "sim/simulation.h"

namespace ispace {

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
