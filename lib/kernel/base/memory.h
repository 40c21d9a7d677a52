// SPDX-License-Identifier: GPL-3.0-or-later
// Hints to the allocator of glibc, for whole programs; elsewhere they have no effect. Call them
// before threads start.
#pragma once

#include <string>
#include <vector>

namespace ispace {

/// Lets the process reuse freed memory instead of returning it to the system, which would have to
/// clear it anew. For programs that allocate and free a few hundred megabytes. Takes 64 MB more at
/// a time.
void keepFreedMemory();
/// Does so if these input files have 256 kB or more in all; those that cannot be asked for their
/// size count as empty.
void keepFreedMemory(const std::vector<std::string>& inputs);

/// Returns freed memory to the system, for a program that is about to allocate as much in larger
/// pieces.
void returnFreedMemory();

}  // namespace ispace
