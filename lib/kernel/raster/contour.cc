// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/contour.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include "geom/polygon.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

/// A run of this many cells is a separate wall, not a tread of a slanted wall's stairs.
constexpr double kLongRun = 12;

/// The face of a bump keeps its corners from this many cells on; shorter ones are noise. Measured
/// on maps of robots: with it round pillars and rough walls keep their areas best.
constexpr double kFace = 4;

/// withoutStairs uses up half a cell of a tolerance.
constexpr double kStairTolerance = 0.5;

/// In the order of kSides.
enum Direction { East, North, West, South };

/// Offset from a lattice point to the cell ahead on the left of each direction; the one ahead on
/// the right is that of the direction to the right.
constexpr std::array<CellIndex, 4> kAheadLeft{{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};

Direction turned(Direction direction, int quarters) {
    return static_cast<Direction>((static_cast<int>(direction) + quarters + 4) % 4);
}

bool isSetAhead(const MapCells& cells, CellIndex at, Direction direction) {
    const CellIndex offset = kAheadLeft[direction];
    return cells.contains(at.x + offset.x, at.y + offset.y);
}

/// Follows the boundary with the set on the left from the lower edge of the cell at `start`;
/// marks the cells if it passes their lower edge eastwards.
Polygon walk(const MapCells& cells, CellIndex start, MapCells& passed) {
    Polygon corners;
    CellIndex at = start;
    Direction direction = East;
    do {
        if (direction == East) passed.insert(at.x, at.y);
        at = {at.x + kSides[direction].x, at.y + kSides[direction].y};
        int quarters = 0;
        // Left first: at a corner where two cells touch, the curve stays with its cell.
        if (!isSetAhead(cells, at, direction))
            quarters = 1;
        else if (isSetAhead(cells, at, turned(direction, -1)))
            quarters = -1;
        if (quarters == 0) continue;
        direction = turned(direction, quarters);
        corners.push_back({static_cast<double>(at.x), static_cast<double>(at.y)});
    } while (at.x != start.x || at.y != start.y || direction != East);
    return corners;
}

/// Removes vertices at which the curve does not turn.
Polygon cornersOf(const Polygon& curve) {
    const std::size_t n = curve.size();
    Polygon corners;
    for (std::size_t i = 0; i < n; ++i)
        if (orientation(curve[(i + n - 1) % n], curve[i], curve[(i + 1) % n]) != Turn::Straight)
            corners.push_back(curve[i]);
    return corners;
}

/// Returns true for the corners of rigid cells.
bool isRigid(Point2 corner, const MapCells* rigid) {
    if (rigid == nullptr) return false;
    const int x = static_cast<int>(corner.x), y = static_cast<int>(corner.y);
    return rigid->contains(x, y) || rigid->contains(x - 1, y) || rigid->contains(x, y - 1) ||
           rigid->contains(x - 1, y - 1);
}

/// Applies withoutStairs to one curve.
Polygon withoutStairs(const Polygon& curve, const MapCells* rigid) {
    const std::size_t n = curve.size();
    std::vector<double> run(n);  // length of edge i, from vertex i to the next
    std::vector<Turn> turn(n);   // at vertex i
    for (std::size_t i = 0; i < n; ++i) {
        const Point2 before = curve[(i + n - 1) % n];
        const Point2 after = curve[(i + 1) % n];
        run[i] = distance(curve[i], after);
        turn[i] = orientation(before, curve[i], after);
    }
    // Edges that turn one way and then back: treads and risers. The others are faces.
    const auto is_stair = [&](std::size_t i) { return turn[i] != turn[(i + 1) % n]; };
    const auto is_step = [&](std::size_t i) {
        return run[i] == 1 && is_stair(i) && run[(i + n - 1) % n] < kLongRun &&
               run[(i + 1) % n] < kLongRun && !isRigid(curve[i], rigid) &&
               !isRigid(curve[(i + 1) % n], rigid);
    };
    const auto yields = [&](std::size_t i) { return is_stair(i) || run[i] < kFace; };
    Polygon smooth;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t before = (i + n - 1) % n;
        const bool goes = (is_step(before) || is_step(i)) && yields(before) && yields(i);
        if (!goes) smooth.push_back(curve[i]);
        if (is_step(i)) smooth.push_back(curve[i] + 0.5 * (curve[(i + 1) % n] - curve[i]));
    }
    return cornersOf(smooth);
}

}  // namespace

