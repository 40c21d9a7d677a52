// SPDX-License-Identifier: GPL-3.0-or-later
// Integrates the pixel density of a camera over areas of the floor.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "coverage/pixel_density.h"
#include "coverage/shadow_footprint.h"
#include "geom/curve.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// Mean of ln(t) for t from a to b, both positive.
double meanLog(double a, double b) {
    const double step = b - a, middle = a + step / 2;
    if (std::fabs(step) < 1e-2 * middle) {
        const double share = step / middle, squared = share * share;
        return std::log(middle) - squared / 24 - squared * squared / 320;
    }
    return (b * std::log(b) - a * std::log(a)) / step - 1;
}

}  // namespace

/// Computes the contribution of an edge to the integral of focal / depth, by Green's theorem: depth
/// grows along one direction of the plane, and edges are weighted by their extent across it.
double FloorDensity::alongAxis(Point2 a, Point2 b) const {
    constexpr double kNearest = 1e-12;
    const Vec2 uphill{axis_.x / slope_, axis_.y / slope_};
    const auto depth = [&](Point2 p) {
        return std::max(kNearest, slope_ * dot(uphill, p - foot_) + axis_.z * drop_);
    };
    return focal_ / slope_ * cross(uphill, b - a) * meanLog(depth(a), depth(b));
}

/// Likewise of focal / distance, weighted by the angle that an edge spans about the foot.
double FloorDensity::around(Point2 a, Point2 b) const {
    constexpr std::array<double, 4> kPlaces = {-0.861136311594052575, -0.339981043584856265,
                                               0.339981043584856265, 0.861136311594052575};
    constexpr std::array<double, 4> kWeights = {0.347854845137453857, 0.652145154862546143,
                                                0.652145154862546143, 0.347854845137453857};
    const Vec2 from = a - foot_, way = b - a;
    const double high = std::fabs(drop_), scale = high + distance(foot_, Segment2{a, b});
    constexpr double kMaxPieces = 4096;
    const double pieces = std::clamp(std::ceil(2 * length(way) / scale), 1.0, kMaxPieces);
    double sum = 0;
    for (double i = 0; i < pieces; ++i)
        for (std::size_t k = 0; k < kPlaces.size(); ++k) {
            const Vec2 p = from + (i + (1 + kPlaces[k]) / 2) / pieces * way;
            sum += kWeights[k] / 2 / (std::hypot(p.x, p.y, high) + high);
        }
    return focal_ * cross(from, way) * sum / pieces;
}

/// Likewise of the density of a lens, by its integral along the ray from the foot.
double FloorDensity::byLens(Point2 a, Point2 b) const {
    constexpr std::array<double, 4> kPlaces = {-0.861136311594052575, -0.339981043584856265,
                                               0.339981043584856265, 0.861136311594052575};
    constexpr std::array<double, 4> kWeights = {0.347854845137453857, 0.652145154862546143,
                                                0.652145154862546143, 0.347854845137453857};
    const auto along_ray = [&](Vec2 to) {  // the mean of t density(t to), t from 0 to 1
        constexpr int kPieces = 8;
        double sum = 0;
        for (int i = 0; i < kPieces; ++i)
            for (std::size_t k = 0; k < kPlaces.size(); ++k) {
                const double t = (i + (1 + kPlaces[k]) / 2) / kPieces;
                sum += kWeights[k] / 2 / kPieces * t * lens_->densityAt(localOf(t * to));
            }
        return sum;
    };
    const Vec2 from = a - foot_, way = b - a;
    const double scale = std::fabs(drop_) + distance(foot_, Segment2{a, b});
    constexpr double kMaxPieces = 64;
    constexpr double kShort = 0.25, kTwo = 0.577350269189625765;  // two places do for short edges
    if (length(way) < kShort * scale)
        return cross(from, way) / 2 *
               (along_ray(from + (1 - kTwo) / 2 * way) + along_ray(from + (1 + kTwo) / 2 * way));
    const double pieces = std::clamp(std::ceil(2 * length(way) / scale), 1.0, kMaxPieces);
    double sum = 0;
    for (double i = 0; i < pieces; ++i)
        for (std::size_t k = 0; k < kPlaces.size(); ++k)
            sum += kWeights[k] / 2 * along_ray(from + (i + (1 + kPlaces[k]) / 2) / pieces * way);
    return cross(from, way) * sum / pieces;
}

double FloorDensity::integral(std::span<const Curve> curves) const {
    constexpr double kLevel = 1e-9;
    if (!lens_ && is_by_depth_ && slope_ < kLevel)
        return focal_ / std::fabs(axis_.z * drop_) * signedArea(curves);
    constexpr double kLensError = 10 * kConicError;  // of a sum that takes a hundred times longer
    double sum = 0;
    for (const Curve& curve : curves)
        forEachEdge(chords(curve, lens_ ? kLensError : kConicError), [&](const Segment2& edge) {
            sum += lens_          ? byLens(edge.a, edge.b)
                   : is_by_depth_ ? alongAxis(edge.a, edge.b)
                                  : around(edge.a, edge.b);
        });
    return sum;
}

}  // namespace ispace
