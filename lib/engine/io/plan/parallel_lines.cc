// SPDX-License-Identifier: GPL-3.0-or-later
// Lines are sorted into 600 directions of half a turn, 0.3 degrees each; the sides of a wall differ
// by at most 0.01 (sine of the angle), so they lie in the same direction or the two on each side of
// it. In the frame of a direction boxes of lines are thin, and a search for neighbours finds few.
#include "io/plan/parallel_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "io/plan/plan_lines.h"

namespace ispace {

namespace {

/// Metres.
constexpr double kThinWall = 0.08, kThickWall = 0.5, kShortestSide = 0.4;
/// Sine of the angle between the sides of a wall.
constexpr double kParallel = 0.01;
/// Share of the shorter side along which the other one faces it.
constexpr double kFacing = 0.5;

/// Directions of half a turn, and those on each side of one that are parallel to it.
constexpr std::size_t kPaths = 600, kNeighbours = 2;
constexpr double kStep = std::numbers::pi / kPaths;
static_assert(kNeighbours * kStep > 1.001 * kParallel);

/// Lines found that cost as much as a search.
constexpr std::size_t kSearch = 16;

std::size_t wayOf(const Segment2& line) {
    const Vec2 v = line.b - line.a;
    double turn = std::atan2(v.y, v.x);
    if (turn < 0) turn += std::numbers::pi;
    return static_cast<std::size_t>(turn / kStep) % kPaths;
}

Box2 boxIn(Vec2 along, const Segment2& line) {
    const auto in = [along](Point2 p) {
        return Point2{dot(p - Point2(), along), cross(along, p - Point2())};
    };
    return bounds(Segment2{in(line.a), in(line.b)});
}

}  // namespace

ParallelLines::ParallelLines(std::span<const Segment2> lines) : lines_(lines) {
    std::map<std::size_t, std::vector<std::size_t>> ways;
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (lines[i].a != lines[i].b) ways[wayOf(lines[i])].push_back(i);
    for (auto& [way, own] : ways) {
        // Lines upon each other, as copies of a symbol leave them, have one distance.
        const auto ends_of = [&](std::size_t i) {
            const auto [a, b] = lines[i];
            return std::array{a.x, a.y, b.x, b.y};
        };
        std::sort(own.begin(), own.end(), [&](std::size_t i, std::size_t k) {
            return std::pair(ends_of(i), i) < std::pair(ends_of(k), k);
        });
        own.erase(
            std::unique(own.begin(), own.end(),
                        [&](std::size_t i, std::size_t k) { return ends_of(i) == ends_of(k); }),
            own.end());
        const Vec2 along = unitVector(Angle::radians((static_cast<double>(way) + 0.5) * kStep));
        std::vector<Box2> boxes;
        boxes.reserve(own.size());
        for (const std::size_t i : own) boxes.push_back(boxIn(along, lines[i]));
        ways_.emplace(way, Path{along, BoxTree(boxes), std::move(own)});
    }
}

/// Directions are in classes of kStep, so only the line's own class and its neighbours can hold a
/// parallel; the search is as deep as the nearest side so far, at first the thickest wall.
std::optional<double> ParallelLines::otherSide(const Segment2& line, double scale, Budget& work) {
    const double thin = kThinWall / scale, least = kShortestSide / scale;
    const Point2 a = line.a, b = line.b;
    const double whole = distance(a, b);
    if (!(whole >= least)) return std::nullopt;
    const Vec2 along = 1 / whole * (b - a);
    double nearest = kThickWall / scale;
    bool any = false;
    const auto look = [&](const Segment2& other) {
        const auto [c, d] = other;
        const double length = distance(c, d);
        if (length < least || std::abs(cross(along, d - c)) > kParallel * length) return;
        const double apart = std::abs(cross(along, c + 0.5 * (d - c) - a));
        const auto [from, to] = std::minmax({dot(c - a, along), dot(d - a, along)});
        const double facing = std::min(whole, to) - std::max(0.0, from);
        if (apart < thin || apart > nearest || facing < kFacing * std::min(whole, length)) return;
        nearest = apart;
        any = true;
    };
    unpaid_ += kSearch;
    const std::size_t own = wayOf(line);
    for (std::size_t turn = kPaths - kNeighbours; turn <= kPaths + kNeighbours; ++turn) {
        const auto way = ways_.find((own + turn) % kPaths);
        if (way == ways_.end()) continue;
        const Box2 box = boxIn(way->second.along, line);
        const Vec2 aside{0, nearest};
        way->second.tree.search({box.low - aside, box.high + aside}, [&](std::size_t k) {
            ++unpaid_;
            look(lines_[way->second.lines[k]]);
        });
    }
    if (!work.take(unpaid_ / NearSegments::kFoundPerUnit))
        throw FormatError(Diagnostic{"", 0, 0, "parallel lines make " + work.excess()});
    unpaid_ %= NearSegments::kFoundPerUnit;
    return any ? std::optional(nearest) : std::nullopt;
}

double shareOfWalls(const Polygon& outline, std::span<const Segment2> lines, Budget& work) {
    ParallelLines parallels(lines);
    double whole = 0, walls = 0;
    forEachEdge(outline, [&](const Segment2& edge) {
        const double length = distance(edge.a, edge.b);
        whole += length;
        if (parallels.otherSide(edge, 1, work)) walls += length;
    });
    return whole > 0 ? walls / whole : 0;
}

}  // namespace ispace
