// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of lib/extensions/locks.
#pragma once

#include "extensions/locks/lock.h"

namespace ispace::testing {

/// Adds the extension to the program of the tests, once, before schemas are asked for.
inline void addLocksOnce() {
    [[maybe_unused]] static const bool is_added = [] {
        locks::addLocks();
        return true;
    }();
}

}  // namespace ispace::testing
