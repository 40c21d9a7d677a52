// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include "cover/map_parts.h"
#include "geom/boolean.h"
#include "raster/contour.h"

namespace ispace {

namespace {

using Curves = std::vector<Polygon>;

/// Indoor cells of a set. Cells that do not count, with the centre off the free floor, are added
/// beside free ones of the set, so that the colour of the floor reaches walls and objects, which
/// are drawn over it.
CellSet shownCells(const CellSet& seen, const Target& target) {
    const Grid& grid = target.grid;
    const auto columns = static_cast<std::size_t>(grid.columns);
    CellSet result = seen;
    result &= target.indoor;
    CellSet free = seen;
    free &= target.free;
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const std::size_t cell = grid.cell(column, row);
            if (target.free.test(cell)) continue;
            if ((column > 0 && free.test(cell - 1)) ||
                (column + 1 < grid.columns && free.test(cell + 1)) ||
                (row > 0 && free.test(cell - columns)) ||
                (row + 1 < grid.rows && free.test(cell + columns)))
                result.set(cell);
        }
    }
    return result;
}

Curves curvesOfCells(const MapPicture& map, const CellSet& seen) {
    return drawable(map, contours(map.coverage.target.grid, shownCells(seen, map.coverage.target)));
}

/// Indoor floor that at least so many sets see: its exact curves.
Curves exactCurves(const MapPicture& map, const Overlay& overlay, std::uint32_t least) {
    const auto is_seen = [least](const LayerLabel& label) {
        return (label.marks & kIndoorMark) != 0 && label.count >= static_cast<std::int32_t>(least);
    };
    return drawable(map, curvesOf(overlay.regions(is_seen)));
}

/// The same, exact where that is known, else by cells.
Curves seenCurves(const MapPicture& map, std::uint32_t least) {
    if (map.coverage.overlay) return exactCurves(map, *map.coverage.overlay, least);
    const std::vector<std::uint32_t> times = timesSeen(map.coverage);
    CellSet cells(times.size());
    for (std::size_t cell = 0; cell < times.size(); ++cell)
        if (times[cell] >= least) cells.set(cell);
    return curvesOfCells(map, cells);
}

Curves curvesOfSet(const MapPicture& map, const SeenSet& set) {
    // Both kinds are never mixed: stripes would show steps where they meet.
    if (map.coverage.overlay && set.region) return drawable(map, *set.region);
    return curvesOfCells(map, set.cells);
}

void drawRedundancy(Picture& picture, const MapPicture& map) {
    const Shades shades = shadesFor(map.coverage.report);
    // Each class is laid over those below it, so that no seam shows between two.
    for (int shade = 1; shade <= shades.count; ++shade)
        picture.area(seenCurves(map, shades.least(shade)), {shades.color(shade)});
}

/// Floor that several see: stripes in their colours, or without colours if there are many.
void drawShared(Picture& picture, const MapPicture& map, const std::vector<Curves>& sets) {
    const Curves shared = seenCurves(map, 2);
    picture.area(shared, {palette::kShared});
    if (sets.size() > kMostStriped) {
        picture.area(shared, {Hatch{palette::kSharedHatch, 0.6 * map.em, 0.08 * map.em}});
        return;
    }
    picture.pushClip(std::span(shared));
    const auto count = static_cast<double>(sets.size());
    const double width = std::max(1.2 / count, 0.3) * map.em;
    for (std::size_t i = 0; i < sets.size(); ++i)
        picture.area(sets[i], {Hatch{stripeColor(map, i), count * width, width,
                                     static_cast<double>(i) * width}});
    picture.pop();
}

void drawBySensor(Picture& picture, const MapPicture& map) {
    std::vector<Curves> sets;
    sets.reserve(map.coverage.sets.size());
    for (const SeenSet& set : map.coverage.sets) sets.push_back(curvesOfSet(map, set));
    for (std::size_t i = 0; i < sets.size(); ++i) picture.area(sets[i], {floorColor(map, i)});
    if (sets.size() > 1) drawShared(picture, map, sets);
}

