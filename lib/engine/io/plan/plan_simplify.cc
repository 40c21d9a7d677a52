// SPDX-License-Identifier: GPL-3.0-or-later
// Simplifies lines by the method of D. H. Douglas and T. K. Peucker, Algorithms for the reduction
// of the number of points required to represent a digitized line, 1973, with a test more: a run is
// replaced only if no other line lies in the area between it and its chord, which keeps the
// topology of the plan (M. de Berg, M. van Kreveld, S. Schirra, Topologically correct subdivision
// simplification, 1998).
#include "io/plan/plan_lines.h"

#include <algorithm>
#include <map>
#include <utility>

#include "geom/planar_map.h"
#include "geom/polyline.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// Longest run in pieces; the method is quadratic at worst.
constexpr std::size_t kMaxRun = 500;

/// Lines this close may become one when the plan is compiled.
constexpr double kTouching = 2 * kWeldDistance;

bool touch(const Segment2& s, const Segment2& t) {
    return intersects(s, t) || distance(s.a, t) <= kTouching || distance(s.b, t) <= kTouching ||
           distance(t.a, s) <= kTouching || distance(t.b, s) <= kTouching;
}

bool shareEnd(const Segment2& s, const Segment2& t) {
    return s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b;
}

class Simplifier {
  public:
    Simplifier(const std::vector<PlanPath>& paths, double tolerance, Budget& work,
               std::span<const std::size_t> fixed)
        : paths_(paths), tolerance_(tolerance), pieces_(pathPieces(paths)), search_(pieces_, work) {
        for (const PlanPath& path : paths) {
            for (const Point2 p : path.points) ++uses_[p];
            if (path.closed) continue;
            ++uses_[path.points.front()];
            ++uses_[path.points.back()];
        }
        for (const std::size_t i : fixed) fix(i);
        for (std::size_t i = 0; i < pieces_.size(); ++i)
            for (const std::size_t k : search_.near(bounds(pieces_[i]), kTouching))
                if (k > i && !shareEnd(pieces_[i], pieces_[k]) && touch(pieces_[i], pieces_[k])) {
                    fix(i);
                    fix(k);
                }
    }

    std::vector<PlanPath> simplify() {
        std::vector<PlanPath> result;
        result.reserve(paths_.size());
        for (const PlanPath& path : paths_) {
            result.push_back(simplified(path));
            first_ += path.pieceCount();
        }
        return result;
    }

  private:
    void fix(std::size_t piece) {
        uses_[pieces_[piece].a] = 2;
        uses_[pieces_[piece].b] = 2;
    }
    [[nodiscard]] bool isJoint(Point2 p) const { return uses_.at(p) > 1; }

    PlanPath simplified(const PlanPath& path) {
        path_ = &path;
        start_ = path.closed ? startOf(path) : 0;
        const std::size_t count = path.pieceCount();
        std::vector<std::size_t> stops{0};
        for (std::size_t i = 1; i < count; ++i)
            if (isJoint(point(i)) || i - stops.back() == kMaxRun) stops.push_back(i);
        if (path.closed && stops.size() == 1) stops.push_back(farthestFromStart());
        stops.push_back(count);

        PlanPath result{{point(0)}, path.closed, path.line, path.thickness};
        for (std::size_t i = 0; i + 1 < stops.size(); ++i)
            addRun(stops[i], stops[i + 1], result.points);
        if (path.closed) result.points.pop_back();  // the first point again
        return result.points.size() < (path.closed ? 3U : 2U) ? path : result;
    }

    /// Returns a joint, else a point that is a corner.
    [[nodiscard]] std::size_t startOf(const PlanPath& path) const {
        const auto joint = std::find_if(path.points.begin(), path.points.end(),
                                        [this](Point2 p) { return isJoint(p); });
        const auto start =
            joint != path.points.end()
                ? joint
                : std::min_element(path.points.begin(), path.points.end(), LexLess());
        return static_cast<std::size_t>(start - path.points.begin());
    }
    [[nodiscard]] std::size_t farthestFromStart() const {
        std::size_t best = 1;
        for (std::size_t i = 2; i < path_->points.size(); ++i)
            if (distance(point(0), point(i)) > distance(point(0), point(best))) best = i;
        return best;
    }
    [[nodiscard]] Point2 point(std::size_t i) const {
        return path_->points[(start_ + i) % path_->points.size()];
    }

    /// Appends the kept points after `begin`, up to `end`.
    void addRun(std::size_t begin, std::size_t end, Polygon& points) const {
        thinPolyline(
            begin, end, [this](std::size_t i) { return point(i); },
            [this](std::size_t from, std::size_t to, double apart) {
                return apart <= tolerance_ && isFree(from, to);
            },
            [&](std::size_t i) { points.push_back(point(i)); });
    }

    /// Returns true if no other line lies between the run and the line that would replace it, or on
    /// that line.
    [[nodiscard]] bool isFree(std::size_t from, std::size_t to) const {
        const Segment2 line{point(from), point(to)};
        if (line.a == line.b) return false;
        Polygon run;
        Box2 box;
        for (std::size_t i = from; i <= to; ++i) {
            run.push_back(point(i));
            box.add(run.back());
        }
        const auto near = search_.near(box, kTouching);
        return std::all_of(near.begin(), near.end(), [&](std::size_t i) {
            return isOfRun(i, from, to) || isApart(pieces_[i], line, run);
        });
    }

    [[nodiscard]] bool isOfRun(std::size_t piece, std::size_t from, std::size_t to) const {
        const std::size_t count = path_->pieceCount();
        if (piece < first_ || piece >= first_ + count) return false;
        const std::size_t own = (piece - first_ + count - start_) % count;
        return from <= own && own < to;
    }

    /// Pieces that continue from the line's ends may touch it there.
    static bool isApart(const Segment2& piece, const Segment2& line, const Polygon& run) {
        const auto is_free = [&](Point2 p) {
            return p == line.a || p == line.b || locate(run, p) == Side::Outside;
        };
        if (!is_free(piece.a) || !is_free(piece.b)) return false;
        if (!shareEnd(piece, line)) return !touch(piece, line);
        const auto lies_on = [](Point2 p, const Segment2& s) {
            return p != s.a && p != s.b && distance(p, s) <= kTouching;
        };
        return !lies_on(piece.a, line) && !lies_on(piece.b, line) && !lies_on(line.a, piece) &&
               !lies_on(line.b, piece);
    }

    const std::vector<PlanPath>& paths_;
    double tolerance_;
    std::vector<Segment2> pieces_;
    NearSegments search_;
    std::map<Point2, int, LexLess> uses_;
    const PlanPath* path_ = nullptr;  // in work, counted from start_
    std::size_t start_ = 0, first_ = 0;
};

}  // namespace

std::vector<PlanPath> simplifiedPaths(const std::vector<PlanPath>& paths, double tolerance,
                                      Budget& work, std::span<const std::size_t> fixed) {
    if (!(tolerance > 0)) return paths;
    return Simplifier(paths, tolerance, work, fixed).simplify();
}

}  // namespace ispace
