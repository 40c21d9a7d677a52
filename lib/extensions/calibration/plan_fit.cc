// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of fitToPlan():
//
// 1. Each beam's mean over the ranges within four standard deviations of their densest half, with
//    its variance; beams that return in half of the scans or fewer are left out.
// 2. Starts: for a level laser a ring of 360 rays from each point of a grid over the free floor
//    (0.35 m, at most some 20 000 points), compared at 180 headings, errors capped at 0.5 m; every
//    local minimum over the heading is a start.
// 3. The best starts are refined by Levenberg and Marquardt over simulated ranges, first with 120
//    beams, then with all. Slopes are differences of 2 mm; a beam with one-sided differences that
//    disagree passes an edge and does not count. Weights are those of Cauchy, 95 % efficient for
//    normal errors.
// 4. Eigenvectors of the information, in metres at the beams' ends, with a standard deviation above
//    0.5 m are motions that the room does not determine: the search goes on across them, and along
//    them the pose stays where it was.
//
// Errors of the plan show as `spread`, the scatter beyond that of the means; it widens the
// covariance.
#include "extensions/calibration/plan_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <unsupported/Eigen/NonLinearOptimization>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "env/level.h"
#include "sense/scan.h"
#include "trace/ray_world.h"

namespace ispace::calibration {

namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

[[noreturn]] void fail(std::string message) {
    throw FormatError(Diagnostic{"", 0, 0, std::move(message)});
}

/// A number of values that share a mean.
struct BeamMean {
    std::size_t beam = 0;
    double range = 0;     ///< metres
    double variance = 0;  ///< of the mean
};

double medianOf(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Returns the standard deviation that a laser's data sheet states at a range.
double statedSigma(const RangeNoise& noise, double range) {
    const auto& [s0, s1, s2] = noise.sigma;
    return std::max({s0 + range * (s1 + range * s2), noise.resolution / std::sqrt(12.0), 1e-4});
}

/// Averages the densest half of the values and all within four standard deviations of it, by the
/// shortest interval that holds half of them (Rousseeuw and Leroy, Robust Regression, 1987).
BeamMean meanOf(std::vector<double>& values, double least_sigma) {
    std::sort(values.begin(), values.end());
    const std::size_t count = values.size(), half = count / 2;
    std::size_t best = 0;
    for (std::size_t i = 0; i + half < count; ++i)
        if (values[i + half] - values[i] < values[best + half] - values[best]) best = i;
    const double middle = 0.5 * (values[best] + values[best + half]);
    // Half of a normal distribution lies within 0.674 standard deviations.
    const double sigma = std::max((values[best + half] - values[best]) / 1.349, least_sigma);
    double sum = 0, squares = 0;
    std::size_t used = 0;
    for (const double value : values)
        if (std::abs(value - middle) <= 4 * sigma) {
            sum += value - middle;
            squares += (value - middle) * (value - middle);
            ++used;
        }
    const double n = static_cast<double>(used), mean = sum / n;
    const double scatter = used > 2 ? (squares - n * mean * mean) / (n - 1) : 0;
    return {0, middle + mean, std::max(scatter, least_sigma * least_sigma) / n};
}

/// Returns the means of all beams that return in more than half of the scans.
std::vector<BeamMean> meansOf(const Laser& laser, std::span<const std::vector<float>> scans) {
    std::vector<BeamMean> means;
    std::vector<double> values;
    for (std::size_t k = 0; k < static_cast<std::size_t>(laser.beams); ++k) {
        values.clear();
        for (const std::vector<float>& scan : scans)
            if (std::isfinite(scan[k]) && scan[k] > 0) values.push_back(scan[k]);
        if (2 * values.size() <= scans.size()) continue;
        const double nearest = *std::min_element(values.begin(), values.end());
        // A single scan has no scatter; many have their own, above a tenth of the stated one.
        const double share = values.size() > 10 ? 0.1 : 1;
        BeamMean mean = meanOf(values, share * statedSigma(laser.noise, nearest));
        mean.beam = k;
        mean.range -= laser.noise.bias;
        means.push_back(mean);
    }
    return means;
}

/// The ranges that a laser reads in the room, by its pose.
class ForwardModel {
  public:
    ForwardModel(const Environment& environment, const Sensor& sensor)
        : environment_(environment), worlds_(environment), sensor_(sensor) {
        worlds_.prepare(sensor.pose);
    }

    /// Simulates the beams at a pose (x, y, heading), without noise.
    [[nodiscard]] std::vector<float> ranges(const Vector3d& pose) const {
        Sensor moved = sensor_;
        moved.pose = poseOf(pose);
        return castBeams(worlds_.at(moved.pose), moved);
    }
    [[nodiscard]] Pose3 poseOf(const Vector3d& pose) const {
        Pose3 result = sensor_.pose;
        result.position.x = pose[0];
        result.position.y = pose[1];
        result.heading = wrapped(Angle::radians(pose[2]));
        return result;
    }
    /// Casts a full turn of `count` rays from a point, at the height of the laser.
    [[nodiscard]] std::vector<float> ring(Point2 at, int count) const {
        Sensor around = sensor_;
        auto& laser = around.as<Laser>();
        laser.first = {};
        laser.step = Angle::degrees(360.0 / count);
        laser.beams = count;
        around.pose.position.x = at.x;
        around.pose.position.y = at.y;
        around.pose.heading = {};
        return castBeams(worlds_.at(around.pose), around);
    }
    [[nodiscard]] bool isLevel() const { return scansSlice(sensor_); }
    [[nodiscard]] const Environment& environment() const { return environment_; }
    [[nodiscard]] const Laser& laser() const { return sensor_.as<Laser>(); }

  private:
    const Environment& environment_;
    RayScenes worlds_;
    const Sensor& sensor_;
};

/// Residuals of the beam means and their derivatives by the pose.
///
/// Coordinates are metres along x and y and `arm` times the heading, so that all have one unit.
struct Linearised {
    VectorXd residual;  ///< measured less simulated; NaN: no surface there
    MatrixXd slope;     ///< of the simulated range, by (x, y, arm * heading)
    std::vector<char> smooth;
};

constexpr double kStep = 0.002;  ///< metres, of the differences

Vector3d unscaled(const Vector3d& scaled, double arm) {
    return {scaled[0], scaled[1], scaled[2] / arm};
}

VectorXd residualsAt(const ForwardModel& model, std::span<const BeamMean> means,
                     const Vector3d& scaled, double arm) {
    const std::vector<float> simulated = model.ranges(unscaled(scaled, arm));
    VectorXd residual(static_cast<Eigen::Index>(means.size()));
    for (std::size_t i = 0; i < means.size(); ++i) {
        const double range = simulated[means[i].beam];
        residual[static_cast<Eigen::Index>(i)] = std::isfinite(range)
                                                     ? means[i].range - range
                                                     : std::numeric_limits<double>::quiet_NaN();
    }
    return residual;
}

Linearised linearise(const ForwardModel& model, std::span<const BeamMean> means,
                     const Vector3d& scaled, double arm) {
    const auto count = static_cast<Eigen::Index>(means.size());
    Linearised at{residualsAt(model, means, scaled, arm), MatrixXd::Zero(count, 3),
                  std::vector<char>(means.size(), 1)};
    for (int axis = 0; axis < 3; ++axis) {
        Vector3d ahead = scaled, behind = scaled;
        ahead[axis] += kStep;
        behind[axis] -= kStep;
        const VectorXd up = residualsAt(model, means, ahead, arm);
        const VectorXd down = residualsAt(model, means, behind, arm);
        for (Eigen::Index i = 0; i < count; ++i) {
            const double forward = at.residual[i] - up[i], backward = down[i] - at.residual[i];
            // Beams that pass an edge jump; both differences agree on a surface.
            const double larger = std::max(std::abs(forward), std::abs(backward));
            if (!(std::abs(forward - backward) <= 0.2 * larger + 0.02 * kStep))
                at.smooth[static_cast<std::size_t>(i)] = 0;
            else
                at.slope(i, axis) = (forward + backward) / (2 * kStep);
        }
    }
    return at;
}

/// Weights of the beams: one over the standard deviation, less for outliers (Cauchy), 0 for beams
/// that pass an edge.
struct Weights {
    VectorXd root;      ///< square roots of the weights
    double spread = 0;  ///< metres: of the plan, besides that of the means
};

/// Returns the scatter about the plan beyond that of the means.
double spreadOf(const Linearised& at, std::span<const BeamMean> means) {
    std::vector<double> sizes, variances;
    for (std::size_t i = 0; i < means.size(); ++i) {
        const double r = at.residual[static_cast<Eigen::Index>(i)];
        sizes.push_back(std::isfinite(r) ? std::abs(r) : 1e3);
        variances.push_back(means[i].variance);
    }
    const double scatter = 1.4826 * medianOf(std::move(sizes));
    return std::sqrt(std::max(0.0, scatter * scatter - medianOf(std::move(variances))));
}

Weights weightsOf(const Linearised& at, std::span<const BeamMean> means) {
    Weights weights{VectorXd::Zero(at.residual.size()), spreadOf(at, means)};
    for (std::size_t i = 0; i < means.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const double r = at.residual[row];
        if (at.smooth[i] == 0 || !std::isfinite(r)) continue;
        const double variance = means[i].variance + weights.spread * weights.spread;
        constexpr double kCauchy = 2.385;  // 95 % efficient for normal errors
        const double relative = r * r / (variance * kCauchy * kCauchy);
        weights.root[row] = 1 / std::sqrt(variance * (1 + relative));
    }
    return weights;
}

/// The weighted residuals as Eigen's Levenberg and Marquardt takes them, in the coordinates of a
/// subspace: pose = origin + basis * u.
struct PoseFunctor {
    using Scalar = double;
    enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };
    using InputType = VectorXd;
    using ValueType = VectorXd;
    using JacobianType = MatrixXd;

    const ForwardModel& model;
    std::span<const BeamMean> means;
    const VectorXd& root;
    Vector3d origin;
    MatrixXd basis;
    double arm;

    [[nodiscard]] int inputs() const { return static_cast<int>(basis.cols()); }
    [[nodiscard]] int values() const { return static_cast<int>(means.size()); }
    int operator()(const VectorXd& u, VectorXd& values) const {
        values = residualsAt(model, means, origin + basis * u, arm);
        for (Eigen::Index i = 0; i < values.size(); ++i)
            values[i] = std::isfinite(values[i]) ? values[i] * root[i] : 0;
        return 0;
    }
    int df(const VectorXd& u, MatrixXd& slopes) const {
        const Linearised at = linearise(model, means, origin + basis * u, arm);
        slopes = -(root.asDiagonal() * at.slope * basis);
        return 0;
    }
};

/// A pose that a search ends at, in scaled coordinates.
struct Candidate {
    Vector3d pose;
    double cost = kInfinity;
};

/// Improves a pose: weights by the residuals, then a minimum with these weights, and so on.
Vector3d refined(const ForwardModel& model, std::span<const BeamMean> means, Vector3d pose,
                 const MatrixXd& basis, double arm, int rounds) {
    for (int round = 0; round < rounds; ++round) {
        const Weights weights = weightsOf(linearise(model, means, pose, arm), means);
        PoseFunctor functor{model, means, weights.root, pose, basis, arm};
        Eigen::LevenbergMarquardt<PoseFunctor> search(functor);
        search.parameters.maxfev = 12;
        search.parameters.xtol = 1e-9;
        VectorXd u = VectorXd::Zero(basis.cols());
        search.minimize(u);
        if (!u.allFinite()) break;
        pose += basis * u;
        if (u.norm() < 1e-7) break;
    }
    return pose;
}

/// Sums squared residuals by their variance, each at most 25.
double costOf(const VectorXd& residual, std::span<const BeamMean> means, double spread) {
    double cost = 0;
    for (std::size_t i = 0; i < means.size(); ++i) {
        const double r = residual[static_cast<Eigen::Index>(i)];
        const double square = r * r / (means[i].variance + spread * spread);
        cost += std::isfinite(square) ? std::min(square, 25.0) : 25.0;
    }
    return cost;
}

/// Returns about `most` of the means, evenly spread over the bearings.
std::vector<BeamMean> thinned(std::span<const BeamMean> means, std::size_t most) {
    std::vector<BeamMean> few;
    const std::size_t step = std::max<std::size_t>(1, means.size() / most);
    for (std::size_t i = step / 2; i < means.size(); i += step) few.push_back(means[i]);
    return few;
}

constexpr double kCapped = 0.5;  ///< metres: larger residuals count as much in the search

/// Searches the whole room: a full turn of rays from each point of a grid, compared at each
/// heading.
std::vector<Candidate> searchRoom(const ForwardModel& model, std::span<const BeamMean> means) {
    constexpr int kRays = 360, kHeadings = 180;
    const Laser& laser = model.laser();
    const auto level = model.environment().level(model.poseOf({0, 0, 0}).position.z);
    const Box2& limits = model.environment().limits();
    const double cell = std::max(0.35, std::sqrt(limits.width() * limits.depth() / 20'000));
    std::vector<std::pair<int, float>> wanted;
    for (const BeamMean& mean : means) {
        const double bearing = laser.bearing(static_cast<int>(mean.beam)).degrees();
        wanted.emplace_back((static_cast<int>(std::lround(bearing)) % kRays + kRays) % kRays,
                            static_cast<float>(mean.range));
    }
    std::vector<Candidate> found;
    for (double y = limits.low.y + cell / 2; y < limits.high.y; y += cell)
        for (double x = limits.low.x + cell / 2; x < limits.high.x; x += cell) {
            if (!level->isFree({x, y})) continue;
            const std::vector<float> ring = model.ring({x, y}, kRays);
            // The best headings of a point: symmetric rooms have several.
            std::vector<float> costs(kHeadings);
            for (int h = 0; h < kHeadings; ++h) {
                float cost = 0;
                for (const auto& [bearing, range] : wanted) {
                    int ray = bearing + h * (kRays / kHeadings);
                    if (ray >= kRays) ray -= kRays;
                    const float off = std::abs(ring[static_cast<std::size_t>(ray)] - range);
                    cost += std::min(off, static_cast<float>(kCapped));  // infinity included
                }
                costs[static_cast<std::size_t>(h)] = cost;
            }
            for (std::size_t h = 0; h < costs.size(); ++h) {
                const float before = costs[(h + kHeadings - 1) % kHeadings];
                const float after = costs[(h + 1) % kHeadings];
                if (costs[h] <= before && costs[h] < after)
                    found.push_back(
                        {{x, y, static_cast<double>(h) * 2 * std::numbers::pi / 180}, costs[h]});
            }
        }
    return found;
}

/// Searches around the start, for lasers that are not level.
std::vector<Candidate> searchNear(const ForwardModel& model, std::span<const BeamMean> means,
                                  const Vector3d& start) {
    std::vector<Candidate> found;
    for (int i = -3; i <= 3; ++i)
        for (int j = -3; j <= 3; ++j)
            for (int h = -5; h <= 5; ++h) {
                const Vector3d pose =
                    start + Vector3d(0.4 * i, 0.4 * j, h * 5 * std::numbers::pi / 180);
                const VectorXd residual = residualsAt(model, means, pose, 1);
                double cost = 0;
                for (const double r : residual)
                    cost += std::isfinite(r) ? std::min(std::abs(r), kCapped) : kCapped;
                found.push_back({pose, cost});
            }
    return found;
}

bool isNear(const Vector3d& a, const Vector3d& b, double metres, double degrees) {
    const double turn = std::remainder(a[2] - b[2], 2 * std::numbers::pi);
    return std::hypot(a[0] - b[0], a[1] - b[1]) < metres &&
           std::abs(turn) < degrees * std::numbers::pi / 180;
}

/// Sorts by cost and removes those near a better one; at most `most` remain.
std::vector<Candidate> distinct(std::vector<Candidate> all, std::size_t most, double metres,
                                double degrees) {
    std::sort(all.begin(), all.end(),
              [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
    std::vector<Candidate> kept;
    for (const Candidate& one : all) {
        if (kept.size() == most) break;
        if (std::none_of(kept.begin(), kept.end(), [&](const Candidate& other) {
                return isNear(one.pose, other.pose, metres, degrees);
            }))
            kept.push_back(one);
    }
    return kept;
}

/// A decomposed information matrix of a pose in scaled coordinates.
struct Information {
    Matrix3d matrix;
    Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
    int unknown = 0;  ///< the first so many eigenvectors are not observed
};

/// A standard deviation above this, in metres at the beams' ends, means that a motion is not
/// observed; so does a share of the best observed motion's information that is within rounding.
constexpr double kUnknownSigma = 0.5, kUnknownShare = 1e-6;

Information informationAt(const Linearised& at, std::span<const BeamMean> means) {
    const Weights weights = weightsOf(at, means);
    const MatrixXd rows = weights.root.asDiagonal() * at.slope;
    Information info{rows.transpose() * rows, {}, 0};
    info.solver.compute(info.matrix);
    const Vector3d values = info.solver.eigenvalues();
    while (info.unknown < 3 && (values[info.unknown] * kUnknownSigma * kUnknownSigma < 1 ||
                                values[info.unknown] < kUnknownShare * values[2]))
        ++info.unknown;
    return info;
}

FreeMotion motionOf(const Vector3d& scaled, double arm) {
    Vector3d plain{scaled[0], scaled[1], scaled[2] / arm};
    plain.normalize();
    // One sign of each line.
    const bool back = plain[0] < -1e-9 || (plain[0] < 1e-9 && plain[1] < 0);
    if (back) plain = -plain;
    return {plain[0], plain[1], plain[2]};
}

/// Fits poses to the means of one laser.
class PlanFitter {
  public:
    PlanFitter(const ForwardModel& model, std::vector<BeamMean> means, const Pose3& start)
        : model_(model), means_(std::move(means)), few_(thinned(means_, 120)) {
        std::vector<double> reaches;
        for (const BeamMean& mean : means_) reaches.push_back(mean.range);
        arm_ = std::max(0.2, medianOf(std::move(reaches)));
        start_ = {start.position.x, start.position.y, start.heading.radians()};
    }

    PlanFit fit() {
        std::vector<Candidate> ends = minima();
        const Candidate& best = ends.front();
        spread_ = spreadOf(linearise(model_, means_, scaled(best.pose), arm_), means_);
        for (Candidate& end : ends)
            end.cost = costOf(residualsAt(model_, means_, scaled(end.pose), arm_), means_, spread_);
        std::sort(ends.begin(), ends.end(),
                  [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
        constexpr double kEqual = 9;  // three standard deviations
        std::erase_if(ends, [least = ends.front().cost](const Candidate& end) {
            return end.cost > least + kEqual;
        });
        // Along motions that are not observed all poses are equal: those next to the start count.
        for (Candidate& end : ends) {
            Information info =
                informationAt(linearise(model_, means_, scaled(end.pose), arm_), means_);
            end.pose = heldAtStart(end.pose, info);
            end.cost = offStart(end.pose);
        }
        const std::size_t most = ends.size();
        return described(distinct(std::move(ends), most, 0.1, 2));
    }

  private:
    [[nodiscard]] Vector3d scaled(const Vector3d& pose) const {
        return {pose[0], pose[1], pose[2] * arm_};
    }
    [[nodiscard]] double offStart(const Vector3d& pose) const {
        const double turn = std::remainder(pose[2] - start_[2], 2 * std::numbers::pi);
        return std::hypot(pose[0] - start_[0], pose[1] - start_[1], turn);
    }

    /// Returns distinct minima, the most likely one first.
    [[nodiscard]] std::vector<Candidate> minima() const {
        std::vector<Candidate> starts =
            model_.isLevel() ? searchRoom(model_, few_) : searchNear(model_, few_, start_);
        starts = distinct(std::move(starts), 24, 0.5, 9);
        starts.push_back({start_});
        const MatrixXd all = MatrixXd::Identity(3, 3);
        for (Candidate& one : starts) {
            one.pose = unscaled(refined(model_, few_, scaled(one.pose), all, arm_, 12), arm_);
            const VectorXd residual = residualsAt(model_, few_, scaled(one.pose), arm_);
            one.cost = 0;
            for (const double r : residual)
                one.cost += std::isfinite(r) ? std::min(std::abs(r), kCapped) : kCapped;
        }
        starts = distinct(std::move(starts), 12, 0.05, 1);
        // A pose that is clearly worse on the few beams is no minimum of all.
        const double bound = 2 * starts.front().cost + 0.02 * static_cast<double>(few_.size());
        std::erase_if(starts, [bound](const Candidate& one) { return one.cost > bound; });
        for (Candidate& one : starts)
            one.pose = unscaled(refined(model_, means_, scaled(one.pose), all, arm_, 20), arm_);
        return starts;
    }

    /// Moves a pose towards the start along the motions that are not observed, and fits the others.
    Vector3d heldAtStart(Vector3d pose, Information& info) const {
        for (int round = 0; round < 3 && info.unknown > 0; ++round) {
            const MatrixXd unknown = info.solver.eigenvectors().leftCols(info.unknown);
            const MatrixXd known = info.solver.eigenvectors().rightCols(3 - info.unknown);
            Vector3d off = scaled(pose) - scaled(start_);
            off[2] = arm_ * std::remainder(off[2] / arm_, 2 * std::numbers::pi);
            Vector3d moved = scaled(pose) - unknown * (unknown.transpose() * off);
            if (info.unknown < 3) moved = refined(model_, means_, moved, known, arm_, 20);
            const Linearised at = linearise(model_, means_, moved, arm_);
            Information next = informationAt(at, means_);
            if (next.unknown < info.unknown) break;  // the start lies elsewhere
            pose = unscaled(moved, arm_);
            info = next;
        }
        return pose;
    }

    [[nodiscard]] PlanFit described(const std::vector<Candidate>& ends) const {
        PlanFit fit;
        const Vector3d pose = ends.front().pose;
        const Information info =
            informationAt(linearise(model_, means_, scaled(pose), arm_), means_);
        fit.pose = model_.poseOf(pose);
        Matrix3d covariance = Matrix3d::Zero();
        for (int i = 0; i < 3; ++i) {
            const Vector3d axis = info.solver.eigenvectors().col(i);
            if (i < info.unknown) {
                fit.unknown.push_back(motionOf(axis, arm_));
                continue;
            }
            covariance += axis * axis.transpose() / info.solver.eigenvalues()[i];
        }
        const Vector3d unit{1, 1, 1 / arm_};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                fit.covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
                    covariance(i, j) * unit[i] * unit[j];
        for (int k = 0; k < info.unknown; ++k)
            for (int i = 0; i < 3; ++i)
                if (std::abs(info.solver.eigenvectors()(i, k)) > 1e-3)
                    fit.covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(i)] =
                        kInfinity;
        addEquals(ends, pose, info, fit);
        addAgreement(pose, fit);
        return fit;
    }

    /// Lists the other poses, but those that only a motion along which all are equal tells apart.
    void addEquals(const std::vector<Candidate>& ends, const Vector3d& pose,
                   const Information& info, PlanFit& fit) const {
        const MatrixXd unknown = info.solver.eigenvectors().leftCols(info.unknown);
        for (const Candidate& end : ends) {
            Vector3d off = scaled(end.pose) - scaled(pose);
            off[2] = arm_ * std::remainder(off[2] / arm_, 2 * std::numbers::pi);
            off -= unknown * (unknown.transpose() * off);
            if (off.norm() > 0.3) fit.equals.push_back(model_.poseOf(end.pose));
        }
    }

    void addAgreement(const Vector3d& pose, PlanFit& fit) const {
        const VectorXd residual = residualsAt(model_, means_, scaled(pose), arm_);
        std::vector<double> sizes;
        std::size_t near = 0;
        for (const double r : residual) {
            sizes.push_back(std::isfinite(r) ? std::abs(r) : 1e3);
            if (sizes.back() <= kPlanInlier) ++near;
        }
        fit.beams = means_.size();
        fit.inliers = static_cast<double>(near) / static_cast<double>(means_.size());
        fit.sigma = 1.4826 * medianOf(std::move(sizes));
    }

    const ForwardModel& model_;
    std::vector<BeamMean> means_, few_;
    double arm_ = 1;
    double spread_ = 0;
    Vector3d start_;
};

}  // namespace

bool FreeMotion::turns() const { return std::abs(turn) > 1e-3; }

Point2 FreeMotion::centre(const Pose3& pose) const {
    // The sensor moves by turn * perpendicular(position - centre).
    return {pose.position.x - y / turn, pose.position.y + x / turn};
}

std::string FreeMotion::text(const Pose3& pose) const {
    if (turns()) {
        const Point2 point = centre(pose);
        return "about the point (" + formatFixed(point.x, 2) + ", " + formatFixed(point.y, 2) + ")";
    }
    return "along the direction " + formatFixed(directionOf(x, y).degrees(), 1) + " deg";
}

PlanFit fitToPlan(const Environment& environment, const Sensor& start,
                  std::span<const std::vector<float>> scans) {
    const auto& laser = start.as<Laser>();
    if (scans.empty()) fail("no scans of " + start.id);
    for (const std::vector<float>& scan : scans)
        if (scan.size() != static_cast<std::size_t>(laser.beams))
            fail("scans of " + start.id + " have " + std::to_string(scan.size()) +
                 " beams, and its record has " + std::to_string(laser.beams));
    std::vector<BeamMean> means = meansOf(laser, scans);
    constexpr std::size_t kFewest = 10;
    if (means.size() < kFewest)
        fail("scans of " + start.id + ": only " + std::to_string(means.size()) +
             " beams return in most scans");
    const ForwardModel model(environment, start);
    PlanFit fit = PlanFitter(model, std::move(means), start.pose).fit();
    fit.scans = scans.size();
    if (fit.inliers < kPlanAgreement)
        fail("scans of " + start.id + " do not fit the room: at the most likely pose " +
             formatFixed(100 * fit.inliers, 0) + " % of " + std::to_string(fit.beams) +
             " beams lie within " + formatFixed(kPlanInlier, 1) + " m of the plan");
    return fit;
}

}  // namespace ispace::calibration
