// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms of a map of cells, in the steps that cell_map.h lists. Each room is cut out with a rim and
// worked on alone, so time and memory of that grow with the boxes of kept rooms, not with the map.
// Records of walls from other inputs win over the map: floor under them is restored, and cleaning
// leaves the cells beside them.
#include "io/map/cell_map.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "env/environment.h"
#include "geom/point.h"
#include "io/map/map_rooms.h"
#include "raster/contour.h"
#include "raster/morphology.h"

namespace ispace {

namespace {

/// Default tolerance of outlines, in cells: half for staircases (see contour.h), the rest for
/// noise.
constexpr double kDefaultSimplify = 1;
constexpr double kRaggedSimplify = 2;  ///< where walls are ragged by a cell on each side

/// Metres; a larger map has the wrong unit, or is not of a building.
constexpr double kMaxExtent = 10000;

/// Maximum number of cells in the bounding boxes of all rooms kept.
constexpr double kMaxCellsOfRooms = 1e9;

/// Cells that become a room in the time of one unit of Budget.
constexpr std::uint64_t kCellsPerUnit = 32;

/// Metres; a room outside these limits has probably a wrong resolution.
constexpr double kSmallRoom = 2, kLargeRoom = 2000;

/// A point that selects a room.
struct Choice {
    Point2 point;
    bool is_option = false;  ///< from --inside, not from a record of another input
    CellIndex place;
};

/// Converts cells to records, step by step.
class CellMapImport {
  public:
    CellMapImport(const CellMap& map, const CellMapSource& source, const ImportOptions& options,
                  ImportRecords& out)
        : map_(map), source_(source), options_(options), out_(out), floor_(map.free) {
        for (const Point2 p : options.inside) choices_.push_back({p, true, map.placeOf(p)});
        // Records of other inputs may refer to another room.
        for (const Point2 p : options.known_inside)
            if (isInGrid(map.placeOf(p))) choices_.push_back({p, false, map.placeOf(p)});
    }

    void run() {
        raiseBarriers();
        const CellPieces pieces(floor_, CellPieces::Joined::BySides);
        if (pieces.size() == 0)
            fail("no free cell among " + std::to_string(floor_.width()) + " x " +
                 std::to_string(floor_.height()) + ": " + source_.hint_if_no_free);
        if (!options_.close_gaps || !keepClosedRooms()) keepRooms(pieces, choose(floor_, pieces));
        if (out_.wantsRooms()) handOver(pieces);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        throw FormatError(Diagnostic{source_.file, 0, 0, message});
    }

    [[nodiscard]] bool isInGrid(CellIndex place) const {
        return place.x >= 0 && place.y >= 0 && place.x < floor_.width() &&
               place.y < floor_.height();
    }

    // Choice of the rooms

    /// Walls of other inputs block the floor while rooms are chosen.
    void raiseBarriers() {
        if (options_.known_walls.empty()) return;
        std::vector<Segment2> lines;
        for (const Segment2& wall : options_.known_walls)
            lines.push_back({map_.inCells(wall.a), map_.inCells(wall.b)});
        barrier_ = barrierCells(lines, floor_.width(), floor_.height());
        floor_ = difference(floor_, *barrier_);
    }

    /// Keeps the rooms of the map with its gaps closed. Returns false if these still reach the
    /// border: then only inner doors were closed.
    bool keepClosedRooms() {
        const MapCells cut = gapCells(floor_, *options_.close_gaps / map_.resolution);
        const MapCells closed = difference(floor_, cut);
        const CellPieces pieces(closed, CellPieces::Joined::BySides);
        const std::vector<std::size_t> rooms =
            pieces.size() == 0 ? std::vector<std::size_t>() : choose(closed, pieces);
        if (cut.count() == 0 || std::any_of(rooms.begin(), rooms.end(), [&](std::size_t room) {
                return pieces[room].border > 0;
            })) {
            out_.note("no gap of up to " + formatDouble(*options_.close_gaps) +
                      " m opens the room to the picture's border");
            return false;
        }
        reportClosedGaps(map_, cut, pieces, rooms, *options_.close_gaps, out_);
        keepRooms(pieces, rooms);
        return true;
    }

