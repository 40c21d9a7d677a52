// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts lines where they meet, in rounds, by iterated snap rounding (D. Halperin, E. Packer,
// Iterated snap rounding, 2002). Each round finds pairs of lines by a grid of cells, or by a tree
// where cells are crowded. Lines of a crowded cell that share an end are compared with their
// neighbours by direction alone, so that a star of n lines takes O(n log n) unless they nearly
// coincide. Two lines that touch at an end within the reach are cut there; others are cut where
// they cross, a point rounded from the same ends whichever way the lines run.
#include "geom/arrangement.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

#include "base/error.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

using Index = std::uint32_t;

/// Pairs of lines tested in a grid, per line and in addition: it is quickest for evenly spread
/// lines. Beyond that a tree is used.
constexpr std::size_t kGridPairsPerLine = 64, kGridPairsAnyway = 1U << 20;
/// The same for the tree: only very many lines that cross need more.
constexpr std::size_t kPairsPerLine = 4096, kPairsAnyway = 1U << 26;
/// Lines of a cell among which those that share an end are looked for.
constexpr std::size_t kCrowd = 64;
/// Rounds of cutting, and how often the distance for merging points is widened if they do not
/// suffice.
constexpr int kMaxRounds = 12, kMaxWidenings = 4;

/// Sample size for counting crossings.
constexpr std::size_t kSampledPairs = 1U << 17, kSampledPairsPerLine = 16, kMaxSampled = 1U << 22;
constexpr std::size_t kSureHits = 16;

/// Rounded to two digits: it is an estimate.
std::string roundNumber(double value) {
    const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(value)) - 1));
    return std::to_string(static_cast<std::uint64_t>(std::round(value / unit) * unit));
}

/// Internal; converted to a message by a caller that knows the lines.
struct TooMany {};

[[noreturn]] void refuse(std::span<const LinePiece> lines, const CrossingMessage& message) {
    std::vector<Segment2> segments;
    segments.reserve(lines.size());
    for (const LinePiece& line : lines) segments.push_back(line.segment);
    const double crossings = sampledCrossings(segments);
    const std::string text = crossings > kMaxCrossings
                                 ? message.what + " cross each other about " +
                                       roundNumber(crossings) + " times, at most " +
                                       roundNumber(kMaxCrossings) + " can be; " + message.hint
                                 : "too many " + message.what +
                                       " cross each other or lie upon each other; " + message.hint;
    throw FormatError(Diagnostic{"", 0, 0, text});
}

/// Stores points at mutual distances of at least `reach`.
class DistinctPoints {
  public:
    /// \param count as many will come, about
    DistinctPoints(double reach, std::size_t count) : reach_(reach) {
        points_.reserve(count);
        grow(std::bit_ceil(2 * count + 16));
    }

    /// Returns the point that represents p: an earlier one, or p itself.
    Point2 standing(Point2 p) {
        if (!(reach_ > 0)) return p;
        const auto [low, high] = cellsAbout(p);
        for (double x = low.x; x <= high.x; ++x) {
            for (double y = low.y; y <= high.y; ++y) {
                for (std::size_t i = slotOf({x, y}); slots_[i] != kFree; i = next(i)) {
                    const Point2 other = points_[slots_[i]];
                    if (other == p || distance(other, p) <= reach_) return other;
                }
            }
        }
        if (2 * points_.size() + 2 > slots_.size()) grow(2 * slots_.size());
        points_.push_back(p);
        enter(static_cast<Index>(points_.size() - 1));
        return p;
    }

  private:
    static constexpr Index kFree = std::numeric_limits<Index>::max();
    /// Wide enough that most points have one cell only in reach.
    static constexpr double kReachesPerCell = 64;

