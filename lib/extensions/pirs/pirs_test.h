// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the kind to a program of tests, as the tools do.
#pragma once

#include "extensions/pirs/pir.h"

namespace ispace::testing {

inline const bool kAddedPirs = [] {
    pirs::addPirs();
    return true;
}();

}  // namespace ispace::testing
