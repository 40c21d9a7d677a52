// SPDX-License-Identifier: GPL-3.0-or-later
// Reads maps of ARIA and MobileSim (MobileRobots, ARIA map file format: LINES, DATA, Cairn;
// millimetres). Points of a laser become cubes on a grid unless a line explains them.
#include "extensions/maps/maps.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/budget.h"
#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "geom/pose.h"
#include "geom/predicates.h"
#include "io/import_records.h"
#include "io/plan/plan_lines.h"
#include "io/plan/plan_rooms.h"
#include "record/text.h"

namespace ispace::maps {

namespace {

constexpr std::string_view kMagic = "2D-Map";
constexpr double kCell = 0.05;      // edge of an obstacle made of points
constexpr double kEchoReach = 0.1;  // points this close to a line are its echoes
constexpr std::size_t kMaxCubes = 100'000;

/// Words separated by blanks; a quoted word may contain blanks.
std::vector<std::string_view> wordsOf(std::string_view line) {
    constexpr std::string_view kBlanks = " \t\r";
    std::vector<std::string_view> words;
    while (true) {
        line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
        if (line.empty()) return words;
        const bool quoted = line.front() == '"';
        if (quoted) line.remove_prefix(1);
        const std::size_t end =
            std::min(quoted ? line.find('"') : line.find_first_of(kBlanks), line.size());
        words.push_back(line.substr(0, end));
        line.remove_prefix(std::min(end + 1, line.size()));
    }
}

/// A rectangle, rotated about the map's origin.
struct ForbiddenArea {
    std::string name;
    Angle heading;
    Point2 a, b;  // opposite corners before turning
};

/// The contents of the map, in metres.
struct AriaMap {
    std::vector<PlanPath> lines;
    std::vector<Point2> points;
    std::vector<ForbiddenArea> areas;
    std::optional<Point2> home;
    std::map<std::string, std::size_t> left_out;  // cairns by type
};

class AriaReader {
  public:
    AriaReader(std::string_view bytes, const std::string& name) : lines_(bytes), name_(name) {}

    AriaMap read() {
        nextLine();  // the magic
        enum { Header, Lines, Points } section = Header;
        while (nextLine()) {
            if (words_.empty()) continue;
            const std::string_view first = words_.front();
            if (first == "LINES")
                section = Lines;
            else if (first == "DATA")
                section = Points;
            else if (section == Lines)
                readLine();
            else if (section == Points)
                readPoint();
            else
                readHeader(first);
        }
        checkCount(map_.lines.size(), line_count_, "line");
        checkCount(map_.points.size(), point_count_, "point");
        return std::move(map_);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        failFile(name_, message, lines_.number());
    }

    bool nextLine() {
        const auto line = lines_.next();
        if (line) words_ = wordsOf(*line);
        return line.has_value();
    }

    [[nodiscard]] double number(std::size_t word) const {
        const auto value = word < words_.size() ? parseDouble(words_[word]) : std::nullopt;
        if (!value)
            fail((word < words_.size() ? "found " + excerpt(words_[word])
                                       : std::string("the line ends early")) +
                 ", wanted a number");
        return *value;
    }
    /// Reads a point in the file's millimetres.
    [[nodiscard]] Point2 place(std::size_t word) const {
        const Point2 p{number(word) / 1000, number(word + 1) / 1000};
        if (std::max(std::abs(p.x), std::abs(p.y)) > kMaxPlanCoordinate)
            fail("a place more than " + formatDouble(kMaxPlanCoordinate / 1000) +
                 " km from the origin");
        return p;
    }
    void wantWords(std::size_t count, const char* what) const {
        if (words_.size() != count)
            fail("found " + countText(words_.size(), "word") + ", wanted " + what);
    }

    void readLine() {
        wantWords(4, "a line, x1 y1 x2 y2 in mm");
        map_.lines.push_back({{place(0), place(2)}, false, lines_.number()});
    }
    void readPoint() {
        wantWords(2, "a point, x y in mm");
        map_.points.push_back(place(0));
    }
    void readHeader(std::string_view key) {
        if (key == "Cairn:") readCairn();
        if (key == "NumLines:") line_count_ = count();
        if (key == "NumPoints:") point_count_ = count();
    }
    [[nodiscard]] std::int64_t count() const {
        const auto value = words_.size() == 2 ? parseInteger(words_[1]) : std::nullopt;
        if (!value || *value < 0) fail(excerpt(words_.front()) + ": wanted how many");
        return *value;
    }
    void checkCount(std::size_t found, std::optional<std::int64_t> wanted, const char* what) const {
        if (wanted && static_cast<std::int64_t>(found) < *wanted)
            fail(std::to_string(found) + " of " + std::to_string(*wanted) + ' ' + what +
                 "s: is the file whole?");
        if (wanted && static_cast<std::int64_t>(found) > *wanted)
            fail("found " + countText(found, what) + ", the header announces " +
                 std::to_string(*wanted));
    }

