// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/locate.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "geom/rotation.h"
#include "sense/dilution.h"

namespace ispace {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Receivers this near to one line, as a share of its length, do not determine a position.
constexpr double kLine = 1e-6;
/// For receivers nearer to one plane than this share of their extent, linear equations do not
/// determine the height above it.
constexpr double kPlane = 1e-5;

/// Receivers relative to their centroid, with the principal axes of their spread.
struct Layout {
    Point3 middle;
    std::vector<Vector3d> places;  // relative to the centroid
    Vector3d spread;               // mean squares along the axes, ascending
    Matrix3d axes;                 // columns; the first is the normal of the best-fitting plane

    [[nodiscard]] double extent() const { return std::sqrt(spread[2]); }
};

Layout layoutOf(std::span<const Hearing> heard) {
    Layout layout;
    const auto count = static_cast<double>(heard.size());
    const Point3 first = heard.front().place;
    for (const Hearing& one : heard) {
        const Vec3 from_first = one.place - first;
        layout.middle = layout.middle + (1 / count) * from_first;
    }
    layout.middle = first + (layout.middle - Point3());
    layout.places.reserve(heard.size());
    Matrix3d scatter = Matrix3d::Zero();
    for (const Hearing& one : heard) {
        const Vector3d place = vectorOf(one.place - layout.middle);
        layout.places.push_back(place);
        scatter += place * place.transpose() / count;
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(scatter);
    layout.spread = solver.eigenvalues().cwiseMax(0);
    layout.axes = solver.eigenvectors();
    return layout;
}

/// Sum of squares of measured minus computed distances at `x`, and the terms of a Gauss-Newton
/// step.
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
        // At the receiver itself the direction is undefined.
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
    constexpr int kMaxSteps = 200;
    const double tiny =
        1e-13 * (layout.extent() + *std::max_element(distances.begin(), distances.end()));
    Linearised here = linearise(layout, distances, x);
    double damping = 1e-6;
    double growth = 2;
    for (int i = 0; i < kMaxSteps; ++i) {
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

/// Start values of the search: solutions of the differences of squared spheres, which are linear.
struct Starts {
    std::array<Vector3d, 2> mirrored;  // with the height above the plane from the sum of squares
    std::optional<Vector3d> spatial;   // if the receivers are not in one plane
};

Starts startsOf(const Layout& layout, std::span<const double> distances) {
    const auto count = static_cast<double>(distances.size());
    double mean_square = 0;
    Vector3d right = Vector3d::Zero();  // mean of p * (|p|^2 - distance^2) / 2 over positions p
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const double less = layout.places[i].squaredNorm() - distances[i] * distances[i];
        mean_square -= less / count;
        right += layout.places[i] * (less / 2 / count);
    }
    // The square of |x| is mean_square, and in the plane's axes each coordinate is independent.
    const Vector3d along = layout.axes.transpose() * right;
    const Vector3d in_plane = layout.axes.col(1) * (along[1] / layout.spread[1]) +
                              layout.axes.col(2) * (along[2] / layout.spread[2]);
    // Not in the plane itself, where the gradient has no component across it.
    const double least = 1e-6 * layout.extent();
    const double height = std::sqrt(std::max(mean_square - in_plane.squaredNorm(), least * least));
    const Vector3d up = height * layout.axes.col(0);
    Starts starts{{in_plane + up, in_plane - up}, {}};
    if (layout.spread[0] > kPlane * kPlane * layout.spread[2])
        starts.spatial = in_plane + layout.axes.col(0) * (along[0] / layout.spread[0]);
    return starts;
}

/// Returns the variances for unit errors of distances.
Vector3d variances(const Matrix3d& normal) {
    return vectorOf(variancesOf(
        {normal(0, 0), normal(0, 1), normal(0, 2), normal(1, 1), normal(1, 2), normal(2, 2)}));
}

/// Returns the distance of a point from the cone in which a receiver hears, in metres; 0 inside.
double outsideOf(const Hearing& one, Point3 place) {
    const Vec3 way = place - one.place;
    const double distance = length(way), half = 0.5 * one.fov.radians();
    if (half >= std::numbers::pi || distance == 0) return 0;
    const double off_axis = std::acos(std::clamp(dot(one.axis, way) / distance, -1.0, 1.0));
    if (off_axis <= half) return 0;
    return distance * (off_axis - half < std::numbers::pi / 2 ? std::sin(off_axis - half) : 1);
}

/// A position that fits the distances.
struct Candidate {
    Vector3d x;         ///< relative to the centroid of the receivers
    double cost;        ///< sum of squared errors of distances
    Vector3d variance;  ///< for unit errors of distances
    double outside;     ///< maximum distance from the receivers' cones and the limits of height
};

/// Locates a tag.
class Search {
  public:
    Search(std::span<const Hearing> heard, const PositionLimits& limits)
        : heard_(heard), limits_(limits), layout_(layoutOf(heard)) {
        for (const Hearing& one : heard_) {
            towards_ += vectorOf(one.axis);
            distances_.push_back(one.distance);
            error_ += one.error * one.error / static_cast<double>(heard_.size());
        }
        error_ = std::sqrt(error_);
        const double farthest = *std::max_element(distances_.begin(), distances_.end());
        rounding_ = kRounding * (layout_.extent() + farthest);
        fit_ = 1e-3 * rounding_;
    }

    std::optional<PositionFix> run() {
        if (!(layout_.spread[1] > kLine * kLine * layout_.spread[2])) return std::nullopt;
        findCandidates();
        std::erase_if(candidates_, [this](const Candidate& one) { return !isHeard(one); });
        if (candidates_.size() == 2) dropTheWorse();
        if (candidates_.size() == 2 && limits_.admits) dropTheImpossible();
        if (candidates_.empty()) return std::nullopt;
        if (candidates_.size() == 1) return fixOf(candidates_[0], Vector3d::Zero());
        // The receivers' axes decide, unless they point along the plane.
        const double out = std::fabs(towards_.dot(layout_.axes.col(0)));
        if (out > kAlong * towards_.norm()) return fixOfTwo(0);
        if (layout_.spread[0] <= kPlane * kPlane * layout_.spread[2]) return std::nullopt;
        const std::size_t best = candidates_[0].cost <= candidates_[1].cost ? 0 : 1;
        return fixOfTwo(best);
    }

  private:
    /// Threshold in standard deviations.
    static constexpr double kClearly = 5;
    /// Rounding error of positions, relative to the distances.
    static constexpr double kRounding = 1e-6;
    /// Minimum component of the receivers' axes across the plane.
    static constexpr double kAlong = 1e-3;

    [[nodiscard]] Point3 placeOf(const Vector3d& x) const {
        return layout_.middle + Vec3{x[0], x[1], x[2]};
    }

    /// Finds the best position on each side of the receivers' plane, first the side to which they
    /// point.
    void findCandidates() {
        const Vector3d normal = layout_.axes.col(0);
        const bool is_up = towards_.dot(normal) >= 0;
        std::array<std::optional<Candidate>, 2> best;
        const auto consider = [&](const Vector3d& start) {
            const Vector3d x = refine(layout_, distances_, start);
            const Linearised there = linearise(layout_, distances_, x);
            std::optional<Candidate>& of_side = best[(x.dot(normal) >= 0) == is_up ? 0 : 1];
            if (of_side && !(there.cost < of_side->cost)) return;
            const double height = placeOf(x).z;
            double outside = std::max({0.0, limits_.lowest - height, height - limits_.highest});
            for (const Hearing& one : heard_)
                outside = std::max(outside, outsideOf(one, placeOf(x)));
            of_side = Candidate{x, there.cost, variances(there.normal), outside};
        };
        const Starts starts = startsOf(layout_, distances_);
        for (const Vector3d& start : starts.mirrored) consider(start);
        if (starts.spatial) consider(*starts.spatial);
        for (const std::optional<Candidate>& of_side : best)
            if (of_side) candidates_.push_back(*of_side);
    }

    /// Of two candidates, removes the one that fits clearly worse, else the only one outside a
    /// cone.
    void dropTheWorse() {
        const double clear = kClearly * error_ * kClearly * error_ + fit_ * fit_;
        const auto fits_worse = [clear](const Candidate& one, const Candidate& other) {
            return one.cost > 4 * other.cost && one.cost > other.cost + clear;
        };
        const auto is_out = [this](const Candidate& one, const Candidate& other) {
            return one.outside > rounding_ && other.outside <= rounding_;
        };
        const Candidate &first = candidates_[0], &second = candidates_[1];
        const bool drop_first =
            fits_worse(first, second) || (is_out(first, second) && !fits_worse(second, first));
        const bool drop_second =
            fits_worse(second, first) || (is_out(second, first) && !fits_worse(first, second));
        if (drop_first)
            candidates_.erase(candidates_.begin());
        else if (drop_second)
            candidates_.pop_back();
    }

    /// Of two candidates, removes the only one that cannot be.
    void dropTheImpossible() {
        const auto can_be = [this](const Candidate& one) {
            return limits_.admits(placeOf(one.x), marginOf(one));
        };
        const bool can_first = can_be(candidates_[0]), can_second = can_be(candidates_[1]);
        if (can_first == can_second) return;
        candidates_.erase(candidates_.begin() + (can_first ? 1 : 0));
    }

    /// Five standard deviations of a candidate, with rounding.
    [[nodiscard]] double marginOf(const Candidate& candidate) const {
        const double own = error_ > 0 ? error_ * std::sqrt(candidate.variance.sum()) : 0;
        return kClearly * own + rounding_;
    }

    /// True if all cones and the limits of height contain it, within the errors.
    [[nodiscard]] bool isHeard(const Candidate& candidate) const {
        return candidate.outside <= marginOf(candidate);
    }

    /// Returns the squares of the factors from a distance's error to the offset between the
    /// candidates, along each axis.
    [[nodiscard]] Vector3d ambiguity(const Candidate& one, const Candidate& other) const {
        const Vector3d way = other.x - one.x;
        // A position in the plane is its mirror image.
        if (way.norm() <= 4 * rounding_) return Vector3d::Zero();
        double squares = 0;
        for (const Vector3d& place : layout_.places) {
            const double difference = (other.x - place).norm() - (one.x - place).norm();
            squares += difference * difference;
        }
        Vector3d result = Vector3d::Zero();
        for (int axis = 0; axis < 3; ++axis) {
            const double share = way[axis] * way[axis];
            if (share <= 1e-9 * way.squaredNorm()) continue;
            result[axis] =
                squares > fit_ * fit_ ? share / squares : std::numeric_limits<double>::infinity();
        }
        return result;
    }

    /// The fix of one of two candidates.
    [[nodiscard]] PositionFix fixOfTwo(std::size_t taken) const {
        const Candidate &one = candidates_[taken], &other = candidates_[1 - taken];
        PositionFix fix = fixOf(one, ambiguity(one, other));
        fix.is_one_of_two = (other.x - one.x).norm() > 4 * rounding_;
        return fix;
    }

    [[nodiscard]] PositionFix fixOf(const Candidate& candidate, const Vector3d& more) const {
        const Vector3d variance = candidate.variance + more;
        PositionFix fix;
        fix.position = placeOf(candidate.x);
        fix.residual = std::sqrt(candidate.cost / static_cast<double>(heard_.size()));
        fix.pdop = std::sqrt(variance.sum());
        fix.hdop = std::sqrt(variance[0] + variance[1]);
        fix.vdop = std::sqrt(variance[2]);
        return fix;
    }

    std::span<const Hearing> heard_;
    PositionLimits limits_;
    Layout layout_;
    Vector3d towards_ = Vector3d::Zero();
    std::vector<double> distances_;
    double error_ = 0;                   // root mean square of the distances' errors
    double rounding_ = 0;                // of positions, in metres
    double fit_ = 0;                     // of distances to them
    std::vector<Candidate> candidates_;  // the first on the side to which receivers point
};

}  // namespace

std::optional<PositionFix> locate(std::span<const Hearing> heard, const PositionLimits& limits) {
    if (heard.size() < limits.receivers) return std::nullopt;
    return Search(heard, limits).run();
}

}  // namespace ispace
