// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts of meshes as walls. Walls that touch are united in groups, so that a wall running into
// another leaves no line across it. Solids wider than a wall stay as they are: the surface of a
// room is a closed curve too, and a union with it would swallow walls and furniture at it.
#include "io/plan/cut_paths.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "base/error.h"
#include "env/walls.h"
#include "geom/arrangement.h"
#include "geom/polygon.h"
#include "geom/predicates.h"
#include "io/plan/plan_rooms.h"

namespace ispace {

namespace {

// Edges cross their neighbours, and some of other solids; uniting more of them takes work.
constexpr std::size_t kFreeCutCrossings = 8, kUnitsPerCutCrossing = 16;

/// Unites solids no wider than a wall that meet at edges. Keeps wider ones, and a solid inside
/// another.
class SolidUnion {
  public:
    /// \param extent of the plan
    SolidUnion(std::vector<Polygon> solids, double extent, Budget& work)
        : solids_(std::move(solids)),
          widest_(widestWall(extent)),
          is_wide_(solids_.size()),
          work_(work) {
        group_.resize(solids_.size());
        std::iota(group_.begin(), group_.end(), std::size_t{0});
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
                if (++crossings > kFreeCutCrossings * edges.size() &&
                    !work_.take(kUnitsPerCutCrossing))
                    throw FormatError(Diagnostic{
                        "", 0, 0, "crossings of the cut's outlines make " + work_.excess()});
                const std::size_t a = rootOf(solid_of[i]), b = rootOf(solid_of[k]);
                if (a == b || isWide(solid_of[i]) || isWide(solid_of[k])) continue;
                group_[std::max(a, b)] = std::min(a, b);
            }
    }

    bool isWide(std::size_t i) {
        if (!is_wide_[i]) {
            const std::vector<Region> parts = unite(std::span(&solids_[i], 1));
            is_wide_[i] = std::ranges::any_of(
                parts, [this](const Region& part) { return !isNarrow(part, widest_); });
        }
        return *is_wide_[i];
    }

    std::vector<Polygon> solids_;
    double widest_;                             // of walls
    std::vector<std::optional<bool>> is_wide_;  // those that are known
    std::vector<std::size_t> group_;
    Budget& work_;
};

}  // namespace

std::vector<PlanPath> cutPaths(Slice slice, Budget& work) {
    const Box2 extent = boundsOf(slice.lines());
    std::vector<PlanPath> paths;
    // Ends of triangles are not corners: the plan's opening finder would use them.
    SolidUnion solids(std::move(slice.solids), std::max(extent.width(), extent.depth()), work);
    for (Polygon& outline : simplified(solids.join(), kMeshStraight))
        paths.push_back({std::move(outline), true, 0});
    for (const Segment2& sheet : slice.sheets) paths.push_back({{sheet.a, sheet.b}, false, 0});
    return paths;
}

}  // namespace ispace
