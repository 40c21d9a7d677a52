// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the openings of a drawing. A symbol of a door or window is a set of chords; each is a
// candidate if its ends meet walls, see candidate(). Swings come before lines, since a line from
// hinge to the end of a swing is its leaf, not an opening. Then two opposite sides of a symbol open
// the walls between them, and last, jambs mark doorways that have no symbol at all.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "base/error.h"
#include "geom/arrangement.h"
#include "geom/planar_map.h"
#include "geom/point_map.h"
#include "geom/polygon.h"
#include "geom/predicates.h"
#include "io/plan/line_plan.h"
#include "io/plan/plan_lines.h"

namespace ispace {

namespace {

constexpr double kReach = 0.1;         // frames keep leaves and hinges off the walls
constexpr double kOnWall = 0.02;       // of lines drawn upon a wall
constexpr double kNearWall = 0.06;     // of swings that end beside the closed door
constexpr double kMinWidth = 0.4;      // metres; narrower ones are frames and jambs
constexpr double kMaxOff = 0.3;        // of the long sides of a symbol across a wall
constexpr std::size_t kMaxSides = 16;  // of such a symbol

/// Short lines across a wall at the ends of an opening, where a drawing has them.
constexpr double kMinJamb = 0.03, kMaxJamb = 0.25;  // metres
constexpr double kAcross = 0.2;                     // cosine of the angle to the wall
constexpr double kMaxDoorway = 1.3;
constexpr double kThinnestDoor = 0.03, kThickestDoor = 0.6;  // between its two thresholds
constexpr std::size_t kMinMarkedDoors = 3;

/// Every pair is compared: more are not doors.
constexpr std::size_t kMaxOpenSwings = 4000;

/// Openings on a wall that are compared for a unit of work.
constexpr std::size_t kComparedPerUnit = 32;

bool isNear(Point2 a, Point2 b) { return distance(a, b) <= kReach; }

/// The point where an end of a symbol meets the walls, and its distance.
struct Anchor {
    Point2 place;
    double apart = 0;
};

class Walls {
  public:
    Walls(std::span<const Segment2> walls, std::span<const double> thickness, Budget& work)
        : walls_(walls), thickness_(thickness), search_(walls, work) {
        for (const double each : thickness) thickest_ = std::max(thickest_, each / 2);
    }

    /// Returns the nearest end of a wall, else the nearest point of one, in reach.
    [[nodiscard]] std::optional<Anchor> anchor(Point2 p) const {
        std::optional<Anchor> corner, foot;
        const auto keep_nearest = [&](std::optional<Anchor>& best, std::size_t wall, Point2 place) {
            const double apart = std::max(0.0, distance(p, place) - halfOf(wall));
            if (apart <= kReach && (!best || apart < best->apart)) best = Anchor{place, apart};
        };
        for (const std::size_t i : search_.near(p, kReach + thickest_)) {
            keep_nearest(corner, i, walls_[i].a);
            keep_nearest(corner, i, walls_[i].b);
            keep_nearest(foot, i, nearestPoint(walls_[i], p));
        }
        if (!corner && foot) foot->place = wholeMicrometres(foot->place);
        return corner ? corner : foot;
    }

    /// Returns the nearest wall piece on which both ends lie.
    [[nodiscard]] std::optional<std::size_t> wallUnder(const Segment2& line, double reach) const {
        std::optional<std::size_t> nearest;
        for (const std::size_t i : search_.near(line.a, reach + thickest_)) {
            const double off = std::max({0.0, distance(line.a, walls_[i]) - halfOf(i),
                                         distance(line.b, walls_[i]) - halfOf(i)});
            if (nearest ? off >= reach : off > reach) continue;
            nearest = i;
            reach = off;
        }
        return nearest;
    }

    /// Returns the wall pieces along the line, at most `reach` from it at both ends.
    [[nodiscard]] std::vector<std::size_t> wallsAlong(const Segment2& line, double reach) const {
        std::vector<std::size_t> along = search_.near(line.a, reach);
        std::erase_if(along, [&](std::size_t i) {
            const auto [a, b] = walls_[i];
            const double turn = std::abs(cross(b - a, line.b - line.a));
            return distance(line.a, walls_[i]) > reach || distance(line.b, walls_[i]) > reach ||
                   turn > kReach * distance(a, b);
        });
        return along;
    }

