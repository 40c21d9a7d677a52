// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of lib/extensions/meshes, and of those that need it.
#pragma once

#include "extensions/meshes/meshes.h"

namespace ispace::testing {

/// Adds the extension to the program of the tests, once.
inline void addMeshesOnce() {
    [[maybe_unused]] static const bool is_added = [] {
        meshes::addMeshes();
        return true;
    }();
}

}  // namespace ispace::testing
