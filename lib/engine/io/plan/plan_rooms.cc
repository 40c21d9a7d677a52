// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the rooms of a plan. The open plan is tried first; only if its rooms are missing or small
// in the drawing, widths of gaps are tried, small ones before doorways. The smallest width wins
// that encloses half of the floor of the best, since areas jump when a room closes. All widths
// share one arrangement of walls and closings (Trials), so that a trial costs a walk over its
// faces.
#include "io/plan/plan_rooms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "base/number.h"
#include "env/environment.h"
#include "geom/arrangement.h"
#include "geom/planar_map.h"
#include "io/plan/room_warnings.h"

namespace ispace {

namespace {

/// Widths of gaps to close, tried in this order unless the user gives one.
constexpr std::array kSmallGaps{0.01, 0.02, 0.05, 0.1, 0.2};
constexpr std::array kDoorways{0.4, 0.7, 0.9, 1.0, 1.2, 1.5, 2.0, 2.5};

/// Drawings with more lines or faces are tried only once: many crossing lines take long enough.
constexpr std::size_t kMaxLinesTried = 10'000, kMaxFacesTried = 1'000;

/// Wider gaps are doorways, between corners of thick walls, too.
constexpr double kMinDoorway = 0.3;

/// If all rooms are kept, smaller ones are shafts, and smaller ones inside another room are things.
constexpr double kMinRoom = 1, kMinInnerRoom = 4;

/// Metres; smaller and larger plans are in other units.
constexpr double kMinPlan = 2, kMaxPlan = 2000;

class RoomChooser {
  public:
    RoomChooser(const PlanWalls& plan, const ImportOptions& options, Budget& work,
                ImportRecords& out)
        : plan_(plan), options_(options), work_(work), out_(out), lines_(plan.lines) {
        lines_.insert(lines_.end(), options.known_walls.begin(), options.known_walls.end());
        points_ = options.inside;
        points_.insert(points_.end(), options.known_inside.begin(), options.known_inside.end());
    }

    PlanRooms choose() {
        const Box2 box = boundsOf(plan_.lines);
        const double extent = std::max(box.width(), box.depth());
        is_odd_ = !plan_.lines.empty() && (extent < kMinPlan || extent > kMaxPlan);
        if (is_odd_)
            out_.warn("the plan is " + lengthText(extent) + " m wide: is its unit right?" +
                      (plan_.unit_hint ? plan_.unit_hint() : ""));
        RoomAttempt best = chosen();
        PlanRooms rooms;
        if (out_.wantsRooms()) handOver(best);
        rooms.writes_inside = options_.known_inside.empty() || !options_.inside.empty();
        if (best.groups.empty()) {
            out_.note("nothing is enclosed: all lines are kept");
            return rooms;
        }
        for (const PlanFaces::Group* group : best.groups) {
            rooms.regions.push_back(best.faces.region(*group));
            if (points_.empty() && plan_.home && best.faces.groupAt(*plan_.home) == group)
                rooms.regions.back().inside = *plan_.home;
            const auto closing = best.faces.closedBy(rooms.regions.back());
            rooms.closing.insert(rooms.closing.end(), closing.begin(), closing.end());
        }
        for (const Segment2& gap : rooms.closing) out_.closedGap(gap);
        report(best, rooms);
        if (options_.reachable) rooms.reached = reach(rooms, *options_.reachable);
        return rooms;
    }

  private:
    /// Inside points choose among the rooms that are enclosed without them; only if one lies
    /// outside all of these, gaps are closed for the points' sake.
    RoomAttempt chosen() {
        const std::vector<Point2> points = std::exchange(points_, {});
        RoomAttempt best = likeliest();
        if (points.empty()) return best;
        points_ = points;
        wider_.reset();
        best.groups.clear();
        take(best);
        return best.is_whole ? std::move(best) : likeliest();
    }

    RoomAttempt likeliest() {
        const double width = options_.close_gaps.value_or(0);
        RoomAttempt best = attempt(width, waysUpTo(width));
        if (!options_.close_gaps && isUncertain(best)) best = closed(std::move(best));
        return best;
    }

