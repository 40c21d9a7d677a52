// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/coverage.
#pragma once

#include <span>
#include <vector>

#include "coverage/coverage.h"
#include "coverage/metrics.h"

namespace ispace {

/// Holes of the free floor, such as the feet of furniture, beyond the reach of all sensors: no
/// view, wall or other boundary comes near their bounds. In a large building they are most of the
/// floor's edges, and an overlay of views is the same without them, but for kFreeMark within them.
class FarHoles {
  public:
    /// Removes them from `floor.free`.
    /// \param sets \pre all regions are known
    FarHoles(FloorCurves& floor, std::span<const CoveredSet> sets,
             std::span<const Segment2> sheets);

    /// Cuts them out of the pieces of unseen free floor in such an overlay.
    /// \param areas of the pieces
    void cutOut(std::vector<Region>& pieces, std::vector<double>& areas) const;

  private:
    std::vector<Polygon> holes_;
};

}  // namespace ispace
