// SPDX-License-Identifier: GPL-3.0-or-later
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

/// Walls no thicker than this are sheets.
constexpr double kThinnest = kWeldDistance;

/// One straight wall line with all that its body needs.
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
    std::vector<std::size_t> owner;  ///< index of the element of each line, ascending

    void add(const WallLine& wall, std::size_t element);
};

/// An upright piece of a wall, or what fills an opening in it.
struct WallPart {
    WallLine piece;        ///< its line may bend off the wall's by the weld
    Vec2 along;            ///< unit, direction of the whole wall line
    std::size_t source;    ///< number of the body that it belongs to
    bool filling = false;  ///< a door's leaf or a window's pane: makes no corners with walls
    bool clear = false;    ///< see Sheet::clear
};

/// One part per welded piece; its source is the index of its line.
std::vector<WallPart> wallParts(std::span<const WallLine> lines, const WeldedLines& welded);

/// Bodies of wall parts, `count` of them: result i has the parts of source i. Parts that meet at a
/// point leave no crack: sheets share the very same corner, boxes too, or the point itself. Where
/// thick walls meet at a corner, the notch between their ends is filled by a mitre, as high as both
/// are, that belongs to the lower source. O(n log n).
std::vector<Body> wallBodies(std::span<const WallPart> parts, std::size_t count);

/// The same for whole lines. \pre welded is the weld of the lines
std::vector<Body> wallBodies(std::span<const WallLine> lines, const WeldedLines& welded);

/// Where walls of two elements run through each other.
struct WallCrossing {
    std::size_t a, b;  ///< indices of the elements, a < b
    Point2 place;      ///< the crossing, or the middle of the stretch they have in common
    bool overlap;      ///< they lie on each other instead of crossing
};

/// Pairs of wall lines of different elements that cross beyond their ends, or lie on each other
/// for more than the weld distance; in the order of the elements, the first `most` (of
/// an element that crosses very many others, any of its own). Walls that share an end or end on
/// one another do not count, nor do rooms (`ispace`) side by side that share a wall. Takes as long
/// as weld.
std::vector<WallCrossing> wallCrossings(std::span<const Element> elements, std::size_t most = 1000);

/// Finds a point where two edges of the closed curve cross; empty without one. Edges that only
/// touch or overlap do not cross. Sweeps along x: O(n log n) for short edges, O(n^2) at worst.
std::optional<Point2> selfCrossing(const Polygon& polygon);

}  // namespace ispace