    /// Returns the threshold opposite to an opening: the nearest piece across the wall that begins
    /// and ends where the opening does.
    [[nodiscard]] std::optional<std::size_t> threshold(const Segment2& opening) const {
        const double width = distance(opening.a, opening.b);
        const Vec2 across = perpendicular(1 / width * (opening.b - opening.a));
        std::optional<std::size_t> found;
        double nearest = kThickestDoor;
        for (const std::size_t i :
             search_.near(opening.a + 0.5 * (opening.b - opening.a), kThickestDoor)) {
            auto [a, b] = walls_[i];
            if (dot(b - a, opening.b - opening.a) < 0) std::swap(a, b);
            const double off = dot(a - opening.a, across);
            if (std::abs(off) < kThinnestDoor || std::abs(off) > nearest ||
                !isNear(a, opening.a + off * across) || !isNear(b, opening.b + off * across))
                continue;
            nearest = std::abs(off);
            found = i;
        }
        return found;
    }

    [[nodiscard]] bool isOnWall(Point2 p) const {
        const auto near = search_.near(p, kOnWall);
        return std::any_of(near.begin(), near.end(),
                           [&](std::size_t i) { return distance(p, walls_[i]) <= kOnWall; });
    }

    [[nodiscard]] const Segment2& operator[](std::size_t i) const { return walls_[i]; }
    [[nodiscard]] std::size_t size() const { return walls_.size(); }

    /// Finds the wall piece that a jamb crosses in its middle; std::nullopt if the piece is no
    /// jamb.
    [[nodiscard]] std::optional<std::size_t> wallAcross(std::size_t jamb) const {
        const auto [a, b] = walls_[jamb];
        const double length_of_it = distance(a, b);
        if (length_of_it < kMinJamb || length_of_it > kMaxJamb) return std::nullopt;
        const Point2 middle = a + 0.5 * (b - a);
        for (const std::size_t i : search_.near(middle, kOnWall)) {
            const Vec2 along = walls_[i].b - walls_[i].a;
            if (length(along) > kMaxJamb && distance(middle, walls_[i]) <= kOnWall &&
                std::abs(dot(along, b - a)) <= kAcross * length(along) * length_of_it)
                return i;
        }
        return std::nullopt;
    }

  private:
    /// Returns the distance of the faces of a wall from its line.
    [[nodiscard]] double halfOf(std::size_t wall) const {
        return thickness_.empty() ? 0 : thickness_[wall] / 2;
    }

    std::span<const Segment2> walls_;
    std::span<const double> thickness_;
    double thickest_ = 0;  // half of it
    NearSegments search_;
};

/// An arc of a door's leaf.
struct Swing {
    PlanChord chord;
    int drawn_on = 0;
    bool is_guess = false;
};

class Finder {
  public:
    /// \param has_lines whether a symbol has a straight piece, which may be the leaf of a swing
    Finder(std::span<const Segment2> walls, std::span<const double> thickness, bool has_lines,
           const DrawnSizes* sizes, Budget& work)
        : walls_(walls, thickness, work), has_lines_(has_lines), sizes_(sizes), work_(work) {}

    void find(std::span<const PlanShape> symbols, bool are_windows) {
        are_windows_ = are_windows;
        open_swings_.clear();
        for (const PlanShape& shape : symbols)
            for (const PlanChord& chord : shape.chords)
                if (chord.center) addSwing({chord, shape.path.line, shape.is_guess});
        joinDoubleDoors();
        std::vector<Segment2> closed;
        for (const PlanShape& shape : symbols) {
            closed.clear();
            for (const PlanChord& chord : shape.chords)
                if (!chord.center && !isLeaf(chord.line) && !add(chord.line, shape.path.line))
                    closed.push_back(chord.line);
            found_.unused += closed.size() - (addAcross(closed, shape.path.line) ? 2 : 0);
        }
    }