    [[nodiscard]] std::vector<std::size_t> choose(const MapCells& cells,
                                                  const CellPieces& pieces) const {
        if (choices_.empty()) {
            if (options_.rooms == RoomChoice::All)
                return closedRooms(cells, pieces, map_.resolution);
            return {likeliestRoom(pieces, map_.resolution).value()};
        }
        std::vector<std::size_t> rooms;
        for (const Choice& choice : choices_) {
            const auto room = pieces.at(choice.place);
            if (!room) refuse(choice);
            if (std::find(rooms.begin(), rooms.end(), *room) == rooms.end()) rooms.push_back(*room);
        }
        return rooms;
    }

    static std::string nameOf(const Choice& choice) {
        return (choice.is_option ? "--inside " : "inside point ") + formatDouble(choice.point.x) +
               ',' + formatDouble(choice.point.y);
    }

    [[noreturn]] void refuse(const Choice& choice) const {
        const std::string name = nameOf(choice);
        const CellIndex place = choice.place;
        const auto width = static_cast<double>(floor_.width());
        const auto height = static_cast<double>(floor_.height());
        if (!isInGrid(place))
            fail(name + " lies outside of the map, whose corners are " +
                 placeText(map_.inMap({0, 0})) + " and " + placeText(map_.inMap({width, height})));
        const char* what = map_.free.contains(place.x, place.y)       ? "on a wall that was added"
                           : map_.occupied.contains(place.x, place.y) ? "on an occupied cell"
                                                                      : "in unknown space";
        fail(name + " lies " + what + ", at pixel " + std::to_string(place.x) + ',' +
             std::to_string(floor_.height() - 1 - place.y) + "; wanted a point on free floor");
    }

    // Their records

    void keepRooms(const CellPieces& pieces, const std::vector<std::size_t>& rooms) {
        checkWork(pieces, rooms);
        Cleaning cleaning;
        std::size_t cells = 0;
        for (const std::size_t room : rooms) {
            cells += pieces[room].cells;
            keepRoom(pieces, room, cleaning);
        }
        warnOfExtent();
        reportDroppedCells(map_, pieces, rooms, options_, out_);
        reportCleaning(map_, cleaning, cells, out_);
    }

    /// The work for a room grows with its bounding box, and rooms may enclose each other.
    void checkWork(const CellPieces& pieces, const std::vector<std::size_t>& rooms) const {
        double cells = 0;
        for (const std::size_t room : rooms) {
            const CellPiece& box = pieces[room];
            cells += (box.highest.x - box.lowest.x + 1.0) * (box.highest.y - box.lowest.y + 1.0);
        }
        if (rooms.size() > 1 && cells > kMaxCellsOfRooms)
            fail(std::to_string(rooms.size()) + " rooms, whose boxes have " +
                 formatFixed(cells, 0) + " cells together, are more than " +
                 formatFixed(kMaxCellsOfRooms, 0) +
                 "; choose some with --inside, or make the cells larger");
    }

    void keepRoom(const CellPieces& pieces, std::size_t piece, Cleaning& cleaning) {
        std::vector<Choice> choices;
        for (const Choice& choice : choices_)
            if (pieces.at(choice.place) == piece) choices.push_back(choice);
        const Outlined outlined = outlinedRoom(pieces, piece, choices, cleaning, true);
        for (const Point2 corner : outlined.floor.outline) extent_.add(corner);
        out_.outline(outlined.floor);
        writeInside(outlined.floor, outlined.within, choices);
        if (!out_.wantsRooms()) return;
        const Point2 inside = choices.empty() ? outlined.within : choices.front().point;
        kept_.push_back(map_.placeOf(outlined.within));
        addFound(outlined, inside, pieces[piece].border > 0, true);
    }

