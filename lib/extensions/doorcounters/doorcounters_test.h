// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the kind to a program of tests, as the tools do.
#pragma once

#include "extensions/doorcounters/doorcounter.h"

namespace ispace::testing {

/// Call it before the first scene is read.
inline void addDoorCountersOnce() {
    [[maybe_unused]] static const bool done = [] {
        doorcounters::addDoorCounters();
        return true;
    }();
}

}  // namespace ispace::testing
