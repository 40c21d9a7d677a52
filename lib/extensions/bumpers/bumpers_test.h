// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of lib/extensions/bumpers.
#pragma once

#include "extensions/bumpers/bumper.h"
#include "scene/placement_schemas.h"

namespace ispace::testing {

/// Adds the extension to the program of the tests, once, before schemas are asked for.
inline void addBumpersOnce() {
    [[maybe_unused]] static const bool is_added = [] {
        addSceneSchemas(bumpers::bumperSchemas());
        bumpers::addBumpers();
        return true;
    }();
}

}  // namespace ispace::testing
