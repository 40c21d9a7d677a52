// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/walls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/number.h"
#include "env/element_schemas.h"
#include "env/environment.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

Material materialOf(const std::string& kind) {
    if (kind == "brick") return Material::Brick;
    if (kind == "wood") return Material::Wood;
    if (kind == "concrete") return Material::Concrete;
    return Material::Wall;
}

/// Returns true if the weld would merge both ends.
bool isZeroLength(const Segment2& line) { return distance(line.a, line.b) <= kWeldDistance; }

bool hasAnEnd(const Record& record) { return record.has("from") || record.has("to"); }

/// Returns the line from `from` to `to`. Reports a missing end, and keys that give the position
/// again.
/// \pre hasAnEnd(record)
std::optional<Segment2> lineByEnds(const Record& record,
                                   std::initializer_list<std::string_view> others,
                                   Diagnostics& findings) {
    for (const std::string_view other : others)
        if (record.has(other))
            findings.add(record.finding(other, record.keyword() + " has `from`/`to` and also `" +
                                                   std::string(other) +
                                                   "`: give its place one way only"));
    if (record.has("from") && record.has("to"))
        return Segment2{pointOf(record.tuple("from")), pointOf(record.tuple("to"))};
    const bool from = record.has("from");
    findings.add(record.finding(
        from ? "from" : "to",
        "`from` and `to` belong together: `" + std::string(from ? "to" : "from") + "` is missing"));
    return std::nullopt;
}

/// Computes a wall from `at`, `heading` and `size`. Returns false, with a finding, if they define
/// no wall.
bool layAlong(const Record& record, WallLine& wall, Diagnostics& findings) {
    if (!record.has("size")) {
        findings.add(record.finding("wall has no extent: give `from` and `to`, or `size`"));
        return false;
    }
    const Tuple& at = record.tuple("at");
    const Tuple& size = record.tuple("size");
    const Vec2 half = size[0] / 2 * unitVector(record.angle("heading"));
    wall.line = {pointOf(at) - half, pointOf(at) + half};
    if (size.size() > 1) wall.thickness = size[1];
    if (size.size() > 2) wall.top = size[2];
    if (at.size() > 2) wall.bottom = at[2];
    wall.top += wall.bottom;
    if (wall.top > wall.bottom) return true;
    findings.add(record.finding("size", "wall has zero height"));
    return false;
}

std::vector<WallLine> wallLine(const Record& record, Diagnostics& findings) {
    WallLine wall;
    wall.thickness = record.number("thickness");
    wall.top = record.number("height");
    wall.material = materialOf(record.text("kind"));
    const bool by_ends = hasAnEnd(record);
    if (by_ends) {
        const auto line = lineByEnds(record, {"at", "heading", "size"}, findings);
        if (!line) return {};
        wall.line = *line;
    } else if (!layAlong(record, wall, findings)) {
        return {};
    }
    if (!isZeroLength(wall.line)) return {wall};
    findings.add(record.finding(by_ends ? "to" : "size", "wall has zero length"));
    return {};
}

/// Reads the points of a fence; empty, with a finding, if it has no extent.
std::vector<Point2> fencePoints(const Record& record, Diagnostics& findings) {
    std::vector<Point2> points;
    if (hasAnEnd(record)) {
        if (const auto line = lineByEnds(record, {"path"}, findings)) points = {line->a, line->b};
    } else if (record.has("path")) {
        for (const Tuple& tuple : record.list("path")) points.push_back(pointOf(tuple));
    } else {
        findings.add(record.finding("fence has no extent: give `path`, or `from` and `to`"));
    }
    return points;
}

std::vector<WallLine> fenceLines(const Record& record, Diagnostics& findings) {
    std::vector<Point2> points = fencePoints(record, findings);
    if (points.empty()) return {};
    const std::string_view extent = record.has("path") ? "path" : "to";
    const bool closed = record.flag("closed");
    // A closed path may repeat its first point.
    if (closed && points.size() > 1 && points.front() == points.back()) points.pop_back();
    const std::size_t least = closed ? 3 : 2;
    if (points.size() < least) {
        findings.add(record.finding(extent, std::string(closed ? "closed fence" : "fence") +
                                                " has " + std::to_string(points.size()) +
                                                " points, wanted at least " +
                                                std::to_string(least)));
        return {};
    }
    if (closed) points.push_back(points.front());
    std::vector<WallLine> out;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Segment2 line{points[i], points[i + 1]};
        if (isZeroLength(line))
            findings.add(record.finding(
                extent, "fence has a piece of zero length at (" + formatDouble(line.a.x) + ", " +
                            formatDouble(line.a.y) + "): leave out the repeated point"));
        else
            out.push_back(
                {line, 0, record.number("height"), record.number("thickness"), Material::Wall});
    }
    return out;
}

