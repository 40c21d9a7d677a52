// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of proofs over poses: floors.
#pragma once

#include <span>
#include <vector>

#include "extensions/proofs/poses/outer_bound.h"
#include "geom/overlay/overlay.h"
#include "geom/polygon.h"
#include "geom/pose.h"
#include "geom/visibility/visibility.h"

namespace ispace::proofs {

/// Two rooms with a door of 1 m between them, and a pillar in the second.
inline Region roomsWithPillar() {
    return {{{0, 0},
             {6, 0},
             {6, 2},
             {6.2, 2},
             {6.2, 0},
             {11, 0},
             {11, 5},
             {6.2, 5},
             {6.2, 3},
             {6, 3},
             {6, 5},
             {0, 5}},
            {{{8, 2}, {8, 3}, {9, 3}, {9, 2}}}};
}

/// Exact areas that sensors at single poses see.
class SeenAreas {
  public:
    SeenAreas(const Region& region, const poses::Sector& sector)
        : sector_(sector), map_(wallsOf(region)) {}

    /// Returns the view, with chords, which lie in it, for its arcs.
    [[nodiscard]] Polygon viewFrom(const Pose2& pose) const {
        VisibleRegion seen = map_.query(pose.position, sector_.range);
        if (!sector_.isRound())
            seen = sectorOf(seen, Angle::radians(pose.heading.radians() + sector_.first),
                            Angle::radians(sector_.field));
        Polygon view;
        if (!seen.is_whole) view.push_back(pose.position);
        for (const VisibilityEdge& edge : seen.edges) {
            view.push_back(edge.from);
            view.push_back(edge.to);
        }
        return view;
    }
    /// Returns the area that at least `times` poses see.
    [[nodiscard]] double of(std::span<const Pose2> poses, int times) const {
        std::vector<Layer> layers;
        for (const Pose2& pose : poses) layers.push_back({.curves = {curveOf(viewFrom(pose))}});
        return Overlay(layers).area(
            [times](const LayerLabel& label) { return label.count >= times; });
    }

  private:
    static std::vector<Segment2> wallsOf(const Region& region) {
        std::vector<Segment2> walls;
        region.forEachEdge([&](const Segment2& edge) { walls.push_back(edge); });
        return walls;
    }
    poses::Sector sector_;
    VisibilityMap map_;
};

}  // namespace ispace::proofs
