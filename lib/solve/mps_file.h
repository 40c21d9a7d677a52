// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "solve/problem.h"

namespace ispace {

/// Writes the problem as a maximum-coverage model in free MPS, for any solver of mixed-integer
/// programs (glpsol, cbc, HiGHS, SCIP): maximise the weights of covered cells. Columns x_KIND_INDEX
/// (binary, 1: a sensor of that kind stands on that candidate) and y_CELL (at most 1); rows
/// cell_CELL (y <= what sees it; binary if more than 1 is required), most_KIND and budget. As MPS
/// knows only minimising everywhere, the objective is minus the value gained; a comment says how to
/// read it, and others describe each candidate. Cells that nothing sees or that are covered already
/// are left out. \param kinds names of the kinds, without spaces
/// \param legend what `describe` tells of a candidate, for a comment each
void writeMps(const Problem& problem, const std::vector<std::string>& kinds,
              const std::string& legend, const std::function<std::string(const Choice&)>& describe,
              std::ostream& out);

}  // namespace ispace
