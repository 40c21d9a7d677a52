// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "geom/arrangement.h"
#include "geom/planar_map.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

/// Number of ways to close a dangling end: the nearest may enclose no further area.
constexpr std::size_t kPathsPerEnd = 4;
/// Closings considered, the narrowest first: no plan has more, and very many loose lines still take
/// seconds only.
constexpr std::size_t kMaxClosings = 10000;

/// A rounded point this near to a line lies on it.
constexpr double kOnLine = 2 * kWeldDistance;

/// Removes the duplicate pieces of overlapping lines.
WeldedLines withoutDoubles(const WeldedLines& lines) {
    std::vector<std::tuple<double, double, double, double, std::size_t>> keys;
    for (std::size_t i = 0; i < lines.pieces.size(); ++i) {
        auto [a, b] = lines.pieces[i];
        if (lexLess(b, a)) std::swap(a, b);
        keys.emplace_back(a.x, a.y, b.x, b.y, lines.source[i]);
    }
    std::sort(keys.begin(), keys.end());
    WeldedLines unique;
    for (const auto& [ax, ay, bx, by, source] : keys) {
        const Segment2 piece{{ax, ay}, {bx, by}};
        if (!unique.pieces.empty() && unique.pieces.back() == piece) continue;
        unique.pieces.push_back(piece);
        unique.source.push_back(source);
    }
    return unique;
}

/// Stores the pieces that meet at each vertex.
class Vertices {
  public:
    explicit Vertices(const std::vector<Segment2>& pieces) {
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            visits_.emplace_back(pieces[i].a, i);
            visits_.emplace_back(pieces[i].b, i);
        }
        std::sort(visits_.begin(), visits_.end(), [](const Visit& u, const Visit& v) {
            return u.first == v.first ? u.second < v.second : lexLess(u.first, v.first);
        });
    }

    using Visit = std::pair<Point2, std::size_t>;
    [[nodiscard]] std::span<const Visit> at(Point2 p) const {
        const auto first =
            std::lower_bound(visits_.begin(), visits_.end(), p,
                             [](const Visit& v, Point2 point) { return lexLess(v.first, point); });
        auto last = first;
        while (last != visits_.end() && last->first == p) ++last;
        return {first, last};
    }

  private:
    std::vector<Visit> visits_;
};

/// Finds how dangling ends could be joined to other lines.
class GapFinder {
  public:
    explicit GapFinder(const WeldedLines& lines)
        : lines_(withoutDoubles(lines)), vertices_(lines_.pieces), tree_(lines_.pieces) {
        Box2 box;
        double total = 0;
        for (const auto& [a, b] : lines_.pieces) {
            box.add(a);
            box.add(b);
            total += distance(a, b);
        }
        first_reach_ = total / static_cast<double>(4 * lines_.pieces.size() + 1);
        extent_ = box.width() + box.depth();
    }

    /// As of ispace::closings().
    [[nodiscard]] std::vector<Closing> closings(std::span<const Point2> corners,
                                                double widest) const {
        std::vector<Closing> all;
        for (std::size_t i = 0; i < lines_.pieces.size(); ++i) {
            const auto& [a, b] = lines_.pieces[i];
            for (const Point2 end : {a, b}) {
                if (vertices_.at(end).size() == 1) addClosings(i, end, widest, all);
            }
        }
        for (const Point2 corner : corners)
            if (const auto own = pieceAt(corner)) addClosings(*own, corner, widest, all);
        const auto key = [](const Closing& c) {
            return std::tuple(c.width, c.line.a.x, c.line.a.y, c.line.b.x, c.line.b.y);
        };
        std::sort(all.begin(), all.end(), [&](const Closing& c, const Closing& d) {
            return std::tuple(key(c), c.a, c.b) < std::tuple(key(d), d.a, d.b);
        });
        // Two dangling ends find each other twice.
        all.erase(std::unique(all.begin(), all.end(),
                              [](const Closing& c, const Closing& d) { return c.line == d.line; }),
                  all.end());
        if (all.size() > kMaxClosings) all.resize(kMaxClosings);
        return all;
    }

  private:
    struct Path {
        double width;
        Point2 to;
        std::size_t source;
        friend bool operator<(const Path& v, const Path& w) {
            return std::tuple(v.width, v.to.x, v.to.y, v.source) <
                   std::tuple(w.width, w.to.x, w.to.y, w.source);
        }
        friend bool operator==(const Path& v, const Path& w) { return v.to == w.to; }
    };

    /// True if lines come no nearer to `end` than at their point `to`. Along the chain of lines
    /// that the end itself hangs on, only where it turns back towards the end.
    [[nodiscard]] bool isNearestOfItsNeighbours(Point2 end, Point2 to, double width) const {
        const auto meeting = vertices_.at(to);
        return std::none_of(meeting.begin(), meeting.end(), [&](const Vertices::Visit& visit) {
            return distance(end, lines_.pieces[visit.second]) < width;
        });
    }