    /// The floor of a room, and a point in its widest part.
    struct Outlined {
        Region floor;
        Point2 within;
    };

    void addFound(const Outlined& room, Point2 inside, bool touches_border, bool is_kept) {
        const Point2 point = room.floor.locate(inside) == Side::Inside ? inside : room.within;
        out_.room({room.floor.area(),
                   shortPointIn(room.floor, point),
                   {},
                   touches_border,
                   is_kept,
                   {room.floor}});
    }

    /// Reports the other rooms, each as it would be if a point in it chose it: rooms that closed
    /// gaps enclose with these gaps closed, the others without.
    void handOver(const CellPieces& open) {
        std::vector<std::pair<const CellPieces*, std::size_t>> rooms;
        const std::optional<MapCells> closed =
            options_.close_gaps
                ? std::optional(
                      difference(floor_, gapCells(floor_, *options_.close_gaps / map_.resolution)))
                : std::nullopt;
        const CellPieces parts(closed ? *closed : floor_, CellPieces::Joined::BySides);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (map_.area(parts[i].cells) < kMinRoomArea) continue;
            if (!closed || parts[i].border == 0) {
                rooms.emplace_back(&parts, i);
                continue;
            }
            const std::pair whole{&open, open.at(widestPlace(parts.cellsOf(i))).value()};
            if (std::find(rooms.begin(), rooms.end(), whole) == rooms.end()) rooms.push_back(whole);
        }
        std::erase_if(rooms, [this](const auto& room) {
            return std::any_of(kept_.begin(), kept_.end(), [&room](CellIndex place) {
                return room.first->at(place) == room.second;
            });
        });
        std::stable_sort(rooms.begin(), rooms.end(), [](const auto& a, const auto& b) {
            return (*a.first)[a.second].cells > (*b.first)[b.second].cells;
        });
        rooms.resize(std::min(rooms.size(), FoundRooms::kMaxRooms));
        for (const auto& [pieces, piece] : rooms) handOver(*pieces, piece);
    }

    void handOver(const CellPieces& pieces, std::size_t piece) {
        const CellIndex place = widestPlace(pieces.cellsOf(piece));
        const Point2 point = map_.middleOf(place);
        Cleaning not_told;
        try {
            addFound(outlinedRoom(pieces, piece, {{point, true, place}}, not_told, false), point,
                     pieces[piece].border > 0, false);
        } catch (const FormatError& /*too narrow for the disc*/) {
            return;
        }
    }

    /// \param talks whether messages report it
    [[nodiscard]] Outlined outlinedRoom(const CellPieces& pieces, std::size_t piece,
                                        const std::vector<Choice>& choices, Cleaning& cleaning,
                                        bool talks) {
        MapRoom room = cutOut(pieces, piece);
        std::vector<CellIndex> keep;
        keep.reserve(choices.size());
        for (const Choice& choice : choices)
            keep.push_back({choice.place.x - room.offset.x, choice.place.y - room.offset.y});
        std::optional<MapCells> raw;
        if (barrier_) raw = room.floor;
        double tolerance = options_.simplify.value_or(0) / map_.resolution;
        if (const double width = options_.clean.value_or(options_.simplify == 0 ? 0 : kNoiseWidth);
            width > 0) {
            const Cleaning own = cleanRoom(room, map_.resolution, width, keep);
            cleaning += own;
            if (!options_.simplify) tolerance = own.isRagged() ? kRaggedSimplify : kDefaultSimplify;
        }
        if (map_.wall_depth > 0) growIntoWalls(room);
        const std::optional<MapCells> rigid = besideBarriers(room);
        if (rigid)
            rigid->forEach([&](int x, int y) {
                if (raw->contains(x, y))
                    room.floor.insert(x, y);
                else
                    room.floor.erase(x, y);
            });
        if (options_.reachable) keepReachable(room, keep, talks);
        if (talks && pieces[piece].border > 0)
            warnOfBorder(map_, room, pieces.borderShare(piece), out_);
        if (barrier_) giveBack(room);
        return outlined(room, tolerance, rigid);
    }

