// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the kind to a program of tests, as the tools do.
#pragma once

#include "extensions/thermometers/thermometer.h"

namespace ispace::testing {

inline const bool kAddedThermometers = [] {
    thermometers::addThermometers();
    return true;
}();

}  // namespace ispace::testing
