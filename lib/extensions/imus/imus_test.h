// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the kind to a program of tests, as the tools do.
#pragma once

#include "extensions/imus/imu.h"

namespace ispace::testing {

inline const bool kAddedImus = [] {
    imus::addImus();
    return true;
}();

}  // namespace ispace::testing
