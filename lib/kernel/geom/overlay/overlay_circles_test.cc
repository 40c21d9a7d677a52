// SPDX-License-Identifier: GPL-3.0-or-later
// Unions of discs that nearly coincide, compared with their closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "geom/overlay/overlay.h"
#include "support/test_overlay.h"

namespace ispace {
namespace overlay_circles_test {

using std::numbers::pi;

struct Disc {
    Point2 center;
    double radius;

    [[nodiscard]] Curve curve() const {
        const Point2 east = center + Vec2{radius, 0}, west = center - Vec2{radius, 0};
        return {{east, west, radius, center}, {west, east, radius, center}};
    }
    [[nodiscard]] double area() const { return pi * radius * radius; }
};

/// Area of a union of discs by Green's theorem: the integral along each circle's arcs outside of
/// all others. Coordinates relative to the first centre.
double unionArea(const std::vector<Disc>& discs) {
    const Point2 origin = discs.front().center;
    double area = 0;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        std::vector<std::pair<double, double>> hidden;  // angles, within 0 ... 2 pi
        bool is_inside = false;
        for (std::size_t k = 0; k < discs.size() && !is_inside; ++k) {
            if (k == i) continue;
            const Vec2 way = discs[k].center - discs[i].center;
            const double d = length(way), r = discs[i].radius, other = discs[k].radius;
            if (d + r < other || (d + r == other && (d > 0 || k < i))) is_inside = true;
            if (d >= r + other || d + other <= r || is_inside) continue;
            const double along = (d + (r - other) * (r + other) / d) / 2;
            const double half = std::acos(std::clamp(along / r, -1.0, 1.0));
            double from = std::atan2(way.y, way.x) - half;
            from -= 2 * pi * std::floor(from / (2 * pi));
            const double to = from + 2 * half;
            hidden.emplace_back(from, std::min(to, 2 * pi));
            if (to > 2 * pi) hidden.emplace_back(0, to - 2 * pi);
        }
        if (is_inside) continue;
        std::sort(hidden.begin(), hidden.end());
        hidden.emplace_back(2 * pi, 2 * pi);
        const Vec2 at = discs[i].center - origin;
        const double r = discs[i].radius;
        double free_from = 0;
        for (const auto& [from, to] : hidden) {
            if (from > free_from) {
                const double a = free_from, b = from;
                area += r / 2 *
                        (r * (b - a) + at.x * (std::sin(b) - std::sin(a)) -
                         at.y * (std::cos(b) - std::cos(a)));
            }
            free_from = std::max(free_from, to);
        }
    }
    return area;
}

/// Bound of the header, with two crossings for each pair of circles.
double boundOf(const Overlay& overlay, const std::vector<Disc>& discs) {
    double length = 0;
    for (const Disc& disc : discs) length += 2 * pi * disc.radius;
    const auto count = static_cast<double>(discs.size());
    return 3 * overlay.unit() * length + count * (count - 1) * kChordError * kChordError;
}

TEST(NearCircles, largerOfTwoIsTheirUnion) {
    const Disc large{{0.10000001, 0.2}, 4.00000001}, small{{0.10000001, 0.2}, 4};
    for (const auto& pair : {std::pair(large, small), std::pair(small, large)}) {
        const Overlay overlay(std::vector<Layer>{{.curves = {pair.first.curve()}},
                                                 {.curves = {pair.second.curve()}}});
        EXPECT_NEAR(overlay.area(kAny), 50.2654827088, 2e-10);
    }
}

// Equal positions and radii up to a shift, in rooms of 4 to 200 m.
TEST(NearCircles, unionIsThatOfTheClosedForm) {
    std::mt19937_64 random(53);
    std::uniform_real_distribution<double> part(-1, 1);
    for (int round = 0; round < 700; ++round) {
        const double shift = std::pow(10, -9 + 6.0 * (round % 13) / 12);
        const double room = 4 * std::pow(50, (round % 11) / 10.0);
        const Disc first{{room * part(random), room * part(random)},
                         room * (0.3 + 0.2 * part(random))};
        std::vector<Disc> discs;
        std::vector<Layer> layers;
        double largest = 0;
        for (int i = 0; i < 2 + round % 9; ++i) {
            Disc disc = first;
            // Of one position, of one range, or of neither.
            if (round % 3 != 0)
                disc.center = disc.center + Vec2{shift * part(random), shift * part(random)};
            if (round % 3 != 1) disc.radius += shift * part(random);
            discs.push_back(disc);
            layers.push_back({.curves = {disc.curve()}});
            largest = std::max(largest, disc.area());
        }
        const Overlay overlay(layers);
        const double area = overlay.area(kAny), bound = boundOf(overlay, discs);
        ASSERT_NEAR(area, unionArea(discs), bound) << round << ", shift " << shift;
        ASSERT_GE(area, largest - bound) << round;
    }
}

TEST(NearCircles, equalCirclesAreOne) {
    for (const double radius : {0.05, 1.0, 30.0, 136.0}) {
        const Disc disc{{3, -2}, radius};
        const std::vector<Layer> layers(10, Layer{.curves = {disc.curve()}});
        const Overlay overlay(layers);
        EXPECT_NEAR(overlay.area(kAny), disc.area(), 1e-12 * disc.area());
        EXPECT_NEAR(overlay.area(atLeast(10)), disc.area(), 1e-12 * disc.area());
    }
}

}  // namespace overlay_circles_test
}  // namespace ispace
