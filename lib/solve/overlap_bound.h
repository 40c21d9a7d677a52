// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "solve/lagrange.h"
#include "solve/problem.h"

namespace ispace {

/// An upper bound below that of the linear program, where one kind of sensors covers cells one by
/// one: it knows that neighbours count what both see only once.
///
/// Lagrangian relaxation of the cells' rows lets the multiplier of a cell count for every sensor
/// that sees it, so fractions of neighbours combine as no whole sensors can. Here candidates are
/// parted into areas, one about each sensor of a good solution, and a spanning tree joins the
/// areas. What the first sensors of two joined areas both see is taken off: of c sensors that see a
/// cell at most c - 1 pairs are edges, so it still counts at least once (Hunter 1976). Within an
/// area two sensors are exact, and more of them at most see all that any candidate of worth there
/// sees. The number of sensors has a multiplier of its own. The best choice for given multipliers
/// is found exactly, from the leaves of the tree to its root.
///
/// Integer arithmetic: the bound is exact. The same for any number of threads.
/// \param plain of the same problem; its multipliers are where the search begins
/// \param near a good solution
/// \param limits as for lagrangianBound()
/// \return the lower of the two bounds, in the problem's units
std::uint64_t overlapBound(const Problem& problem, const Bound& plain,
                           const std::vector<Choice>& near, const LagrangeLimits& limits,
                           Progress& progress);

/// True if overlapBound() can do anything for such a problem.
bool isBoundByOverlaps(const Problem& problem);

}  // namespace ispace
