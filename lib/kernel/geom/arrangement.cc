// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/arrangement.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "geom/plane_graph.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

using plane::Index;
using plane::kNone;
using plane::twin;

/// Lines that meet at common ends only, and the faces into which they divide the plane.
class Arrangement {
  public:
    explicit Arrangement(const std::vector<LinePiece>& pieces)
        : ends_(endsOf(pieces)), faces_(points_, lines_) {
        parent_.resize(faces_.count());
        std::iota(parent_.begin(), parent_.end(), Index{0});
    }

    [[nodiscard]] Index faces() const { return faces_.count(); }

    /// Makes one of the faces on both sides of each line of which this is true, where both are kept
    /// and bounded. \param kept for each face
    template <typename Open>
    void join(const std::vector<bool>& kept, Open is_open) {
        for (Index i = 0; i < lines_.size(); ++i) {
            const Index left = faces_.of(2 * i), right = faces_.of(2 * i + 1);
            if (left == kNone || right == kNone || !kept[left] || !kept[right] || !is_open(i))
                continue;
            const Index a = root(left), b = root(right);
            parent_[std::max(a, b)] = std::min(a, b);
        }
        for (Index& parent : parent_) parent = root(parent);
    }

    /// Sums the winding numbers of the pieces along a path from the outside to each face.
    [[nodiscard]] std::vector<std::pair<int, int>> windings(
        const std::vector<LinePiece>& pieces) const {
        const Index outside = faces_.count();
        const auto face = [&](Index half) { return std::min(faces_.of(half), outside); };
        std::vector<std::size_t> first(outside + 2, 0);
        const auto halves = static_cast<Index>(2 * lines_.size());
        for (Index half = 0; half < halves; ++half) ++first[face(half) + 1];
        std::partial_sum(first.begin(), first.end(), first.begin());
        std::vector<Index> around(halves);
        std::vector<std::size_t> next(first.begin(), first.end() - 1);
        for (Index half = 0; half < halves; ++half) around[next[face(half)]++] = half;

        std::vector<std::pair<int, int>> winding(outside + 1);
        std::vector<bool> reached(outside + 1);
        std::vector<Index> open{outside};
        reached[outside] = true;
        while (!open.empty()) {
            const Index from = open.back();
            open.pop_back();
            for (std::size_t i = first[from]; i < first[from + 1]; ++i) {
                const Index half = around[i], to = face(twin(half));
                if (reached[to]) continue;
                // From the left of a line to its right, as its piece runs.
                const LinePiece& piece = pieces[half / 2];
                const bool is_forward = !lexLess(piece.segment.b, piece.segment.a);
                const int step = (half % 2 == 0) == is_forward ? -1 : 1;
                winding[to] = {winding[from].first + step * piece.added,
                               winding[from].second + step * piece.removed};
                reached[to] = true;
                open.push_back(to);
            }
        }
        return winding;
    }

    /// Builds the connected pieces that consist of kept faces.
    [[nodiscard]] std::vector<Region> regions(const std::vector<bool>& kept) const {
        const auto piece_of = [&](Index half) {
            const Index face = faces_.of(half);
            return face == kNone || !kept[face] ? kNone : parent_[face];
        };
        std::vector<Index> boundaries(points_.size(), 0);  // at each point
        for (Index i = 0; i < lines_.size(); ++i) {
            if (piece_of(2 * i) == piece_of(2 * i + 1)) continue;
            ++boundaries[lines_[i].from];
            ++boundaries[lines_[i].to];
        }
        std::vector<Region> regions(faces_.count());
        faces_.forEachBoundary(piece_of,
                               [&](Index piece, const plane::Loop& loop, bool is_outline) {
                                   Polygon curve = curveOf(loop, boundaries);
                                   // A loop that doubles cannot distinguish from a line has no area
                                   // either.
                                   if (is_outline && signedArea(curve) > 0)
                                       regions[piece].outline = std::move(curve);
                                   else if (!is_outline && signedArea(curve) < 0)
                                       regions[piece].holes.push_back(std::move(curve));
                               });
        putInOrder(regions);
        return regions;
    }

  private:
    /// The ends of the pieces, each once and sorted, and the pieces as lines between them.
    struct Ends {
        std::vector<Point2> points;
        std::vector<plane::Line> lines;
    };