std::vector<WallLine> roomLines(const Record& record, Diagnostics& findings) {
    const PlacementFrame room = standingOf(record);
    std::vector<WallLine> out;
    bool zero = false;
    forEachEdge(room.rectangle(), [&](const Segment2& line) {
        zero = zero || isZeroLength(line);
        out.push_back({line, room.bottom, room.top, 0, Material::Wall});
    });
    if (!zero) return out;
    findings.add(record.finding("size", "ispace has a wall of zero length"));
    return {};
}

}  // namespace

bool isWall(const Record& record) {
    const std::string& keyword = record.keyword();
    return keyword == "wall" || keyword == "fence" || keyword == "ispace";
}

void WallPlan::add(const WallLine& wall, std::size_t element) {
    walls.push_back(wall);
    lines.push_back(wall.line);
    owner.push_back(element);
}

std::vector<WallLine> wallLinesOf(const Record& record, Diagnostics& findings) {
    if (record.keyword() == "wall") return wallLine(record, findings);
    if (record.keyword() == "fence") return fenceLines(record, findings);
    if (record.keyword() == "ispace") return roomLines(record, findings);
    return {};
}

std::vector<Segment2> wallLines(const Record& record, Diagnostics& findings) {
    std::vector<Segment2> out;
    for (const WallLine& wall : wallLinesOf(record, findings)) out.push_back(wall.line);
    return out;
}

namespace {

/// Limit of crossings of one element before sorting, as a multiple of `most`; enough for an element
/// that crosses very many others.
constexpr std::size_t kPerElement = 16;

struct Meeting {
    Point2 place;
    bool overlap;
};

bool apart(const Segment2& s, const Segment2& t) {
    return std::max(s.a.x, s.b.x) < std::min(t.a.x, t.b.x) - kWeldDistance ||
           std::max(t.a.x, t.b.x) < std::min(s.a.x, s.b.x) - kWeldDistance ||
           std::max(s.a.y, s.b.y) < std::min(t.a.y, t.b.y) - kWeldDistance ||
           std::max(t.a.y, t.b.y) < std::min(s.a.y, s.b.y) - kWeldDistance;
}

/// Finds the overlap of two lines, if it is longer than twice the weld distance.
std::optional<Meeting> overlapOf(const Segment2& s, const Segment2& t) {
    Point2 from = s.a, to = s.a;
    bool any = false;
    const auto take = [&](Point2 p) {
        if (!any) from = p;
        // At most four points on one line: keep the two farthest from each other.
        if (!any || distance(from, p) > distance(from, to)) to = p;
        any = true;
    };
    for (const Point2 p : {s.a, s.b})
        if (distance(p, t) <= kWeldDistance) take(p);
    for (const Point2 p : {t.a, t.b})
        if (distance(p, s) <= kWeldDistance) take(p);
    if (!any || distance(from, to) <= 2 * kWeldDistance) return std::nullopt;
    return Meeting{from + 0.5 * (to - from), true};
}

/// Returns true for lines that share an end and meet nowhere else, as the other end of each is
/// farther than the weld distance from the other's line: walls of a star, at hardly any cost.
/// False if unknown.
bool fanOut(const Segment2& s, const Segment2& t) {
    const auto fan = [](Point2 from, Point2 a, Point2 b) {
        constexpr double kFar = 2 * kWeldDistance;  // with room for rounding
        const Vec2 u = a - from, v = b - from;
        const double twist = cross(u, v);
        return twist * twist > kFar * kFar * std::max(dot(u, u), dot(v, v));
    };
    if (s.a == t.a) return fan(s.a, s.b, t.b);
    if (s.a == t.b) return fan(s.a, s.b, t.a);
    if (s.b == t.a) return fan(s.b, s.a, t.b);
    return s.b == t.b && fan(s.b, s.a, t.a);
}

/// Finds the crossing or overlap of two lines.
std::optional<Meeting> meetingOf(const Segment2& s, const Segment2& t) {
    if (apart(s, t) || fanOut(s, t)) return std::nullopt;
    if (const auto overlap = overlapOf(s, t)) return overlap;
    if (!intersects(s, t)) return std::nullopt;
    // An end on the other line is no crossing, even if rounding puts it just beyond.
    for (const Point2 p : {s.a, s.b})
        if (distance(p, t) <= kWeldDistance) return std::nullopt;
    for (const Point2 p : {t.a, t.b})
        if (distance(p, s) <= kWeldDistance) return std::nullopt;
    const Vec2 along = s.b - s.a, other = t.b - t.a;
    return Meeting{s.a + cross(t.a - s.a, other) / cross(along, other) * along, false};
}

bool isBefore(const WallCrossing& c, const WallCrossing& d) {
    return std::tuple(c.a, c.b, c.place.x, c.place.y) < std::tuple(d.a, d.b, d.place.x, d.place.y);
}

bool same(const WallCrossing& c, const WallCrossing& d) {
    return c.a == d.a && c.b == d.b && c.place == d.place;
}

/// Finds the lines that may meet a line elsewhere than at a common end. Where hundreds of lines end
/// at one point only neighbours by direction may, so that a star takes no time for each pair.
class MeetingLines {
  public:
    explicit MeetingLines(std::span<const Segment2> lines) : lines_(lines), hubs_of_(lines.size()) {
        findHubs();
        std::vector<std::vector<std::size_t>> parts(hubs_.size() + 1);
        for (std::size_t i = 0; i < lines.size(); ++i)
            parts[hubs_of_[i].empty() ? hubs_.size() : hubs_of_[i].front().hub].push_back(i);
        std::vector<Box2> boxes;
        for (std::vector<std::size_t>& part : parts) {
            std::vector<Segment2> own;
            own.reserve(part.size());
            Box2& box = boxes.emplace_back(Box2{Point2(), Point2()});
            if (!part.empty()) box = Box2();
            for (const std::size_t i : part) {
                own.push_back(lines[i]);
                box.add(lines[i].a);
                box.add(lines[i].b);
            }
            trees_.push_back({SegmentTree(own), std::move(part)});
        }
        tree_of_trees_ = BoxTree(boxes);
    }