    [[nodiscard]] Point2 cellOf(Point2 p) const {
        const double size = kReachesPerCell * reach_;
        return {std::floor(p.x / size), std::floor(p.y / size)};
    }
    /// Computes the first and the last cell that may hold points in reach.
    [[nodiscard]] std::pair<Point2, Point2> cellsAbout(Point2 p) const {
        const double size = kReachesPerCell * reach_;
        const Point2 place{p.x / size, p.y / size}, cell{std::floor(place.x), std::floor(place.y)};
        // With twice the reach from the sides of a cell all points are in it, despite rounding.
        constexpr double kClear = 2 / kReachesPerCell;
        const auto is_clear = [](double within) { return within > kClear && within < 1 - kClear; };
        if (is_clear(place.x - cell.x) && is_clear(place.y - cell.y)) return {cell, cell};
        return {cellOf(p - Vec2{reach_, reach_}), cellOf(p + Vec2{reach_, reach_})};
    }
    [[nodiscard]] std::size_t slotOf(Point2 cell) const {
        const auto x = std::bit_cast<std::uint64_t>(cell.x + 0.0);
        const auto y = std::bit_cast<std::uint64_t>(cell.y + 0.0);
        const std::uint64_t mixed = (x * 0x9E3779B97F4A7C15U ^ y) * 0xBF58476D1CE4E5B9U;
        return (mixed ^ mixed >> 32) & (slots_.size() - 1);
    }
    [[nodiscard]] std::size_t next(std::size_t slot) const {
        return (slot + 1) & (slots_.size() - 1);
    }
    void enter(Index point) {
        std::size_t i = slotOf(cellOf(points_[point]));
        while (slots_[i] != kFree) i = next(i);
        slots_[i] = point;
    }
    void grow(std::size_t slots) {
        slots_.assign(slots, kFree);
        for (Index i = 0; i < points_.size(); ++i) enter(i);
    }

    double reach_;
    std::vector<Point2> points_;
    std::vector<Index> slots_;  // open addressing; a power of two, at most half full
};

/// Returns the segment from its lower end to its upper.
Segment2 ordered(const Segment2& s) { return lexLess(s.b, s.a) ? Segment2{s.b, s.a} : s; }

/// One round of cutting; pieces moved by rounding may need another.
class Cutter {
  public:
    Cutter(std::vector<LinePiece>& pieces, DistinctPoints& points, double reach)
        : pieces_(pieces), points_(points), reach_(reach) {
        segments_.reserve(pieces.size());
        for (const LinePiece& piece : pieces) segments_.push_back(piece.segment);
    }

    /// \return whether any line was cut
    bool cut() {
        if (!meetInGrid()) meetInTree();
        if (cuts_.empty()) return false;
        apply();
        return true;
    }

  private:
    struct Cut {
        Index piece;
        double along;
        Point2 at;
        friend bool operator<(const Cut& a, const Cut& b) {
            if (a.piece != b.piece) return a.piece < b.piece;
            return a.along < b.along || (a.along == b.along && lexLess(a.at, b.at));
        }
    };

    /// \return false if the grid is crowded
    bool meetInGrid() {
        const SegmentGrid grid(segments_, reach_);
        std::size_t pairs = 0;
        std::vector<Fan> fans;  // of the crowded cells, in order
        grid.forEachCell([&](std::span<const Index> cell) {
            pairs += cell.size() * cell.size() / 2;
            if (cell.size() < kCrowd) return;
            fans.push_back(fanOf(cell));
            const std::size_t lines = fans.back().lines.size();
            pairs -= lines * lines / 2;
        });
        if (pairs > kGridPairsAnyway + kGridPairsPerLine * segments_.size()) return false;
        auto fan = fans.begin();
        grid.forEachCell([&](std::span<const Index> cell) {
            if (cell.size() < kCrowd) {
                for (std::size_t i = 0; i < cell.size(); ++i)
                    for (std::size_t k = i + 1; k < cell.size(); ++k) meet(cell[i], cell[k]);
            } else {
                meetBeside(*fan, cell);
                meetInFan(*fan++);
            }
            checkCuts();
        });
        return true;
    }

    /// Lines of a cell that share an end.
    struct Fan {
        Point2 end;
        std::vector<Index> lines;  // ascending
    };

    [[nodiscard]] bool endsAt(Index line, Point2 at) const {
        return segments_[line].a == at || segments_[line].b == at;
    }

    /// Returns the most lines of a cell that share an end.
    [[nodiscard]] Fan fanOf(std::span<const Index> cell) const {
        std::vector<Point2> all;
        for (const Index line : cell)
            for (const Point2 end : {segments_[line].a, segments_[line].b}) all.push_back(end);
        std::sort(all.begin(), all.end(), [](Point2 p, Point2 q) { return lexLess(p, q); });
        Fan fan;
        for (std::size_t from = 0, most = 0, to = 0; from < all.size(); from = to) {
            while (to < all.size() && all[to] == all[from]) ++to;
            if (to - from <= most) continue;
            most = to - from;
            fan.end = all[from];
        }
        for (const Index line : cell)
            if (endsAt(line, fan.end)) fan.lines.push_back(line);
        return fan;
    }

