// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include "env/environment.h"

namespace ispace {

/// Open doors that lead out of the room into a wall close behind, as between two rooms whose walls
/// stand apart: what to say of them, by the index of their element. O(doors x walls).
std::map<std::size_t, std::string> blockedDoors(const Environment& environment);

}  // namespace ispace
