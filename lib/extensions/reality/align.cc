// SPDX-License-Identifier: GPL-3.0-or-later
// Aligns poses by the simulation: unknowns are a move of all poses, then one of each scan,
// residuals the beams. Derivatives are differences (1 mm, 0.03 degrees); beams that jump to another
// surface have none. Cauchy's loss makes people and errors of the plan count little; its width
// shrinks, so that a start half a metre off still finds the walls.
#include "extensions/reality/align.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>

#include "extensions/reality/beam_model.h"

namespace ispace::reality {

namespace {

/// Square root of Cauchy's loss, with the residual's sign.
double robust(double residual, double width) {
    const double u = residual / width;
    return std::copysign(width * std::sqrt(std::log1p(u * u)), residual);
}

/// How the three unknowns, x and y in metres and a turn, move the pose of a scan.
using MovePose = Pose3 (*)(const Pose3& pose, const Eigen::VectorXd& by);

Pose3 movedInPlace(const Pose3& pose, const Eigen::VectorXd& by) {
    Pose3 moved = pose;
    moved.position.x += by(0);
    moved.position.y += by(1);
    moved.heading = pose.heading + Angle::radians(by(2));
    return moved;
}

/// Turns about the origin, then moves.
Pose3 movedAsMap(const Pose3& pose, const Eigen::VectorXd& by) {
    const Pose2 plan_from_log{{by(0), by(1)}, Angle::radians(by(2))};
    const Point2 at = plan_from_log * pose.position.onFloor();
    Pose3 moved = pose;
    moved.position = {at.x, at.y, pose.position.z};
    moved.heading = pose.heading + plan_from_log.heading;
    return moved;
}

/// Residuals of the beams of some scans whose poses move together.
class PoseResiduals {
  public:
    using Scalar = double;
    using InputType = Eigen::VectorXd;
    using ValueType = Eigen::VectorXd;
    using JacobianType = Eigen::MatrixXd;
    enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

    PoseResiduals(const LoggedRun& run, const RayScenes& worlds, std::vector<std::size_t> scans,
                  MovePose move, double width)
        : run_(run), worlds_(worlds), scans_(std::move(scans)), move_(move), width_(width) {
        for (const std::size_t i : scans_) count_ += run_.scans[i].ranges().size();
    }

    [[nodiscard]] int inputs() const { return 3; }
    [[nodiscard]] int values() const { return static_cast<int>(count_); }

    int operator()(const Eigen::VectorXd& by, Eigen::VectorXd& residuals) const {
        std::vector<std::size_t> first;
        std::size_t at = 0;
        for (const std::size_t i : scans_) {
            first.push_back(at);
            at += run_.scans[i].ranges().size();
        }
        tbb::parallel_for(std::size_t{0}, scans_.size(), [&](std::size_t s) {
            const MeasuredScan& scan = run_.scans[scans_[s]];
            const std::vector<float>& measured = scan.ranges();
            std::vector<float> expected(measured.size()), cosines(measured.size());
            castMeasured(worlds_, run_, scan, move_(scan.pose, by), expected, cosines);
            for (std::size_t k = 0; k < measured.size(); ++k) {
                const bool both = measured[k] < kNoReturn && expected[k] < kNoReturn;
                // One without the other is as far off as a residual of a metre.
                const double off = both ? double{measured[k]} - double{expected[k]}
                                   : measured[k] < kNoReturn ? 1.0
                                                             : 0.0;
                residuals(static_cast<Eigen::Index>(first[s] + k)) = robust(off, width_);
            }
        });
        return 0;
    }

    int df(const Eigen::VectorXd& by, Eigen::MatrixXd& jacobian) const {
        constexpr double kMetres = 1e-3, kRadians = 5e-4;
        Eigen::VectorXd less(values()), more(values());
        for (int k = 0; k < inputs(); ++k) {
            const double h = k < 2 ? kMetres : kRadians;
            Eigen::VectorXd beside = by;
            beside(k) = by(k) - h;
            (*this)(beside, less);
            beside(k) = by(k) + h;
            (*this)(beside, more);
            jacobian.col(k) = (more - less) / (2 * h);
            // A beam that jumps to another surface has no derivative.
            constexpr double kMostSlope = 20;
            for (Eigen::Index i = 0; i < jacobian.rows(); ++i)
                if (std::abs(jacobian(i, k)) > kMostSlope) jacobian(i, k) = 0;
        }
        return 0;
    }

    /// Returns the number of beams with a return.
    [[nodiscard]] std::size_t returns() const {
        std::size_t count = 0;
        for (const std::size_t i : scans_)
            for (const float range : run_.scans[i].ranges()) count += range < kNoReturn ? 1 : 0;
        return count;
    }

