// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the kind to a program of tests, as the tools do.
#pragma once

#include "extensions/luxes/luxes_test.h"
#include "extensions/motes/mote.h"

namespace ispace::testing {

inline const bool kAddedMotes = [] {
    motes::addMotes();
    return true;
}();

}  // namespace ispace::testing
