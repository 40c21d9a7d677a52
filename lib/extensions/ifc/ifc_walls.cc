// SPDX-License-Identifier: GPL-3.0-or-later
// Walls of a scene as IFC wants them: bodies with openings. Rooms from plans have the two faces of
// a wall as lines without thickness; faces that an opening joins are the sides of one solid, which
// is found here and written as a wall.
#include "extensions/ifc/ifc_walls.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "geom/arrangement.h"
#include "geom/planar_map.h"
#include "io/plan/line_plan.h"

namespace ispace::ifc {

namespace {

/// Faces are searched this far beside the middle of a line, in metres.
constexpr double kBesideFace = 0.002;

/// Returns the parts without those inside another one on the same line.
std::vector<WallPart> withoutDoubles(const std::vector<WallPart>& parts) {
    const auto ends = [&](std::size_t i) {
        const auto& [a, b] = parts[i].piece.line;
        return lexLess(b, a) ? std::tuple(b.x, b.y, a.x, a.y) : std::tuple(a.x, a.y, b.x, b.y);
    };
    const auto holds = [&](std::size_t i, std::size_t k) {
        const WallLine &outer = parts[i].piece, &inner = parts[k].piece;
        return outer.thickness >= inner.thickness && outer.bottom <= inner.bottom &&
               outer.top >= inner.top;
    };
    std::vector<std::size_t> order(parts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
        return std::tuple(ends(i), -parts[i].piece.thickness, i) <
               std::tuple(ends(k), -parts[k].piece.thickness, k);
    });
    std::vector<bool> dropped(parts.size());
    std::size_t last = 0;  // the last one that is kept
    for (std::size_t i = 1; i < order.size(); ++i) {
        dropped[order[i]] = ends(order[last]) == ends(order[i]) && holds(order[last], order[i]);
        if (!dropped[order[i]]) last = i;
    }
    std::vector<WallPart> kept;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (!dropped[i]) kept.push_back(parts[i]);
    return kept;
}

/// Faces of thin walls, searched by their boxes.
class ThinFaces {
  public:
    ThinFaces(const WallPlan& plan, const WeldedLines& welded) {
        WeldedLines thin;
        for (std::size_t i = 0; i < welded.pieces.size(); ++i) {
            if (plan.walls[welded.source[i]].thickness > kThinnest) continue;
            thin.pieces.push_back(welded.pieces[i]);
            thin.source.push_back(welded.source[i]);
        }
        faces_ = boundedFaces(thin);
        for (const Region& face : faces_) boxes_.push_back(bounds(face.outline));
    }
    [[nodiscard]] std::optional<std::size_t> around(Point2 p) const {
        for (std::size_t i = 0; i < faces_.size(); ++i)
            if (boxes_[i].contains(p) && faces_[i].locate(p) == Side::Inside) return i;
        return std::nullopt;
    }
    [[nodiscard]] const Region& at(std::size_t face) const { return faces_[face]; }

  private:
    std::vector<Region> faces_;
    std::vector<Box2> boxes_;
};

/// Returns true if more than half of the face lies outdoors, or in a wall: doorways are indoors.
bool isMostlySolid(const Region& face, const Regions& indoor) {
    std::vector<Polygon> rooms;
    for (const Region& room : indoor.parts) rooms.push_back(room.outline);
    const std::vector<Region> solid = difference(face, rooms);
    return totalArea(solid) > 0.5 * face.area();
}

Point2 middleOf(const Segment2& segment) { return segment.a + 0.5 * (segment.b - segment.a); }

/// Returns the segment between the two cuts, as long as the first.
Segment2 between(const OpeningCut& one, const OpeningCut& other) {
    const Vec2 half = 0.5 * (one.jambs.b - one.jambs.a);
    const Point2 middle = middleOf({middleOf(one.jambs), middleOf(other.jambs)});
    return {middle - half, middle + half};
}

}  // namespace

WholeWalls::WholeWalls(const Environment& environment) {
    const std::vector<Element>& elements = environment.elements();
    Diagnostics findings;  // the environment has had them
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (isWall(elements[i].record))
            for (const WallLine& wall : wallLinesOf(elements[i].record, findings))
                plan.add(wall, i);
    openings = placeOpenings(elements, plan, findings);
    std::vector<WallLine> thick = plan.walls;
    for (WallLine& wall : thick)
        if (wall.thickness <= kThinnest) wall.thickness = kThinWall;
    const WeldedLines welded = weld(plan.lines);
    cuts = openingCuts(plan, openings);
    const std::vector<WallPart> parts =
        outsideSolids(withoutDoubles(wallParts(thick, welded)), environment, welded);
    bodies = wallBodies(parts, thick.size());
    lengths.resize(thick.size());
    for (const WallPart& part : parts)
        lengths[part.source] += distance(part.piece.line.a, part.piece.line.b);
    std::erase_if(cuts, [&](const OpeningCut& cut) { return !stands(cut); });
    std::stable_sort(cuts.begin(), cuts.end(), [&](const OpeningCut& c, const OpeningCut& d) {
        const auto other = [&](const OpeningCut& cut) {
            return std::pair(cut.opening, cut.line != openings[cut.opening].line);
        };
        return other(c) < other(d);
    });
}

