// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of lib/extensions/ifc.
#pragma once

#include "extensions/ifc/ifc.h"

namespace ispace::testing {

/// Adds the extension to the program of the tests, once.
inline void addIfcOnce() {
    [[maybe_unused]] static const bool is_added = [] {
        ifc::addIfc();
        return true;
    }();
}

}  // namespace ispace::testing