    /// Reports the rooms of the plan; outside the kept rooms only the largest.
    void handOver(const RoomAttempt& taken) {
        const Box2 all = boundsOf(plan_.lines);
        const NearSegments walls(lines_, work_);
        std::size_t others = 0;
        for (const PlanFaces::Group& group : taken.faces.groups()) {
            const bool is_kept =
                std::find(taken.groups.begin(), taken.groups.end(), &group) != taken.groups.end();
            if (!is_kept && (others == FoundRooms::kMaxRooms || group.area < kMinRoom ||
                             !isRoom(plan_, taken.faces, group)))
                continue;
            others += is_kept ? 0 : 1;
            FoundRoom room{group.area, {}, {}, false, is_kept, {}};
            Box2 box;
            for (const std::size_t i : group.faces) {
                room.floor.push_back(taken.faces.faces()[i]);
                box.add(bounds(room.floor.back().outline).low);
                box.add(bounds(room.floor.back().outline).high);
            }
            std::vector<Segment2> near;
            for (const std::size_t i : walls.near(bounds(room.floor.front().outline), 0))
                near.push_back(lines_[i]);
            room.inside = shortPointIn(room.floor.front(), clearPoint(room.floor.front(), near));
            room.touches_border =
                std::min({box.low.x - all.low.x, box.low.y - all.low.y, all.high.x - box.high.x,
                          all.high.y - box.high.y}) <= kAtBorder;
            out_.room(std::move(room));
        }
    }

    /// Lines that could close gaps, the narrowest first, so that those up to a width are a prefix.
    struct GapLines {
        std::vector<Segment2> lines;
        std::vector<double> widths;  // of the gaps, that grow

        [[nodiscard]] std::span<const Segment2> upTo(double width) const {
            const auto end = std::upper_bound(widths.begin(), widths.end(), width);
            return std::span(lines).first(static_cast<std::size_t>(end - widths.begin()));
        }
    };

    [[nodiscard]] GapLines waysUpTo(double width) const {
        GapLines ways;
        if (!(width > 0)) return ways;
        std::vector<Point2> corners;
        if (width >= kMinDoorway) corners = PlanFaces(lines_, work_).wallCorners();
        for (const Closing& gap : closings(lines_, corners, width)) {
            const Segment2 line{wholeMicrometres(gap.line.a), wholeMicrometres(gap.line.b)};
            if (line.a == line.b) continue;
            ways.lines.push_back(line);
            ways.widths.push_back(gap.width);
        }
        return ways;
    }

    [[nodiscard]] RoomAttempt attempt(double width, const GapLines& ways) const {
        const std::span<const Segment2> closing = ways.upTo(width);
        return attemptOf(width, closing.size(), PlanFaces(lines_, work_, plan_.doors, closing));
    }

    [[nodiscard]] RoomAttempt attemptOf(double width, std::size_t closings, PlanFaces faces) const {
        RoomAttempt attempt{width, closings, std::move(faces)};
        take(attempt);
        return attempt;
    }

    void take(RoomAttempt& attempt) const {
        takeGroups(attempt);
        attempt.area = 0;
        for (const PlanFaces::Group* group : attempt.groups) attempt.area += group->area;
    }

    void takeGroups(RoomAttempt& attempt) const {
        const PlanFaces& faces = attempt.faces;
        attempt.is_whole = true;
        if (!points_.empty()) {
            std::set<const PlanFaces::Group*> taken;
            for (const Point2 p : points_) {
                const PlanFaces::Group* group = faces.groupAt(p);
                if (group == nullptr)
                    attempt.is_whole = false;
                else if (taken.insert(group).second)
                    attempt.groups.push_back(group);
            }
            return;
        }
        if (options_.rooms == RoomChoice::All) return takeAll(attempt);
        if (plan_.home) {
            const PlanFaces::Group* group = faces.groupAt(*plan_.home);
            attempt.is_whole = group != nullptr && isRoom(plan_, faces, *group);
            if (attempt.is_whole) return attempt.groups.push_back(group);
        }
        for (const PlanFaces::Group& group : faces.groups())
            if (isRoom(plan_, faces, group)) return attempt.groups.push_back(&group);
    }

    void takeAll(RoomAttempt& attempt) const {
        const PlanFaces& faces = attempt.faces;
        for (const PlanFaces::Group& group : faces.groups()) {
            if (group.area < kMinRoom || !isRoom(plan_, faces, group)) continue;
            const Point2 corner = faces.faces()[group.faces.front()].outline.front();
            const bool is_inner = std::any_of(
                attempt.groups.begin(), attempt.groups.end(), [&](const PlanFaces::Group* outer) {
                    const Region& room = faces.faces()[outer->faces.front()];
                    return std::any_of(
                        room.holes.begin(), room.holes.end(),
                        [&](const Polygon& hole) { return locate(hole, corner) != Side::Outside; });
                });
            if (!is_inner || group.area >= kMinInnerRoom) attempt.groups.push_back(&group);
        }
    }