    /// Calls visit(line) for each line, maybe twice, and for some that do not meet it.
    template <typename Visit>
    void search(std::size_t line, Visit visit) const {
        const std::vector<Place>& own = hubs_of_[line];
        tree_of_trees_.search(bounds(lines_[line]).expanded(kWeldDistance), [&](std::size_t t) {
            if (std::none_of(own.begin(), own.end(), [t](const Place& at) { return at.hub == t; }))
                trees_[t].tree.search(lines_[line], kWeldDistance,
                                      [&](std::size_t i) { visit(trees_[t].lines[i]); });
        });
        for (const Place& at : own) hubs_[at.hub].searchBeside(at.ray, visit);
    }

  private:
    static constexpr std::size_t kMany = 64;
    /// A line among those of a hub.
    struct Place {
        std::size_t hub, ray;
    };
    static constexpr double kLeastLength = 16 * kWeldDistance;

    /// The lines that end at a point, by their directions.
    struct Hub {
        std::vector<std::pair<double, std::size_t>> rays;
        double shortest = std::numeric_limits<double>::infinity();

        template <typename Visit>
        void searchBeside(std::size_t at, Visit visit) const {
            // fanOut() holds beyond this angle, up to that of lines in opposite directions.
            const double near = std::asin(std::min(1.0, 4 * kWeldDistance / shortest));
            for (const bool is_left : {true, false})
                for (std::size_t n = 1; n < rays.size(); ++n) {
                    const auto& ray = rays[(at + (is_left ? n : rays.size() - n)) % rays.size()];
                    const double turn =
                        std::abs(std::remainder(ray.first - rays[at].first, 2 * std::numbers::pi));
                    if (turn > near) break;
                    visit(ray.second);
                }
        }
    };
    struct Part {
        SegmentTree tree;
        std::vector<std::size_t> lines;
    };

