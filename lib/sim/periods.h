// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "sim/sim_time.h"

namespace ispace {

/// When the periods of a sensor begin: period k at k / rate seconds, in exact arithmetic. A rate
/// with up to nine decimals counts as written, any other as the double it is.
class Periods {
  public:
    /// \pre rate > 0
    explicit Periods(double rate);
    /// The latest period that has begun.
    [[nodiscard]] std::int64_t newest(SimTime time) const;
    /// The first nanosecond of period k; a time beyond any run if that is after a hundred years.
    [[nodiscard]] SimTime begin(std::int64_t k) const;

  private:
    // Periods a nanosecond, as a fraction; a numerator of 0: never again.
    __int128 numerator_ = 0, denominator_ = 1;
};

}  // namespace ispace
