// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of a map's import: floor that is not kept, openings in the border of the picture, noise,
// closed gaps; and pictures without map.yaml.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/error.h"
#include "base/number.h"
#include "env/environment.h"
#include "io/import_records.h"
#include "io/importers.h"
#include "io/map/cell_map.h"
#include "io/map/map_rooms.h"
#include "raster/morphology.h"
#include "raster/picture.h"

namespace ispace {

namespace {

constexpr double kMinOpening = 0.5;   ///< metres of the picture's border
constexpr double kMaxDoor = 1.2;      ///< metres
constexpr double kGapOfPoints = 0.3;  ///< metres between points of a wall: not reported one by one
constexpr double kShareBehindDoor = 0.1;  ///< of the floor, for a warning

/// Returns for each piece whether it is one of the rooms.
std::vector<bool> areRooms(const CellPieces& pieces, const std::vector<std::size_t>& rooms) {
    std::vector<bool> are(pieces.size());
    for (const std::size_t room : rooms) are[room] = true;
    return are;
}

/// Writes a point as options take it.
std::string pointText(Point2 p) { return formatFixed(p.x, 2) + ',' + formatFixed(p.y, 2); }

/// A run of floor along an edge of the picture.
struct Opening {
    int length = 0;
    Point2 middle;  ///< in cells
};

std::vector<Opening> openingsOf(const CellMap& map, const MapRoom& room) {
    std::vector<Opening> openings;
    const auto follow = [&](CellIndex at, CellIndex step, int count) {
        int length = 0;
        for (int i = 0; i <= count; ++i) {
            const CellIndex place{at.x + i * step.x, at.y + i * step.y};
            if (i < count &&
                room.floor.contains(place.x - room.offset.x, place.y - room.offset.y)) {
                ++length;
                continue;
            }
            if (length > 0) {
                const double back = (length + 1) / 2.0;
                openings.push_back(
                    {length, {place.x + 0.5 - back * step.x, place.y + 0.5 - back * step.y}});
            }
            length = 0;
        }
    };
    const int width = map.free.width(), height = map.free.height();
    follow({0, 0}, {1, 0}, width);
    follow({0, height - 1}, {1, 0}, width);
    follow({0, 0}, {0, 1}, height);
    follow({width - 1, 0}, {0, 1}, height);
    return openings;
}

/// Finds the largest part of a room that closing doors would separate from the picture's border.
struct BehindDoor {
    std::size_t cells = 0;
    CellIndex place;
};

BehindDoor behindDoors(const CellMap& map, const MapRoom& room) {
    // In a grid without margin around the picture.
    MapCells floor(map.free.width(), map.free.height());
    for (int y = 0; y < room.floor.height(); ++y)
        for (int x = 0; x < room.floor.width(); ++x)
            if (room.floor.contains(x, y)) floor.insert(x + room.offset.x, y + room.offset.y);
    const MapCells cut = gapCells(floor, kMaxDoor / map.resolution);
    const CellPieces pieces(difference(floor, cut), CellPieces::Joined::BySides);
    BehindDoor result;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (pieces[i].border > 0 || pieces[i].cells <= result.cells) continue;
        result = {pieces[i].cells, {}};
        result.place = widestPlace(pieces.cellsOf(i));
    }
    return result;
}

void warnOfOpenings(const CellMap& map, const MapRoom& room, ImportRecords& out) {
    std::vector<Opening> openings = openingsOf(map, room);
    std::erase_if(openings, [&map](const Opening& opening) {
        return opening.length * map.resolution < kMinOpening;
    });
    if (openings.empty()) return;
    const Opening widest =
        *std::max_element(openings.begin(), openings.end(),
                          [](const auto& a, const auto& b) { return a.length < b.length; });
    out.warn(
        "the room leaves the picture over " + formatFixed(widest.length * map.resolution, 2) +
        " m at " + placeText(map.inMap(widest.middle)) +
        (openings.size() == 1 ? "" : " and at " + countText(openings.size() - 1, "other place")) +
        "; --fence closes it where it should end");
}

/// Returns a diagonal of the box around a gap's cells, in the direction of the gap.
Segment2 acrossGap(const CellMap& map, const CellPieces& gaps, std::size_t gap) {
    const CellIndex low = gaps[gap].lowest, high = gaps[gap].highest;
    const bool rises = 2 * gaps[gap].first.x <= low.x + high.x;  // the lowest cell lies on the left
    const double left = rises ? low.y : high.y + 1, right = rises ? high.y + 1 : low.y;
    return {map.inMap({static_cast<double>(low.x), left}), map.inMap({high.x + 1.0, right})};
}

}  // namespace