    /// \pre pieces are sorted by their lower ends, as noded() sorts them
    static Ends endsOf(const std::vector<LinePiece>& pieces) {
        struct Upper {
            Point2 at;
            Index piece;
        };
        std::vector<Upper> uppers;
        uppers.reserve(pieces.size());
        const auto lower = [&pieces](std::size_t i) {
            const auto& [a, b] = pieces[i].segment;
            return lexLess(b, a) ? b : a;
        };
        for (Index i = 0; i < pieces.size(); ++i) {
            const auto& [a, b] = pieces[i].segment;
            uppers.push_back({lexLess(b, a) ? a : b, i});
        }
        std::sort(uppers.begin(), uppers.end(),
                  [](const Upper& s, const Upper& t) { return lexLess(s.at, t.at); });
        Ends ends;
        ends.points.reserve(pieces.size());
        ends.lines.resize(pieces.size());
        const auto number_of = [&points = ends.points](Point2 p) {
            if (points.empty() || points.back() != p) points.push_back(p);
            return static_cast<Index>(points.size() - 1);
        };
        std::size_t next = 0;
        for (const Upper& upper : uppers) {
            for (; next < pieces.size() && !lexLess(upper.at, lower(next)); ++next)
                ends.lines[next].from = number_of(lower(next));
            ends.lines[upper.piece].to = number_of(upper.at);
        }
        return ends;
    }

    [[nodiscard]] Index root(Index face) {
        while (parent_[face] != face) {
            parent_[face] = parent_[parent_[face]];
            face = parent_[face];
        }
        return face;
    }

    /// Vertices of the loop, from the lowest, without those due only to lines that bound no piece.
    [[nodiscard]] Polygon curveOf(const plane::Loop& loop,
                                  const std::vector<Index>& boundaries) const {
        const plane::Graph<Point2>& graph = faces_.graph();
        Polygon curve;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Index before = graph.source(loop[i == 0 ? loop.size() - 1 : i - 1]);
            const Index vertex = graph.source(loop[i]), after = graph.target(loop[i]);
            const bool is_own = graph.leaving(vertex).size() == 2;  // the input's
            if (is_own || boundaries[vertex] != 2 ||
                orientation(points_[before], points_[vertex], points_[after]) != Turn::Straight)
                curve.push_back(points_[vertex]);
        }
        if (curve.size() < 3) return {};
        rotateToLowest(curve);
        return curve;
    }

    Ends ends_;
    const std::vector<Point2>& points_ = ends_.points;
    const std::vector<plane::Line>& lines_ = ends_.lines;
    plane::Faces<Point2> faces_;
    std::vector<Index> parent_;  // of each face: joined ones have the same
};

bool lexLess(const Polygon& a, const Polygon& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                        [](Point2 p, Point2 q) { return lexLess(p, q); });
}

/// Equal points become equal doubles.
void dropNegativeZeros(std::vector<LinePiece>& lines) {
    for (LinePiece& line : lines)
        for (Point2* p : {&line.segment.a, &line.segment.b}) *p = {p->x + 0.0, p->y + 0.0};
}

}  // namespace

std::vector<Region> facesOf(std::vector<LinePiece> lines, const CrossingMessage& message) {
    dropNegativeZeros(lines);
    const std::vector<LinePiece> pieces = noded(std::move(lines), message);
    Arrangement arrangement(pieces);
    const std::vector<bool> all(arrangement.faces(), true);
    arrangement.join(all, [&](Index i) { return pieces[i].is_passage; });
    return arrangement.regions(all);
}

std::vector<Region> differenceOf(std::vector<LinePiece> lines, const CrossingMessage& message) {
    dropNegativeZeros(lines);
    const std::vector<LinePiece> pieces = noded(std::move(lines), message);
    Arrangement arrangement(pieces);
    const auto windings = arrangement.windings(pieces);
    std::vector<bool> kept(arrangement.faces());
    for (std::size_t i = 0; i < kept.size(); ++i)
        kept[i] = windings[i].first > 0 && windings[i].second == 0;
    arrangement.join(kept, [](Index) { return true; });
    return arrangement.regions(kept);
}

void rotateToLowest(Polygon& curve) {
    const auto from = [&](std::size_t i) {
        return std::pair(curve[i], curve[(i + 1) % curve.size()]);
    };
    std::size_t lowest = 0;
    for (std::size_t i = 1; i < curve.size(); ++i) {
        const auto [p, p_next] = from(i);
        const auto [q, q_next] = from(lowest);
        if (lexLess(p, q) || (p == q && lexLess(p_next, q_next))) lowest = i;
    }
    std::rotate(curve.begin(), curve.begin() + static_cast<std::ptrdiff_t>(lowest), curve.end());
}

void putInOrder(std::vector<Region>& regions) {
    std::erase_if(regions, [](const Region& region) { return region.outline.empty(); });
    for (Region& region : regions) {
        std::sort(region.holes.begin(), region.holes.end(),
                  [](const Polygon& a, const Polygon& b) { return lexLess(a, b); });
    }
    std::sort(regions.begin(), regions.end(),
              [](const Region& a, const Region& b) { return lexLess(a.outline, b.outline); });
}

}  // namespace ispace