    /// Notes the symbols without an opening in reach. To be called last.
    void noteLost(std::span<const PlanShape> symbols, Budget& work) {
        std::vector<Segment2> lines;
        for (const PlanOpening& opening : found_.openings) lines.push_back(opening.line);
        const NearSegments search(lines, work);
        for (const PlanShape& shape : symbols) {
            if (shape.is_guess || shape.path.points.empty()) continue;
            const Box2 box = bounds(shape.path.points);
            const Box2 around = box.expanded(kReach);
            const auto near = search.near(box, kReach);
            if (std::none_of(near.begin(), near.end(),
                             [&](std::size_t i) { return bounds(lines[i]).meets(around); })) {
                found_.lost.push_back({shape.layer, box.center(), shape.path.line});
                found_.lost_in.push_back({box.low, box.high});
            }
        }
    }
    PlanOpenings take() { return std::move(found_); }

    /// Finds doorways between jambs: if these mark the ends of three swings or more, two others on
    /// one wall are a doorway.
    void findJambs() {
        std::map<std::size_t, std::vector<Point2>> free;  // by wall
        for (std::size_t i = 0; i < walls_.size(); ++i)
            if (const auto wall = walls_.wallAcross(i))
                free[*wall].push_back(walls_[i].a + 0.5 * (walls_[i].b - walls_[i].a));
        std::size_t marked = 0;
        for (const PlanOpening& opening : found_.openings) {
            const auto jambs = opening.wall ? free.find(*opening.wall) : free.end();
            if (jambs == free.end()) continue;
            const auto [a, b] = opening.line;
            const std::size_t used = std::erase_if(jambs->second, [&, a = a, b = b](Point2 p) {
                return isNear(p, a) || isNear(p, b);
            });
            marked += used >= 2 ? 1 : 0;
        }
        if (marked < kMinMarkedDoors) return;
        for (auto& [wall, jambs] : free) {
            const Segment2& line = walls_[wall];
            std::sort(jambs.begin(), jambs.end(), [&](Point2 p, Point2 q) {
                return dot(p - line.a, line.b - line.a) < dot(q - line.a, line.b - line.a);
            });
            for (std::size_t i = 0; i + 1 < jambs.size(); ++i) {
                const double width = distance(jambs[i], jambs[i + 1]);
                if (width < kMinWidth || width > kMaxDoorway) continue;
                keep({{wholeMicrometres(nearestPoint(line, jambs[i])),
                       wholeMicrometres(nearestPoint(line, jambs[i + 1]))},
                      wall,
                      false,
                      0});
                ++i;
            }
        }
    }

  private:
    /// Finds the opening that a line represents, and the distance of its ends from the walls.
    struct Candidate {
        PlanOpening opening;
        double apart = 0;
    };

    [[nodiscard]] std::optional<Candidate> candidate(const Segment2& line, int drawn_on,
                                                     double on_wall = kOnWall) const {
        if (distance(line.a, line.b) < kMinWidth) return std::nullopt;
        if (const auto wall = walls_.wallUnder(line, on_wall)) {
            const auto foot = [&](Point2 p) {
                return wholeMicrometres(nearestPoint(walls_[*wall], p));
            };
            return Candidate{{{foot(line.a), foot(line.b)}, wall, are_windows_, drawn_on}, 0};
        }
        const auto a = walls_.anchor(line.a), b = walls_.anchor(line.b);
        if (!a || !b || distance(a->place, b->place) < kMinWidth) return std::nullopt;
        const Point2 middle = a->place + 0.5 * (b->place - a->place);
        if (walls_.isOnWall(middle)) return std::nullopt;
        return Candidate{{{a->place, b->place}, std::nullopt, are_windows_, drawn_on},
                         a->apart + b->apart};
    }

    void keep(const PlanOpening& opening) {
        const auto [a, b] = opening.line;
        if (opening.wall) {
            std::vector<Extent>& others = on_wall_[*opening.wall];
            payForComparisons(others.size());
            const Extent mine = extentOf(opening);
            if (std::any_of(others.begin(), others.end(),
                            [&](const Extent& other) { return mine.overlaps(other); }))
                return;
            others.push_back(mine);
        } else if (!(lexLess(a, b) ? isNewGap(a, b) : isNewGap(b, a))) {
            return;
        }
        found_.openings.push_back(opening);
    }

    void payForComparisons(std::size_t count) {
        unpaid_ += count;
        if (!work_.take(unpaid_ / kComparedPerUnit))
            throw FormatError(Diagnostic{"", 0, 0, "openings on one wall make " + work_.excess()});
        unpaid_ %= kComparedPerUnit;
    }

    /// Part of a wall's face: along its direction, scaled by its length, and upright.
    struct Extent {
        double from, to, bottom, top;

