// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "extensions/doorcounters/doorcounter.h"

namespace ispace::testing {

/// Adds the kind as the tools do.
inline void addDoorCountersOnce() {
    [[maybe_unused]] static const bool done = [] {
        doorcounters::addDoorCounters();
        return true;
    }();
}

}  // namespace ispace::testing
