// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of lib/kernel/geom and lib/kernel/raster: random curves, pixel maps and the exact
// reference.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace::test {

inline Polygon box(double x0, double y0, double x1, double y1) {
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

inline std::vector<Segment2> edgesOf(const Polygon& polygon) {
    std::vector<Segment2> edges;
    forEachEdge(polygon, [&](const Segment2& e) { edges.push_back(e); });
    return edges;
}

inline Polygon circle(Point2 center, double radius, int corners) {
    Polygon polygon;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        polygon.push_back(center + radius * Vec2{std::cos(angle), std::sin(angle)});
    }
    return polygon;
}

/// Creates a simple polygon with a ragged outline around (0, 0), which lies inside.
/// Counter-clockwise.
inline Polygon star(std::mt19937_64& random, int corners, double size) {
    std::uniform_real_distribution<double> radius(0.1 * size, size);
    Polygon polygon;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        polygon.push_back(Point2{} + radius(random) * Vec2{std::cos(angle), std::sin(angle)});
    }
    return polygon;
}

/// A picture of free and occupied pixels like an occupancy map, with free pixels at random.
struct PixelMap {
    int columns, rows;
    std::vector<bool> free;

    PixelMap(std::mt19937_64& random, int w, int h, double share) : columns(w), rows(h) {
        std::bernoulli_distribution coin(share);
        for (int i = 0; i < w * h; ++i) free.push_back(coin(random));
    }
    PixelMap(int w, int h) : columns(w), rows(h), free(static_cast<std::size_t>(w * h)) {}

    [[nodiscard]] bool at(int x, int y) const {
        return x >= 0 && y >= 0 && x < columns && y < rows &&
               free[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(x)];
    }
    /// Returns the unit edges between free and occupied pixels, the free ones on the left.
    [[nodiscard]] std::vector<Segment2> boundary() const {
        std::vector<Segment2> edges;
        for (int y = 0; y <= rows; ++y) {
            for (int x = 0; x <= columns; ++x) {
                const Point2 p{double(x), double(y)}, right{x + 1.0, p.y}, up{p.x, y + 1.0};
                if (at(x, y) && !at(x - 1, y)) edges.push_back({up, p});
                if (!at(x, y) && at(x - 1, y)) edges.push_back({p, up});
                if (at(x, y) && !at(x, y - 1)) edges.push_back({p, right});
                if (!at(x, y) && at(x, y - 1)) edges.push_back({right, p});
            }
        }
        return edges;
    }
    [[nodiscard]] std::size_t freeCount() const {
        std::size_t count = 0;
        for (const bool f : free) count += f ? 1 : 0;
        return count;
    }
    /// Counts the pieces of free pixels that share edges.
    [[nodiscard]] int pieces() const {
        std::vector<bool> seen(free.size());
        int count = 0;
        for (int start = 0; start < columns * rows; ++start) {
            if (seen[static_cast<std::size_t>(start)] || !free[static_cast<std::size_t>(start)])
                continue;
            ++count;
            std::vector<int> open{start};
            while (!open.empty()) {
                const int i = open.back();
                open.pop_back();
                const int x = i % columns, y = i / columns;
                if (!at(x, y) || seen[static_cast<std::size_t>(i)]) continue;
                seen[static_cast<std::size_t>(i)] = true;
                if (x > 0) open.push_back(i - 1);
                if (x + 1 < columns) open.push_back(i + 1);
                if (y > 0) open.push_back(i - columns);
                if (y + 1 < rows) open.push_back(i + columns);
            }
        }
        return count;
    }
};

// The reference for faces and differences: CGAL's arrangement in exact numbers, rounded to doubles
// at the end. Defined in arrangement_cgal_test.cc.

/// Computes the result expected of boundedFaces().
std::vector<Region> exactFaces(std::span<const Segment2> lines,
                               std::span<const Segment2> passages = {});

/// Computes the open connected pieces where the winding number of `added` is positive and that of
/// `removed` is zero.
std::vector<Region> exactDifference(std::span<const Segment2> added,
                                    std::span<const Segment2> removed);

}  // namespace ispace::test
