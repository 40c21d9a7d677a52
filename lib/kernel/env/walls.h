// SPDX-License-Identifier: GPL-3.0-or-later
// Wall lines of records, and the bodies of walls that meet. Lines are welded first
// (geom/planar_map.h): ends within a micrometre are one, so boxes and sheets share corners exactly
// and no ray slips through a corner. Deterministic, single-threaded. Metres.
//
//     const std::vector<WallLine> walls = wallLinesOf(record, findings);
//     std::vector<Segment2> lines;
//     for (const WallLine& wall : walls) lines.push_back(wall.line);
//     const std::vector<Body> bodies = wallBodies(walls, weld(lines));
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "env/body.h"
#include "geom/planar_map.h"
#include "geom/polygon.h"

namespace ispace {

struct Element;

/// Walls up to this thickness are sheets.
constexpr double kThinnest = kWeldDistance;

/// One straight wall line with the data of its body.
struct WallLine {
    Segment2 line;
    double bottom = 0, top = 0;
    double thickness = 0;
    Material material = Material::Wall;
};

/// Returns true for the records that have wall lines: wall, fence and ispace.
bool isWall(const Record& record);

/// Computes the lines of a wall, fence or ispace record, in order. Reports missing or doubled
/// extents and zero lengths or heights as findings.
std::vector<WallLine> wallLinesOf(const Record& record, Diagnostics& findings);

/// All wall lines of an environment, in the order of its elements.
struct WallPlan {
    std::vector<WallLine> walls;
    std::vector<Segment2> lines;     ///< of the walls
    std::vector<std::size_t> owner;  ///< index of each line's element, ascending

    void add(const WallLine& wall, std::size_t element);
};

/// An upright piece of a wall, or the filling of an opening in it.
struct WallPart {
    WallLine piece;        ///< the weld may have moved its line off the wall's
    Vec2 along;            ///< unit direction of the whole wall line
    std::size_t source;    ///< index of the body that it belongs to
    bool filling = false;  ///< a door's leaf or a window's pane, which forms no corners with walls
    bool clear = false;    ///< see Sheet::clear
};

/// Returns one part per welded piece; its source is the index of its line.
std::vector<WallPart> wallParts(std::span<const WallLine> lines, const WeldedLines& welded);

/// Builds `count` bodies; body i has the parts with source i. Parts that meet at a point leave no
/// crack: sheets have identical corners there, boxes too, or the point itself as a corner. At a
/// corner of thick walls a mitre, as high as both, fills the notch between their ends and belongs
/// to the lower source. O(n log n).
std::vector<Body> wallBodies(std::span<const WallPart> parts, std::size_t count);

/// Builds the bodies of whole lines. \pre welded is the weld of the lines
std::vector<Body> wallBodies(std::span<const WallLine> lines, const WeldedLines& welded);

/// Returns the point of a tuple x,y.
inline Point2 pointOf(const Tuple& tuple) { return {tuple[0], tuple[1]}; }

/// A crossing or an overlap of the walls of two elements.
struct WallCrossing {
    std::size_t a, b;  ///< indices of the elements, a < b
    Point2 place;      ///< the crossing, or the middle of the overlap
    bool overlap;      ///< the walls lie on each other instead of crossing
};

/// Finds pairs of wall lines of different elements that cross away from their ends, or overlap by
/// more than twice the weld distance. Returns them in the order of the elements, the first `most`;
/// an element with very many crossings contributes an arbitrary selection. Skips walls that share
/// an end or end on one another, and adjacent rooms (`ispace`) that share a wall. Takes as long as
/// weld.
std::vector<WallCrossing> wallCrossings(std::span<const Element> elements, std::size_t most = 1000);

/// Finds a point where two edges of the closed curve cross; empty without one. Edges that only
/// touch or overlap do not cross. A sweep with exact predicates (M. I. Shamos, D. Hoey, Geometric
/// intersection problems, 1976). O(n log n)
std::optional<Point2> selfCrossing(const Polygon& polygon);

}  // namespace ispace
