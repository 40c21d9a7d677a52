// SPDX-License-Identifier: GPL-3.0-or-later
// Finds doors among walls: runs of a path that bend one way are candidates for swings, straight
// lines from their hinge candidates for leaves. Drawings show swings as arcs, polylines, splines or
// quarter ellipses, so the test is loose in shape (12 % of the leaf) and strict in size.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "geom/predicates.h"
#include "io/plan/line_plan.h"
#include "io/plan/plan_lines.h"

namespace ispace {

namespace {

constexpr double kNarrowLeaf = 0.4, kWideLeaf = 1.5;  // metres
/// Tolerance of lengths and ends, as share of the leaf's width.
constexpr double kOff = 0.12;
/// Angle between the leaf and the closed door.
constexpr double kMinOpen = 5, kMaxOpen = 110;  // degrees

/// Limits of a curve: it turns one way, by less than this at each of its points, and has few.
constexpr double kMaxTurn = 35;  // degrees
constexpr std::size_t kMinChords = 2, kMaxChords = 200;
/// Metres; no swing is shorter or longer.
constexpr double kMinSwing = 0.05, kMaxSwing = 2 * kWideLeaf;

/// An end of a leaf is not free if another wall comes this close.
constexpr double kMeets = 2 * kDefaultSnap;

/// Consecutive pieces of a path that bend one way, as indices of pathPieces().
struct Run {
    std::size_t first = 0, count = 0;
    int line = 0;  ///< of the file
};

class DoorFinder {
  public:
    DoorFinder(std::vector<PlanPath> paths, Budget& work)
        : paths_(std::move(paths)),
          pieces_(pathPieces(paths_)),
          is_door_(pieces_.size()),
          work_(work) {
        std::size_t first = 0;
        for (const PlanPath& path : paths_) {
            findRuns(path, first);
            first += path.pieceCount();
        }
    }

    DrawnDoors find() {
        if (!runs_.empty()) takeDoors();
        if (!doors_.swings.empty()) dropLeafOutlines();
        is_door_.flip();
        // Without other lines these are the room, not its doors.
        const bool any_wall = std::find(is_door_.begin(), is_door_.end(), true) != is_door_.end();
        if (doors_.swings.empty() || !any_wall) return {{}, std::move(paths_)};
        doors_.walls = withPieces(std::move(paths_), is_door_);
        return std::move(doors_);
    }

  private:
    /// A line of the leaf's length from the hinge to the swing.
    struct Leaf {
        std::size_t piece;
        Point2 hinge, end, latch;  ///< `latch` is the swing's end at the closed door
    };

    static double degreesBetween(Vec2 a, Vec2 b) {
        return std::atan2(cross(a, b), dot(a, b)) * 180 / std::numbers::pi;
    }

    /// Finds the runs of one path. \param first index of its first piece
    void findRuns(const PlanPath& path, std::size_t first) {
        const std::size_t count = path.pieceCount();
        if (count < kMinChords) return;
        const auto turn_after = [&](std::size_t i) {
            const Segment2 here = pieces_[first + i], next = pieces_[first + (i + 1) % count];
            return degreesBetween(here.b - here.a, next.b - next.a);
        };
        Run run{first, 1, path.line};
        double way = 0;
        for (std::size_t i = 0; i + 1 < count; ++i) {
            const double turn = turn_after(i);
            const bool is_curve = turn != 0 && std::abs(turn) <= kMaxTurn;
            if (is_curve && (run.count == 1 || turn * way > 0)) {
                ++run.count;
                way = turn;
                continue;
            }
            keep(run);
            run = {first + i + 1, 1, path.line};
        }
        keep(run);
    }

    void keep(const Run& run) {
        if (run.count < kMinChords || run.count > kMaxChords) return;
        double length = 0, longest = 0;
        for (std::size_t i = run.first; i < run.first + run.count; ++i) {
            const double piece = distance(pieces_[i].a, pieces_[i].b);
            length += piece;
            longest = std::max(longest, piece);
        }
        if (length >= kMinSwing && length <= kMaxSwing && longest < kNarrowLeaf)
            runs_.push_back(run);
    }

    [[nodiscard]] std::span<const Segment2> of(const Run& run) const {
        return std::span(pieces_).subspan(run.first, run.count);
    }

    static bool isLeafWidth(double width) { return width >= kNarrowLeaf && width <= kWideLeaf; }

    void takeDoors() {
        std::vector<bool> is_curved(pieces_.size());
        for (const Run& run : runs_)
            std::fill_n(is_curved.begin() + static_cast<std::ptrdiff_t>(run.first), run.count,
                        true);
        std::vector<Segment2> lines;
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            if (is_curved[i] || !isLeafWidth(distance(pieces_[i].a, pieces_[i].b))) continue;
            lines.push_back(pieces_[i]);
            straight_.push_back(i);
        }
        const NearSegments search(lines, work_);
        for (const Run& run : runs_) takeDoor(run, search);
    }