    /// Cairn: TYPE x y heading "description" ICON "name" [x1 y1 x2 y2]
    void readCairn() {
        if (words_.size() < 2) fail("a cairn without type");
        const std::string_view type = words_[1];
        if (type == "ForbiddenArea") {
            map_.areas.push_back({words_.size() > 7 ? std::string(words_[7]) : "",
                                  Angle::degrees(number(4)), place(8), place(10)});
            if (std::abs(number(4)) > 1e6) fail("a heading of " + excerpt(words_[4]));
        } else if ((type == "RobotHome" || type == "Home" || type == "Dock") && !map_.home) {
            map_.home = place(2);
        } else {
            ++map_.left_out[printable(type.substr(0, 40))];
        }
    }

    LineReader lines_;
    const std::string& name_;
    std::vector<std::string_view> words_;
    AriaMap map_;
    std::optional<std::int64_t> line_count_, point_count_;
};

/// A block of cells.
struct Cells {
    std::int64_t left, right, bottom, top;
};

/// Merges the cells of the points into blocks: runs within a row, joined if adjacent rows have the
/// same run.
std::vector<Cells> cellsOf(const std::vector<Point2>& points) {
    using Cell = std::pair<std::int64_t, std::int64_t>;  // row, column
    std::vector<Cell> cells;
    cells.reserve(points.size());
    // Whole micrometres, so that all points on a grid line fall to the same side.
    const auto cell_of = [](double metres) {
        return static_cast<std::int64_t>(std::floor(std::round(metres * 1e6) / (kCell * 1e6)));
    };
    for (const Point2 p : points) cells.emplace_back(cell_of(p.y), cell_of(p.x));
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    std::vector<Cells> blocks;
    std::map<Cell, std::size_t> open;  // block with a top run over these columns
    for (std::size_t i = 0; i < cells.size();) {
        const auto [row, left] = cells[i];
        std::int64_t right = left;
        while (++i < cells.size() && cells[i] == Cell{row, right + 1}) ++right;
        const auto [it, is_new] = open.try_emplace({left, right}, blocks.size());
        if (!is_new && blocks[it->second].top == row - 1) {
            blocks[it->second].top = row;
            continue;
        }
        it->second = blocks.size();
        blocks.push_back({left, right, row, row});
    }
    return blocks;
}

/// Bytes of a line in a map, about.
constexpr std::size_t kBytesPerLine = 20;

class AriaPlan {
  public:
    AriaPlan(AriaMap map, const std::string& name, const ImportOptions& options, ImportRecords& out)
        : map_(std::move(map)),
          name_(name),
          budget_(kBytesPerLine * map_.lines.size(), options.max_work),
          paths_(normalisedLines(map_.lines, options.snap.value_or(kDefaultSnap), budget_)) {
        std::vector<Segment2> lines = pathPieces(paths_);
        if (lines.empty())
            fail(map_.points.empty()
                     ? "a map without lines: nothing is a wall"
                     : "a map of points alone, without LINES: nothing is a wall; draw lines in "
                       "Mapper3, or export the points as a picture");
        const double crossings = sampledCrossings(lines);
        if (crossTooOften(lines, crossings))
            fail("the lines cross each other too often to be walls");
        if (!payForCrossings(crossings, lines.size(), options.rooms, budget_))
            fail("crossings of the lines make " + budget_.excess());
        if (options.simplify.value_or(0) > 0) {
            paths_ = simplifiedPaths(joinedAtEnds(paths_), *options.simplify, budget_);
            lines = pathPieces(paths_);
        }
        rooms_ = chooseRooms({lines, {}, map_.home}, options, budget_, out);
        if (rooms_.regions.empty()) return;
        const std::vector<bool> keep = belongsTo(rooms_.regions, lines);
        dropped_ = static_cast<std::size_t>(std::count(keep.begin(), keep.end(), false));
        paths_ = withPieces(paths_, keep);
    }