    /// Cuts the lines of a cell where they meet, but for pairs of the fan.
    void meetBeside(const Fan& fan, std::span<const Index> cell) {
        std::vector<std::size_t> others;  // places in the cell
        for (std::size_t i = 0; i < cell.size(); ++i)
            if (!endsAt(cell[i], fan.end)) others.push_back(i);
        for (std::size_t i = 0; i < cell.size(); ++i) {
            if (!endsAt(cell[i], fan.end)) {
                for (std::size_t k = i + 1; k < cell.size(); ++k) meet(cell[i], cell[k]);
                continue;
            }
            for (auto k = std::upper_bound(others.begin(), others.end(), i); k != others.end(); ++k)
                meet(cell[i], cell[*k]);
        }
    }

    /// Cuts the lines of a fan where the end of one lies on another, which holds for neighbours by
    /// direction alone.
    void meetInFan(const Fan& fan) {
        std::vector<std::pair<double, Index>> rays;  // by their angles
        double shortest = std::numeric_limits<double>::infinity();
        for (const Index line : fan.lines) {
            const Segment2& s = segments_[line];
            const Vec2 way = (s.a == fan.end ? s.b : s.a) - fan.end;
            rays.emplace_back(std::atan2(way.y, way.x), line);
            shortest = std::min(shortest, length(way));
        }
        std::sort(rays.begin(), rays.end());
        // Beyond this angle no end is within reach of another line, with room for rounding.
        constexpr double kRounding = 1e-12, kTurn = 2 * std::numbers::pi;
        const double near = 4 * reach_ / shortest + kRounding;
        for (std::size_t i = 0; i < rays.size(); ++i)
            for (std::size_t n = 1; n < rays.size(); ++n) {
                const std::size_t k = (i + n) % rays.size();
                if (rays[k].first - rays[i].first + (k < i ? kTurn : 0) > near) break;
                meet(rays[i].second, rays[k].second);
            }
    }

    void meetInTree() {
        const SegmentTree tree(segments_);
        std::size_t pairs = 0;
        for (Index i = 0; i < segments_.size(); ++i) {
            tree.search(segments_[i], reach_, [&](std::size_t k) {
                ++pairs;
                if (k > i) meet(i, static_cast<Index>(k));
            });
            if (pairs > kPairsAnyway + kPairsPerLine * segments_.size()) throw TooMany();
            checkCuts();
        }
    }

    void checkCuts() const {
        if (static_cast<double>(cuts_.size()) >
            2 * kMaxCrossings + 8 * static_cast<double>(segments_.size()))
            throw TooMany();
    }

    [[nodiscard]] static bool isNear(const Segment2& s, const Segment2& t, double reach) {
        const auto apart = [reach](double a, double b, double c, double d) {
            return std::max(a, b) + reach < std::min(c, d) ||
                   std::max(c, d) + reach < std::min(a, b);
        };
        return !apart(s.a.x, s.b.x, t.a.x, t.b.x) && !apart(s.a.y, s.b.y, t.a.y, t.b.y);
    }

    void meet(Index i, Index k) {
        const Segment2 &s = segments_[i], &t = segments_[k];
        if (!isNear(s, t, reach_)) return;
        bool touches = s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b;
        for (const Point2 end : {t.a, t.b}) touches |= cutAtEnd(i, end);
        for (const Point2 end : {s.a, s.b}) touches |= cutAtEnd(k, end);
        // Else they cross, or not at all.
        if (touches || !intersects(s, t)) return;
        // The result does not depend on the directions of the lines.
        const auto [a, b] = ordered(s);
        const auto [from, to] = ordered(t);
        const double right = std::abs(cross(b - a, from - a)),
                     left = std::abs(cross(b - a, to - a));
        const Point2 at = points_.standing(from + right / (right + left) * (to - from));
        add(i, at);
        add(k, at);
    }

    bool cutAtEnd(Index i, Point2 end) {
        const Segment2& s = segments_[i];
        if (end == s.a || end == s.b || !(distance(end, s) <= reach_)) return false;
        add(i, end);
        return true;
    }

    void add(Index i, Point2 at) {
        const Segment2& s = segments_[i];
        if (at != s.a && at != s.b) cuts_.push_back({i, dot(at - s.a, s.b - s.a), at});
    }

