// SPDX-License-Identifier: GPL-3.0-or-later
// Normalises hand-drawn lines. Points are welded in their order, each to the nearest earlier
// representative, so the result depends on the order of the file alone, and no chain of near points
// collapses: representatives are at least the reach apart. All coordinates are whole micrometres
// afterwards.
#include "io/plan/plan_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "geom/planar_map.h"
#include "geom/point_map.h"
#include "geom/predicates.h"
#include "geom/tolerance.h"

namespace ispace {

NearSegments::NearSegments(std::span<const Segment2> segments, Budget& work)
    : tree_(boundsOfEach(segments)), work_(work) {}

std::vector<std::size_t> NearSegments::near(Point2 p, double reach) const {
    Box2 box;
    box.add(p);
    return near(box, reach);
}

std::vector<std::size_t> NearSegments::near(const Box2& box, double reach) const {
    constexpr std::size_t kMaxRepeats = 8;
    std::vector<std::size_t> found;
    found.reserve(kMaxRepeats);
    tree_.search(box.expanded(reach), [&found](std::size_t i) { found.push_back(i); });
    unpaid_ += found.size();
    if (!work_.take(unpaid_ / kFoundPerUnit))
        throw FormatError(Diagnostic{"", 0, 0,
                                     "lines close to each other make " + work_.excess() +
                                         "; leave hatching and doubles out"});
    unpaid_ %= kFoundPerUnit;
    std::sort(found.begin(), found.end());
    return found;
}

namespace {

/// Finds the representative of each point: the nearest earlier one within reach, else itself.
class PointWelder {
  public:
    explicit PointWelder(double reach) : reach_(reach) {}

    Point2 standing(Point2 p) {
        if (reach_ == 0) return p;
        best_ = kNone;
        nearest_ = reach_;
        const Vec2 margin{reach_, reach_};
        const Point2 low = cellOf(p - margin, kWide * reach_);
        const Point2 high = cellOf(p + margin, kWide * reach_);
        for (double x = low.x; x <= high.x; ++x)
            for (double y = low.y; y <= high.y; ++y) look({x, y}, p);
        if (best_ != kNone) return standing_[best_].at;
        Cell& cell = cells_[cellOf(p, kWide * reach_)];
        standing_.push_back({p, std::exchange(cell.latest, size())});
        return p;
    }

  private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    /// Representatives are apart, so a cell of a few reaches holds few of them.
    static constexpr double kWide = 8;

    struct Cell {
        std::uint32_t latest = kNone;
    };
    struct Standing {
        Point2 at;
        std::uint32_t next;  // in the same cell
    };

    [[nodiscard]] std::uint32_t size() const {
        return static_cast<std::uint32_t>(standing_.size());
    }

    /// Plans end at 1000 km, and the reach is a micrometre or more: whole numbers are exact.
    [[nodiscard]] static Point2 cellOf(Point2 p, double size) {
        return {std::floor(p.x / size), std::floor(p.y / size)};
    }

    /// Of two that are equally near, the one farther left counts, then the lower, then the earlier
    /// one, in steps of the reach.
    [[nodiscard]] bool isBefore(std::uint32_t i, std::uint32_t k) const {
        const Point2 a = cellOf(standing_[i].at, reach_), b = cellOf(standing_[k].at, reach_);
        return a == b ? i < k : lexLess(a, b);
    }

    void look(Point2 cell, Point2 p) {
        const Cell* found = cells_.find(cell);
        if (found == nullptr) return;
        for (std::uint32_t i = found->latest; i != kNone; i = standing_[i].next) {
            const double apart = distance(p, standing_[i].at);
            if (apart > nearest_ || (apart == nearest_ && best_ != kNone && !isBefore(i, best_)))
                continue;
            best_ = i;
            nearest_ = apart;
        }
    }

