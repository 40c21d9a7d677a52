// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_cut.h"

#include <algorithm>
#include <map>
#include <utility>

#include "env/walls.h"
#include "geom/boolean.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

constexpr double kStraight = 0.001;  // metres: floats of a file wobble by less

bool edgesMeet(const Polygon& a, const Polygon& b) {
    bool meet = false;
    forEachEdge(a, [&](const Segment2& s) {
        forEachEdge(b, [&](const Segment2& t) { meet = meet || intersects(s, t); });
    });
    return meet;
}

/// Unites solids whose edges meet, as walls that run into each other. One inside another stays, as
/// furniture in a room modelled by its inner surface.
class Joiner {
  public:
    explicit Joiner(std::vector<Polygon> solids) : solids_(std::move(solids)) {
        for (std::size_t i = 0; i < solids_.size(); ++i) group_.push_back(i);
    }

    std::vector<Polygon> join() {
        groupTouching();
        std::map<std::size_t, std::vector<Polygon>> groups;
        for (std::size_t i = 0; i < solids_.size(); ++i)
            groups[rootOf(i)].push_back(std::move(solids_[i]));
        std::vector<Polygon> outlines;
        // Even single ones: a cavity joined to its outline by a seam becomes a curve of its own.
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

    /// From left to right, so that only boxes that overlap in x are compared.
    void groupTouching() {
        std::vector<Box2> boxes;
        for (const Polygon& solid : solids_) boxes.push_back(bounds(solid));
        std::vector<std::size_t> order(group_);
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return std::pair(boxes[a].low.x, a) < std::pair(boxes[b].low.x, b);
        });
        for (std::size_t i = 0; i < order.size(); ++i)
            for (std::size_t k = i + 1; k < order.size(); ++k) {
                const Box2 &a = boxes[order[i]], &b = boxes[order[k]];
                if (b.low.x > a.high.x) break;
                if (b.low.y > a.high.y || b.high.y < a.low.y) continue;
                if (rootOf(order[i]) != rootOf(order[k]) &&
                    edgesMeet(solids_[order[i]], solids_[order[k]]))
                    group_[std::max(rootOf(order[i]), rootOf(order[k]))] =
                        std::min(rootOf(order[i]), rootOf(order[k]));
            }
    }

    std::vector<Polygon> solids_;
    std::vector<std::size_t> group_;
};

}  // namespace

void closeLoops(Slice& slice) {
    std::vector<PlanPath> lines;
    for (const Segment2& sheet : slice.sheets) lines.push_back({{sheet.a, sheet.b}, false, 0});
    slice.sheets.clear();
    for (PlanPath& path : joinedAtEnds(withoutRepeats(snapped(lines, kStraight)))) {
        if (path.closed && !selfCrossing(path.points)) {
            slice.solids.push_back(std::move(path.points));
            continue;
        }
        for (std::size_t i = 0; i < path.pieceCount(); ++i) slice.sheets.push_back(path.piece(i));
    }
}

std::vector<PlanPath> cutPaths(Slice slice) {
    std::vector<PlanPath> paths;
    // Ends of triangles are not corners: openings would be fitted to them.
    for (Polygon& outline : simplified(Joiner(std::move(slice.solids)).join(), kStraight))
        paths.push_back({std::move(outline), true, 0});
    for (const Segment2& sheet : slice.sheets) paths.push_back({{sheet.a, sheet.b}, false, 0});
    return paths;
}

}  // namespace ispace
