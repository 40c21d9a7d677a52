// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the kind to a program of tests, as the tools do.
#pragma once

#include "extensions/radars/radar.h"

namespace ispace::testing {

inline const bool kAddedRadars = [] {
    radars::addRadars();
    return true;
}();

}  // namespace ispace::testing
