// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/noding.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

using Index = std::uint32_t;

/// Pairs of lines looked at, per line and besides.
constexpr std::size_t kLooksPerLine = 4096, kLooksAnyway = 1U << 26;
constexpr int kMaxRounds = 12;

[[noreturn]] void refuse() {
    throw FormatError(
        Diagnostic{"", 0, 0, "too many lines cross each other; end them where they meet"});
}

/// Points of which none are nearer to each other than `reach`.
class DistinctPoints {
  public:
    explicit DistinctPoints(double reach) : reach_(reach) {}

    /// The point that stands for p: one that came before, or p itself.
    Point2 standing(Point2 p) {
        if (!(reach_ > 0)) return p;
        // Cells twice as wide as the reach: four at most come into it.
        const double size = 2 * reach_;
        const double left = std::floor((p.x - reach_) / size);
        const double right = std::floor((p.x + reach_) / size);
        const double bottom = std::floor((p.y - reach_) / size);
        const double top = std::floor((p.y + reach_) / size);
        for (double x = left; x <= right; ++x) {
            for (double y = bottom; y <= top; ++y) {
                const auto [first, last] = points_.equal_range({x, y});
                for (auto it = first; it != last; ++it)
                    if (distance(it->second, p) <= reach_) return it->second;
            }
        }
        points_.emplace(Point2{std::floor(p.x / size), std::floor(p.y / size)}, p);
        return p;
    }

  private:
    struct Hash {
        std::size_t operator()(Point2 cell) const {
            const std::hash<double> hash;
            return hash(cell.x) * 0x9E3779B97F4A7C15U ^ hash(cell.y);
        }
    };
    double reach_;
    std::unordered_multimap<Point2, Point2, Hash> points_;  // by cell
};

/// One round of cutting; what it moves by rounding may have to be cut again.
class Cutter {
  public:
    Cutter(std::vector<LinePiece>& pieces, DistinctPoints& points, double reach)
        : pieces_(pieces), points_(points), reach_(reach) {
        segments_.reserve(pieces.size());
        for (const LinePiece& piece : pieces) segments_.push_back(piece.segment);
    }

    /// \return whether there was anything to cut
    bool cut() {
        const SegmentGrid grid(segments_, reach_);
        grid.forEachCell([this](std::span<const Index> cell) {
            looks_ += cell.size() * cell.size() / 2;
            if (looks_ > kLooksAnyway + kLooksPerLine * segments_.size()) refuse();
            for (std::size_t i = 0; i < cell.size(); ++i)
                for (std::size_t k = i + 1; k < cell.size(); ++k) meet(cell[i], cell[k]);
            if (static_cast<double>(cuts_.size()) >
                2 * kMaxCrossings + 8.0 * static_cast<double>(segments_.size()))
                refuse();
        });
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
        const double right = std::abs(cross(s.b - s.a, t.a - s.a));
        const double left = std::abs(cross(s.b - s.a, t.b - s.a));
        const Point2 at = points_.standing(t.a + right / (right + left) * (t.b - t.a));
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
                parts.push_back({{rest.segment.a, cut->at}, rest.line});
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
    std::size_t looks_ = 0;
};

/// Each piece once, whichever way it runs, in the order of their lines.
void dropDoubles(std::vector<LinePiece>& pieces) {
    std::erase_if(pieces, [](const LinePiece& p) { return p.segment.a == p.segment.b; });
    const auto ordered = [](const LinePiece& p) {
        const auto& [a, b] = p.segment;
        return lexLess(b, a) ? Segment2{b, a} : Segment2{a, b};
    };
    const auto less = [&](const LinePiece& p, const LinePiece& q) {
        const Segment2 s = ordered(p), t = ordered(q);
        if (s.a != t.a) return lexLess(s.a, t.a);
        if (s.b != t.b) return lexLess(s.b, t.b);
        return p.line < q.line;
    };
    std::sort(pieces.begin(), pieces.end(), less);
    const auto same = [&](const LinePiece& p, const LinePiece& q) {
        return ordered(p) == ordered(q);
    };
    pieces.erase(std::unique(pieces.begin(), pieces.end(), same), pieces.end());
}

}  // namespace