    [[nodiscard]] bool isUncertain(const RoomAttempt& attempt) const {
        if (is_odd_) return false;  // report one warning only
        const Box2 drawn = boundsOf(plan_.lines);
        return attempt.groups.empty() || !attempt.is_whole ||
               attempt.area < kSmallShare * drawn.width() * drawn.depth();
    }

    /// Compares attempts: lines and closings are split at their crossings once for all widths, so
    /// that finding faces is a walk. Rooms are those of attempt() up to rounding.
    class Trials {
      public:
        Trials(const RoomChooser& chooser, const GapLines& ways) : chooser_(chooser), ways_(ways) {
            std::vector<Segment2> all = chooser.lines_;
            all.insert(all.end(), ways.lines.begin(), ways.lines.end());
            std::vector<LinePiece> cut = noded(linePieces(all));
            std::stable_sort(cut.begin(), cut.end(), [](const LinePiece& p, const LinePiece& q) {
                return p.line < q.line;
            });
            const std::size_t walls = chooser.lines_.size();
            std::vector<Segment2> lines, closings;
            std::vector<std::size_t> needs;
            for (const LinePiece& piece : cut) {
                (piece.line < walls ? lines : closings).push_back(piece.segment);
                if (piece.line >= walls) needs.push_back(piece.line - walls + 1);
            }
            pieces_ = PlanFaces::weldedPieces(lines, closings, chooser.work_);
            for (const std::size_t closing : pieces_.closing_of) needs_.push_back(needs[closing]);
        }

        [[nodiscard]] RoomAttempt at(double width) const {
            const std::size_t count = ways_.upTo(width).size();
            const auto end = std::upper_bound(needs_.begin(), needs_.end(), count);
            const auto pieces = static_cast<std::size_t>(end - needs_.begin());
            return chooser_.attemptOf(
                width, count, PlanFaces(pieces_, chooser_.work_, chooser_.plan_.doors, pieces));
        }

      private:
        const RoomChooser& chooser_;
        const GapLines& ways_;
        PlanFaces::Pieces pieces_;
        std::vector<std::size_t>
            needs_;  // number of closed gaps from which a piece exists; ascending
    };

    /// The attempt with the smallest width that encloses half of the best, if that is better.
    template <typename Widths>
    std::optional<RoomAttempt> smallestGood(const Widths& widths, const RoomAttempt& open) {
        std::vector<RoomAttempt> attempts;
        double best = 0;
        bool any_whole = false;
        const GapLines ways = waysUpTo(widths.back());
        const Trials trials(*this, ways);
        for (const double width : widths) {
            // Without a new gap the rooms are those of the width before.
            const std::size_t count = ways.upTo(width).size();
            if (!attempts.empty() && attempts.back().closings == count) continue;
            attempts.push_back(trials.at(width));
            any_whole = any_whole || attempts.back().is_whole;
        }
        for (const RoomAttempt& a : attempts)
            if (a.is_whole == any_whole) best = std::max(best, a.area);
        // Halves are common where plans are regular, and the areas are rounded.
        constexpr double kAlmost = 1 - 1e-9;
        if (any_whole == open.is_whole && !(best * kSmallShare * kAlmost > open.area))
            return std::nullopt;
        for (const RoomAttempt& a : attempts)
            if (a.is_whole == any_whole && a.area > 0 && a.area >= best * kSmallShare * kAlmost)
                return attempt(a.width, ways);
        return std::nullopt;
    }

    RoomAttempt closed(RoomAttempt open) {
        if (lines_.size() > kMaxLinesTried || open.faces.faces().size() > kMaxFacesTried)
            return open;
        if (auto better = smallestGood(kSmallGaps, open)) open = *std::move(better);
        if (!isUncertain(open)) return open;
        auto wide = smallestGood(kDoorways, open);
        if (!wide) return open;
        if (open.groups.empty() || !open.is_whole) return *std::move(wide);
        wider_ = {wide->width, wide->area};
        return open;
    }

    [[nodiscard]] std::vector<PlanPath> reach(const PlanRooms& rooms, double radius) const {
        std::vector<Segment2> walls = withoutPassages(lines_, plan_.doors, work_);
        walls.insert(walls.end(), rooms.closing.begin(), rooms.closing.end());
        std::vector<Region> reached;
        double floor = 0;
        for (const PlanRegion& region : rooms.regions) {
            Point2 start = region.inside;
            for (const Point2 p : points_)
                for (const Region& room : region.rooms)
                    if (room.locate(p) == Side::Inside) start = p;
            std::vector<Region> pieces = reachedFloor(region.rooms, walls, start, radius);
            if (pieces.empty())
                throw FormatError(Diagnostic{"", 0, 0,
                                             "a disc of " + lengthText(radius) +
                                                 " m does not fit at the inside point " +
                                                 placeText(start) +
                                                 ": give another with --inside, or a smaller "
                                                 "--reachable"});
            for (Region& piece : pieces) {
                floor += piece.area();
                reached.push_back(std::move(piece));
            }
        }
        out_.note("a disc of " + lengthText(radius) + " m reaches " + areaText(floor) + " of " +
                  areaText(rooms.area()));
        return reachedOutlines(reached, plan_.doors, work_);
    }

