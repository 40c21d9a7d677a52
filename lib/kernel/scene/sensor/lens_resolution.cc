// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/lens_resolution.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace ispace {

namespace {

/// The smaller singular value of a matrix, row by row.
double leastStretch(const std::array<double, 4>& m) {
    const double sum = m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + m[3] * m[3];
    const double det = m[0] * m[3] - m[1] * m[2];
    const double apart = std::sqrt(std::max(0.0, sum * sum - 4 * det * det));
    return std::fabs(det) / std::sqrt(std::max((sum + apart) / 2, 1e-300));
}

/// Returns an upper bound of it for matrices that differ by at most `change`: the stretch of the
/// direction that the middle stretches least.
double mostStretch(const std::array<double, 4>& m, const std::array<double, 4>& change) {
    const double turn = std::atan2(2 * (m[0] * m[1] + m[2] * m[3]),
                                   m[0] * m[0] + m[2] * m[2] - m[1] * m[1] - m[3] * m[3]) /
                        2;
    const double x = -std::sin(turn), y = std::cos(turn);
    return std::hypot(m[0] * x + m[1] * y, m[2] * x + m[3] * y) +
           std::hypot(change[0] * std::fabs(x) + change[1] * y,
                      change[2] * std::fabs(x) + change[3] * y);
}

/// Bounds of it: it changes by no more than the norm of a change of the matrix, and is that of the
/// transposed matrix, too.
Interval leastStretch(const std::array<Interval, 4>& m) {
    std::array<double, 4> middle{}, change{};
    double norm = 0;
    for (std::size_t i = 0; i < m.size(); ++i) {
        middle[i] = (m[i].low + m[i].high) / 2;
        change[i] = (m[i].high - m[i].low) / 2;
        norm += squareOf(change[i]);
    }
    const auto transposed = [](const std::array<double, 4>& a) {
        return std::array<double, 4>{a[0], a[2], a[1], a[3]};
    };
    return {
        std::max(0.0, leastStretch(middle) - std::sqrt(norm)),
        std::min(mostStretch(middle, change), mostStretch(transposed(middle), transposed(change)))};
}

/// Polynomials of the squared angle of a fisheye: the picture's radius over the angle, and the
/// derivative of the radius.
template <typename Number>
std::array<Number, 2> fisheyeOf(const std::array<double, 5>& d, Number s) {
    return {1 + s * (d[0] + s * (d[1] + s * (d[2] + d[3] * s))),
            1 + s * (3 * d[0] + s * (5 * d[1] + s * (7 * d[2] + 9 * d[3] * s)))};
}

}  // namespace

LensResolution::LensResolution(const Camera& camera)
    : lens_(camera.lens),
      focal_(std::min(camera.fx, camera.fy)),
      mirror_(camera.mirror),
      distortion_(camera.distortion),
      widest_(camera.widestInPicture().radians()),
      cos_widest_(std::cos(widest_)),
      sin_widest_(std::sin(widest_)),
      is_lopsided_(camera.isLopsided()) {}

bool LensResolution::isEven(const Camera& camera) {
    return camera.isStraight() || (camera.lens == Lens::Fisheye && !camera.isDistorted());
}

/// The picture of a point at `tangent` from the axis of the plane at depth 1 is that of
/// `plumb_bob`; a radian along the bearing moves the point by 1 + tangent^2, one across it by the
/// square root of that.
template <typename Number>
std::array<Number, 4> LensResolution::stretch(Number tangent, Number u, Number v) const {
    const auto& d = distortion_;
    const Number s = squareOf(tangent), far = 1 + s, near = rootOf(far);
    const Number radial = 1 + s * (d[0] + s * (d[1] + d[4] * s));
    const Number slope = 1 + s * (3 * d[0] + s * (5 * d[1] + 7 * d[4] * s));
    const Number along = 2 * tangent * (d[3] * u + d[2] * v);
    const Number across = 2 * tangent * (d[2] * u + -d[3] * v);
    return {far * (slope + 3 * along), near * across, far * across, near * (radial + along)};
}

double LensResolution::unitAt(double along, double across, double u, double v) const {
    constexpr double kSmall = 1e-9;
    if (lens_ == Lens::Pinhole) return leastStretch(stretch(across / along, u, v));
    if (lens_ == Lens::Mirror) {
        const double depth = along + mirror_;
        return std::min(1 / depth, (1 + mirror_ * along) / (depth * depth));
    }
    const double angle = std::atan2(across, along);
    const auto [radial, slope] = fisheyeOf(distortion_, angle * angle);
    return std::min(std::fabs(slope), across > kSmall ? angle * radial / across : radial);
}