        [[nodiscard]] bool overlaps(const Extent& other) const {
            return std::max(from, other.from) < std::min(to, other.to) &&
                   std::max(bottom, other.bottom) < std::min(top, other.top);
        }
    };

    [[nodiscard]] Extent extentOf(const PlanOpening& opening) const {
        constexpr double kFar = std::numeric_limits<double>::infinity();
        const auto [start, end] = walls_[*opening.wall];
        const double a = dot(opening.line.a - start, end - start);
        const double b = dot(opening.line.b - start, end - start);
        Extent extent{std::min(a, b), std::max(a, b), -kFar, kFar};
        if (sizes_ == nullptr) return extent;
        const auto size = sizes_->find(opening.drawn_on);
        if (size == sizes_->end() || !(size->second.height > 0)) return extent;
        extent.bottom = wholeMicrometres(size->second.bottom);
        extent.top = wholeMicrometres(size->second.bottom + size->second.height);
        return extent;
    }

    /// Returns true for the first opening across a gap with these ends.
    bool isNewGap(Point2 from, Point2 to) {
        std::uint32_t& latest = latest_gap_[from];
        for (std::uint32_t i = latest; i != 0; i = gaps_[i - 1].before)
            if (gaps_[i - 1].to == to) return false;
        gaps_.push_back({to, latest});
        latest = static_cast<std::uint32_t>(gaps_.size());
        return true;
    }

    bool add(const Segment2& line, int drawn_on, bool is_double_door = false) {
        const auto found = candidate(line, drawn_on);
        if (!found) return false;
        if (is_double_door)
            keepDoor(found->opening);
        else
            keep(found->opening);
        return true;
    }

    /// Opens the walls between two opposite sides of a symbol.
    bool addAcross(std::span<const Segment2> sides, int drawn_on) {
        if (sides.size() > kMaxSides) return false;
        bool found = false;
        for (std::size_t i = 0; i < sides.size() && !found; ++i)
            for (std::size_t k = i + 1; k < sides.size() && !found; ++k) {
                const auto [a, b] = sides[i];
                const bool is_turned = dot(b - a, sides[k].b - sides[k].a) < 0;
                const Segment2 other = is_turned ? Segment2{sides[k].b, sides[k].a} : sides[k];
                const Segment2 middle{a + 0.5 * (other.a - a), b + 0.5 * (other.b - b)};
                const double off = 0.5 * distance(a, other.a);
                if (off > kMaxOff || std::abs(off - 0.5 * distance(b, other.b)) > kOnWall) continue;
                for (const std::size_t wall : walls_.wallsAlong(middle, off)) {
                    const Segment2 open{wholeMicrometres(nearestPoint(walls_[wall], middle.a)),
                                        wholeMicrometres(nearestPoint(walls_[wall], middle.b))};
                    if (distance(open.a, open.b) < kMinWidth) continue;
                    keep({open, wall, are_windows_, drawn_on});
                    found = true;
                }
            }
        return found;
    }

    void addSwing(const Swing& swing) {
        const Point2 hinge = *swing.chord.center;
        const auto [a, b] = swing.chord.line;
        const double on_wall = swing.is_guess ? kNearWall : kOnWall;
        const auto first = candidate({hinge, a}, swing.drawn_on, on_wall);
        auto second = candidate({hinge, b}, swing.drawn_on, on_wall);
        if (swing.is_guess) {
            if (first && second && first->opening.wall && second->opening.wall) return;
            second.reset();
        }
        if (!first && !second) {
            open_swings_.push_back(swing);
            return;
        }
        const bool takes_first = first && (!second || first->apart <= second->apart);
        keepDoor(takes_first ? first->opening : second->opening);
        addLeaf({hinge, takes_first ? b : a});
    }

    /// Keeps a door, and opens the threshold on the other side of its wall.
    void keepDoor(const PlanOpening& opening) {
        keep(opening);
        const auto other = walls_.threshold(opening.line);
        if (!other) return;
        const auto [a, b] = walls_[*other];
        keep({{wholeMicrometres(a), wholeMicrometres(b)}, other, are_windows_, opening.drawn_on});
    }