    double reach_;
    PointMap<Cell> cells_;
    std::vector<Standing> standing_;
    std::uint32_t best_ = kNone;
    double nearest_ = 0;
};

/// Merges equal neighbours and drops paths without extent.
void dropRepeatedPoints(std::vector<PlanPath>& paths) {
    for (PlanPath& path : paths) {
        path.points.erase(std::unique(path.points.begin(), path.points.end()), path.points.end());
        while (path.closed && path.points.size() > 1 && path.points.front() == path.points.back())
            path.points.pop_back();
        if (path.closed && path.points.size() == 2) path.closed = false;
    }
    std::erase_if(paths, [](const PlanPath& path) { return path.points.size() < 2; });
}

/// Moves ends that lie on no other path onto the nearest piece within reach.
class EndMover {
  public:
    EndMover(const std::vector<PlanPath>& paths, double reach, Budget& work)
        : pieces_(pathPieces(paths)), reach_(reach), work_(work) {
        parallelInvoke(
            pieces_.size() > kManyPieces,
            [&] {
                for (const PlanPath& path : paths)
                    for (const Point2 p : path.points) ++uses_[p];
            },
            [this] { index(); });
    }

    /// Moves the ends of open paths, which are those of the constructor.
    void move(std::vector<PlanPath>& paths) const {
        parallelChunks(grid_ && paths.size() > kManyPieces, paths.size(),
                       [&](std::size_t first, std::size_t last) {
                           for (std::size_t i = first; i < last; ++i) {
                               if (paths[i].closed) continue;
                               Polygon& points = paths[i].points;
                               const Point2 front = moved(points.front());
                               points.back() = moved(points.back());
                               points.front() = front;
                           }
                       });
    }

  private:
    static constexpr std::size_t kManyPieces = 10'000;
    /// Pairs of pieces in the cells of a grid: one with more is crowded, and a tree finds fewer.
    static constexpr std::size_t kGridPairsPerPiece = 64, kGridPairsAnyway = 1U << 20;

    void index() {
        grid_.emplace(pieces_, reach_);
        std::size_t pairs = 0;
        grid_->forEachCell(
            [&](std::span<const std::uint32_t> cell) { pairs += cell.size() * cell.size(); });
        if (pairs <= kGridPairsAnyway + kGridPairsPerPiece * pieces_.size()) return;
        grid_.reset();
        tree_.emplace(pieces_, work_);
    }

    [[nodiscard]] Point2 moved(Point2 end) const {
        if (*uses_.find(end) > 1) return end;
        Nearest best{end, reach_};
        if (grid_)
            for (const std::uint32_t i : grid_->near(end)) approach(i, end, best);
        else
            for (const std::size_t i : tree_->near(end, reach_)) approach(i, end, best);
        return best.foot;
    }

    struct Nearest {
        Point2 foot;
        double apart;
    };

    /// Of pieces that are equally near, the last one counts.
    void approach(std::size_t i, Point2 end, Nearest& best) const {
        const Segment2& piece = pieces_[i];
        if (piece.a == end || piece.b == end) return;
        const Vec2 margin{reach_, reach_};
        if (!bounds(piece).meets({end - margin, end + margin})) return;
        const Point2 foot = nearestPoint(piece, end);
        if (const double apart = distance(foot, end); apart <= best.apart)
            best = {wholeMicrometres(foot), apart};
    }

    std::vector<Segment2> pieces_;
    std::optional<SegmentGrid> grid_;
    std::optional<NearSegments> tree_;  // instead of a crowded grid
    double reach_;
    Budget& work_;
    PointMap<int> uses_;
};

/// Adds the path that begins or ends where `path` ends.
void append(PlanPath& path, const PlanPath& next) {
    Polygon& points = path.points;
    if (next.points.front() == points.back())
        points.insert(points.end(), next.points.begin() + 1, next.points.end());
    else
        points.insert(points.end(), next.points.rbegin() + 1, next.points.rend());
}

/// Finds the ends of open paths by their positions.
class PathJoiner {
  public:
    explicit PathJoiner(std::vector<PlanPath> paths)
        : paths_(std::move(paths)), used_(paths_.size()) {
        for (std::size_t i = 0; i < paths_.size(); ++i) {
            if (paths_[i].closed) continue;
            add(paths_[i].points.front(), i);
            add(paths_[i].points.back(), i);
        }
    }

