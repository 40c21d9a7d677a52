// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cover/contour.h"
#include "cover/map_parts.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

bool standsAt(const Prism& prism, double height) {
    return prism.bottom <= height && height <= prism.top;
}

/// A room's own walls count as walls, not as things in it.
bool isWall(const Element& element) {
    const RecordType type = element.record.schema().type;
    return type == RecordType::Wall || type == RecordType::Space;
}

/// Class of redundancy of every cell, 0 for unseen ones. Cells that do not count, with the centre
/// off the free floor, take the best class of their free neighbours, so that the colour of the
/// floor reaches walls and objects, which are drawn over it.
std::vector<int> shadesOf(const Coverage& coverage, const Shades& shades) {
    const Grid& grid = coverage.target.grid;
    const CellSet& free = coverage.target.free;
    const std::vector<std::uint32_t> times = timesSeen(grid, coverage.seen);
    const auto columns = static_cast<std::size_t>(grid.columns);
    std::vector<int> result(grid.size());
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const std::size_t cell = grid.cell(column, row);
            if (coverage.target.indoor.test(cell)) result[cell] = shades.of(times[cell]);
            if (free.test(cell)) continue;
            const auto extend = [&](bool exists, std::size_t neighbour) {
                if (exists && free.test(neighbour))
                    result[cell] = std::max(result[cell], shades.of(times[neighbour]));
            };
            extend(column > 0, cell - 1);
            extend(column + 1 < grid.columns, cell + 1);
            extend(row > 0, cell - columns);
            extend(row + 1 < grid.rows, cell + columns);
        }
    }
    return result;
}

void drawFloor(Canvas& canvas, const Scene& scene, const Coverage& coverage) {
    const Grid& grid = coverage.target.grid;
    const Region& indoor = scene.environment.indoor();
    const Shades shades = shadesFor(coverage.report.redundancy);
    canvas.fill(indoor, map_colors::kUncovered);
    const std::vector<int> shade = shadesOf(coverage, shades);
    canvas.pushClip(indoor);
    // Each class is laid over those below it, so that no seam shows between two.
    for (int level = 1; level <= shades.count; ++level) {
        CellSet cells(grid.size());
        for (std::size_t cell = 0; cell < shade.size(); ++cell)
            if (shade[cell] >= level) cells.set(cell);
        canvas.fill(contours(grid, cells), shades.color(level));
    }
    canvas.pop();
    for (const Polygon& hole : indoor.holes) canvas.fill(hole, map_colors::kOutside);
}

void drawObjects(Canvas& canvas, const Scene& scene, double height, double em) {
    for (const bool at_height : {false, true}) {
        const Color inner = at_height ? map_colors::kSolid : map_colors::kObject;
        const Stroke edge{at_height ? map_colors::kSolidEdge : map_colors::kObjectEdge, em / 16};
        for (const Element& element : scene.environment.elements()) {
            if (isWall(element)) continue;
            for (const Prism& prism : element.body.prisms) {
                if (standsAt(prism, height) != at_height) continue;
                // What does not stand in the way lets the floor's colour through.
                canvas.fill(prism.footprint, at_height ? inner : inner.faded(0.6));
                canvas.stroke(prism.footprint, edge);
            }
        }
    }
}

/// Width of wall lines: finer where walls are made of short pieces, as in ragged maps.
double wallWidth(const Environment& environment, double scale, double em) {
    double sum = 0;
    for (const Segment2& wall : environment.wallLines()) sum += distance(wall.a, wall.b);
    const double mean = sum / static_cast<double>(environment.wallLines().size());
    return std::clamp(0.1 * scale * mean, em / 14, em / 7);
}

void drawWalls(Canvas& canvas, const Scene& scene, double scale, double em) {
    const double width = wallWidth(scene.environment, scale, em);
    for (const Element& element : scene.environment.elements()) {
        std::vector<Segment2> lines;
        for (const Sheet& sheet : element.body.sheets) lines.push_back(sheet.line);
        if (!lines.empty()) canvas.lines(lines, {map_colors::kWall, width});
        if (!isWall(element)) continue;
        for (const Prism& prism : element.body.prisms) {
            canvas.fill(prism.footprint, map_colors::kWall);
            canvas.stroke(prism.footprint, {map_colors::kWall, em / 16});
        }
    }
}

void drawZones(Canvas& canvas, const Scene& scene, double scale, double em) {
    const double inset = 0.5 * em / scale;
    TextStyle style{0.85 * em, false, Align::Left, map_colors::kZone,
                    map_colors::kWhite.faded(0.8)};
    for (const Element& element : scene.environment.elements()) {
        if (element.record.keyword() != "zone") continue;
        const Polygon outline = zoneOutline(element.record);
        canvas.stroke(outline, {map_colors::kZone, em / 10, {em / 2, em / 3}});
        const Point2 corner = bounds(outline).low;
        canvas.text({corner.x + inset, corner.y + inset}, element.id, style);
    }
}