/// Both, gained and lost. Those that one sees alone are drawn over what both do: where the curves
/// of the two run together, no seam shows.
void drawComparison(Picture& picture, const MapPicture& map) {
    const bool exact = map.coverage.overlay && map.other->overlay;
    const Curves now = exact ? exactCurves(map, *map.coverage.overlay, 1)
                             : curvesOfCells(map, coveredCells(map.coverage));
    const Curves before = exact ? exactCurves(map, *map.other->overlay, 1)
                                : curvesOfCells(map, coveredCells(*map.other));
    const auto outside = [&map](Curves curves) {
        const double far = map.limits().width() + map.limits().depth();
        const Point2 low = map.limits().low, high = map.limits().high;
        curves.push_back({{low.x - far, low.y - far},
                          {high.x + far, low.y - far},
                          {high.x + far, high.y + far},
                          {low.x - far, high.y + far}});
        return curves;
    };
    picture.area(now, {palette::kBoth});
    picture.area(before, {palette::kBoth});
    picture.pushClip(std::span<const Polygon>(outside(before)));
    picture.area(now, {palette::kGained});
    picture.pop();
    picture.pushClip(std::span<const Polygon>(outside(now)));
    picture.area(before, {palette::kLost});
    picture.area(before, {Hatch{palette::kLostHatch, 0.55 * map.em, 0.1 * map.em}});
    picture.pop();
}

}  // namespace

Shades shadesFor(const CoverageReport& report) {
    constexpr std::uint32_t kMostShades = 6;
    constexpr double kLeastShare = 1e-6;  // slivers of exact regions make no class
    const std::vector<double>& shares =
        report.redundancy_exact ? *report.redundancy_exact : report.redundancy;
    std::uint32_t most = 1;
    for (std::uint32_t k = 1; k < shares.size(); ++k)
        if (shares[k] > kLeastShare) most = k;
    Shades shades;
    shades.width = (most + kMostShades - 1) / kMostShades;
    shades.count = shades.of(most);
    return shades;
}

Color setColor(const MapPicture& map, std::size_t set) {
    if (map.options.color == MapColor::Redundancy) return seriesColor(set);
    // Green and purple are greys to many colour-blind people: as floor they come late and apart.
    constexpr std::array<std::size_t, kSeriesColors> kOrder = {0, 3, 1, 4, 6, 2, 5};
    return seriesColor(kOrder[set % kSeriesColors]);
}

Color floorColor(const MapPicture& map, std::size_t set) {
    const Color color = setColor(map, set);
    // Dark colours become as light as the others: marks and lines on the floor stay readable.
    return tint(color, std::min(0.4, 0.25 / (1 - lightness(color))));
}

Color stripeColor(const MapPicture& map, std::size_t set) { return tint(setColor(map, set), 0.7); }

std::vector<Polygon> outsideOf(const Regions& indoor) {
    std::vector<Point2> middles;
    middles.reserve(indoor.parts.size());
    for (const Region& part : indoor.parts) middles.push_back(interiorPoint(part));
    std::vector<Polygon> outside;
    for (const Region& part : indoor.parts)
        for (const Polygon& hole : part.holes) {
            // Other rooms in it are no outside; what lies in their holes, those add.
            std::vector<Polygon> rooms;
            for (std::size_t i = 0; i < indoor.parts.size(); ++i)
                if (&indoor.parts[i] != &part && locate(hole, middles[i]) == Side::Inside)
                    rooms.push_back(indoor.parts[i].outline);
            if (rooms.empty())
                outside.push_back(hole);
            else
                for (Polygon& curve : curvesOf(difference(Region{hole, {}}, rooms)))
                    outside.push_back(std::move(curve));
        }
    return outside;
}

void drawFloor(Picture& picture, const MapPicture& map) {
    const Regions& indoor = map.scene.environment.indoor();
    picture.area(curvesOf(indoor), {palette::kFloor});
    picture.pushClip(curvesOf(indoor));
    if (map.other != nullptr)
        drawComparison(picture, map);
    else if (map.options.color == MapColor::Sensor)
        drawBySensor(picture, map);
    else
        drawRedundancy(picture, map);
    picture.pop();
    const std::vector<Polygon> outside = outsideOf(indoor);
    picture.area(outside, {palette::kOutside});
    picture.area(outside, {Hatch{palette::kOutsideHatch, 0.7 * map.em, 0.07 * map.em, 0,
                                 Angle::degrees(-45)}});
}

}  // namespace ispace
