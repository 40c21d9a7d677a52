// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef TRACKER_CLUSTERS_H
#define TRACKER_CLUSTERS_H

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <ispace_client.h>
#include <Eigen/Core>

#include "geometry.h"

namespace tracker {

enum class Kind { Leg, Robot };

/// The visible part of one leg or one robot.
struct Cluster {
    Vector2d surface = Vector2d::Zero();  ///< the middle of the visible part
    Vector2d centre = Vector2d::Zero();   ///< of the whole thing, which reaches farther back
    double width = 0;                     ///< m, across
    Kind kind = Kind::Leg;
};

/// Range of each beam in the empty room, learned while the program runs. A beam that reaches
/// farther than before, several times, updates its background.
class Background {
  public:
    /// \return for each beam whether something stands before the background
    std::vector<bool> foreground(const std::vector<float>& ranges, double farthest) {
        if (ranges_.empty()) {
            for (const float range : ranges) ranges_.push_back(std::min<double>(range, farthest));
            beyond_.assign(ranges.size(), 0);
        }
        std::vector<bool> before(ranges.size());
        for (std::size_t k = 0; k < ranges.size(); ++k) {
            const double range = std::min<double>(ranges[k], farthest);
            before[k] = range < ranges_[k] - kBefore;
            if (std::fabs(range - ranges_[k]) <= kBefore)
                ranges_[k] += kRate * (range - ranges_[k]);
            beyond_[k] = range > ranges_[k] + kBefore ? beyond_[k] + 1 : 0;
            if (beyond_[k] < kTimes) continue;
            ranges_[k] = range;
            beyond_[k] = 0;
        }
        return before;
    }

  private:
    static constexpr double kBefore = 0.12;  // m: several times the noise of a range
    static constexpr double kRate = 0.05;    // of a scan in the mean
    static constexpr int kTimes = 3;

    std::vector<double> ranges_;
    std::vector<int> beyond_;
};

/// Finds legs and robots in the scans of one laser.
class ClusterFinder {
  public:
    ClusterFinder(const Mount& mount, double farthest) : mount_(mount), farthest_(farthest) {}

    const Mount& mount() const { return mount_; }

    std::vector<Cluster> find(const ispace::client::Scan& scan) {
        const std::vector<bool> before = background_.foreground(scan.ranges, farthest_);
        std::vector<Cluster> clusters;
        MoverPoses points;
        for (std::size_t k = 0; k <= before.size(); ++k) {
            const bool is_before = k < before.size() && before[k];
            Vector2d point = Vector2d::Zero();
            if (is_before) {
                const double angle = mount_.heading + scan.angle(k) * M_PI / 180;
                point = mount_.place + scan.ranges[k] * Vector2d(std::cos(angle), std::sin(angle));
            }
            const bool goes_on =
                is_before && (points.empty() || (point - points.back()).norm() < gap(scan, k));
            if (!goes_on) {
                if (points.size() >= kMinCount) clusters.push_back(clusterOf(points));
                points.clear();
            }
            if (is_before) points.push_back(point);
        }
        return clusters;
    }

  private:
    static constexpr std::size_t kMinCount = 2;
    static constexpr double kRobotWidth = 0.3;                      // m: legs are narrower
    static constexpr double kLegRadius = 0.06, kRobotRadius = 0.2;  // m
    static constexpr double kMiddle =
        M_PI / 4;  // of a circle's radius its front lies before it, in the mean

    /// Neighbouring beams that are farther apart than this meet different things.
    static double gap(const ispace::client::Scan& scan, std::size_t k) {
        return 0.08 + 2 * scan.ranges[k] * scan.step * M_PI / 180;
    }

    Cluster clusterOf(const MoverPoses& points) const {
        Cluster cluster;
        for (const Vector2d& point : points) cluster.surface += point;
        cluster.surface /= static_cast<double>(points.size());
        cluster.width = (points.back() - points.front()).norm();
        cluster.kind = cluster.width < kRobotWidth ? Kind::Leg : Kind::Robot;
        const double radius = cluster.kind == Kind::Leg ? kLegRadius : kRobotRadius;
        const Vector2d away = (cluster.surface - mount_.place).normalized();
        cluster.centre = cluster.surface + kMiddle * radius * away;
        return cluster;
    }

    Mount mount_;
    double farthest_;
    Background background_;
};

}  // namespace tracker

#endif  // TRACKER_CLUSTERS_H
