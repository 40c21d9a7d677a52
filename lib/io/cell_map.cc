// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cell_map.h"

#include "base/error.h"
#include "io/outline.h"

namespace ispace {

namespace {

/// Cells that outlines move by default: half for stairs, see outline.h, and half for noise.
constexpr double kDefaultSimplify = 1;

Point2 inMap(const CellMap& map, Point2 cells) {
    return map.map_from_grid * Point2{cells.x * map.resolution, cells.y * map.resolution};
}

Region inMap(const CellMap& map, Region region) {
    for (Point2& corner : region.outline) corner = inMap(map, corner);
    for (Polygon& hole : region.holes)
        for (Point2& corner : hole) corner = inMap(map, corner);
    return region;
}

/// The middle of the widest place; where simplification took it away, another point of the room.
Point2 insideOf(const MapCells& room, const Region& region) {
    const CellPlace widest = widestPlace(room);
    const Point2 middle{widest.x + 0.5, widest.y + 0.5};
    return region.locate(middle) == Side::Inside ? middle : interiorPoint(region);
}

}  // namespace

void writeCellMap(const CellMap& map, const CellMapSource& source, const ImportOptions& options,
                  ImportRecords& out) {
    const MapCells room = largestPiece(map.free);
    const std::size_t count = room.count();
    if (count == 0)
        throw FormatError(Diagnostic{source.file, 0, 0,
                                     "no free cell among " + std::to_string(map.free.width()) +
                                         " x " + std::to_string(map.free.height()) + ": " +
                                         source.hint_if_no_free});
    if (const std::size_t others = map.free.count() - count; others > 0)
        out.note(countText(others, "free cell") + " apart from the room dropped; the room has " +
                 std::to_string(count));
    const double tolerance =
        options.simplify ? *options.simplify / map.resolution : kDefaultSimplify;
    const Region region = vectorised(room, tolerance);
    out.region(inMap(map, region), inMap(map, insideOf(room, region)));
}

}  // namespace ispace
