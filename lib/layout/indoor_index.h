// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/layout only: regions that are asked often.
#pragma once

#include <vector>

#include "geom/polygon.h"
#include "geom/spatial_index.h"

namespace ispace {

/// Answers as Regions::locate does, in O(log n + edges beside the point).
class IndoorIndex {
  public:
    explicit IndoorIndex(const Regions& regions);

    [[nodiscard]] Side locate(Point2 p) const;
    /// Outside, and farther from the boundary than touching.
    [[nodiscard]] bool isOut(Point2 p) const;
    /// Calls visit(const Segment2&) for the edges whose bounds meet the window.
    template <typename Visit>
    void edgesIn(const Box2& window, Visit visit) const {
        tree_.search(window, [&](std::size_t i) { visit(edges_[i]); });
    }
    [[nodiscard]] bool hasEdgeIn(const Box2& window) const;

  private:
    std::vector<Segment2> edges_;
    BoxTree tree_;
    double right_ = 0;  // no edge lies beyond
};

}  // namespace ispace
