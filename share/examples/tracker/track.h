// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef TRACKER_TRACK_H
#define TRACKER_TRACK_H

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "clusters.h"
#include "geometry.h"

namespace tracker {

/// A followed person: a Kalman filter of position and velocity, m and m/s, of constant velocity up
/// to a random acceleration.
class Track {
  public:
    Track(int id, double time, const Vector2d& place) : id_(id), seen_(time), now_(time) {
        state_ << place, Vector2d::Zero();
        covariance_.diagonal() << 0.15 * 0.15, 0.15 * 0.15, 1, 1;
    }

    int id() const { return id_; }
    double unseen() const { return now_ - seen_; }  ///< s
    int hits() const { return hits_; }
    Vector2d place() const { return state_.head<2>(); }
    Kind kind() const { return robots_ > legs_ ? Kind::Robot : Kind::Leg; }

    void predict(double time) {
        const double dt = time - now_;
        now_ = time;
        Eigen::Matrix4d step = Eigen::Matrix4d::Identity();
        step.topRightCorner<2, 2>() = dt * Eigen::Matrix2d::Identity();
        // The velocity of an unseen track decays. The damping is that of a scan, for ten or so a
        // second.
        if (unseen() > 0.5) step.bottomRightCorner<2, 2>() *= 0.8;
        Eigen::Matrix<double, 4, 2> push;
        push << dt * dt / 2 * Eigen::Matrix2d::Identity(), dt * Eigen::Matrix2d::Identity();
        state_ = step * state_;
        covariance_ = step * covariance_ * step.transpose() +
                      kAcceleration * kAcceleration * push * push.transpose();
    }

    /// Distance of a point from the predicted one, squared, in standard deviations.
    /// \param sigma of a measurement there, m
    double distance(const Vector2d& place, double sigma) const {
        const Vector2d off = place - state_.head<2>();
        return off.dot(spread(sigma).inverse() * off);
    }

    /// Logarithm of the spread of the prediction in spreads of the measurement alone, squared, as
    /// distance() is: any single point is less likely by that.
    double vagueness(double sigma) const {
        return std::log(spread(sigma).determinant()) - 4 * std::log(sigma);
    }

    void update(const Vector2d& place, double sigma, Kind kind) {
        const Eigen::Matrix<double, 4, 2> gain =
            covariance_.leftCols<2>() * spread(sigma).inverse();
        state_ += gain * (place - state_.head<2>());
        covariance_ -= gain * covariance_.topRows<2>().eval();
        covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
        if (seen_ < now_ || hits_ == 0) ++hits_;
        seen_ = now_;
        ++(kind == Kind::Robot ? robots_ : legs_);
    }

  private:
    static constexpr double kAcceleration = 1.5;  // m/s²

    Eigen::Matrix2d spread(double sigma) const {
        return covariance_.topLeftCorner<2, 2>() + sigma * sigma * Eigen::Matrix2d::Identity();
    }

    int id_;
    double seen_, now_;
    int hits_ = 0, legs_ = 0, robots_ = 0;
    Eigen::Vector4d state_ = Eigen::Vector4d::Zero();
    Eigen::Matrix4d covariance_ = Eigen::Matrix4d::Zero();
};

/// Tracks hold fixed-size vectors of Eigen.
using Tracks = std::vector<Track, Eigen::aligned_allocator<Track>>;

/// Those that were seen in so many scans.
inline Tracks withHits(const Tracks& tracks, int hits) {
    Tracks out;
    std::copy_if(tracks.begin(), tracks.end(), std::back_inserter(out),
                 [hits](const Track& track) { return track.hits() >= hits; });
    return out;
}

/// Gives up one of each two tracks that are nearer to each other than `same`, in m: they are of one
/// person. The one to go is not sure yet, that is has less than `sure` hits, or is longer unseen,
/// or is younger, in this order.
inline void eraseDoubles(Tracks& tracks, double same, int sure) {
    const auto rank = [sure](const Track& track) {
        return std::make_tuple(track.hits() < sure, track.unseen(), track.id());
    };
    std::vector<int> doubles;
    for (const Track& one : tracks)
        for (const Track& other : tracks)
            if (rank(other) < rank(one) && (other.place() - one.place()).norm() < same)
                doubles.push_back(one.id());
    tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                                [&doubles](const Track& track) {
                                    return std::find(doubles.begin(), doubles.end(), track.id()) !=
                                           doubles.end();
                                }),
                 tracks.end());
}

}  // namespace tracker

#endif  // TRACKER_TRACK_H