std::vector<Polygon> boundaryCurves(const MapCells& cells) {
    std::vector<Polygon> curves;
    MapCells passed(cells.width(), cells.height());
    for (int y = 0; y < cells.height(); ++y)
        for (int x = 0; x < cells.width(); ++x)
            if (cells.contains(x, y) && !cells.contains(x, y - 1) && !passed.contains(x, y))
                curves.push_back(walk(cells, {x, y}, passed));
    return curves;
}

std::vector<Polygon> withoutStairs(const std::vector<Polygon>& curves, const MapCells* rigid) {
    std::vector<Polygon> smooth;
    smooth.reserve(curves.size());
    for (const Polygon& curve : curves) smooth.push_back(withoutStairs(curve, rigid));
    return smooth;
}

Region vectorised(const MapCells& cells, double tolerance, const MapCells* rigid) {
    std::vector<Polygon> curves = boundaryCurves(cells);
    std::vector<Point2> kept;
    for (const Polygon& curve : curves)
        std::copy_if(curve.begin(), curve.end(), std::back_inserter(kept),
                     [rigid](Point2 corner) { return isRigid(corner, rigid); });
    if (tolerance >= kStairTolerance) {
        curves = withoutStairs(curves, rigid);
        tolerance -= kStairTolerance;
    }
    if (tolerance > 0) curves = simplified(curves, tolerance, std::move(kept));
    Region region;
    region.outline = std::move(curves.front());
    region.holes.assign(std::make_move_iterator(curves.begin() + 1),
                        std::make_move_iterator(curves.end()));
    return region;
}

std::vector<Polygon> contours(const Grid& grid, const CellSet& cells) {
    std::vector<Polygon> curves = boundaryCurves(MapCells(cells, grid.columns, grid.rows));
    const Box2& limits = grid.limits;
    for (Polygon& curve : curves)
        for (Point2& p : curve)
            p = {limits.low.x + limits.width() * (p.x / grid.columns),
                 limits.low.y + limits.depth() * (p.y / grid.rows)};
    return curves;
}

std::vector<Region> cellRegions(const Grid& grid, const CellSet& cells) {
    std::vector<Region> pieces;
    std::vector<Polygon> holes;
    std::vector<Box2> boxes;
    for (Polygon& curve : contours(grid, cells)) {
        if (signedArea(curve) < 0) {
            holes.push_back(std::move(curve));
            continue;
        }
        boxes.push_back(bounds(curve));
        pieces.push_back({std::move(curve), {}});
    }
    const BoxTree tree(boxes);
    for (Polygon& hole : holes) {
        // Finds the innermost of the outlines around the cell on the left of its first edge.
        const Vec2 way = hole[1] - hole[0], ahead = 1 / length(way) * way;
        const Vec2 left = perpendicular(ahead);
        const Point2 cell = hole[0] + Vec2{(ahead.x + left.x) * grid.limits.width() / grid.columns,
                                           (ahead.y + left.y) * grid.limits.depth() / grid.rows};
        const Point2 middle = hole[0] + 0.5 * (cell - hole[0]);
        std::optional<std::size_t> owner;
        tree.search({middle, middle}, [&](std::size_t i) {
            const bool is_within = !owner || boxes[i].width() < boxes[*owner].width();
            if (is_within && locate(pieces[i].outline, middle) == Side::Inside) owner = i;
        });
        if (owner) pieces[*owner].holes.push_back(std::move(hole));
    }
    return pieces;
}

}  // namespace ispace