    /// Finds a piece that contains the point.
    [[nodiscard]] std::optional<std::size_t> pieceAt(Point2 p) const {
        std::optional<std::size_t> found;
        tree_.search({p, p}, kOnLine, [&](std::size_t i) {
            if (distance(p, lines_.pieces[i]) <= kOnLine && (!found || i < *found)) found = i;
        });
        return found;
    }

    void addClosings(std::size_t own, Point2 end, double widest, std::vector<Closing>& all) const {
        std::vector<Path> ways;
        const auto collect = [&](std::size_t i) {
            if (i == own) return;
            const Point2 to = nearestPoint(lines_.pieces[i], end);
            const double width = distance(end, to);
            if (width > kOnLine && width <= widest && isNearestOfItsNeighbours(end, to, width))
                ways.push_back({width, to, lines_.source[i]});
        };
        // Crowded lines lie much closer than evenly spread ones: three steps lead to those.
        constexpr double kStep = 16, kCrowded = 1 / (kStep * kStep * kStep);
        const double even = std::min(first_reach_, widest);
        for (double reach = kCrowded * even;; reach *= reach < even ? kStep : 4) {
            ways.clear();
            tree_.search({end, end}, reach, collect);
            std::sort(ways.begin(), ways.end());
            ways.erase(std::unique(ways.begin(), ways.end()), ways.end());
            if (ways.size() >= kPathsPerEnd && ways[kPathsPerEnd - 1].width <= reach) break;
            if (!(reach < extent_) || reach >= widest) break;  // all lines were visited
        }
        ways.resize(std::min(ways.size(), kPathsPerEnd));
        const std::size_t source = lines_.source[own];
        for (const Path& way : ways) {
            Segment2 line{end, way.to};
            if (lexLess(line.b, line.a)) std::swap(line.a, line.b);
            all.push_back(
                {line, way.width, std::min(source, way.source), std::max(source, way.source)});
        }
    }

    WeldedLines lines_;
    Vertices vertices_;
    SegmentTree tree_;
    double first_reach_ = 0;  // first search radius about an end, for evenly spread lines
    double extent_ = 0;       // no two points of lines are farther apart
};

/// Stores the lines with all closings, cut and welded once.
class Closed {
  public:
    Closed(std::span<const Segment2> lines, std::span<const Closing> closings) {
        std::vector<Segment2> all(lines.begin(), lines.end());
        for (const Closing& closing : closings) all.push_back(closing.line);
        const std::vector<LinePiece> cut =
            noded(linePieces(all), {"wall lines", "end them where they meet"});
        std::vector<Segment2> segments;
        segments.reserve(cut.size());
        for (const LinePiece& piece : cut) segments.push_back(piece.segment);
        WeldedLines welded = weld(segments);
        pieces_ = std::move(welded.pieces);
        needs_.reserve(pieces_.size());
        for (const std::size_t source : welded.source) {
            const std::size_t line = cut[source].line;
            needs_.push_back(line < lines.size() ? 0 : line - lines.size() + 1);
        }
    }

    /// True if the point, or any area, is enclosed when the first `count` gaps are closed.
    [[nodiscard]] bool encloses(std::size_t count, std::optional<Point2> inside) const {
        std::vector<Segment2> pieces;
        for (std::size_t i = 0; i < pieces_.size(); ++i)
            if (needs_[i] <= count) pieces.push_back(pieces_[i]);
        const auto faces = boundedFaces(pieces, {});
        if (!inside) return !faces.empty();
        return std::any_of(faces.begin(), faces.end(), [&](const Region& face) {
            return face.locate(*inside) != Side::Outside;
        });
    }

  private:
    std::vector<Segment2> pieces_;
    std::vector<std::size_t> needs_;  // how many gaps have to be closed for each piece to be there
};

}  // namespace

std::vector<Closing> closings(std::span<const Segment2> lines, std::span<const Point2> corners,
                              double widest) {
    if (lines.empty()) return {};
    return GapFinder(weld(lines)).closings(corners, widest);
}

std::optional<Gap> findGap(std::span<const Segment2> lines, std::optional<Point2> inside) {
    const std::vector<Closing> closings =
        ispace::closings(lines, {}, std::numeric_limits<double>::infinity());
    if (closings.empty()) return std::nullopt;
    const Closed closed(lines, closings);
    // Enclosed areas stay enclosed as more gaps are closed: bisect the number of gaps.
    std::size_t too_few = 0, enough = closings.size();
    if (closed.encloses(too_few, inside) || !closed.encloses(enough, inside)) return std::nullopt;
    while (enough - too_few > 1) {
        const std::size_t count = too_few + (enough - too_few) / 2;
        (closed.encloses(count, inside) ? enough : too_few) = count;
    }
    const Closing& last = closings[enough - 1];
    const Point2 place = last.line.a + 0.5 * (last.line.b - last.line.a);
    return Gap{last.width, place, last.a, last.b};
}

}  // namespace ispace
