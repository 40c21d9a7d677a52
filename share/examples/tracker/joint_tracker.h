// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef TRACKER_JOINT_TRACKER_H
#define TRACKER_JOINT_TRACKER_H

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "assignment.h"
#include "clusters.h"
#include "track.h"

namespace tracker {

/// One set of tracks for all lasers. Assigns the legs that a laser sees to all tracks at once, at
/// most two to each, with the best total (global nearest neighbour): a track whose person is hidden
/// from one laser does not take other legs there, and the other lasers update it.
class JointTracker {
  public:
    /// \param seen the clusters of each laser, of the same moment
    void update(double time, const std::vector<std::vector<Cluster>>& seen) {
        for (Track& track : tracks_) track.predict(time);
        std::vector<Cluster> strangers;
        for (const std::vector<Cluster>& clusters : seen) share(clusters, strangers);
        greet(time, strangers);
        tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(),
                                     [](const Track& track) { return isGone(track); }),
                      tracks_.end());
        eraseDoubles(tracks_, kSame, kSure);
    }

    /// Those that are sure enough to be told of.
    Tracks tracks() const { return withHits(tracks_, kSure); }

  private:
    static constexpr int kLegs = 2;
    static constexpr double kLegSigma = 0.13;   // m: one leg against the middle of the person
    static constexpr double kBothSigma = 0.05;  // m: the middle of both
    static constexpr double kRobotSigma = 0.06;
    static constexpr double kGate = 9;        // standard deviations, squared
    static constexpr double kNoOwner = 30;    // more than any within the gate
    static constexpr double kApart = 0.45;    // m: clusters so near are of one stranger
    static constexpr double kReach = 0.6;     // m: between the feet of a walker of up to 2.1 m
    static constexpr double kSame = 0.2;      // m: two tracks so near are of the same person
    static constexpr double kPatience = 1.5;  // s
    static constexpr int kSure = 4;           // scans

    static double sigmaOf(Kind kind) { return kind == Kind::Leg ? kLegSigma : kRobotSigma; }

    /// Assigns each cluster to a leg of a track, or to no track, which costs most. The likeliest
    /// assignment is the cheapest, so that a track that has lost its person does not take other
    /// legs.
    void share(const std::vector<Cluster>& clusters, std::vector<Cluster>& strangers) {
        const auto rows = static_cast<Eigen::Index>(clusters.size());
        const auto places = static_cast<Eigen::Index>(kLegs * tracks_.size());
        if (rows == 0) return;
        Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(rows, places + rows, kNoOwner);
        for (Eigen::Index row = 0; row < rows; ++row) {
            const Cluster& cluster = clusters[static_cast<std::size_t>(row)];
            for (Eigen::Index place = 0; place < places; ++place) {
                const Track& track = tracks_[static_cast<std::size_t>(place / kLegs)];
                const double sigma = sigmaOf(cluster.kind);
                const double far = track.distance(cluster.centre, sigma);
                // A cluster beyond the gate must never be cheaper.
                cost(row, place) = far < kGate ? far + track.vagueness(sigma) : 1000 * kNoOwner;
            }
        }
        const std::vector<int> chosen = assign(cost);
        std::vector<std::vector<const Cluster*>> of_track(tracks_.size());
        for (std::size_t row = 0; row < clusters.size(); ++row) {
            if (chosen[row] < places) {
                of_track[static_cast<std::size_t>(chosen[row] / kLegs)].push_back(&clusters[row]);
            } else {
                strangers.push_back(clusters[row]);
            }
        }
        for (std::size_t i = 0; i < tracks_.size(); ++i)
            if (!of_track[i].empty()) update(tracks_[i], of_track[i]);
    }

    static void update(Track& track, const std::vector<const Cluster*>& clusters) {
        Vector2d place = Vector2d::Zero();
        for (const Cluster* cluster : clusters) place += cluster->centre;
        place /= static_cast<double>(clusters.size());
        const Kind kind = clusters.front()->kind;
        track.update(place, clusters.size() == 2 ? kBothSigma : sigmaOf(kind), kind);
    }

    /// Creates a track for each group of unassigned clusters, but not within a step of a track:
    /// where only the rear leg is seen, the track lies there, and the front leg appears a step
    /// ahead. The price: of two people who meet so near, unseen before, one is found when they
    /// part.
    void greet(double time, const std::vector<Cluster>& strangers) {
        std::vector<bool> used(strangers.size(), false);
        for (std::size_t i = 0; i < strangers.size(); ++i) {
            if (used[i] || isNearAnybody(strangers[i].centre)) continue;
            Vector2d sum = Vector2d::Zero();
            int count = 0;
            for (std::size_t k = i; k < strangers.size(); ++k) {
                if (used[k] || (strangers[k].centre - strangers[i].centre).norm() > kApart)
                    continue;
                used[k] = true;
                sum += strangers[k].centre;
                ++count;
            }
            tracks_.emplace_back(++last_id_, time, sum / count);
            tracks_.back().update(sum / count, sigmaOf(strangers[i].kind), strangers[i].kind);
        }
    }

    bool isNearAnybody(const Vector2d& place) const {
        return std::any_of(tracks_.begin(), tracks_.end(), [&place](const Track& track) {
            return (track.place() - place).norm() < kReach;
        });
    }

    static bool isGone(const Track& track) {
        return track.unseen() > (track.hits() >= kSure ? kPatience : 0.3);
    }

    Tracks tracks_;
    int last_id_ = 0;
};

}  // namespace tracker

#endif  // TRACKER_JOINT_TRACKER_H