/// Thin lines around a face that is mostly solid are one wall with the face as its section:
/// openings become its holes, its height is that of the lines, and the lines are no walls of their
/// own.
std::vector<WallPart> WholeWalls::outsideSolids(std::vector<WallPart> parts,
                                                const Environment& environment,
                                                const WeldedLines& welded) {
    const ThinFaces faces(plan, welded);
    std::map<std::size_t, std::optional<std::size_t>> solid_of;  // of faces; empty: a room
    for (auto first = cuts.begin(); first != cuts.end();) {
        const auto last = std::find_if(
            first, cuts.end(), [&](const OpeningCut& c) { return c.opening != first->opening; });
        addHoles({first, last}, [&](Point2 p) -> std::optional<std::size_t> {
            const auto face = faces.around(p);
            if (!face) return std::nullopt;
            const auto [at, is_new] = solid_of.try_emplace(*face);
            if (is_new && isMostlySolid(faces.at(*face), environment.indoor())) {
                at->second = solids.size();
                const WallLine& wall = plan.walls[first->line];
                solids.push_back({faces.at(*face), wall.bottom, wall.top, first->line});
            }
            return at->second;
        });
        first = last;
    }
    if (solids.empty()) return parts;
    std::erase_if(parts, [&](const WallPart& part) {
        if (plan.walls[part.source].thickness > kThinnest) return false;
        const Point2 middle = middleOf(part.piece.line);
        const Vec2 aside = kBesideFace * Vec2{-part.along.y, part.along.x};
        for (const Point2 p : {middle + aside, middle - aside}) {
            const auto face = faces.around(p);
            const auto found = face ? solid_of.find(*face) : solid_of.end();
            if (found == solid_of.end() || !found->second) continue;
            SolidWall& solid = solids[*found->second];
            solid.bottom = std::min(solid.bottom, part.piece.bottom);
            solid.top = std::max(solid.top, part.piece.top);
            return true;
        }
        return false;
    });
    return parts;
}

void WholeWalls::addHoles(std::span<const OpeningCut> of_opening,
                          const std::function<std::optional<std::size_t>(Point2)>& solid_at) {
    std::vector<OpeningCut> thin;
    for (const OpeningCut& cut : of_opening)
        if (plan.walls[cut.line].thickness <= kThinnest) thin.push_back(cut);
    if (thin.size() < 2) return;
    const Vec2 along = thin.front().jambs.b - thin.front().jambs.a;
    const Vec2 across = (1 / length(along)) * Vec2{-along.y, along.x};
    const auto offset = [&](const OpeningCut& cut) {
        return dot(middleOf(cut.jambs) - thin.front().jambs.a, across);
    };
    std::stable_sort(thin.begin(), thin.end(), [&](const OpeningCut& c, const OpeningCut& d) {
        return offset(c) < offset(d);
    });
    for (std::size_t i = 1; i < thin.size(); ++i) {
        const double depth = offset(thin[i]) - offset(thin[i - 1]);
        if (depth <= 2 * kBesideFace) continue;
        const Segment2 middle = between(thin[i - 1], thin[i]);
        if (const auto solid = solid_at(middleOf(middle)))
            holes.push_back({of_opening.front().opening, *solid, middle, depth});
    }
}

bool WholeWalls::stands(const OpeningCut& cut) const {
    const Point2 middle = middleOf(cut.jambs);
    const Opening& opening = openings[cut.opening];
    const auto& prisms = bodies[cut.line].prisms;
    return std::any_of(prisms.begin(), prisms.end(), [&](const Prism& prism) {
        return prism.bottom < opening.top && prism.top > opening.bottom &&
               locate(prism.footprint, middle) != Side::Outside;
    });
}

std::vector<Polygon> WholeWalls::footprints() const {
    std::vector<Polygon> footprints;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (plan.walls[i].thickness > kThinnest)
            for (const Prism& prism : bodies[i].prisms)
                if (prism.bottom <= 0) footprints.push_back(prism.footprint);
    return footprints;
}

}  // namespace ispace::ifc
