// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cover/shadow_footprint.h"
#include "geom/predicates.h"

namespace ispace {

FloorDensity::FloorDensity(const Camera& camera, const Pose3& pose, double plane)
    : focal_(rangeOf(camera, 1)),
      drop_(plane - pose.position.z),
      is_by_depth_(camera.lens == Lens::Pinhole),
      foot_(pose.position.onFloor()),
      axis_(Frame3(pose).forward),
      slope_(std::hypot(axis_.x, axis_.y)) {}

double FloorDensity::at(Point2 place) const {
    const Vec2 way = place - foot_;
    const double far = is_by_depth_ ? axis_.x * way.x + axis_.y * way.y + axis_.z * drop_
                                    : std::hypot(way.x, way.y, drop_);
    return far > 0 ? focal_ / far : std::numeric_limits<double>::infinity();
}

std::vector<Curve> FloorDensity::least(double pixels_per_metre, const Box2& box) const {
    const double far = focal_ / pixels_per_metre;
    if (!is_by_depth_) {
        if (!(std::fabs(drop_) < far)) return {};
        Curve disc = circleOf(std::sqrt(far * far - drop_ * drop_));
        for (CurveEdge& edge : disc) {
            const Vec2 way = foot_ - Point2{};
            edge = {edge.from + way, edge.to + way, edge.radius, edge.center + way};
        }
        return {std::move(disc)};
    }
    const Polygon polygon = {box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}};
    const double offset = far - axis_.z * drop_ + axis_.x * foot_.x + axis_.y * foot_.y;
    const Polygon half = halfOf(polygon, Vec2{-axis_.x, -axis_.y}, offset);
    if (half.empty()) return {};
    return {curveOf(half)};
}

namespace {

/// Mean of ln(t) for t from a to b, both over 0.
double meanLog(double a, double b) {
    const double step = b - a, middle = a + step / 2;
    if (std::fabs(step) < 1e-2 * middle) {
        const double share = step / middle, squared = share * share;
        return std::log(middle) - squared / 24 - squared * squared / 320;
    }
    return (b * std::log(b) - a * std::log(a)) / step - 1;
}

}  // namespace

/// The part of an edge in the integral of focal / depth, by Green's theorem: depth grows along one
/// direction of the plane, and edges count by how far they go across it.
double FloorDensity::alongAxis(Point2 a, Point2 b) const {
    constexpr double kNearest = 1e-12;
    const Vec2 uphill{axis_.x / slope_, axis_.y / slope_};
    const auto depth = [&](Point2 p) {
        return std::max(kNearest, slope_ * dot(uphill, p - foot_) + axis_.z * drop_);
    };
    return focal_ / slope_ * cross(uphill, b - a) * meanLog(depth(a), depth(b));
}

/// Likewise of focal / distance, by the angle that edges span about the foot.
double FloorDensity::around(Point2 a, Point2 b) const {
    constexpr std::array<double, 4> kPlaces = {-0.861136311594052575, -0.339981043584856265,
                                               0.339981043584856265, 0.861136311594052575};
    constexpr std::array<double, 4> kWeights = {0.347854845137453857, 0.652145154862546143,
                                                0.652145154862546143, 0.347854845137453857};
    const Vec2 from = a - foot_, way = b - a;
    const double high = std::fabs(drop_), scale = high + distance(foot_, Segment2{a, b});
    constexpr double kMostPieces = 4096;
    const double pieces = std::clamp(std::ceil(2 * length(way) / scale), 1.0, kMostPieces);
    double sum = 0;
    for (double i = 0; i < pieces; ++i)
        for (std::size_t k = 0; k < kPlaces.size(); ++k) {
            const Vec2 p = from + (i + (1 + kPlaces[k]) / 2) / pieces * way;
            sum += kWeights[k] / 2 / (std::hypot(p.x, p.y, high) + high);
        }
    return focal_ * cross(from, way) * sum / pieces;
}