    void growIntoWalls(MapRoom& room) const {
        grown(room.floor, map_.wall_depth).forEach([&room](int x, int y) {
            if (room.occupied.contains(x, y)) room.floor.insert(x, y);
        });
    }

    /// The cells of the map within a room's grid.
    static MapCells cutOf(const MapCells& map, const MapCells& grid, CellIndex offset) {
        MapCells cells(grid.width(), grid.height());
        const int left = std::max(offset.x, 0),
                  right = std::min(offset.x + grid.width(), map.width());
        const int top = std::min(offset.y + grid.height(), map.height());
        for (int y = std::max(offset.y, 0); y < top; ++y) {
            const auto row = map.row(y).subspan(static_cast<std::size_t>(left),
                                                static_cast<std::size_t>(right - left));
            forEachRunOf(row, [&](int first, int last) {
                cells.insertRun(y - offset.y, first + left - offset.x, last + left - offset.x);
            });
        }
        return cells;
    }

    /// Cells within two of an added wall. Cleaning moves no edge there, so that added walls still
    /// meet those of the map.
    [[nodiscard]] std::optional<MapCells> besideBarriers(const MapRoom& room) const {
        if (!barrier_) return std::nullopt;
        return grown(cutOf(*barrier_, room.floor, room.offset), 2);
    }

    /// With a rim for giveBack().
    [[nodiscard]] MapRoom cutOut(const CellPieces& pieces, std::size_t piece) const {
        constexpr int kRim = 3;
        const CellPiece& box = pieces[piece];
        const CellIndex offset{box.lowest.x - kRim, box.lowest.y - kRim};
        MapCells floor(box.highest.x - box.lowest.x + 1 + 2 * kRim,
                       box.highest.y - box.lowest.y + 1 + 2 * kRim);
        pieces.forEachRunOfPiece(piece, [&](const RowRun& run) {
            floor.insertRun(run.row - offset.y, run.first - offset.x, run.last - offset.x);
        });
        MapCells occupied = cutOf(map_.occupied, floor, offset);
        return {std::move(floor), std::move(occupied), offset};
    }

    void keepReachable(MapRoom& room, const std::vector<CellIndex>& from, bool talks) {
        const std::size_t before = room.floor.count();
        const std::string radius = formatDouble(*options_.reachable) + " m";
        room.floor = reachedByDisc(room.floor, *options_.reachable / map_.resolution, from);
        const std::size_t after = room.floor.count();
        if (after == 0)
            fail("a disc with a radius of " + radius + " does not fit " +
                 (from.empty() ? "into the room" : "over the inside point") +
                 "; give --reachable a smaller one");
        if (!talks) return;
        out_.note(areaText(map_.area(before - after)) + " of floor that no disc with a radius of " +
                  radius + " reaches dropped");
    }

    /// Adds the floor under added walls and one cell beyond, so that these walls are the border.
    void giveBack(MapRoom& room) const {
        const MapCells free = cutOf(map_.free, room.floor, room.offset);
        const MapCells near = grown(room.floor, 1);
        MapCells under(near.width(), near.height());
        cutOf(*barrier_, room.floor, room.offset).forEach([&](int x, int y) {
            if (near.contains(x, y) && free.contains(x, y)) under.insert(x, y);
        });
        grown(under, 1).forEach([&](int x, int y) {
            if (free.contains(x, y)) room.floor.insert(x, y);
        });
        // Cells that touch only at a corner are not part of the room.
        const CellPieces pieces(room.floor, CellPieces::Joined::BySides);
        const auto& list = pieces.list();
        const auto largest = std::max_element(
            list.begin(), list.end(),
            [](const CellPiece& a, const CellPiece& b) { return a.cells < b.cells; });
        room.floor = pieces.cellsOf(static_cast<std::size_t>(largest - list.begin()));
    }