  private:
    const LoggedRun& run_;
    const RayScenes& worlds_;
    std::vector<std::size_t> scans_;
    MovePose move_;
    double width_;
    std::size_t count_ = 0;
};

constexpr std::array<double, 3> kWidths{0.5, 0.2, 0.1};  // metres

/// Returns the best change of the poses of some scans, nullopt if too few beams return or the
/// change does not lower the loss.
std::optional<Eigen::VectorXd> bestMove(const LoggedRun& run, const RayScenes& worlds,
                                        const std::vector<std::size_t>& scans, MovePose move) {
    Eigen::VectorXd by = Eigen::VectorXd::Zero(3);
    constexpr std::size_t kLeastReturns = 10;
    for (const double width : kWidths) {
        PoseResiduals residuals(run, worlds, scans, move, width);
        if (residuals.returns() < kLeastReturns) return std::nullopt;
        Eigen::LevenbergMarquardt<PoseResiduals> search(residuals);
        constexpr int kMostCalls = 60;
        search.parameters.maxfev = kMostCalls;
        search.parameters.xtol = 1e-6;
        search.parameters.ftol = 1e-8;
        search.minimize(by);
        if (!by.allFinite()) return std::nullopt;
    }
    PoseResiduals residuals(run, worlds, scans, move, kWidths.back());
    Eigen::VectorXd before(residuals.values()), after(residuals.values());
    residuals(Eigen::VectorXd::Zero(3), before);
    residuals(by, after);
    if (after.squaredNorm() > before.squaredNorm()) return std::nullopt;
    return by;
}

/// Every scan of a log, or an even share of a long one.
std::vector<std::size_t> someScans(const LoggedRun& run) {
    constexpr std::size_t kMost = 60;
    const std::size_t step = std::max<std::size_t>(1, run.scans.size() / kMost);
    std::vector<std::size_t> scans;
    for (std::size_t i = 0; i < run.scans.size(); i += step)
        if (!run.sensors[run.scans[i].sensor].stands) scans.push_back(i);
    return scans;
}

/// Groups of scans whose poses move together: one for each sensor that stands still, and one for
/// each other scan.
std::vector<std::vector<std::size_t>> groupsOf(const LoggedRun& run) {
    std::vector<std::vector<std::size_t>> groups;
    std::vector<std::size_t> standing(run.sensors.size(), std::size_t(-1));
    for (std::size_t i = 0; i < run.scans.size(); ++i) {
        const std::size_t sensor = run.scans[i].sensor;
        if (!run.sensors[sensor].stands) {
            groups.push_back({i});
            continue;
        }
        if (standing[sensor] == std::size_t(-1)) {
            standing[sensor] = groups.size();
            groups.emplace_back();
        }
        groups[standing[sensor]].push_back(i);
    }
    // Many scans of one pose add no view.
    constexpr std::size_t kMost = 200;
    for (std::vector<std::size_t>& group : groups)
        if (group.size() > kMost) {
            const std::size_t step = group.size() / kMost;
            std::vector<std::size_t> some;
            for (std::size_t k = 0; k < group.size(); k += step) some.push_back(group[k]);
            group = std::move(some);
        }
    return groups;
}

void summarise(Alignment& alignment) {
    std::vector<double> metres, degrees;
    for (const Pose2& each : alignment.moved) {
        metres.push_back(std::hypot(each.position.x, each.position.y));
        degrees.push_back(std::abs(each.heading.degrees()));
    }
    if (metres.empty()) return;
    std::sort(metres.begin(), metres.end());
    std::sort(degrees.begin(), degrees.end());
    alignment.median_metres = metres[metres.size() / 2];
    alignment.most_metres = metres.back();
    alignment.median_turn = Angle::degrees(degrees[degrees.size() / 2]);
    alignment.most_turn = Angle::degrees(degrees.back());
}

}  // namespace

Alignment align(LoggedRun& run, const RayScenes& worlds) {
    Alignment alignment;
    if (const std::vector<std::size_t> some = someScans(run); !some.empty())
        if (const auto by = bestMove(run, worlds, some, movedAsMap)) {
            alignment.whole = {{(*by)(0), (*by)(1)}, Angle::radians((*by)(2))};
            for (MeasuredScan& scan : run.scans)
                if (!run.sensors[scan.sensor].stands) scan.pose = movedAsMap(scan.pose, *by);
        }
    const std::vector<std::vector<std::size_t>> groups = groupsOf(run);
    std::vector<std::optional<Eigen::VectorXd>> moves(groups.size());
    tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
        moves[g] = bestMove(run, worlds, groups[g], movedInPlace);
    });
    std::vector<std::optional<Eigen::VectorXd>> of_sensor(run.sensors.size());
    std::vector<std::optional<Eigen::VectorXd>> of_scan(run.scans.size());
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const std::size_t sensor = run.scans[groups[g].front()].sensor;
        (run.sensors[sensor].stands ? of_sensor[sensor] : of_scan[groups[g].front()]) = moves[g];
    }
    alignment.moved.resize(run.scans.size());
    for (std::size_t i = 0; i < run.scans.size(); ++i) {
        MeasuredScan& scan = run.scans[i];
        const auto& by = run.sensors[scan.sensor].stands ? of_sensor[scan.sensor] : of_scan[i];
        if (!by) {
            ++alignment.kept;
            continue;
        }
        scan.pose = movedInPlace(scan.pose, *by);
        alignment.moved[i] = {{(*by)(0), (*by)(1)}, Angle::radians((*by)(2))};
    }
    summarise(alignment);
    return alignment;
}

}  // namespace ispace::reality