void reportDroppedCells(const CellMap& map, const CellPieces& pieces,
                        const std::vector<std::size_t>& rooms, const ImportOptions& options,
                        ImportRecords& out) {
    std::size_t kept = 0, all = 0, indoor = 0;
    std::optional<std::size_t> largest;
    const std::vector<bool> are_rooms = areRooms(pieces, rooms);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const std::size_t cells = pieces[i].cells;
        const bool is_room = are_rooms[i];
        all += cells;
        if (is_room) kept += cells;
        if (!is_room && pieces.borderShare(i) > kOutsideShare) continue;
        indoor += cells;
        if (!is_room && (!largest || cells > pieces[*largest].cells)) largest = i;
    }
    if (kept == all) return;
    const bool is_chosen = !options.inside.empty() || !options.known_inside.empty();
    if (is_chosen || !largest || 2 * kept >= indoor) {
        out.note(countText(all - kept, "free cell") +
                 (rooms.size() == 1 ? " apart from the room dropped; the room has "
                                    : " apart from the rooms dropped; the rooms have ") +
                 std::to_string(kept));
        return;
    }
    const Point2 place = map.middleOf(widestPlace(pieces.cellsOf(*largest)));
    out.warn("less than half of the free floor is kept, " + areaText(map.area(kept)) + " of " +
             areaText(map.area(indoor)) + "; --inside " + pointText(place) +
             " chooses the largest region left out, " + areaText(map.area(pieces[*largest].cells)) +
             (options.rooms == RoomChoice::All ? "" : ", and --rooms all keeps every closed room"));
}

void warnOfBorder(const CellMap& map, const MapRoom& room, double border_share,
                  ImportRecords& out) {
    if (border_share <= kOutsideShare) return warnOfOpenings(map, room, out);
    const BehindDoor inner = behindDoors(map, room);
    const auto cells = static_cast<double>(inner.cells);
    if (cells < kShareBehindDoor * static_cast<double>(room.floor.count())) return;
    out.warn("the room runs along " + formatFixed(100 * border_share, 0) +
             "% of the picture's border and may be the outside; --close-gaps " +
             formatDouble(kMaxDoor) + " parts " + areaText(map.area(inner.cells)) + " at " +
             placeText(map.middleOf(inner.place)) + " from it");
}

void reportCleaning(const CellMap& map, const Cleaning& cleaning, std::size_t cells,
                    ImportRecords& out) {
    const std::size_t filled = cleaning.speck_cells + cleaning.slit_cells;
    if (filled + cleaning.spike_cells == 0) return;
    std::string text = "below the map's noise: " + countText(cleaning.specks, "speck") +
                       " and slits of " + areaText(map.area(filled)) + " became floor, " +
                       countText(cleaning.spikes, "spike") + " of " +
                       areaText(map.area(cleaning.spike_cells)) + " went; --clean 0 keeps them";
    const bool is_much = cleaning.spike_cells > cells / 100;
    is_much ? out.warn(std::move(text)) : out.note(std::move(text));
}

void reportClosedGaps(const CellMap& map, const MapCells& cut, const CellPieces& pieces,
                      const std::vector<std::size_t>& rooms, double widest, ImportRecords& out) {
    const CellPieces gaps(cut, CellPieces::Joined::ByCorners);
    const std::vector<bool> are_rooms = areRooms(pieces, rooms);
    std::vector<bool> is_ours(gaps.size());
    gaps.forEachRun([&](const RowRun& run, std::size_t gap) {
        for (int x = run.first; x <= run.last; ++x)
            for (const CellIndex side : kSides)
                if (const auto piece = pieces.at({x + side.x, run.row + side.y});
                    piece && are_rooms[*piece])
                    is_ours[gap] = true;
    });
    std::size_t count = 0;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        if (!is_ours[i]) continue;
        ++count;
        if (map.wall_depth > 0 && gaps[i].extent() * map.resolution <= kGapOfPoints) continue;
        out.closedGap(acrossGap(map, gaps, i));
        const Point2 middle{(gaps[i].lowest.x + gaps[i].highest.x + 1) / 2.0,
                            (gaps[i].lowest.y + gaps[i].highest.y + 1) / 2.0};
        out.note("a gap of " + formatFixed(gaps[i].extent() * map.resolution, 2) +
                 " m is closed at " + placeText(map.inMap(middle)));
    }
    out.note(countText(count, "gap") + " of up to " + formatDouble(widest) + " m closed");
}

namespace {

/// Pixels with a lower opacity show the background.
constexpr std::uint8_t kOpaque = 128;
/// Shade that map_server writes for unknown, of 255.
constexpr int kUnknownGrey = 205;

/// Returns the picture with its transparent pixels unknown.
GreyPicture onUnknown(GreyPicture image) {
    const auto unknown = static_cast<std::uint16_t>(image.max_value * kUnknownGrey / 255);
    for (std::size_t i = 0; i < image.opacity.size(); ++i)
        if (image.opacity[i] < kOpaque) image.samples[i] = unknown;
    image.opacity.clear();
    return image;
}

}  // namespace

Document readBarePicture(std::string_view bytes, const std::string& name,
                         const ImportOptions& options, const Schemas& schemas) {
    if (!options.resolution)
        failFile(
            name,
            "a picture does not say how large its pixels are: say it with `envc --resolution M` "
            "(metres a pixel), or name the map.yaml that goes with it");
    const auto read_cells = [&]() -> CellMap {
        const GreyPicture image = onUnknown(parsePicture(bytes, name));
        checkCellMap(image.width, image.height, *options.resolution, name, options.max_work);
        OccupancyRule rule;
        rule.unknown_is_free = options.unknown == "free";
        return {freeCells(image, rule), occupiedCells(image, rule), *options.resolution,
                options.origin};
    };
    ImportRecords out(schemas, name, options);
    writeCellMap(read_cells(),
                 {name, "what is white is free; with a map.yaml, `negate: 1` turns that about"},
                 options, out);
    return out.take();
}

}  // namespace ispace