/// Points of a line that lies within `tolerance` of all of them (Douglas and Peucker).
std::vector<Point2> thinned(const std::vector<Point2>& points, double tolerance) {
    if (points.size() < 3) return points;
    std::vector<bool> keep(points.size());
    keep.front() = keep.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> open = {{0, points.size() - 1}};
    while (!open.empty()) {
        const auto [first, last] = open.back();
        open.pop_back();
        const Segment2 chord{points[first], points[last]};
        double farthest = tolerance;
        std::size_t at = first;
        for (std::size_t i = first + 1; i < last; ++i) {
            if (const double off = distance(points[i], chord); off > farthest) {
                farthest = off;
                at = i;
            }
        }
        if (at == first) continue;
        keep[at] = true;
        open.insert(open.end(), {{first, at}, {at, last}});
    }
    std::vector<Point2> kept;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (keep[i]) kept.push_back(points[i]);
    return kept;
}

/// The ends of all beams on the plan, from above; through the sensor itself unless the beams go
/// round. Beams end at `farthest`, beyond which nothing is drawn.
Polygon fanOutline(const PlacedLaser& sensor, const std::vector<float>& beams, double farthest,
                   double tolerance) {
    const Point3 origin = sensor.pose.position;
    std::vector<Point2> ends;
    for (std::size_t k = 0; k < beams.size(); ++k) {
        const double range =
            std::min({static_cast<double>(beams[k]), sensor.laser.max_range, farthest});
        const Vec3 beam = sensor.pose.beam(sensor.laser.bearing(static_cast<int>(k)));
        ends.push_back((origin + range * beam).onFloor());
    }
    Polygon outline = thinned(ends, tolerance);
    const Angle span = sensor.laser.last() + sensor.laser.step - sensor.laser.first;
    if (span < Angle::degrees(360 - 1e-9)) outline.push_back(origin.onFloor());
    return outline;
}

void drawFans(Canvas& canvas, const Scene& scene, const Coverage& coverage, double scale,
              double em) {
    constexpr std::size_t kMostBands = 12;  // soft rims help to tell few fans apart, and hide many
    const Box2& limits = coverage.target.grid.limits;
    const double rim = std::min(0.9 * em, 0.04 * scale * std::min(limits.width(), limits.depth()));
    for (std::size_t i = 0; i < scene.lasers.size(); ++i) {
        const Point2 origin = scene.lasers[i].pose.position.onFloor();
        Box2 reach = limits;
        reach.add(origin);
        const double farthest = 2 * length(reach.high - reach.low);
        const Polygon fan = fanOutline(scene.lasers[i], coverage.beams[i], farthest, 0.2 / scale);
        const Stroke line = sensorStroke(i, scene.lasers.size(), em);
        if (scene.lasers.size() <= kMostBands) {
            canvas.pushClip(fan);
            canvas.stroke(fan, {line.color.faded(0.16), rim});
            canvas.pop();
        }
        canvas.stroke(fan, line);
    }
}

}  // namespace

Shades shadesFor(const std::vector<double>& redundancy) {
    constexpr std::uint32_t kMostShades = 6;
    std::uint32_t most = 1;
    for (std::uint32_t k = 1; k < redundancy.size(); ++k)
        if (redundancy[k] > 0) most = k;
    Shades shades;
    shades.width = (most + kMostShades - 1) / kMostShades;
    shades.count = shades.of(most);
    return shades;
}

MapContents contentsOf(const Scene& scene, const Coverage& coverage) {
    MapContents contents;
    contents.outside = !scene.environment.indoor().holes.empty();
    for (const Element& element : scene.environment.elements()) {
        if (element.record.keyword() == "zone") contents.zones = true;
        if (!element.body.sheets.empty()) contents.walls = true;
        for (const Prism& prism : element.body.prisms) {
            const bool solid = standsAt(prism, coverage.target.height);
            (isWall(element) ? contents.walls : solid ? contents.solids : contents.objects) = true;
        }
    }
    return contents;
}

void drawPlan(Canvas& canvas, const Scene& scene, const Coverage& coverage, const PageView& view,
              double em) {
    const Box2& limits = coverage.target.grid.limits;
    const double rim = em / 4 / view.scale;  // walls on the limits are drawn whole
    canvas.pushView(view);
    canvas.pushClip({{limits.low.x - rim, limits.low.y - rim},
                     {limits.high.x + rim, limits.low.y - rim},
                     {limits.high.x + rim, limits.high.y + rim},
                     {limits.low.x - rim, limits.high.y + rim}});
    drawFloor(canvas, scene, coverage);
    drawObjects(canvas, scene, coverage.target.height, em);
    drawFans(canvas, scene, coverage, view.scale, em);
    drawWalls(canvas, scene, view.scale, em);
    drawZones(canvas, scene, view.scale, em);
    canvas.pop();
    canvas.pop();
}

}  // namespace ispace