    /// Handles arcs that end off the walls: two that meet are a double door.
    void joinDoubleDoors() {
        if (open_swings_.size() > kMaxOpenSwings) {
            for (const Swing& swing : open_swings_) found_.unused += swing.is_guess ? 0 : 1;
            return;
        }
        std::vector<bool> used(open_swings_.size());
        for (std::size_t i = 0; i < open_swings_.size(); ++i) {
            for (std::size_t k = i + 1; k < open_swings_.size() && !used[i]; ++k)
                if (!used[k] && joinLeaves(open_swings_[i], open_swings_[k]))
                    used[i] = used[k] = true;
            if (!used[i] && !open_swings_[i].is_guess) ++found_.unused;
        }
    }

    bool joinLeaves(const Swing& left, const Swing& right) {
        const Segment2 line{*left.chord.center, *right.chord.center};
        const Segment2 &l = left.chord.line, &r = right.chord.line;
        for (const auto& [p, other_p] : {std::pair{l.a, l.b}, std::pair{l.b, l.a}})
            for (const auto& [q, other_q] : {std::pair{r.a, r.b}, std::pair{r.b, r.a}}) {
                if (!isNear(p, q) || distance(p, line) > kReach) continue;
                if (!add(line, left.drawn_on, true)) continue;
                addLeaf({line.a, other_p});
                addLeaf({line.b, other_q});
                return true;
            }
        return false;
    }

    using Cell = std::pair<std::int64_t, std::int64_t>;
    [[nodiscard]] static Cell cellOf(Point2 p) {
        return {static_cast<std::int64_t>(std::floor(p.x / kReach)),
                static_cast<std::int64_t>(std::floor(p.y / kReach))};
    }
    void addLeaf(const Segment2& leaf) {
        if (has_lines_) leaves_[cellOf(leaf.a)].push_back(leaf);
    }

    [[nodiscard]] bool isLeaf(const Segment2& line) const {
        return isLeafFrom(line.a, line.b) || isLeafFrom(line.b, line.a);
    }
    [[nodiscard]] bool isLeafFrom(Point2 hinge, Point2 end) const {
        const Cell home = cellOf(hinge);
        for (std::int64_t x = home.first - 1; x <= home.first + 1; ++x)
            for (std::int64_t y = home.second - 1; y <= home.second + 1; ++y) {
                const auto leaves = leaves_.find({x, y});
                if (leaves != leaves_.end() &&
                    std::any_of(leaves->second.begin(), leaves->second.end(),
                                [&](const Segment2& leaf) {
                                    return isNear(hinge, leaf.a) && isNear(end, leaf.b);
                                }))
                    return true;
            }
        return false;
    }

    /// An opening across a gap, by its other end and the number of an earlier one from the same
    /// end, from 1; 0: none.
    struct Gap {
        Point2 to;
        std::uint32_t before = 0;
    };

    Walls walls_;
    bool has_lines_;
    const DrawnSizes* sizes_;  // null: unknown
    PlanOpenings found_;
    bool are_windows_ = false;
    std::vector<Gap> gaps_;
    PointMap<std::uint32_t> latest_gap_;  // numbers by the lower end
    Budget& work_;
    std::size_t unpaid_ = 0;  // comparisons
    std::map<std::size_t, std::vector<Extent>> on_wall_;
    std::map<Cell, std::vector<Segment2>> leaves_;  // by hinge: from there to where it is drawn
    std::vector<Swing> open_swings_;
};

}  // namespace

PlanOpenings findOpenings(std::span<const PlanShape> doors, std::span<const PlanShape> windows,
                          std::span<const Segment2> walls, Budget& work, const DrawnSizes* sizes,
                          std::span<const double> thickness) {
    if (doors.empty() && windows.empty()) return {};
    const auto has_lines = [](std::span<const PlanShape> symbols) {
        return std::any_of(symbols.begin(), symbols.end(), [](const PlanShape& shape) {
            return std::any_of(shape.chords.begin(), shape.chords.end(),
                               [](const PlanChord& chord) { return !chord.center; });
        });
    };
    Finder finder(walls, thickness, has_lines(doors) || has_lines(windows), sizes, work);
    finder.find(doors, false);
    if (std::any_of(doors.begin(), doors.end(),
                    [](const PlanShape& door) { return door.is_guess; }))
        finder.findJambs();
    finder.find(windows, true);
    finder.noteLost(doors, work);
    finder.noteLost(windows, work);
    return finder.take();
}

}  // namespace ispace
