// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/world.h"

namespace ispace {

/// Says which robots start as written as their start_noise leads nowhere free.
/// \param id of one of them; "" for all
std::vector<std::string> startWarnings(const World& world, std::string_view id = "");

}  // namespace ispace