    void report(const RoomAttempt& taken, PlanRooms& rooms) {
        warnOfGaps(rooms.closing, taken.width, out_);
        std::size_t faces = 0;
        Box2 kept;
        for (const PlanRegion& region : rooms.regions)
            for (const Region& room : region.rooms) {
                ++faces;
                kept.add(bounds(room.outline).low);
                kept.add(bounds(room.outline).high);
            }
        const bool is_largest = points_.empty() && !plan_.home && rooms.regions.size() == 1;
        out_.note((is_largest ? "kept the largest region, " : "kept ") + areaText(taken.area) +
                  " in " + countText(faces, "room"));
        if (wider_)
            out_.warn("only " + areaText(taken.area) +
                      " are enclosed, the walls are open; with --close-gaps " +
                      formatDouble(wider_->first) + " it would be " + areaText(wider_->second));
        if (points_.empty() && !is_odd_ && !wider_) warnOfTheRest(plan_, taken, kept, out_);
        if (plan_.is_drawing && points_.empty() && rooms.regions.size() == 1 &&
            lines_.size() <= kMaxLinesTried)
            rooms.is_frame = warnOfFrame(plan_, lines_, taken, rooms.regions.front(), work_, out_);
        if (plan_.is_drawing) warnOfTiles(taken, out_);
    }

    const PlanWalls& plan_;
    const ImportOptions& options_;
    Budget& work_;
    ImportRecords& out_;
    std::vector<Segment2> lines_;  // with those of other inputs
    std::vector<Point2> points_;
    bool is_odd_ = false;                             // its size is no plan's
    std::optional<std::pair<double, double>> wider_;  // width and area of the attempt not taken
};

}  // namespace

double PlanRooms::area() const {
    return std::accumulate(
        regions.begin(), regions.end(), 0.0,
        [](double sum, const PlanRegion& region) { return sum + region.area(); });
}

PlanRooms chooseRooms(const PlanWalls& plan, const ImportOptions& options, Budget& work,
                      ImportRecords& out) {
    return RoomChooser(plan, options, work, out).choose();
}

void writeRooms(const PlanRooms& rooms, const ImportOptions& options, ImportRecords& out) {
    for (const PlanPath& outline : rooms.reached) out.fence(outline);
    if (rooms.reached.empty())
        for (const Segment2& line : rooms.closing)
            out.fence({{wholeMicrometres(line.a), wholeMicrometres(line.b)}, false, 0});
    if (!rooms.writes_inside) return;
    for (const Point2 p : options.inside) out.inside(p);
    if (!options.inside.empty()) return;
    for (const PlanRegion& region : rooms.regions) out.inside(region.inside);
}

std::vector<Segment2> withoutPassages(std::span<const Segment2> lines,
                                      std::span<const Segment2> passages, Budget& work,
                                      double reach) {
    const NearSegments search(passages, work);
    std::vector<Segment2> rest;
    for (const Segment2& line : lines) {
        const Vec2 along = line.b - line.a;
        if (line.a == line.b) continue;
        const auto share = [&](Point2 p) { return dot(p - line.a, along) / dot(along, along); };
        std::vector<std::pair<double, double>> open;
        for (const std::size_t i : search.near(bounds(line), reach)) {
            auto [from, to] = std::minmax({share(passages[i].a), share(passages[i].b)});
            from = std::max(from, 0.0);
            to = std::min(to, 1.0);
            const Point2 a = line.a + from * along, b = line.a + to * along;
            if (from < to && distance(a, passages[i]) <= reach && distance(b, passages[i]) <= reach)
                open.emplace_back(from, to);
        }
        std::sort(open.begin(), open.end());
        double at = 0;
        for (const auto& [from, to] : open) {
            if (from > at) rest.push_back({line.a + at * along, line.a + from * along});
            at = std::max(at, to);
        }
        if (at < 1) rest.push_back({line.a + at * along, line.b});
    }
    return rest;
}

}  // namespace ispace
