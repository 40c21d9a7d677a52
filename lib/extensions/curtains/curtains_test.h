// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of lib/extensions/curtains.
#pragma once

#include "extensions/curtains/curtain.h"
#include "scene/placement_schemas.h"

namespace ispace::testing {

/// Adds the extension to the program of the tests, once, before schemas are asked for.
inline void addCurtainsOnce() {
    [[maybe_unused]] static const bool is_added = [] {
        addSceneSchemas(curtains::curtainSchemas());
        curtains::addCurtains();
        return true;
    }();
}

}  // namespace ispace::testing
