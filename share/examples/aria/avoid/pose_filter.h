// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef AVOID_POSE_FILTER_H
#define AVOID_POSE_FILTER_H

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/LU>

#include "grid_map.h"

namespace avoid {

/// An angle between -pi and pi.
inline double wrapped(double angle) { return std::remainder(angle, 2 * M_PI); }

/// x and y in metres, heading in radians.
using Pose = Eigen::Vector3d;

/// `step` as seen from `from`, in the frame of `from`.
inline Pose compose(const Pose& from, const Pose& step) {
    const double c = std::cos(from.z()), s = std::sin(from.z());
    return Pose(from.x() + c * step.x() - s * step.y(), from.y() + s * step.x() + c * step.y(),
                wrapped(from.z() + step.z()));
}

/// The inverse: returns `to` in the frame of `from`.
inline Pose difference(const Pose& from, const Pose& to) {
    const double c = std::cos(from.z()), s = std::sin(from.z());
    const double dx = to.x() - from.x(), dy = to.y() - from.y();
    return Pose(c * dx + s * dy, -s * dx + c * dy, wrapped(to.z() - from.z()));
}

/// A sonar of the robot: its pose in the robot's frame, and its cone.
struct SonarMount {
    Pose place;
    double fov;  ///< rad
};

/// Pose of the robot: an extended Kalman filter (Thrun, Burgard and Fox, Probabilistic Robotics,
/// 2005, chapter 7) that predicts by the odometry and updates by the sonars, from the ranges that
/// the plan of the room predicts for them.
class PoseFilter {
  public:
    PoseFilter(const GridMap& map, const Pose& start) : map_(map), pose_(start) {
        covariance_.diagonal() << 0.1 * 0.1, 0.1 * 0.1, 0.1 * 0.1;
    }

    const Pose& pose() const { return pose_; }
    const Eigen::Matrix3d& covariance() const { return covariance_; }

    /// The robot's wheels have moved it so, by its own count.
    void predict(const Pose& step) {
        const double way = step.head<2>().norm(), turn = std::fabs(step.z());
        const double c = std::cos(pose_.z()), s = std::sin(pose_.z());
        Eigen::Matrix3d by_pose = Eigen::Matrix3d::Identity();
        by_pose(0, 2) = -s * step.x() - c * step.y();
        by_pose(1, 2) = c * step.x() - s * step.y();
        Eigen::Matrix3d by_step = Eigen::Matrix3d::Identity();
        by_step.topLeftCorner<2, 2>() << c, -s, s, c;
        Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
        noise.diagonal() << kWay * way, kWay * way / 4, kTurn * turn + kTurnOfWay * way;
        covariance_ =
            by_pose * covariance_ * by_pose.transpose() + by_step * noise * by_step.transpose();
        pose_ = compose(pose_, step);
    }

    /// Updates the pose by a sonar reading.
    /// \param range m
    /// \return false if it contradicts the plan: an unknown obstacle, or a wrong echo
    bool correct(const SonarMount& sonar, double range) {
        const double expected = echo(pose_, sonar);
        if (expected >= kMaxDistance || range >= kMaxDistance) return false;
        Eigen::RowVector3d by_pose;
        for (int axis = 0; axis < 3; ++axis) {
            // As wide as the cells of the map, which would make narrower differences rough.
            Pose less = pose_, more = pose_;
            less[axis] -= kDelta;
            more[axis] += kDelta;
            by_pose[axis] = (echo(more, sonar) - echo(less, sonar)) / (2 * kDelta);
        }
        // Where an edge comes in sight or leaves it, a linear prediction fails.
        if (by_pose.head<2>().norm() > 2) return false;
        const double sigma = 0.03 + 0.02 * range;
        const double innovation = range - expected;
        const double variance = by_pose * covariance_ * by_pose.transpose() + sigma * sigma;
        if (innovation * innovation > 9 * variance) return false;
        const Eigen::Vector3d gain = covariance_ * by_pose.transpose() / variance;
        pose_ += gain * innovation;
        pose_.z() = wrapped(pose_.z());
        const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - gain * by_pose;
        // Joseph's form keeps it symmetric and positive.
        covariance_ =
            rest * covariance_ * rest.transpose() + gain * gain.transpose() * (sigma * sigma);
        return true;
    }

  private:
    /// Variances of a metre of way and a radian of turn.
    static constexpr double kWay = 0.004, kTurn = 0.01, kTurnOfWay = 0.004;
    static constexpr double kMaxDistance = 3.5;  // m; echoes from beyond tell little
    static constexpr double kDelta = 0.04;       // m and rad

    /// Computes the sonar's expected range: the nearest obstacle in its cone.
    double echo(const Pose& pose, const SonarMount& sonar) const {
        constexpr int kRays = 7;
        const Pose from = compose(pose, sonar.place);
        double nearest = kMaxDistance;
        for (int ray = 0; ray < kRays; ++ray) {
            const double off = sonar.fov * (static_cast<double>(ray) / (kRays - 1) - 0.5);
            nearest = std::min(nearest, map_.rayLength(from.head<2>(), from.z() + off, nearest));
        }
        return nearest;
    }

    const GridMap& map_;
    Pose pose_;
    Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace avoid

#endif  // AVOID_POSE_FILTER_H
