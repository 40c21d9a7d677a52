// SPDX-License-Identifier: GPL-3.0-or-later
// For tests and benchmarks of visibility: random plans and the exact reference.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "geom/polygon.h"
#include "geom/pose.h"

namespace ispace::test {

struct PlanSize {
    int columns = 2, rows = 2;  ///< rooms of 4 m x 4 m
    int furniture = 9;          ///< pieces in all; at most 9 per room
    int corners = 12;           ///< of a piece
    int outline_corners = 40;   ///< number of corners of a ragged outline
};

/// Creates plans with disjoint curves: an outline with notches, rooms between walls with
/// portal gaps (walls are thin boxes, a centimetre apart at their ends), furniture of any shape;
/// rotated.
class PlanMaker {
  public:
    PlanMaker(std::uint64_t seed, const PlanSize& size)
        : random_(seed), size_(size), turned_({{3, -2}, Angle::degrees(360 * share())}) {}

    Region make() {
        Region plan;
        addOutline(plan.outline);
        for (int row = 0; row < size_.rows; ++row) {
            for (int column = 0; column < size_.columns; ++column) {
                const double x = kRoom * column, y = kRoom * row;
                if (column + 1 < size_.columns) addWall(plan, {x + kRoom, y}, {0, 1});
                if (row + 1 < size_.rows) addWall(plan, {x, y + kRoom}, {1, 0});
            }
        }
        const int rooms = size_.columns * size_.rows;
        for (int i = 0; i < size_.furniture; ++i) {
            const int room = i % rooms, place = 4 * (i / rooms) % 9;
            const int column = room % size_.columns, row = room / size_.columns;
            const int across = place % 3, up = place / 3;
            const Point2 center{kRoom * column + 0.9 + 1.1 * across, kRoom * row + 0.9 + 1.1 * up};
            addHole(plan, piece(center));
        }
        return plan;
    }

  private:
    static constexpr double kRoom = 4, kWall = 0.1, kGap = 0.01;

    double share() { return std::uniform_real_distribution<double>()(random_); }

    void addOutline(Polygon& outline) {
        const double width = kRoom * size_.columns, depth = kRoom * size_.rows;
        const Point2 corners[] = {{0, 0}, {width, 0}, {width, depth}, {0, depth}};
        const int steps = std::max(1, size_.outline_corners / 4);
        for (int side = 0; side < 4; ++side) {
            const Point2 from = corners[side];
            const Vec2 way = corners[(side + 1) % 4] - from;
            const Vec2 out = (-1 / length(way)) * perpendicular(way);
            for (int i = 0; i < steps; ++i) {
                const double notch = i == 0 ? 0 : 0.4 * share();
                outline.push_back(turned_ * (from + (double(i) / steps) * way + notch * out));
            }
        }
    }

    /// Adds two boxes along a side of a room, with a portal between them.
    void addWall(Region& plan, Point2 from, Vec2 along) {
        const double portal = 0.5 + 2 * share(), end = kRoom - kWall - kGap;
        const double start = kWall + kGap;
        for (const auto& [a, b] : {std::pair(start, portal), std::pair(portal + 0.9, end)}) {
            const Vec2 half = (kWall / 2) * perpendicular(along);
            addHole(plan, {from + a * along - half, from + b * along - half,
                           from + b * along + half, from + a * along + half});
        }
    }

    Polygon piece(Point2 center) {
        Polygon polygon;
        const double size = 0.2 + 0.3 * share(), turn = share();
        for (int i = 0; i < size_.corners; ++i) {
            const double angle = 2 * std::numbers::pi * (i + turn) / size_.corners;
            const double radius = size * (0.5 + 0.5 * share());
            polygon.push_back(center + radius * Vec2{std::cos(angle), std::sin(angle)});
        }
        return polygon;
    }

    void addHole(Region& plan, const Polygon& outline) {
        Polygon hole;
        for (std::size_t i = outline.size(); i-- > 0;) hole.push_back(turned_ * outline[i]);
        plan.holes.push_back(std::move(hole));
    }

    std::mt19937_64 random_;
    PlanSize size_;
    Pose2 turned_;
};

inline Region makePlan(std::uint64_t seed, const PlanSize& size) {
    return PlanMaker(seed, size).make();
}

inline std::vector<Segment2> linesOf(const Region& plan) {
    std::vector<Segment2> lines;
    plan.forEachEdge([&lines](const Segment2& edge) { lines.push_back(edge); });
    return lines;
}

inline Box2 boxOf(std::span<const Segment2> lines) {
    Box2 box;
    for (const auto& [a, b] : lines) {
        box.add(a);
        box.add(b);
    }
    return box;
}

inline Point2 randomIn(std::mt19937_64& random, const Box2& box) {
    std::uniform_real_distribution<double> x(box.low.x, box.high.x), y(box.low.y, box.high.y);
    const double px = x(random);
    return {px, y(random)};
}

/// Returns a random point strictly inside, and clear of all lines.
inline Point2 randomInside(std::mt19937_64& random, const Region& plan) {
    const Box2 box = bounds(plan.outline);
    for (;;) {
        const Point2 p = randomIn(random, box);
        if (plan.locate(p) == Side::Inside) return p;
    }
}

// The reference for visibility in tests and benchmarks: CGAL's triangular expansion, in exact
// numbers.
/// Holds lines and a box around them, 10 m away. Defined in visibility_oracle_cgal_test.cc.
class VisibilityOracle {
  public:
    explicit VisibilityOracle(std::span<const Segment2> lines);
    ~VisibilityOracle();
    VisibilityOracle(const VisibilityOracle&) = delete;
    VisibilityOracle& operator=(const VisibilityOracle&) = delete;

    /// Computes the area seen from a point, on both sides of all lines on which it lies.
    [[nodiscard]] double areaFrom(Point2 p) const;
    /// Computes the same from the point at `eighths` of a line, exactly on it; sets `rounded` to
    /// it.
    [[nodiscard]] double areaFrom(const Segment2& line, int eighths, Point2& rounded) const;

    /// Finds the number of the face that a point lies strictly in.
    [[nodiscard]] std::optional<std::size_t> faceOf(Point2 p);
    /// Computes the visibility polygon of a point in a face; returns the sum of its corners as
    /// doubles.
    [[nodiscard]] Vec2 query(Point2 p, std::size_t face) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace::test
