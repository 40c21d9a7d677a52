// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "sense/ultrasound.h"

namespace ispace {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Receivers this near to one line, as a share of its length, do not fix a place.
constexpr double kLine = 1e-6;
/// Receivers nearer to one plane than this share of their extent tell nothing of the height above
/// it by linear equations.
constexpr double kPlane = 1e-5;

Vector3d vectorOf(Vec3 v) { return {v.x, v.y, v.z}; }

/// Receivers about their middle, with the axes along which they spread.
struct Layout {
    Point3 middle;
    std::vector<Vector3d> places;  // from the middle
    Vector3d spread;               // mean squares along the axes, in ascending order
    Matrix3d axes;                 // columns; the first is the normal of the plane that fits best

    [[nodiscard]] double extent() const { return std::sqrt(spread[2]); }
};

Layout layoutOf(std::span<const Point3> receivers) {
    Layout layout;
    const auto count = static_cast<double>(receivers.size());
    for (const Point3 p : receivers) {
        const Vec3 from_first = p - receivers[0];
        layout.middle = layout.middle + (1 / count) * from_first;
    }
    layout.middle = receivers[0] + (layout.middle - Point3());
    layout.places.reserve(receivers.size());
    Matrix3d scatter = Matrix3d::Zero();
    for (const Point3 p : receivers) {
        const Vector3d place = vectorOf(p - layout.middle);
        layout.places.push_back(place);
        scatter += place * place.transpose() / count;
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(scatter);
    layout.spread = solver.eigenvalues().cwiseMax(0);
    layout.axes = solver.eigenvectors();
    return layout;
}

/// Sum of squares of measured less computed distances at `x`, and what a step of Gauss-Newton
/// needs.
struct Linearised {
    double cost = 0;
    Matrix3d normal = Matrix3d::Zero();    // J^T J
    Vector3d gradient = Vector3d::Zero();  // J^T r
};

Linearised linearise(const Layout& layout, std::span<const double> distances, const Vector3d& x) {
    Linearised result;
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const Vector3d from_receiver = x - layout.places[i];
        const double computed = from_receiver.norm();
        const double error = computed - distances[i];
        result.cost += error * error;
        // At the receiver itself its distance has no direction.
        if (computed == 0) continue;
        const Vector3d direction = from_receiver / computed;
        result.normal += direction * direction.transpose();
        result.gradient += error * direction;
    }
    return result;
}

/// Levenberg-Marquardt with the damping of Nielsen (Madsen, Nielsen, Tingleff: Methods for
/// Non-Linear Least Squares Problems, 2004, algorithm 3.16).
Vector3d refine(const Layout& layout, std::span<const double> distances, Vector3d x) {
    constexpr int kMostSteps = 200;
    const double tiny =
        1e-13 * (layout.extent() + *std::max_element(distances.begin(), distances.end()));
    Linearised here = linearise(layout, distances, x);
    double damping = 1e-6;
    double growth = 2;
    for (int i = 0; i < kMostSteps; ++i) {
        const Matrix3d damped = here.normal + damping * Matrix3d::Identity();
        const Vector3d step = damped.ldlt().solve(-here.gradient);
        if (!(step.norm() > tiny)) break;
        const Linearised there = linearise(layout, distances, x + step);
        const double expected = step.dot(damping * step - here.gradient);
        if (there.cost < here.cost) {
            const double gain = 2 * (here.cost - there.cost) / expected - 1;
            x += step;
            here = there;
            damping *= std::max(1.0 / 3, 1 - gain * gain * gain);
            growth = 2;
        } else {
            damping *= growth;
            growth *= 2;
        }
    }
    return x;
}

/// Where the search begins: solutions of the differences of squared spheres, which are linear.
struct Starts {
    std::array<Vector3d, 2> mirrored;  // with the height over the plane that squares sum up to
    std::optional<Vector3d> spatial;   // if the receivers are not in one plane
};

Starts startsOf(const Layout& layout, std::span<const double> distances) {
    const auto count = static_cast<double>(distances.size());
    double mean_square = 0;
    Vector3d right = Vector3d::Zero();  // mean of place * (|place|^2 - distance^2) / 2
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const double less = layout.places[i].squaredNorm() - distances[i] * distances[i];
        mean_square -= less / count;
        right += layout.places[i] * (less / 2 / count);
    }
    // |x|^2 = mean_square, and in the plane's axes each coordinate by itself.
    const Vector3d along = layout.axes.transpose() * right;
    const Vector3d in_plane = layout.axes.col(1) * (along[1] / layout.spread[1]) +
                              layout.axes.col(2) * (along[2] / layout.spread[2]);
    // Not in the plane itself, from where no direction leads out of it.
    const double least = 1e-6 * layout.extent();
    const double height = std::sqrt(std::max(mean_square - in_plane.squaredNorm(), least * least));
    const Vector3d up = height * layout.axes.col(0);
    Starts starts{{in_plane + up, in_plane - up}, {}};
    if (layout.spread[0] > kPlane * kPlane * layout.spread[2])
        starts.spatial = in_plane + layout.axes.col(0) * (along[0] / layout.spread[0]);
    return starts;
}

