// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of lib/extensions/postures.
#pragma once

#include "extensions/postures/posture.h"

namespace ispace::testing {

/// Adds the extension to the program of the tests, once, before schemas are asked for.
inline void addPosturesOnce() {
    [[maybe_unused]] static const bool is_added = [] {
        postures::addPostures();
        return true;
    }();
}

}  // namespace ispace::testing
