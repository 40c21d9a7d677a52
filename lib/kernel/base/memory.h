// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace ispace {

/// Lets the process reuse freed memory instead of returning it to the system, which would have to
/// clear it anew. For programs that allocate and free a few hundred megabytes.
void keepFreedMemory();
/// Does so if these input files are so large that reading them takes such memory.
void keepFreedMemory(const std::vector<std::string>& inputs);

/// Returns freed memory to the system, for a program that is about to allocate as much in larger
/// pieces.
void returnFreedMemory();

}  // namespace ispace