    void apply() {
        std::sort(cuts_.begin(), cuts_.end());
        std::vector<LinePiece> parts;
        parts.reserve(pieces_.size() + cuts_.size());
        auto cut = cuts_.begin();
        for (Index i = 0; i < pieces_.size(); ++i) {
            LinePiece rest = pieces_[i];
            for (; cut != cuts_.end() && cut->piece == i; ++cut) {
                if (cut->at == rest.segment.a) continue;
                parts.push_back(rest);
                parts.back().segment.b = cut->at;
                rest.segment.a = cut->at;
            }
            parts.push_back(rest);
        }
        pieces_ = std::move(parts);
    }

    std::vector<LinePiece>& pieces_;
    DistinctPoints& points_;
    double reach_;
    std::vector<Segment2> segments_;
    std::vector<Cut> cuts_;
};

/// Sorts pieces by position and removes duplicates of either direction.
void mergeDoubles(std::vector<LinePiece>& pieces) {
    struct Place {
        Segment2 segment;
        Index line, piece;
    };
    std::vector<Place> places;
    places.reserve(pieces.size());
    for (Index i = 0; i < pieces.size(); ++i)
        if (const Segment2& s = pieces[i].segment; s.a != s.b)
            places.push_back({ordered(s), pieces[i].line, i});
    std::sort(places.begin(), places.end(), [](const Place& p, const Place& q) {
        if (p.segment.a != q.segment.a) return lexLess(p.segment.a, q.segment.a);
        if (p.segment.b != q.segment.b) return lexLess(p.segment.b, q.segment.b);
        return p.line != q.line ? p.line < q.line : p.piece < q.piece;
    });
    std::vector<LinePiece> merged;
    merged.reserve(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        const LinePiece& piece = pieces[places[i].piece];
        if (i == 0 || places[i - 1].segment != places[i].segment) {
            merged.push_back(piece);
            continue;
        }
        LinePiece& all = merged.back();
        const int turn = all.segment == piece.segment ? 1 : -1;
        all.added += turn * piece.added;
        all.removed += turn * piece.removed;
        all.is_passage = all.is_passage && piece.is_passage;
    }
    pieces = std::move(merged);
}

/// \return true if the pieces meet at common ends only
bool cutAll(std::vector<LinePiece>& pieces, double reach) {
    DistinctPoints points(reach, 2 * pieces.size());
    for (LinePiece& piece : pieces)
        piece.segment = {points.standing(piece.segment.a), points.standing(piece.segment.b)};
    mergeDoubles(pieces);
    const double most = static_cast<double>(pieces.size()) + 2 * kMaxCrossings;
    for (int round = 0; round < kMaxRounds; ++round) {
        if (!Cutter(pieces, points, reach).cut()) return true;
        mergeDoubles(pieces);
        if (static_cast<double>(pieces.size()) > most) throw TooMany();
    }
    return false;
}

}  // namespace

std::vector<LinePiece> linePieces(std::span<const Segment2> lines) {
    std::vector<LinePiece> pieces;
    pieces.reserve(lines.size());
    for (const Segment2& line : lines)
        pieces.push_back({line, static_cast<Index>(pieces.size()), 0, 0, false});
    return pieces;
}

std::vector<LinePiece> noded(std::vector<LinePiece> lines, const CrossingMessage& message) {
    double farthest = 0;
    for (const LinePiece& line : lines)
        for (const Point2 p : {line.segment.a, line.segment.b})
            farthest = std::max({farthest, std::abs(p.x), std::abs(p.y)});
    try {
        std::vector<LinePiece> pieces = lines;
        double reach = std::ldexp(farthest, -46);
        for (int i = 0; i < kMaxWidenings; ++i, reach *= 64)
            if (cutAll(pieces, reach)) return pieces;
    } catch (const TooMany&) {
    }
    refuse(lines, message);
}

double sampledCrossings(std::span<const Segment2> lines) {
    const std::size_t n = lines.size();
    const std::size_t pairs = std::min(kSampledPairs + kSampledPairsPerLine * n, kMaxSampled);
    std::size_t hits = 0;
    if (n < kMaxSampled && n * n / 2 <= pairs) {
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < i; ++k) hits += intersects(lines[i], lines[k]);
        return static_cast<double>(hits);
    }
    std::mt19937_64 random(1);
    for (std::size_t i = 0; i < pairs; ++i) {
        const std::uint64_t bits = random();
        const Segment2& s = lines[(bits >> 32U) % n];
        const Segment2& t = lines[(bits & 0xffffffffU) % n];
        hits += &s != &t && intersects(s, t);
    }
    if (hits < kSureHits) return 0;
    return static_cast<double>(hits) / static_cast<double>(pairs) * static_cast<double>(n) *
           static_cast<double>(n) / 2;
}

}  // namespace ispace