    std::vector<PlanPath> join() {
        std::vector<PlanPath> all;
        for (std::size_t i = 0; i < paths_.size(); ++i) {
            if (used_[i]) continue;
            all.push_back(paths_[i].closed ? std::move(paths_[i]) : chainFrom(i));
        }
        return all;
    }

  private:
    PlanPath chainFrom(std::size_t first) {
        used_[first] = true;
        PlanPath chain = std::move(paths_[first]);
        Polygon& points = chain.points;
        extend(chain);
        if (points.front() != points.back()) {
            std::reverse(points.begin(), points.end());
            extend(chain);
            std::reverse(points.begin(), points.end());
        }
        if (points.front() == points.back()) {
            points.pop_back();
            chain.closed = true;
        }
        return chain;
    }

    void extend(PlanPath& chain) {
        while (chain.points.front() != chain.points.back()) {
            const Ends& meeting = *ends_.find(chain.points.back());
            if (meeting.count != 2) return;
            const std::size_t next = meeting.paths[used_[meeting.paths[0]] ? 1 : 0];
            if (used_[next] || paths_[next].thickness != chain.thickness) return;
            used_[next] = true;
            append(chain, paths_[next]);
        }
    }

    std::vector<PlanPath> paths_;
    std::vector<bool> used_;
    /// The first two paths that end at a point, and the number of all.
    struct Ends {
        std::array<std::uint32_t, 2> paths{};
        std::uint32_t count = 0;
    };
    void add(Point2 end, std::size_t path) {
        Ends& ends = ends_[end];
        if (ends.count < 2) ends.paths[ends.count] = static_cast<std::uint32_t>(path);
        ++ends.count;
    }