std::vector<LinePiece> piecesOf(std::span<const Segment2> lines) {
    double farthest = 0;
    for (const auto& [a, b] : lines)
        for (const double x : {a.x, a.y, b.x, b.y}) farthest = std::max(farthest, std::abs(x));
    const double reach = std::ldexp(farthest, -46);
    DistinctPoints points(reach);
    std::vector<LinePiece> pieces;
    pieces.reserve(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i)
        pieces.push_back(
            {{points.standing(lines[i].a), points.standing(lines[i].b)}, static_cast<Index>(i)});
    dropDoubles(pieces);
    const double most = static_cast<double>(pieces.size()) + 2 * kMaxCrossings;
    for (int round = 0; round < kMaxRounds; ++round) {
        if (!Cutter(pieces, points, reach).cut()) break;
        dropDoubles(pieces);
        if (static_cast<double>(pieces.size()) > most) refuse();
    }
    return pieces;
}

namespace {

constexpr std::size_t kCrossingsPerLine = 20, kCrossingsAnyway = 1000;

/// The lines as they are.
WeldedLines whole(std::span<const Segment2> lines) {
    WeldedLines all;
    all.pieces.assign(lines.begin(), lines.end());
    all.source.resize(lines.size());
    std::iota(all.source.begin(), all.source.end(), std::size_t{0});
    return all;
}

}  // namespace

WeldedLines cutAtCrossings(std::span<const Segment2> lines) {
    struct Cut {
        std::size_t line;
        double share;
        Point2 at;
    };
    const SegmentTree tree(lines);
    std::vector<Cut> cuts;
    const std::size_t most = kCrossingsAnyway + 2 * kCrossingsPerLine * lines.size();
    for (std::size_t i = 0; i < lines.size() && cuts.size() <= most; ++i) {
        const Vec2 along = lines[i].b - lines[i].a;
        tree.search(lines[i], 0, [&](std::size_t k) {
            // Each pair once, so that both get the same point.
            if (k <= i || cuts.size() > most || !intersects(lines[i], lines[k])) return;
            const Vec2 other = lines[k].b - lines[k].a;
            const double turn = cross(along, other);
            if (turn == 0) return;
            const Vec2 between = lines[k].a - lines[i].a;
            const double share = cross(between, other) / turn,
                         on_other = cross(between, along) / turn;
            const Point2 at = lines[i].a + share * along;
            const auto is_inside = [&](const Segment2& line) {
                return distance(at, line.a) > kWeldDistance && distance(at, line.b) > kWeldDistance;
            };
            if (is_inside(lines[i])) cuts.push_back({i, share, at});
            if (is_inside(lines[k])) cuts.push_back({k, on_other, at});
        });
    }
    if (cuts.size() > most) return whole(lines);
    std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) {
        return std::pair(a.line, a.share) < std::pair(b.line, b.share);
    });
    WeldedLines pieces;
    auto cut = cuts.begin();
    for (std::size_t i = 0; i < lines.size(); ++i) {
        Point2 from = lines[i].a;
        for (; cut != cuts.end() && cut->line == i; ++cut) {
            if (cut->at == from) continue;
            pieces.pieces.push_back({from, cut->at});
            pieces.source.push_back(i);
            from = cut->at;
        }
        pieces.pieces.push_back({from, lines[i].b});
        pieces.source.push_back(i);
    }
    return pieces;
}

namespace {

/// Pairs of lines by which crossings are counted.
constexpr std::size_t kSampledPairs = 1U << 17, kSampledPairsPerLine = 16, kMaxSampled = 1U << 22;
constexpr std::size_t kSureHits = 16;

/// Two digits: it is an estimate.
std::string roundNumber(double value) {
    const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(value)) - 1));
    return std::to_string(static_cast<std::uint64_t>(std::round(value / unit) * unit));
}

}  // namespace

double sampledCrossings(std::span<const Segment2> lines) {
    const std::size_t n = lines.size();
    if (n < 2) return 0;
    std::mt19937_64 random(1);
    const std::size_t pairs = std::min(kSampledPairs + kSampledPairsPerLine * n, kMaxSampled);
    std::size_t hits = 0;
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

void mustCrossRarely(std::span<const Segment2> lines, const std::string& what,
                     const std::string& hint) {
    // Of fewer lines not even all pairs are too many.
    if (static_cast<double>(lines.size()) <= std::sqrt(2 * kMaxCrossings)) return;
    const double crossings = sampledCrossings(lines);
    if (crossings <= kMaxCrossings) return;
    throw FormatError(Diagnostic{"", 0, 0,
                                 what + " cross each other about " + roundNumber(crossings) +
                                     " times, at most " + roundNumber(kMaxCrossings) + " can be; " +
                                     hint});
}

}  // namespace ispace