    /// \param tolerance in cells
    [[nodiscard]] Outlined outlined(const MapRoom& room, double tolerance,
                                    const std::optional<MapCells>& rigid) const {
        Region region = vectorised(room.floor, tolerance, rigid ? &*rigid : nullptr);
        const CellIndex widest = widestPlace(room.floor);
        const Point2 middle{widest.x + 0.5, widest.y + 0.5};
        // Simplification may have removed the widest part.
        const Point2 within =
            region.locate(middle) == Side::Inside ? middle : interiorPoint(region);
        const auto moved = [&](Point2 p) {
            return map_.inMap({p.x + room.offset.x, p.y + room.offset.y});
        };
        for (Point2& corner : region.outline) corner = moved(corner);
        for (Polygon& hole : region.holes)
            for (Point2& corner : hole) corner = moved(corner);
        return {std::move(region), moved(within)};
    }

    void writeInside(const Region& region, Point2 within, const std::vector<Choice>& choices) {
        if (choices.empty()) return out_.inside(within);
        bool any_option = false, any_inside = false;
        for (const Choice& choice : choices) {
            if (!choice.is_option) continue;
            any_option = true;
            if (region.locate(choice.point) != Side::Inside) {
                out_.note(nameOf(choice) + " is too near to a wall and not kept");
                continue;
            }
            any_inside = true;
            out_.inside(choice.point);
        }
        if (any_option && !any_inside) out_.inside(within);
    }

    void warnOfExtent() {
        const double width = extent_.width();
        const double height = extent_.depth();
        const double larger = std::max(width, height);
        if (larger >= kSmallRoom && larger <= kLargeRoom) return;
        out_.warn("the room is " + formatFixed(width, 2) + " m x " + formatFixed(height, 2) +
                  " m; is the resolution of " + formatDouble(map_.resolution) + " m a cell meant?");
    }

    const CellMap& map_;
    const CellMapSource& source_;
    const ImportOptions& options_;
    ImportRecords& out_;
    MapCells floor_;                   ///< free cells without barriers
    std::optional<MapCells> barrier_;  ///< under walls that were added
    std::vector<Choice> choices_;
    Box2 extent_;                  ///< of the rooms written
    std::vector<CellIndex> kept_;  ///< cells in them, if the caller requires all rooms
};

}  // namespace

Point2 CellMap::inMap(Point2 cells) const {
    return map_from_grid * Point2{cells.x * resolution, cells.y * resolution};
}

Point2 CellMap::inCells(Point2 point) const {
    const Vec2 way = point - map_from_grid.position;
    const Vec2 right = unitVector(map_from_grid.heading);
    return {dot(way, right) / resolution, cross(right, way) / resolution};
}

CellIndex CellMap::placeOf(Point2 point) const {
    constexpr double kFar = 1e9;
    const Point2 cells = inCells(point);
    return {static_cast<int>(std::clamp(std::floor(cells.x), -kFar, kFar)),
            static_cast<int>(std::clamp(std::floor(cells.y), -kFar, kFar))};
}

void checkCellMap(int width, int height, double resolution, const std::string& file,
                  const WorkLimit& limit) {
    const std::string cells = std::to_string(width) + " x " + std::to_string(height) + " cells";
    if (resolution * std::max(width, height) > kMaxExtent)
        failFile(file, cells + " of " + formatDouble(resolution) + " m are more than " +
                           formatDouble(kMaxExtent) + " m: is `resolution` in metres?");
    const auto count = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    if (limit.whole != nullptr && !limit.whole->take(count / kCellsPerUnit))
        failFile(file, cells + ", and the maps of the building make " + limit.whole->excess());
}

void writeCellMap(const CellMap& map, const CellMapSource& source, const ImportOptions& options,
                  ImportRecords& out) {
    CellMapImport(map, source, options, out).run();
}

}  // namespace ispace
