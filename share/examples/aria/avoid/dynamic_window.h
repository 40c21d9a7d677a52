// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef AVOID_DYNAMIC_WINDOW_H
#define AVOID_DYNAMIC_WINDOW_H

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "global_plan.h"
#include "grid_map.h"
#include "pose_filter.h"

namespace avoid {

/// Speeds ahead (m/s) and of rotation (rad/s).
struct Speeds {
    double ahead = 0, turn = 0;
};

/// Limits of the robot. Accelerations are those for planning: less than the motors have, as floors
/// may be slippery.
struct Limits {
    double radius = 0.25;            ///< m
    double ahead = 0.4, turn = 1.0;  ///< m/s, rad/s
    double speeding = 0.3;           ///< m/s²
    double braking = 0.15;           ///< m/s²
    double turning = 1.2;            ///< rad/s²
};

/// The dynamic window approach (Fox, Burgard and Thrun, IEEE Robotics & Automation Magazine, 1997):
/// of the speeds that the robot can reach in a moment, finds the pair with the best of all arcs on
/// which it can still brake before a collision. A good arc leaves little of the way by the global
/// plan (Brock and Khatib, ICRA 1999) and keeps clear of obstacles.
class DynamicWindow {
  public:
    DynamicWindow(const GridMap& map, const GlobalPlan& plan, const Limits& limits)
        : map_(map), plan_(plan), limits_(limits) {}

    /// \param now motion of the robot
    /// \param echoes points that its sonars hear, in the robot's frame of the room: obstacles
    /// besides those of the map
    Speeds choose(const Pose& pose, const Speeds& now,
                  const std::vector<Eigen::Vector2d>& echoes) const {
        const Eigen::Vector2d ahead = aimOf(pose);
        Speeds best;
        double best_score = -std::numeric_limits<double>::infinity();
        for (int i = 0; i < kSpeeds; ++i) {
            Speeds speeds;
            speeds.ahead = within(now.ahead, limits_.speeding, limits_.ahead, 0, i, kSpeeds);
            for (int k = 0; k < kTurns; ++k) {
                speeds.turn =
                    within(now.turn, limits_.turning, limits_.turn, -limits_.turn, k, kTurns);
                const double value = score(pose, speeds, ahead, echoes);
                if (value <= best_score) continue;
                best_score = value;
                best = speeds;
            }
        }
        if (std::isfinite(best_score)) return best;
        // No way is free: brake, and turn on the spot to where the plan leads.
        const double off =
            wrapped(std::atan2(ahead.y() - pose.y(), ahead.x() - pose.x()) - pose.z());
        best.ahead = 0;
        best.turn = std::copysign(std::min(std::fabs(off), limits_.turn / 2), off);
        return best;
    }

  private:
    static constexpr int kSpeeds = 7, kTurns = 15;
    static constexpr double kWindow = 0.25;  // s
    static constexpr double kHorizon = 2;    // s
    static constexpr double kMargin = 0.08;  // m kept beside the robot
    static constexpr int kPieces = 16;       // of an arc

    /// The k-th of n values that can be reached within the window.
    static double within(double now, double rate, double most, double least, int k, int n) {
        const double low = std::max(least, now - rate * kWindow);
        const double high = std::max(low, std::min(most, now + rate * kWindow));
        return low + (high - low) * k / (n - 1);
    }

    /// A point of the way, a little ahead.
    Eigen::Vector2d aimOf(const Pose& pose) const {
        const std::vector<Eigen::Vector2d> way = plan_.way(pose.head<2>());
        for (const Eigen::Vector2d& place : way)
            if ((place - pose.head<2>()).norm() > 0.6) return place;
        return way.empty() ? Eigen::Vector2d(pose.head<2>()) : way.back();
    }

    double room(const Eigen::Vector2d& at, const std::vector<Eigen::Vector2d>& echoes) const {
        double least = map_.clearance(at);
        for (const Eigen::Vector2d& echo : echoes) least = std::min(least, (echo - at).norm());
        return least - limits_.radius;
    }

    /// -infinity: on that arc the robot could not brake in time.
    double score(const Pose& pose, const Speeds& speeds, const Eigen::Vector2d& aim,
                 const std::vector<Eigen::Vector2d>& echoes) const {
        constexpr double kNever = -std::numeric_limits<double>::infinity();
        const double dt = kHorizon / kPieces;
        const double braking =
            speeds.ahead * speeds.ahead / (2 * limits_.braking) + speeds.ahead * kWindow;
        const double here = room(pose.head<2>(), echoes);
        Pose at = pose;
        double least = here;
        for (int piece = 1; piece <= kPieces; ++piece) {
            const double middle = at.z() + speeds.turn * dt / 2;
            at += Pose(std::cos(middle), std::sin(middle), 0) * (speeds.ahead * dt);
            at.z() += speeds.turn * dt;
            const double free = room(at.head<2>(), echoes);
            // A robot that is too near already may move to more clearance.
            if (free < kMargin && free <= here) {
                if (speeds.ahead * dt * piece <= braking) return kNever;
                break;
            }
            least = std::min(least, free);
        }
        const double left = plan_.left(at.head<2>());
        if (!std::isfinite(left)) return kNever;
        const Eigen::Vector2d to = aim - at.head<2>();
        const double off =
            to.norm() < 0.2 ? 0 : std::fabs(wrapped(std::atan2(to.y(), to.x()) - at.z()));
        return -left - 0.3 * off + 0.5 * std::min(least, 0.3) + 0.2 * speeds.ahead / limits_.ahead;
    }

    const GridMap& map_;
    const GlobalPlan& plan_;
    Limits limits_;
};

}  // namespace avoid

#endif  // AVOID_DYNAMIC_WINDOW_H
