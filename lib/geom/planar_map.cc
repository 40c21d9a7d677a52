// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/planar_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <numeric>
#include <random>
#include <set>
#include <utility>

#include "base/error.h"
#include "geom/overlay.h"
#include "geom/predicates.h"
#include "geom/segment_grid.h"

namespace ispace {

namespace {

/// For each point the one that stands for all within kWeldDistance of it.
///
/// Points are taken from left to right; each joins the nearest standing point in reach or becomes
/// one, so that no point moves farther than kWeldDistance however many lie close together.
std::vector<Point2> weldPoints(const std::vector<Point2>& points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
        return points[i] == points[k] ? i < k : lexLess(points[i], points[k]);
    });
    std::vector<Point2> welded(points.size());
    std::deque<Point2> recent;                   // standing points in reach along x, …
    std::set<std::pair<double, double>> by_y_x;  // … and the same to be searched along y
    for (const std::size_t i : order) {
        const Point2 p = points[i];
        while (!recent.empty() && recent.front().x < p.x - kWeldDistance) {
            by_y_x.erase({recent.front().y, recent.front().x});
            recent.pop_front();
        }
        double nearest = kWeldDistance;
        welded[i] = p;
        bool joined = false;
        for (auto it = by_y_x.lower_bound({p.y - kWeldDistance, p.x - kWeldDistance});
             it != by_y_x.end() && it->first <= p.y + kWeldDistance; ++it) {
            const Point2 standing{it->second, it->first};
            const double apart = distance(p, standing);
            if (joined ? apart < nearest : apart <= nearest) {
                welded[i] = standing;
                nearest = apart;
                joined = true;
            }
        }
        if (joined) continue;
        recent.push_back(p);
        by_y_x.emplace(p.y, p.x);
    }
    return welded;
}

/// Points on lines, and looks for them, per line and besides: no plan needs as many, and what does
/// would not fit into memory.
constexpr std::size_t kTouchesPerLine = 32, kTouchesAnyway = 1U << 21;
constexpr std::size_t kLooksPerLine = 1024, kLooksAnyway = 1U << 26;
/// Crossings that an arrangement may have, about, and the pairs of lines by which they are counted.
constexpr double kMostCrossings = 500'000;
constexpr std::size_t kSampledPairs = 1U << 17, kSampledPairsPerLine = 16, kMostSampled = 1U << 22;
constexpr std::size_t kSureHits = 16;

/// For each segment the points of others that lie on its inside, in order along it.
std::vector<std::vector<Point2>> touchingPoints(const std::vector<Segment2>& segments) {
    std::vector<Point2> points;
    for (const auto& [a, b] : segments) points.insert(points.end(), {a, b});
    std::sort(points.begin(), points.end(), [](Point2 a, Point2 b) { return lexLess(a, b); });
    points.erase(std::unique(points.begin(), points.end()), points.end());

    const SegmentGrid grid(segments, kWeldDistance);
    std::vector<std::vector<Point2>> touching(segments.size());
    std::size_t touches = 0, looks = 0;
    for (const Point2 p : points) {
        const auto near = grid.near(p);
        looks += near.size();
        for (const std::uint32_t i : near) {
            const Segment2& s = segments[i];
            // Far out distances overflow to what is not near.
            if (p == s.a || p == s.b || !(distance(p, s) <= kWeldDistance)) continue;
            touching[i].push_back(p);
            ++touches;
        }
        if (touches > kTouchesAnyway + kTouchesPerLine * segments.size() ||
            looks > kLooksAnyway + kLooksPerLine * segments.size())
            throw FormatError(Diagnostic{
                "", 0, 0, "too many wall lines lie upon each other; leave out the doubles"});
    }
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const Vec2 along = segments[i].b - segments[i].a;
        std::stable_sort(touching[i].begin(), touching[i].end(), [&](Point2 p, Point2 q) {
            return dot(p - segments[i].a, along) < dot(q - segments[i].a, along);
        });
    }
    return touching;
}

/// About how many pairs of the lines have a point in common, by a sample of them where there are
/// many; 0 where too few of the sample do.
double sampledCrossings(std::span<const Segment2> lines) {
    const std::size_t n = lines.size();
    if (n < 2) return 0;
    std::mt19937_64 random(1);
    const std::size_t pairs = std::min(kSampledPairs + kSampledPairsPerLine * n, kMostSampled);
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

}  // namespace

WeldedLines weld(std::span<const Segment2> lines) {
    std::vector<Point2> ends;
    ends.reserve(2 * lines.size());
    for (const auto& [a, b] : lines) ends.insert(ends.end(), {a, b});
    const std::vector<Point2> welded_ends = weldPoints(ends);

    WeldedLines whole;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const Segment2 line{welded_ends[2 * i], welded_ends[2 * i + 1]};
        if (line.a == line.b) continue;
        whole.pieces.push_back(line);
        whole.source.push_back(i);
    }
    const auto touching = touchingPoints(whole.pieces);

    WeldedLines split;
    for (std::size_t i = 0; i < whole.pieces.size(); ++i) {
        Point2 from = whole.pieces[i].a;
        const auto add_piece = [&](Point2 to) {
            split.pieces.push_back({from, to});
            split.source.push_back(whole.source[i]);
            from = to;
        };
        for (const Point2 p : touching[i]) add_piece(p);
        add_piece(whole.pieces[i].b);
    }
    return split;
}

std::vector<Region> boundedFaces(const WeldedLines& lines) {
    return boundedFaces(lines.pieces, {});
}

std::vector<Region> boundedFaces(std::span<const Segment2> lines,
                                 std::span<const Segment2> passages) {
    if (auto faces = tracedFaces(lines, passages)) return std::move(*faces);
    // Of fewer lines not even all pairs are too many.
    if (static_cast<double>(lines.size()) > std::sqrt(2 * kMostCrossings) &&
        sampledCrossings(lines) > kMostCrossings)
        throw FormatError(
            Diagnostic{"", 0, 0, "too many wall lines cross each other; end them where they meet"});
    return overlayFaces(lines, passages);
}

}  // namespace ispace
