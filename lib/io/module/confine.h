// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "io/mesh_parts.h"

namespace ispace {

/// Takes from this process what a reader of strangers' bytes does not need: memory and time beyond
/// the limits, files (those that are open stay), programs, the network, a core, and its life when
/// the parent ends. Where the system has no seccomp, or refuses it, the limits hold all the same.
/// Under sanitizers, which need more, only time is limited.
void confine(const MeshLimits& limits, int parent);

}  // namespace ispace
