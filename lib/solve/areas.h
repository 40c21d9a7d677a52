// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <vector>

#include "solve/problem.h"

namespace ispace {

/// Areas of the floor, by kind and candidate: which sensor of a good solution sees most of the
/// same, the first among equals.
using Areas = std::vector<std::vector<std::uint32_t>>;

/// \param near the good solution
/// \param multipliers of the cells, by which views are weighed
/// O(sensors * runs)
Areas areasAbout(const Problem& problem, const std::vector<Choice>& near,
                 const std::vector<std::uint32_t>& multipliers);

}  // namespace ispace
