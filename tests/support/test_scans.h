// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of FlatWorld: scans, their hits, and plans.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "support/test_triangles.h"
#include "trace/flat_world.h"

namespace ispace::testing {

using Lines = std::vector<Segment2>;

inline Directions scan(Angle first, Angle step, std::size_t beams) {
    Directions directions;
    directions.resize(beams);
    directions.arc = Directions::Arc{first, step};
    for (std::size_t i = 0; i < beams; ++i) {
        const Vec2 way = unitVector(first + static_cast<double>(i) * step);
        directions.set(i, {way.x, way.y, 0});
    }
    return directions;
}

inline Directions towards(Point2 origin, const std::vector<Point2>& targets) {
    Directions directions;
    directions.resize(targets.size());
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const Vec2 way = targets[i] - origin;
        directions.set(i, {way.x / length(way), way.y / length(way), 0});
    }
    return directions;
}

struct Seen {
    std::vector<float> ranges, cosines;
    friend bool operator==(const Seen&, const Seen&) = default;
};

inline Seen cast(const FlatWorld& world, Point2 origin, const Directions& directions,
                 double max_range = kInfinity) {
    Seen seen{std::vector<float>(directions.size(), -1), std::vector<float>(directions.size(), -1)};
    world.cast(origin, directions, max_range, kTouching, seen.ranges, seen.cosines);
    std::vector<float> alone(directions.size(), -1);
    world.cast(origin, directions, max_range, kTouching, alone, {});
    EXPECT_EQ(alone, seen.ranges);
    return seen;
}

/// Casts the same beams, each from a separate origin.
inline Seen castApart(const FlatWorld& world, Point2 origin, const Directions& directions,
                      double max_range = kInfinity) {
    Seen seen{std::vector<float>(directions.size(), -1), std::vector<float>(directions.size(), -1)};
    const std::vector<Point2> origins(directions.size(), origin);
    world.cast(origins, directions, max_range, kTouching, seen.ranges, seen.cosines);
    return seen;
}

inline void addPolygon(Lines& lines, Point2 middle, double radius, int corners, double turn) {
    Polygon polygon;
    for (int i = 0; i < corners; ++i) {
        const Angle bearing = Angle::degrees(turn + 360.0 * i / corners);
        polygon.push_back(middle + radius * unitVector(bearing));
    }
    forEachEdge(polygon, [&](const Segment2& edge) { lines.push_back(edge); });
}

/// Creates rooms of 4 m x 5 m along corridors, each with a gap for a door, a desk, a chair and a
/// round table.
inline Lines office(int columns, int rows) {
    Lines lines;
    const double right = 4 * columns, top = 7 * rows;
    forEachEdge(Polygon{{0, 0}, {right, 0}, {right, top}, {0, top}},
                [&](const Segment2& edge) { lines.push_back(edge); });
    for (int row = 0; row < rows; ++row) {
        const double y = 7 * row;
        if (row > 0) lines.push_back({{0, y}, {right - 1, y}});
        for (int column = 0; column < columns; ++column) {
            const double x = 4 * column;
            lines.push_back({{x, y + 5}, {x + 1, y + 5}});
            lines.push_back({{x + 2, y + 5}, {x + 4, y + 5}});
            lines.push_back({{x + 4, y}, {x + 4, y + 5}});
            addPolygon(lines, {x + 2.8, y + 1}, 0.9, 4, 27);
            addPolygon(lines, {x + 2.8, y + 2.2}, 0.25, 4, 10 * column);
            addPolygon(lines, {x + 1.2, y + 3.4}, 0.5, 16, 0);
        }
    }
    return lines;
}

/// Creates lines of all sizes and directions, some of them with common ends.
inline Lines tangle(std::mt19937_64& random, int count, double size) {
    std::uniform_real_distribution<double> place(0, size), turn(0, 360), exponent(-4, 0);
    Lines lines;
    for (int i = 0; i < count; ++i) {
        const bool joins = i % 3 == 1;
        const Point2 a = joins ? lines.back().b : Point2{place(random), place(random)};
        const double reach = size * std::pow(10, exponent(random));
        lines.push_back({a, a + reach * unitVector(Angle::degrees(turn(random)))});
    }
    return lines;
}

}  // namespace ispace::testing
