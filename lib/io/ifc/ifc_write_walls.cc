// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/ifc/ifc_write_walls.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>

#include "geom/planar_map.h"

namespace ispace {

namespace {

/// The parts without those that stand in another one on the same line.
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

}  // namespace

WholeWalls::WholeWalls(const std::vector<Element>& elements) {
    Diagnostics findings;  // the environment has had them
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (isWall(elements[i].record))
            for (const WallLine& wall : wallLinesOf(elements[i].record, findings))
                plan.add(wall, i);
    openings = placeOpenings(elements, plan, findings);
    std::vector<WallLine> thick = plan.walls;
    for (WallLine& wall : thick)
        if (wall.thickness <= kThinnest) wall.thickness = kThinWall;
    const std::vector<WallPart> parts = withoutDoubles(wallParts(thick, weld(plan.lines)));
    bodies = wallBodies(parts, thick.size());
    lengths.resize(thick.size());
    for (const WallPart& part : parts)
        lengths[part.source] += distance(part.piece.line.a, part.piece.line.b);
}

bool WholeWalls::stands(const OpeningCut& cut) const {
    const Point2 middle = cut.jambs.a + 0.5 * (cut.jambs.b - cut.jambs.a);
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

}  // namespace ispace