    PointMap<Ends> ends_;
};

}  // namespace

double wholeMicrometres(double metres) {
    const double whole = std::round(metres * 1e6) / 1e6;
    return whole == 0 ? 0 : whole;  // no minus zero
}

Box2 boundsOf(std::span<const Segment2> lines) {
    Box2 box;
    for (const Segment2& line : lines) {
        box.add(line.a);
        box.add(line.b);
    }
    return box;
}

std::vector<PlanPath> snapped(std::vector<PlanPath> paths, double snap, Budget& work) {
    if (snap < kCornerTolerance) snap = 0;
    PointWelder welder(snap);
    for (PlanPath& path : paths)
        for (Point2& p : path.points) p = welder.standing(wholeMicrometres(p));
    dropRepeatedPoints(paths);
    if (snap > 0 && !paths.empty()) {
        EndMover(paths, snap, work).move(paths);
        dropRepeatedPoints(paths);
    }
    return paths;
}

std::vector<Segment2> pathPieces(const std::vector<PlanPath>& paths) {
    std::vector<Segment2> pieces;
    pieces.reserve(paths.size());
    for (const PlanPath& path : paths)
        for (std::size_t i = 0; i < path.pieceCount(); ++i) pieces.push_back(path.piece(i));
    return pieces;
}

std::vector<PlanPath> withPieces(std::vector<PlanPath> paths, const std::vector<bool>& keep) {
    std::vector<PlanPath> all;
    std::size_t first = 0;
    for (PlanPath& path : paths) {
        const std::size_t count = path.pieceCount();
        const auto is_kept = [&](std::size_t i) { return keep[first + i % count]; };
        std::size_t begin = 0;
        while (begin < count && is_kept(begin)) ++begin;
        if (begin == count) {
            all.push_back(std::move(path));
        } else {
            // A closed path is walked from its first gap on, so that no run is cut in two.
            if (!path.closed) begin = 0;
            PlanPath run{{}, false, path.line, path.thickness};
            for (std::size_t i = begin; i < begin + count; ++i) {
                const auto [a, b] = path.piece(i % count);
                if (!is_kept(i)) continue;
                if (run.points.empty()) run.points.push_back(a);
                run.points.push_back(b);
                if (i + 1 < begin + count && is_kept(i + 1)) continue;
                all.push_back(std::exchange(run, {{}, false, path.line, path.thickness}));
            }
        }
        first += count;
    }
    return all;
}

std::vector<PlanPath> withoutRepeats(std::vector<PlanPath> paths) {
    struct Piece {
        Segment2 line;  // from its lower end
        std::size_t index;
    };
    std::vector<Piece> pieces;
    for (const Segment2& line : pathPieces(paths))
        pieces.push_back(
            {lexLess(line.b, line.a) ? Segment2{line.b, line.a} : line, pieces.size()});
    std::sort(pieces.begin(), pieces.end(), [](const Piece& p, const Piece& q) {
        if (p.line.a != q.line.a) return lexLess(p.line.a, q.line.a);
        return p.line.b == q.line.b ? p.index < q.index : lexLess(p.line.b, q.line.b);
    });
    std::vector<bool> keep(pieces.size(), true);
    for (std::size_t i = 1; i < pieces.size(); ++i)
        if (pieces[i].line == pieces[i - 1].line) keep[pieces[i].index] = false;
    return withPieces(std::move(paths), keep);
}

std::vector<PlanPath> bridged(std::vector<PlanPath> paths, double reach) {
    std::map<Point2, int, LexLess> free;  // loose ends, with the line of the file
    PointMap<int> uses;
    for (const PlanPath& path : paths)
        for (std::size_t i = 0; i < path.pieceCount(); ++i)
            for (const Point2 p : {path.piece(i).a, path.piece(i).b}) ++uses[p];
    for (const PlanPath& path : paths)
        for (const Point2 end : {path.points.front(), path.points.back()})
            if (!path.closed && uses[end] == 1) free.emplace(end, path.line);
    const std::vector<Segment2> lines = pathPieces(paths);
    for (const Closing& closing : closings(lines, {}, reach)) {
        auto from = free.find(closing.line.a);
        if (from == free.end()) from = free.find(closing.line.b);
        if (from == free.end()) continue;
        const bool forward = from->first == closing.line.a;
        const Point2 to = forward ? closing.line.b : closing.line.a;
        paths.push_back({{from->first, wholeMicrometres(to)}, false, from->second});
        free.erase(from);
        free.erase(to);
    }
    return paths;
}

std::vector<PlanPath> normalisedLines(std::vector<PlanPath> paths, double snap, Budget& work) {
    std::vector<PlanPath> lines = snapped(std::move(paths), std::min(snap, kDefaultSnap), work);
    if (snap > kDefaultSnap && !lines.empty()) lines = bridged(std::move(lines), snap);
    return withoutRepeats(std::move(lines));
}

std::vector<PlanPath> joinedAtEnds(std::vector<PlanPath> paths) {
    return PathJoiner(std::move(paths)).join();
}

std::optional<std::vector<PlanPath>> withoutJoints(const std::vector<PlanPath>& paths,
                                                   std::span<const Segment2> places, Budget& work) {
    if (places.empty()) return std::nullopt;
    const NearSegments search(places, work);
    std::vector<PlanPath> joined = joinedAtEnds(paths);
    PointMap<int> uses;
    for (const PlanPath& path : joined)
        for (const Point2 p : path.points) ++uses[p];
    bool found = false;
    for (PlanPath& path : joined) {
        Polygon kept;
        const std::size_t n = path.points.size();
        for (std::size_t i = 0; i < n; ++i) {
            const Point2 p = path.points[i];
            const bool is_end = !path.closed && (i == 0 || i + 1 == n);
            const Segment2 past{kept.empty() ? path.points[n - 1] : kept.back(),
                                path.points[i + 1 == n ? 0 : i + 1]};
            if (is_end || uses[p] > 1 || distance(p, past) > kCornerTolerance ||
                search.near(p, 0).empty())
                kept.push_back(p);
        }
        found |= kept.size() < n;
        path.points = std::move(kept);
    }
    if (!found) return std::nullopt;
    return joined;
}

}  // namespace ispace
