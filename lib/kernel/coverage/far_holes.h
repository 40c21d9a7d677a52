// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/coverage: holes of the floor that an overlay of views need not see. Areas
// and pieces are those of the whole overlay. O(n log n) in the edges of the floor, once for a room;
// then a look-up of each hole among the boxes of the views, and a copy of the curves that remain.
#pragma once

#include <span>
#include <vector>

#include "coverage/coverage.h"

namespace ispace {

/// Holes of the free floor, such as the feet of furniture, beyond the reach of all sensors: no
/// view, wall or other boundary comes near their bounds. In a large building they are most of the
/// floor's edges, and an overlay of views is the same without them, but for kFreeMark within them.
class FarHoles {
  public:
    /// Finds the holes that no other boundary of the floor comes near.
    /// \param free_floor stored by reference
    FarHoles(const Regions& indoor, const std::vector<Region>& free_floor,
             std::span<const Segment2> sheets);

    /// Returns the boundary of the free floor without the far holes. \pre all regions are known
    std::vector<Curve> curvesWithout(std::span<const CoveredSet> sets);

    /// Cuts the far holes of curvesWithout() out of the pieces of unseen free floor in an overlay
    /// of these curves.
    /// \param areas of the pieces
    void cutOut(std::vector<Region>& pieces, std::vector<double>& areas) const;

  private:
    const std::vector<Region>& floor_;
    double margin_ = 0;
    std::vector<char> is_lone_;  // for each hole of each region
    std::vector<const Polygon*> far_;
};

}  // namespace ispace