/// Diagonal of the inverse of J^T J; +infinity along what it leaves open.
Vector3d variances(const Matrix3d& normal) {
    constexpr double kOpen = 1e-14;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(normal);
    Vector3d result = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
        const double value = solver.eigenvalues()[k];
        const bool is_open = value <= kOpen * solver.eigenvalues()[2];
        for (int axis = 0; axis < 3; ++axis) {
            const double share = solver.eigenvectors()(axis, k) * solver.eigenvectors()(axis, k);
            if (!is_open) {
                result[axis] += share / value;
            } else if (share > 1e-9) {
                result[axis] = std::numeric_limits<double>::infinity();
            }
        }
    }
    return result;
}

}  // namespace

std::optional<Fix> locate(std::span<const Point3> receivers, std::span<const double> distances,
                          Vec3 towards) {
    assert(receivers.size() == distances.size());
    if (receivers.size() < kLeastReceivers) return std::nullopt;
    const Layout layout = layoutOf(receivers);
    if (!(layout.spread[1] > kLine * kLine * layout.spread[2])) return std::nullopt;

    const auto count = static_cast<double>(receivers.size());
    // The best place on each side of the receivers' plane, that of `towards` first.
    const Vector3d normal = layout.axes.col(0);
    const double out = vectorOf(towards).dot(normal);
    const bool is_flat = layout.spread[0] <= kPlane * kPlane * layout.spread[2];
    // Which of two mirror images it is nothing tells then.
    constexpr double kAlong = 1e-3;
    if (is_flat && std::fabs(out) <= kAlong * vectorOf(towards).norm()) return std::nullopt;
    const bool is_up = out >= 0;
    std::array<Vector3d, 2> places;
    std::array<double, 2> errors{std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::infinity()};
    const auto consider = [&](const Vector3d& start) {
        const Vector3d x = refine(layout, distances, start);
        const double error = std::sqrt(linearise(layout, distances, x).cost / count);
        const std::size_t side = (x.dot(normal) >= 0) == is_up ? 0 : 1;
        if (!(error < errors[side])) return;
        places[side] = x;
        errors[side] = error;
    };
    const Starts starts = startsOf(layout, distances);
    for (const Vector3d& start : starts.mirrored) consider(start);
    if (starts.spatial) consider(*starts.spatial);

    const bool is_far_side = errors[0] > 2 * errors[1] + 1e-9 * layout.extent();
    const Vector3d& x = places[is_far_side ? 1 : 0];
    const Vector3d variance = variances(linearise(layout, distances, x).normal);
    Fix fix;
    fix.position = layout.middle + Vec3{x[0], x[1], x[2]};
    fix.residual = errors[is_far_side ? 1 : 0];
    fix.pdop = std::sqrt(variance.sum());
    fix.hdop = std::sqrt(variance[0] + variance[1]);
    fix.vdop = std::sqrt(variance[2]);
    return fix;
}

}  // namespace ispace
