// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "place/candidates.h"

namespace ispace {

/// One sensor to be placed and what it may choose from; sensors of one kind share candidates.
struct Choice {
    const std::vector<Candidate>* candidates;
};

/// A placement and what is known of the best one.
struct Placement {
    std::vector<std::size_t> chosen;  ///< index of a candidate, per choice
    CellSet covered;                  ///< target cells seen by the chosen and by what stood before
    /// No choice of these candidates covers more target cells than this, on this grid.
    std::size_t bound = 0;
};

/// Places one sensor after another, each on the candidate that adds the most cells to those before
/// it (thesis section 4.6); among equals the first. `covered` are the target cells seen already.
///
/// The bound uses that what a sensor adds can only shrink as others are placed: it is the least of
/// what all candidates see together, of the sum of the best single candidates, and, for every
/// stage of the placement, of the cells covered so far plus the best addition to them per sensor.
/// O(sensors * candidates * cells / 64). \pre no choice is without candidates
Placement placeGreedily(const std::vector<Choice>& choices, const CellSet& covered,
                        Progress& progress);

}  // namespace ispace
