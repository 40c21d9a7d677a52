// SPDX-License-Identifier: GPL-3.0-or-later
// A budget for tests that are not about work.
#pragma once

#include <cstdint>
#include <limits>

#include "base/budget.h"

namespace ispace {

/// Returns a budget that no test uses up.
inline Budget& ampleWork() {
    thread_local Budget work(0, {std::numeric_limits<std::uint64_t>::max()});
    return work;
}

}  // namespace ispace