Interval LensResolution::unitIn(const Cell& cell) const {
    const auto [low, high] = cell.angle;
    if (lens_ == Lens::Pinhole) {
        const double turn = std::numbers::pi / 2;
        return leastStretch(stretch(Interval{std::tan(low), std::tan(high)}, cosineOf(cell.bearing),
                                    cosineOf({cell.bearing.low - turn, cell.bearing.high - turn})));
    }
    if (lens_ == Lens::Mirror) {
        const Interval depth{std::cos(high) + mirror_, std::cos(low) + mirror_};
        return lesserOf({1 / depth.high, 1 / depth.low},
                        {(1 + mirror_ * std::cos(high)) / squareOf(depth.high),
                         (1 + mirror_ * std::cos(low)) / squareOf(depth.low)});
    }
    const auto [radial, slope] = fisheyeOf(distortion_, squareOf(cell.angle));
    const auto over_sine = [](double angle) { return angle > 0 ? angle / std::sin(angle) : 1; };
    return lesserOf(absolute(slope), Interval{over_sine(low), over_sine(high)} * radial);
}

Interval LensResolution::around(Vec3 center, double radius) const {
    constexpr double kPi = std::numbers::pi;
    const double across = std::hypot(center.y, center.z), far = std::hypot(center.x, across);
    Cell cell{{0, widest_}, {-kPi, kPi}};
    if (radius < far) {
        const double angle = std::atan2(across, center.x), change = std::asin(radius / far);
        cell.angle = {std::clamp(angle - change, 0.0, widest_),
                      std::clamp(angle + change, 0.0, widest_)};
    }
    if (!is_lopsided_) {
        cell.bearing = {0, 0};
    } else if (radius < across) {
        const double bearing = std::atan2(-center.z, -center.y);
        const double change = std::asin(radius / across);
        cell.bearing = {bearing - change, bearing + change};
    }
    return focal_ * unitIn(cell);
}

double LensResolution::at(Vec3 direction) const {
    const double squared = direction.y * direction.y + direction.z * direction.z;
    const double across = std::sqrt(squared);
    const double far = std::sqrt(direction.x * direction.x + squared);
    double u = 1, v = 0;
    if (across > 0) {
        u = -direction.y / across;
        v = -direction.z / across;
    }
    if (direction.x <= cos_widest_ * far) return focal_ * unitAt(cos_widest_, sin_widest_, u, v);
    return focal_ * unitAt(direction.x / far, across / far, u, v);
}

double LensResolution::densityAt(Vec3 local) const {
    const double far = std::sqrt(dot(local, local));
    return far > 0 ? at(local) / far : std::numeric_limits<double>::infinity();
}

/// Splits the cell with the highest bound until that is near a value in the picture. After
/// kMaxCells it may stay half as high again, near 90 degrees off the axis.
double LensResolution::largest(bool is_along_axis) const {
    constexpr double kPi = std::numbers::pi, kEnough = 1.01, kRounding = 1 + 1e-9;
    constexpr std::size_t kMaxCells = 1 << 12;
    struct Bounded {
        Cell cell;
        double bound = 0;
        bool operator<(const Bounded& other) const { return bound < other.bound; }
    };
    const auto factor = [&](double angle) { return is_along_axis ? std::cos(angle) : 1; };
    const auto bounded = [&](const Cell& cell) {
        return Bounded{cell, factor(cell.angle.low) * unitIn(cell).high};
    };
    const auto halves = [&](const Cell& cell, Interval Cell::*side) {
        std::array<Cell, 2> cells = {cell, cell};
        (cells[0].*side).high = (cells[1].*side).low = ((cell.*side).low + (cell.*side).high) / 2;
        return std::array<Bounded, 2>{bounded(cells[0]), bounded(cells[1])};
    };
    double largest = 0;
    std::vector<Bounded> cells = {
        bounded({{0, widest_}, is_lopsided_ ? Interval{-kPi, kPi} : Interval{0, 0}})};
    while (cells.front().bound > kEnough * largest && cells.size() < kMaxCells) {
        std::pop_heap(cells.begin(), cells.end());
        const Cell cell = cells.back().cell;
        cells.pop_back();
        std::vector<Bounded> parts;
        for (const Bounded& half : halves(cell, &Cell::angle)) {
            if (!is_lopsided_) {
                parts.push_back(half);
                continue;
            }
            for (const Bounded& quarter : halves(half.cell, &Cell::bearing))
                parts.push_back(quarter);
        }
        for (const Bounded& half : parts) {
            const auto [angle, bearing] = half.cell;
            const double turn = (bearing.low + bearing.high) / 2;
            for (const double a : {(angle.low + angle.high) / 2, angle.high})
                largest = std::max(largest, factor(a) * unitAt(std::cos(a), std::sin(a),
                                                               std::cos(turn), std::sin(turn)));
            cells.push_back(half);
            std::push_heap(cells.begin(), cells.end());
        }
    }
    return kRounding * focal_ * cells.front().bound;
}

double LensResolution::farthest(double pixels_per_metre) const {
    return largest(lens_ == Lens::Pinhole) / pixels_per_metre;
}

double LensResolution::most() const { return largest(false); }

}  // namespace ispace
