// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of overlays: layers and queries of their areas.
#pragma once

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <tuple>
#include <vector>

#include "geom/overlay/overlay.h"
#include "support/test_curves.h"

namespace ispace {

using std::numbers::pi;

inline const auto kAny = [](const LayerLabel& label) { return label.count > 0; };
inline auto atLeast(int k) {
    return [k](const LayerLabel& label) { return label.count >= k; };
}

inline Curve straight(const Polygon& polygon) {
    Curve curve;
    forEachEdge(polygon, [&](const Segment2& e) { curve.push_back({e.a, e.b, 0, {}}); });
    return curve;
}

inline Layer layerOf(const std::vector<Polygon>& polygons, std::int64_t number = 0) {
    std::vector<Curve> curves;
    curves.reserve(polygons.size());
    for (const Polygon& polygon : polygons) curves.push_back(straight(polygon));
    return {.curves = std::move(curves), .number = number};
}

inline Layer marking(const Polygon& polygon, std::uint64_t marks) {
    Layer layer = layerOf({polygon});
    layer.counts = false;
    layer.marks = marks;
    return layer;
}

inline Polygon reversed(Polygon polygon) {
    std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

/// Builds a disc in four quarters, from this direction.
inline Curve disc(Point2 center, double radius, double from = 0) {
    Curve curve;
    const auto at = [&](int i) {
        const double angle = from + i % 4 * pi / 2;
        return center + radius * Vec2{std::cos(angle), std::sin(angle)};
    };
    for (int i = 0; i < 4; ++i) curve.push_back({at(i), at(i + 1), radius, center});
    return curve;
}

inline Layer curveLayer(const Curve& curve, std::int64_t number = 0) {
    return {.curves = {curve}, .number = number};
}

/// Returns areas by label, without the outside.
inline std::map<std::tuple<int, std::int64_t, std::uint64_t>, double> areasOf(
    const Overlay& overlay) {
    std::map<std::tuple<int, std::int64_t, std::uint64_t>, double> areas;
    overlay.addAreas([&](const LayerLabel& label, double area) {
        areas[{label.count, label.numbers, label.marks}] += area;
    });
    areas.erase({0, 0, 0});
    return areas;
}

inline std::vector<double> depths(const Overlay& overlay, std::size_t most) {
    std::vector<double> areas(most + 1);
    overlay.addAreas([&](const LayerLabel& label, double area) {
        ASSERT_GE(label.count, 0);
        ASSERT_LE(static_cast<std::size_t>(label.count), most);
        areas[static_cast<std::size_t>(label.count)] += area;
    });
    areas[0] = 0;
    return areas;
}

inline double boundOf(const Overlay& overlay, const std::vector<Layer>& layers) {
    double length = 0;
    for (const Layer& layer : layers)
        for (const Curve& curve : layer.curves)
            for (const CurveEdge& edge : curve) length += 2 * distance(edge.from, edge.to);
    return 3 * overlay.unit() * length + 1e-15;
}

inline Polygon moved(Polygon polygon, Vec2 by) {
    for (Point2& p : polygon) p = p + by;
    return polygon;
}

inline std::vector<Layer> randomStars(std::mt19937_64& random, int count, int corners,
                                      double spread) {
    std::uniform_real_distribution<double> at(-spread, spread);
    std::vector<Layer> layers;
    layers.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
        layers.push_back(
            layerOf({moved(test::star(random, corners, 4), {at(random), at(random)})}, i));
    return layers;
}

}  // namespace ispace