    /// Finds all lines that may be the leaf of this swing. \param search of straight_
    [[nodiscard]] std::vector<Leaf> leavesOf(const Run& run, const NearSegments& search) const {
        const std::span<const Segment2> swing = of(run);
        const Point2 from = swing.front().a, to = swing.back().b;
        const Segment2 half = swing[swing.size() / 2];
        const Point2 middle = swing.size() % 2 == 0 ? half.a : half.a + 0.5 * (half.b - half.a);
        const double reach = kOff * kWideLeaf;
        std::vector<Leaf> leaves;
        for (const std::size_t k : search.near(boundsOf(swing), reach)) {
            const std::size_t i = straight_[k];
            const Segment2& line = pieces_[i];
            const double width = distance(line.a, line.b);
            const auto is_off = [width](double length) {
                return std::abs(length - width) > kOff * width;
            };
            for (const auto& [hinge, end] : {line, Segment2{line.b, line.a}}) {
                const Point2 latch = distance(end, from) < distance(end, to) ? to : from;
                if (is_off(distance(hinge, latch)) || is_off(distance(hinge, middle))) continue;
                const bool meets =
                    std::any_of(swing.begin(), swing.end(), [&, at = end](const Segment2& piece) {
                        return distance(at, piece) <= kOff * width;
                    });
                const double open = std::abs(degreesBetween(end - hinge, latch - hinge));
                if (meets && open >= kMinOpen && open <= kMaxOpen)
                    leaves.push_back({i, hinge, end, latch});
            }
        }
        return leaves;
    }

    /// Returns true if another line than those of the door ends at the leaf's free end.
    [[nodiscard]] bool isAttached(const Leaf& leaf, const Run& run) {
        if (!all_) all_.emplace(pieces_, work_);
        const auto near = all_->near(leaf.end, kMeets);
        return std::any_of(near.begin(), near.end(), [&](std::size_t i) {
            if (i == leaf.piece || (i >= run.first && i < run.first + run.count)) return false;
            const auto& [a, b] = pieces_[i];
            const double width = distance(leaf.hinge, leaf.end);
            // Another side of the leaf is no wall.
            const bool is_leaf = distance(a, {leaf.hinge, leaf.end}) <= kOff * width &&
                                 distance(b, {leaf.hinge, leaf.end}) <= kOff * width;
            return !is_leaf && std::min(distance(a, leaf.end), distance(b, leaf.end)) <= kMeets;
        });
    }

    /// Of lines to both ends of a swing one is the leaf and one the threshold or a wall: the leaf
    /// has a free end.
    void takeDoor(const Run& run, const NearSegments& search) {
        std::vector<Leaf> leaves = leavesOf(run, search);
        if (leaves.empty()) return;
        const Point2 latch = leaves.front().latch;
        const bool has_both = std::any_of(leaves.begin(), leaves.end(),
                                          [&](const Leaf& leaf) { return !(leaf.latch == latch); });
        if (has_both)
            std::stable_partition(leaves.begin(), leaves.end(),
                                  [&](const Leaf& leaf) { return !isAttached(leaf, run); });
        const Leaf door = leaves.front();
        for (const Leaf& leaf : leaves) {
            if (has_both && isAttached(leaf, run)) continue;
            is_door_[leaf.piece] = true;
        }
        std::fill_n(is_door_.begin() + static_cast<std::ptrdiff_t>(run.first), run.count, true);
        leaves_.push_back({door.hinge, door.end});
        PlanShape shape;
        shape.path = {{door.latch, door.end}, false, run.line};
        shape.chords.push_back({{door.latch, door.end}, door.hinge});
        shape.is_guess = true;
        doors_.swings.push_back(std::move(shape));
    }

    /// Removes closed outlines of leaves as a whole.
    void dropLeafOutlines() {
        if (std::none_of(paths_.begin(), paths_.end(),
                         [](const PlanPath& path) { return path.closed; }))
            return;
        const NearSegments search(leaves_, work_);
        std::size_t first = 0;
        for (const PlanPath& path : paths_) {
            const std::size_t begin = std::exchange(first, first + path.pieceCount());
            const auto end = is_door_.begin() + static_cast<std::ptrdiff_t>(first);
            const auto start = is_door_.begin() + static_cast<std::ptrdiff_t>(begin);
            if (!path.closed || std::find(start, end, true) == end) continue;
            const auto near = search.near(path.points.front(), kOff * kWideLeaf);
            const bool is_leaf = std::any_of(near.begin(), near.end(), [&](std::size_t i) {
                const double off = kOff * distance(leaves_[i].a, leaves_[i].b);
                return std::all_of(path.points.begin(), path.points.end(),
                                   [&](Point2 p) { return distance(p, leaves_[i]) <= off; });
            });
            if (is_leaf) std::fill(start, end, true);
        }
    }

    std::vector<PlanPath> paths_;
    std::vector<Segment2> pieces_;
    std::vector<bool> is_door_;  // by piece
    std::vector<Run> runs_;
    std::vector<std::size_t> straight_;  // pieces as wide as a leaf
    std::optional<NearSegments> all_;    // pieces, once needed
    std::vector<Segment2> leaves_;       // from hinge to end
    DrawnDoors doors_;
    Budget& work_;
};

}  // namespace

DrawnDoors takeDrawnDoors(std::vector<PlanPath> walls, Budget& work) {
    return DoorFinder(std::move(walls), work).find();
}

}  // namespace ispace
