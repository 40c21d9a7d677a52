// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of lib/extensions/heads.
#pragma once

#include "extensions/heads/head.h"
#include "scene/placement_schemas.h"

namespace ispace::testing {

/// Adds the extension to the program of the tests, once, before schemas are asked for.
inline void addHeadsOnce() {
    [[maybe_unused]] static const bool is_added = [] {
        addSceneSchemas(heads::headSchemas());
        heads::addHeads();
        return true;
    }();
}

}  // namespace ispace::testing
