// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/environment.h"
#include "io/import_records.h"
#include "io/importers.h"
#include "io/map/cell_map.h"
#include "io/map/map_rooms.h"
#include "raster/morphology.h"
#include "raster/picture.h"
#include "record/text.h"

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

struct GridCells {
    MapCells free, occupied;
};

class GridMapReader {
  public:
    GridMapReader(std::string_view bytes, const std::string& name)
        : size_(bytes.size()), lines_(bytes), name_(name) {}

    GridCells read(ImportRecords& out) {
        if (const std::string_view type = header("type"); type != "octile")
            fail("found type " + excerpt(type) + ", wanted `type octile`");
        const int height = count("height"), width = count("width");
        // Each cell takes a byte, so the file size bounds the allocation.
        if (std::int64_t{width} * height > static_cast<std::int64_t>(size_))
            fail("truncated: " + std::to_string(size_) + " bytes do not hold " +
                 std::to_string(width) + " x " + std::to_string(height) + " cells");
        if (nextLine(); text_ != "map") fail("found " + excerpt(text_) + ", wanted `map`");
        GridCells cells{MapCells(width, height), MapCells(width, height)};
        for (int y = height - 1; y >= 0; --y) readRow(y, cells);
        while (nextLine())
            if (!text_.empty()) fail("more than " + std::to_string(height) + " rows");
        if (cells.free.count() == 0) fail("no cell of ground (. G or S)");
        note(out);
        return cells;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        failFile(name_, message, lines_.number());
    }

    bool nextLine() {
        const auto line = lines_.next();
        text_ = trimmed(line.value_or(""));
        return line.has_value();
    }

    std::string_view header(std::string_view key) {
        nextLine();
        const std::size_t end = std::min(text_.find_first_of(" \t"), text_.size());
        if (text_.substr(0, end) != key)
            fail("found " + excerpt(text_) + ", wanted `" + std::string(key) + '`');
        return trimmed(text_.substr(end));
    }

    int count(std::string_view key) {
        const std::string_view text = header(key);
        const auto value = parseInteger(text);
        if (!value || *value < 1 || *value > INT32_MAX)
            fail("found " + std::string(key) + ' ' + excerpt(text) + ", wanted a number of cells");
        return static_cast<int>(*value);
    }

    void readRow(int y, GridCells& cells) {
        if (!nextLine())
            fail("truncated: " + std::to_string(cells.free.height() - 1 - y) + " of " +
                 std::to_string(cells.free.height()) + " rows");
        if (text_.size() != static_cast<std::size_t>(cells.free.width()))
            fail("a row of " + countText(text_.size(), "cell") + ", wanted " +
                 std::to_string(cells.free.width()));
        for (int x = 0; x < cells.free.width(); ++x) {
            const char c = text_[static_cast<std::size_t>(x)];
            if (c == '.' || c == 'G' || c == 'S')
                cells.free.insert(x, y);
            else if (std::string_view("@OTW").find(c) != std::string_view::npos)
                cells.occupied.insert(x, y);
            else
                fail("found " + excerpt(text_.substr(static_cast<std::size_t>(x), 1)) +
                     " in a row, wanted one of . G S @ O T W");
            swamp_ += c == 'S' ? 1 : 0;
            water_ += c == 'W' ? 1 : 0;
        }
    }

    void note(ImportRecords& out) const {
        if (swamp_ > 0) out.note(countText(swamp_, "cell") + " of swamp can be walked: floor");
        if (water_ > 0) out.note(countText(water_, "cell") + " of water count as walls");
    }

    std::size_t size_;
    LineReader lines_;
    std::string_view text_;  // of the line
    const std::string& name_;
    std::size_t swamp_ = 0, water_ = 0;
};

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

bool isGridMap(std::string_view bytes) {
    const std::string_view line = trimmed(bytes.substr(0, bytes.find('\n')));
    return line.starts_with("type ") && line.find(':') == std::string_view::npos &&
           line.find('=') == std::string_view::npos;
}

Document readGridMap(std::string_view bytes, const std::string& name, const ImportOptions& options,
                     const Schemas& schemas) {
    ImportRecords out(schemas, name, options);
    GridCells cells = GridMapReader(bytes, name).read(out);
    const double resolution = options.resolution.value_or(1);
    checkCellMap(cells.free.width(), cells.free.height(), resolution, name, options.max_work);
    ImportOptions exact = options;  // the cells are a game map, not noisy measurements
    exact.simplify = options.simplify.value_or(0);
    writeCellMap({std::move(cells.free), std::move(cells.occupied), resolution, options.origin},
                 {name, "ground is . G or S"}, exact, out);
    return out.take();
}

}  // namespace ispace