    void write(ImportRecords& out, const ImportOptions& options) {
        if (rooms_.reached.empty())
            for (const PlanPath& path : joinedAtEnds(paths_)) out.fence(path);
        if (options.own.get<AriaPoints>().are_obstacles) writePoints(out);
        writeAreas(out);
        writeRooms(rooms_, options, out);
        if (rooms_.regions.empty() && rooms_.writes_inside && options.inside.empty() && map_.home)
            out.inside(*map_.home);
        note(out, options);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { failFile(name_, message); }

    [[nodiscard]] bool isInside(Point2 p) const {
        return std::any_of(
            rooms_.regions.begin(), rooms_.regions.end(), [p](const PlanRegion& region) {
                return std::any_of(
                    region.rooms.begin(), region.rooms.end(),
                    [p](const Region& room) { return room.locate(p) == Side::Inside; });
            });
    }

    void writePoints(ImportRecords& out) {
        const std::vector<Segment2> lines = pathPieces(paths_);
        const NearSegments search(lines, budget_);
        std::vector<Point2> free;
        std::size_t echoes = 0, outside = 0;
        for (const Point2 p : map_.points) {
            const auto near = search.near(p, kEchoReach);
            const bool is_echo = std::any_of(near.begin(), near.end(), [&](std::size_t i) {
                return distance(p, lines[i]) <= kEchoReach;
            });
            const bool is_outside = !is_echo && !rooms_.regions.empty() && !isInside(p);
            echoes += is_echo ? 1 : 0;
            outside += is_outside ? 1 : 0;
            if (!is_echo && !is_outside) free.push_back(p);
        }
        const std::vector<Cells> blocks = cellsOf(free);
        if (blocks.size() > kMaxCubes)
            fail("the points make " + std::to_string(blocks.size()) +
                 " obstacles, wanted at most " + std::to_string(kMaxCubes) +
                 ": import the map without them");
        for (const auto& [left, right, bottom, top] : blocks) {
            const auto length = static_cast<double>(right - left + 1) * kCell;
            const auto width = static_cast<double>(top - bottom + 1) * kCell;
            out.cube({static_cast<double>(left) * kCell + length / 2,
                      static_cast<double>(bottom) * kCell + width / 2},
                     length, width);
        }
        out.note(countText(free.size(), "point") + " became " + countText(blocks.size(), "cube") +
                 "; left out: " + std::to_string(echoes) + " at lines, " + std::to_string(outside) +
                 " outside");
    }

    void writeAreas(ImportRecords& out) const {
        for (const auto& [name, heading, a, b] : map_.areas) {
            const double length = wholeMicrometres(std::abs(b.x - a.x));
            const double width = wholeMicrometres(std::abs(b.y - a.y));
            if (length == 0 || width == 0) {
                out.note("a forbidden area without extent left out");
                continue;
            }
            const Pose2 turned{{}, heading};
            const Point2 middle = turned * Point2{(a.x + b.x) / 2, (a.y + b.y) / 2};
            out.zone(out.freeId("forbidden-" + name, "forbidden"), middle, heading, length, width);
        }
    }

    void note(ImportRecords& out, const ImportOptions& options) const {
        for (const auto& [type, count] : map_.left_out)
            out.note(countText(count, type) + " left out");
        if (!options.own.get<AriaPoints>().are_obstacles && !map_.points.empty())
            out.note(countText(map_.points.size(), "point") + " left out");
        if (dropped_ > 0) out.note("left out outside of it: " + countText(dropped_, "line"));
    }

    AriaMap map_;
    const std::string& name_;
    Budget budget_;
    std::vector<PlanPath> paths_;
    PlanRooms rooms_;
    std::size_t dropped_ = 0;
};

}  // namespace

bool isAriaMap(std::string_view bytes) {
    if (!bytes.starts_with(kMagic)) return false;
    bytes.remove_prefix(kMagic.size());
    return bytes.substr(0, bytes.find('\n')).find_first_not_of(" \t\r") == std::string_view::npos;
}

Document readAriaMap(std::string_view bytes, const std::string& name, const ImportOptions& options,
                     const Schemas& schemas) {
    ImportRecords out(schemas, name, options);
    withFileName(name, [&] {
        AriaPlan(AriaReader(bytes, name).read(), name, options, out).write(out, options);
    });
    return out.take();
}

}  // namespace ispace::maps
