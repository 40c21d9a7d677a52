// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/proofs/gallery: the fewest points that see a whole floor, over all points of it
// (the art gallery problem). Uses geom, base and arrange/search.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "arrange/search/set_cover.h"
#include "base/error.h"
#include "geom/polygon.h"

namespace ispace::proofs {

/// A cover of the floor, and a proof that no smaller one exists.
struct GalleryCover {
    /// Together they see the floor but for `missed`; with duplicates of no point.
    std::vector<Point2> guards;
    /// Area that no guard sees, m2, by an exact union of their regions; crossings are rounded to
    /// doubles. At most kMissedShare of the floor, unless `guards` is empty.
    double missed = 0;
    /// No set of fewer points sees all of the witnesses, and so none sees the whole floor.
    std::size_t bound = 0;
    std::vector<Point2> witnesses;  ///< that prove the bound
    /// A point sees no more than one of these sets of witnesses, ascending.
    std::vector<std::vector<std::uint32_t>> sets;
    std::size_t candidates = 0;  ///< points tried as guards
    int rounds = 0;              ///< of lower bounds
    bool is_complete = true;     ///< false: stopped with guards.size() > bound

    [[nodiscard]] bool isProven() const { return !guards.empty() && guards.size() == bound; }
};

/// Finds the fewest guards: points of the closed floor that see it all, at any distance and all
/// around. Sight is blocked by the boundary of the floor and ends there; a point on a wall sees
/// both sides of it, as for VisibilityMap.
///
/// Tozoni, de Rezende & de Souza (2016): a set of witnesses bounds the number from below, by the
/// least number of points that see them all (WitnessSets); a set of candidates from above, by the
/// fewest of them that cover the floor, found by set covers whose rows are points of what earlier
/// ones left unseen. These become witnesses until both bounds meet. Ends earlier if progress says
/// stop, with the best cover and bound so far. Deterministic for any number of threads, unless
/// stopped.
/// \pre regions with disjoint interiors
/// \throws FormatError (without a line number) for views that cross by the million
GalleryCover guardGallery(std::span<const Region> floor, Progress& progress);

}  // namespace ispace::proofs
