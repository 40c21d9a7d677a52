// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts of meshes as walls. Solids that touch are united in groups, so that a wall running into
// another leaves no line across it; solids apart from each other stay apart, since a union would
// swallow furniture in a room that is modelled by its inner surface.
#include "io/plan/cut_paths.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "base/error.h"
#include "env/walls.h"
#include "geom/arrangement.h"
#include "geom/polygon.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

// Edges cross their neighbours, and some of other solids; uniting more of them takes work.
constexpr std::size_t kFreeCrossings = 8, kUnitsPerCrossing = 16;

/// Unites solids that meet at edges, such as walls that run into each other. Keeps a solid inside
/// another, e.g. furniture in a room modelled by its inner surface.
class Joiner {
  public:
    Joiner(std::vector<Polygon> solids, Budget& work) : solids_(std::move(solids)), work_(work) {
        for (std::size_t i = 0; i < solids_.size(); ++i) group_.push_back(i);
    }

    std::vector<Polygon> join() {
        groupTouching();
        std::map<std::size_t, std::vector<Polygon>> groups;
        for (std::size_t i = 0; i < solids_.size(); ++i)
            groups[rootOf(i)].push_back(std::move(solids_[i]));
        std::vector<Polygon> outlines;
        // Even single ones: a cavity joined to its outline by a seam becomes a separate curve.
        for (const auto& [root, group] : groups)
            for (Region& region : unite(group)) {
                outlines.push_back(std::move(region.outline));
                for (Polygon& hole : region.holes) outlines.push_back(std::move(hole));
            }
        return outlines;
    }

  private:
    std::size_t rootOf(std::size_t i) {
        while (group_[i] != i) i = group_[i] = group_[group_[i]];
        return i;
    }

    void groupTouching() {
        std::vector<Segment2> edges;
        std::vector<std::size_t> solid_of;
        for (std::size_t i = 0; i < solids_.size(); ++i)
            forEachEdge(solids_[i], [&](const Segment2& edge) {
                edges.push_back(edge);
                solid_of.push_back(i);
            });
        const NearSegments search(edges, work_);
        std::size_t crossings = 0;
        for (std::size_t i = 0; i < edges.size(); ++i)
            for (const std::size_t k : search.near(bounds(edges[i]), 0)) {
                if (k >= i) break;
                if (!intersects(edges[i], edges[k])) continue;
                if (++crossings > kFreeCrossings * edges.size() && !work_.take(kUnitsPerCrossing))
                    throw FormatError(Diagnostic{
                        "", 0, 0, "crossings of the cut's outlines make " + work_.excess()});
                const std::size_t a = rootOf(solid_of[i]), b = rootOf(solid_of[k]);
                group_[std::max(a, b)] = std::min(a, b);
            }
    }

    std::vector<Polygon> solids_;
    std::vector<std::size_t> group_;
    Budget& work_;
};

}  // namespace

std::vector<PlanPath> cutPaths(Slice slice, Budget& work) {
    std::vector<PlanPath> paths;
    // Ends of triangles are not corners: the plan's opening finder would use them.
    for (Polygon& outline : simplified(Joiner(std::move(slice.solids), work).join(), kMeshStraight))
        paths.push_back({std::move(outline), true, 0});
    for (const Segment2& sheet : slice.sheets) paths.push_back({{sheet.a, sheet.b}, false, 0});
    return paths;
}

}  // namespace ispace