double FloorDensity::integral(std::span<const Curve> curves) const {
    constexpr double kLevel = 1e-9;
    if (is_by_depth_ && slope_ < kLevel)
        return focal_ / std::fabs(axis_.z * drop_) * signedArea(curves);
    double sum = 0;
    for (const Curve& curve : curves)
        forEachEdge(chords(curve, kConicError), [&](const Segment2& edge) {
            sum += is_by_depth_ ? alongAxis(edge.a, edge.b) : around(edge.a, edge.b);
        });
    return sum;
}

std::vector<SeenSet> classesOf(const FloorDensity& density, const Grid& grid, const SeenSet& view) {
    const auto classes = pixelDensities();
    std::vector<SeenSet> sets(classes.size());
    for (SeenSet& set : sets) set.cells = CellSet(grid.size());
    view.cells.forEach([&](std::size_t cell) {
        const double pixels = density.at(grid.center(cell));
        for (std::size_t i = 0; i < classes.size() && pixels >= classes[i].pixels_per_metre; ++i)
            sets[i].cells.set(cell);
    });
    if (!view.region) return sets;
    for (SeenSet& set : sets) set.region.emplace();
    Box2 box = boundsOfAll(*view.region);
    if (box.empty()) return sets;
    constexpr double kAround = 1;
    box = {{box.low.x - kAround, box.low.y - kAround},
           {box.high.x + kAround, box.high.y + kAround}};
    std::vector<Layer> layers = {{.curves = *view.region}};
    for (std::size_t i = 0; i < classes.size(); ++i)
        layers.push_back({.curves = density.least(classes[i].pixels_per_metre, box),
                          .counts = false,
                          .marks = classMark(i)});
    const Overlay overlay(layers);
    for (std::size_t i = 0; i < classes.size(); ++i)
        sets[i].region = overlay.curves([i](const LayerLabel& label) {
            return label.count > 0 && (label.marks & classMark(i)) != 0;
        });
    return sets;
}

namespace {

/// How near and how far curves come to a place; 0 near if they hold it.
void addDistances(const std::vector<Curve>& curves, Point2 foot, PictureMetrics& metrics) {
    bool is_inside = false;
    for (const Curve& curve : curves) {
        const Polygon polygon = chords(curve);
        is_inside = is_inside != (locate(polygon, foot) == Side::Inside);
        forEachEdge(polygon, [&](const Segment2& edge) {
            metrics.nearest =
                std::min(metrics.nearest.value_or(std::numeric_limits<double>::infinity()),
                         distance(foot, edge));
            metrics.farthest = std::max(metrics.farthest.value_or(0), distance(foot, edge.a));
        });
    }
    if (is_inside) metrics.nearest = 0;
}

}  // namespace

PictureMetrics pictureMetricsOf(const FloorDensity& density, const Grid& grid, Point2 foot,
                                const SensorView& view) {
    PictureMetrics metrics;
    for (const SeenSet& set : view.classes) {
        Metric area{static_cast<double>(set.cells.count()) * grid.cellArea(), {}};
        if (set.region) area.exact = std::max(0.0, signedArea(*set.region));
        metrics.areas.push_back(area);
    }
    double sum = 0;
    std::size_t cells = 0;
    view.cells.forEach([&](std::size_t cell) {
        const Point2 center = grid.center(cell);
        if (const double pixels = density.at(center); std::isfinite(pixels)) {
            sum += pixels;
            ++cells;
        }
        if (view.region) return;
        const double far = distance(foot, center);
        metrics.nearest = std::min(metrics.nearest.value_or(far), far);
        metrics.farthest = std::max(metrics.farthest.value_or(far), far);
    });
    if (cells > 0) metrics.mean_density.grid = sum / static_cast<double>(cells);
    if (!view.region) return metrics;
    addDistances(*view.region, foot, metrics);
    const double area = signedArea(*view.region);
    if (area > kMinPiece) metrics.mean_density.exact = density.integral(*view.region) / area;
    return metrics;
}

}  // namespace ispace