    void findHubs() {
        std::vector<std::pair<Point2, std::size_t>> ends;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            const auto [a, b] = lines_[i];
            if (!(distance(a, b) >= kLeastLength)) continue;
            ends.emplace_back(a, i);
            ends.emplace_back(b, i);
        }
        std::sort(ends.begin(), ends.end(), [](const auto& e, const auto& f) {
            return e.first != f.first ? lexLess(e.first, f.first) : e.second < f.second;
        });
        for (std::size_t from = 0, to = 0; from < ends.size(); from = to) {
            while (to < ends.size() && ends[to].first == ends[from].first) ++to;
            if (to - from < kMany) continue;
            Hub& hub = hubs_.emplace_back();
            for (std::size_t k = from; k < to; ++k) {
                const auto& [at, line] = ends[k];
                const Segment2& s = lines_[line];
                const Vec2 way = (s.a == at ? s.b : s.a) - at;
                hub.rays.emplace_back(std::atan2(way.y, way.x), line);
                hub.shortest = std::min(hub.shortest, length(way));
            }
            std::sort(hub.rays.begin(), hub.rays.end());
            for (std::size_t k = 0; k < hub.rays.size(); ++k)
                hubs_of_[hub.rays[k].second].push_back({hubs_.size() - 1, k});
        }
    }

    std::span<const Segment2> lines_;
    std::vector<std::vector<Place>> hubs_of_;  // of each line, at most two
    std::vector<Hub> hubs_;
    std::vector<Part> trees_;  // of the lines whose first hub it is, then of those without one
    BoxTree tree_of_trees_;
};

/// Finds the crossings of one plan line by line.
class CrossingFinder {
  public:
    explicit CrossingFinder(std::span<const Element> elements) : elements_(elements) {
        Diagnostics ignored;  // records of elements have no findings
        for (std::size_t i = 0; i < elements.size(); ++i) {
            for (const WallLine& wall : wallLinesOf(elements[i].record, ignored))
                plan_.add(wall, i);
        }
    }

    /// Returns the crossings of the first elements, at most `most`.
    [[nodiscard]] std::vector<WallCrossing> find(std::size_t most) const {
        const MeetingLines lines(plan_.lines);
        std::vector<WallCrossing> found;
        std::vector<std::size_t> later;
        std::size_t sorted = 0;  // number of crossings of earlier elements
        for (std::size_t i = 0; i < plan_.lines.size(); ++i) {
            if (i > 0 && plan_.owner[i] != plan_.owner[i - 1]) sortFrom(sorted, found);
            if (found.size() >= most &&
                (found.size() == sorted || found.size() / kPerElement >= most))
                break;
            later.clear();
            lines.search(i, [&](std::size_t k) {
                if (k > i && mayCross(i, k)) later.push_back(k);
            });
            std::sort(later.begin(), later.end());
            later.erase(std::unique(later.begin(), later.end()), later.end());
            for (const std::size_t k : later) add(i, k, found);
        }
        sortFrom(sorted, found);
        found.resize(std::min(found.size(), most));
        return found;
    }

  private:
    [[nodiscard]] bool areRooms(std::size_t i, std::size_t k) const {
        const auto is_room = [&](std::size_t line) {
            return elements_[plan_.owner[line]].record.keyword() == "ispace";
        };
        return is_room(i) && is_room(k);
    }

    /// Returns false for lines of one element, and for coincident walls of two rooms.
    [[nodiscard]] bool mayCross(std::size_t i, std::size_t k) const {
        return plan_.owner[i] != plan_.owner[k] &&
               !(plan_.lines[i] == plan_.lines[k] && areRooms(i, k));
    }

    void add(std::size_t i, std::size_t k, std::vector<WallCrossing>& found) const {
        const auto meeting = meetingOf(plan_.lines[i], plan_.lines[k]);
        if (!meeting || (meeting->overlap && areRooms(i, k))) return;
        found.push_back({plan_.owner[i], plan_.owner[k], meeting->place, meeting->overlap});
    }

    /// Sorts the crossings found since and removes duplicates.
    static void sortFrom(std::size_t& sorted, std::vector<WallCrossing>& found) {
        const auto first = found.begin() + static_cast<std::ptrdiff_t>(sorted);
        std::sort(first, found.end(), isBefore);
        found.erase(std::unique(first, found.end(), same), found.end());
        sorted = found.size();
    }

    std::span<const Element> elements_;
    WallPlan plan_;
};

}  // namespace

std::vector<WallCrossing> wallCrossings(std::span<const Element> elements, std::size_t most) {
    return CrossingFinder(elements).find(most);
}

}  // namespace ispace
