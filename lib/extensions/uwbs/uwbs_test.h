// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the kind to a program of tests, as the tools do.
#pragma once

#include "extensions/uwbs/uwb.h"

namespace ispace::testing {

inline const bool kAddedUwbs = [] {
    uwbs::addUwbs();
    return true;
}();

}  // namespace ispace::testing
