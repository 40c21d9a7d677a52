// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/plan_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "geom/planar_map.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

std::vector<Box2> boxesOf(std::span<const Segment2> segments) {
    std::vector<Box2> boxes;
    boxes.reserve(segments.size());
    for (const Segment2& segment : segments) boxes.push_back(bounds(segment));
    return boxes;
}

}  // namespace

NearSegments::NearSegments(std::span<const Segment2> segments) : tree_(boxesOf(segments)) {}

std::vector<std::size_t> NearSegments::near(Point2 p, double reach) const {
    Box2 box;
    box.add(p);
    return near(box, reach);
}

std::vector<std::size_t> NearSegments::near(const Box2& box, double reach) const {
    const Vec2 margin{reach, reach};
    std::vector<std::size_t> found;
    tree_.search({box.low - margin, box.high + margin},
                 [&found](std::size_t i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    return found;
}

namespace {

/// Points are whole micrometres: a smaller reach joins no points.
constexpr double kMinSnap = 1e-6;

struct PointHash {
    std::size_t operator()(Point2 p) const { return mixed(std::hash<double>()(p.x), p.y); }
    static std::size_t mixed(std::size_t seed, double value) {
        constexpr std::size_t kOdd = 0x9E3779B97F4A7C15;  // spreads neighbours over all bits
        return (seed * kOdd ^ std::hash<double>()(value)) * kOdd >> 7U;
    }
};
template <typename T>
using PointMap = std::unordered_map<Point2, T, PointHash>;

/// Finds the representative of each point: the nearest earlier one within reach, else itself.
class PointWelder {
  public:
    PointWelder(double reach, std::size_t points) : reach_(reach) {
        if (reach_ > 0) cells_.reserve(points);
    }

    Point2 standing(Point2 p) {
        if (reach_ == 0) return p;
        best_ = kNone;
        nearest_ = reach_;
        const Cell low = cellOf({p.x - reach_, p.y - reach_}, kWide * reach_);
        const Cell high = cellOf({p.x + reach_, p.y + reach_}, kWide * reach_);
        for (std::int64_t x = low.first; x <= high.first; ++x)
            for (std::int64_t y = low.second; y <= high.second; ++y) look({x, y}, p);
        if (best_ != kNone) return standing_[best_].at;
        std::uint32_t& first = cells_.try_emplace(cellOf(p, kWide * reach_), kNone).first->second;
        standing_.push_back({p, first});
        first = static_cast<std::uint32_t>(standing_.size() - 1);
        return p;
    }

  private:
    using Cell = std::pair<std::int64_t, std::int64_t>;
    struct CellHash {
        std::size_t operator()(const Cell& cell) const {
            return PointHash::mixed(static_cast<std::size_t>(cell.first),
                                    static_cast<double>(cell.second));
        }
    };
    /// Representatives are apart, so a cell of a few reaches holds few of them.
    struct PlacementFrame {
        Point2 at;
        std::uint32_t next;  // in the same cell
    };
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    static constexpr double kWide = 4;

    /// Plans end at 1000 km, and the reach is a micrometre or more: far within the integers.
    [[nodiscard]] static Cell cellOf(Point2 p, double size) {
        return {static_cast<std::int64_t>(std::floor(p.x / size)),
                static_cast<std::int64_t>(std::floor(p.y / size))};
    }

    /// Of two that are equally near, the one farther left counts, then the lower, then the earlier
    /// one, in steps of the reach.
    [[nodiscard]] bool isBefore(std::uint32_t i, std::uint32_t k) const {
        const Cell a = cellOf(standing_[i].at, reach_), b = cellOf(standing_[k].at, reach_);
        return a == b ? i < k : a < b;
    }

    void look(const Cell& cell, Point2 p) {
        const auto found = cells_.find(cell);
        if (found == cells_.end()) return;
        for (std::uint32_t i = found->second; i != kNone; i = standing_[i].next) {
            const double apart = distance(p, standing_[i].at);
            if (apart > nearest_ || (apart == nearest_ && best_ != kNone && !isBefore(i, best_)))
                continue;
            best_ = i;
            nearest_ = apart;
        }
    }

    double reach_;
    std::unordered_map<Cell, std::uint32_t, CellHash> cells_;  // the latest of each
    std::vector<PlacementFrame> standing_;
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
    EndMover(const std::vector<PlanPath>& paths, double reach)
        : pieces_(pathPieces(paths)), search_(pieces_), reach_(reach) {
        uses_.reserve(pieces_.size());
        for (const PlanPath& path : paths)
            for (const Point2 p : path.points) ++uses_[p];
    }

    [[nodiscard]] Point2 moved(Point2 end) const {
        if (uses_.at(end) > 1) return end;
        Point2 best = end;
        double nearest = reach_;
        for (const std::size_t i : search_.near(end, reach_)) {
            const Segment2& piece = pieces_[i];
            if (piece.a == end || piece.b == end) continue;
            const Point2 foot = nearestPoint(piece, end);
            const double apart = distance(foot, end);
            if (apart > nearest) continue;
            best = wholeMicrometres(foot);
            nearest = apart;
        }
        return best;
    }

  private:
    std::vector<Segment2> pieces_;
    NearSegments search_;
    double reach_;
    PointMap<int> uses_;
};

void moveEnds(std::vector<PlanPath>& paths, double reach) {
    const EndMover mover(paths, reach);
    for (PlanPath& path : paths) {
        if (path.closed) continue;
        const Point2 front = mover.moved(path.points.front());
        const Point2 back = mover.moved(path.points.back());
        path.points.front() = front;
        path.points.back() = back;
    }
}

/// Adds the path that begins or ends where `path` ends.
void append(PlanPath& path, const PlanPath& next) {
    Polygon& points = path.points;
    if (next.points.front() == points.back())
        points.insert(points.end(), next.points.begin() + 1, next.points.end());
    else
        points.insert(points.end(), next.points.rbegin() + 1, next.points.rend());
}

/// Finds the ends of open paths by their positions.
class Joiner {
  public:
    explicit Joiner(const std::vector<PlanPath>& paths) : paths_(paths), used_(paths.size()) {
        for (std::size_t i = 0; i < paths.size(); ++i) {
            if (paths[i].closed) continue;
            add(paths[i].points.front(), i);
            add(paths[i].points.back(), i);
        }
    }

    std::vector<PlanPath> join() {
        std::vector<PlanPath> all;
        for (std::size_t i = 0; i < paths_.size(); ++i) {
            if (paths_[i].closed) all.push_back(paths_[i]);
            if (!paths_[i].closed && !used_[i]) all.push_back(chainFrom(i));
        }
        return all;
    }

  private:
    PlanPath chainFrom(std::size_t first) {
        used_[first] = true;
        PlanPath chain = paths_[first];
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
            const Ends& meeting = ends_.at(chain.points.back());
            if (meeting.count != 2) return;
            const std::size_t next = meeting.paths[used_[meeting.paths[0]] ? 1 : 0];
            if (used_[next]) return;
            used_[next] = true;
            append(chain, paths_[next]);
        }
    }

    const std::vector<PlanPath>& paths_;
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

std::vector<PlanPath> snapped(const std::vector<PlanPath>& paths, double snap) {
    std::vector<PlanPath> result(paths);
    if (snap < kMinSnap) snap = 0;
    std::size_t points = 0;
    for (const PlanPath& path : result) points += path.points.size();
    PointWelder welder(snap, points);
    for (PlanPath& path : result)
        for (Point2& p : path.points) p = welder.standing(wholeMicrometres(p));
    dropRepeatedPoints(result);
    if (snap > 0 && !result.empty()) {
        moveEnds(result, snap);
        dropRepeatedPoints(result);
    }
    return result;
}

std::vector<Segment2> pathPieces(const std::vector<PlanPath>& paths) {
    std::vector<Segment2> pieces;
    pieces.reserve(paths.size());
    for (const PlanPath& path : paths)
        for (std::size_t i = 0; i < path.pieceCount(); ++i) pieces.push_back(path.piece(i));
    return pieces;
}

std::vector<PlanPath> withPieces(const std::vector<PlanPath>& paths,
                                 const std::vector<bool>& keep) {
    std::vector<PlanPath> all;
    std::size_t first = 0;
    for (const PlanPath& path : paths) {
        const std::size_t count = path.pieceCount();
        const auto is_kept = [&](std::size_t i) { return keep[first + i % count]; };
        std::size_t begin = 0;
        while (begin < count && is_kept(begin)) ++begin;
        if (begin == count) {
            all.push_back(path);
        } else {
            // A closed path is walked from its first gap on, so that no run is cut in two.
            if (!path.closed) begin = 0;
            PlanPath run{{}, false, path.line};
            for (std::size_t i = begin; i < begin + count; ++i) {
                const auto [a, b] = path.piece(i % count);
                if (!is_kept(i)) continue;
                if (run.points.empty()) run.points.push_back(a);
                run.points.push_back(b);
                if (i + 1 < begin + count && is_kept(i + 1)) continue;
                all.push_back(std::exchange(run, {{}, false, path.line}));
            }
        }
        first += count;
    }
    return all;
}

std::vector<PlanPath> withoutRepeats(const std::vector<PlanPath>& paths) {
    std::vector<Segment2> pieces = pathPieces(paths);
    for (Segment2& piece : pieces)
        if (lexLess(piece.b, piece.a)) std::swap(piece.a, piece.b);
    std::vector<std::size_t> order(pieces.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
        return pieces[i].a == pieces[k].a ? lexLess(pieces[i].b, pieces[k].b)
                                          : lexLess(pieces[i].a, pieces[k].a);
    });
    std::vector<bool> keep(pieces.size(), true);
    for (std::size_t i = 1; i < order.size(); ++i)
        if (pieces[order[i]] == pieces[order[i - 1]]) keep[order[i]] = false;
    return withPieces(paths, keep);
}

std::vector<PlanPath> bridged(std::vector<PlanPath> paths, double reach) {
    PointMap<int> free;  // loose ends, with the line of the file
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

std::vector<PlanPath> normalisedLines(const std::vector<PlanPath>& paths, double snap) {
    std::vector<PlanPath> lines = snapped(paths, std::min(snap, kDefaultSnap));
    if (snap > kDefaultSnap && !lines.empty()) lines = bridged(std::move(lines), snap);
    return withoutRepeats(lines);
}

std::vector<PlanPath> joinedAtEnds(const std::vector<PlanPath>& paths) {
    return Joiner(paths).join();
}

}  // namespace ispace
