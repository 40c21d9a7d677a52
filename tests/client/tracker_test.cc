// SPDX-License-Identifier: GPL-3.0-or-later
// The trackers of share/examples/tracker, by clusters that are given.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "joint_tracker.h"

namespace tracker {
namespace {

std::vector<Cluster> legsAt(const std::vector<double>& xs) {
    std::vector<Cluster> clusters;
    for (const double x : xs) {
        Cluster cluster;
        cluster.centre = cluster.surface = Vector2d(x, 0);
        clusters.push_back(cluster);
    }
    return clusters;
}

// One person stands out of sight of all lasers, and another one walks over that point.
TEST(JointTracker, WhoWalksOverALostTrackKeepsTheirOwn) {
    JointTracker joint;
    double time = 0;
    for (int k = 0; k < 10; ++k, time += 0.1) joint.update(time, {legsAt({0, 1})});
    ASSERT_EQ(joint.tracks().size(), 2U);
    const int walker = joint.tracks().back().id();
    for (int k = 1; k <= 14; ++k, time += 0.1) {
        const double x = 1 - 0.1 * k;
        joint.update(time, {legsAt({x})});
        int found = 0;
        for (const Track& track : joint.tracks())
            if (track.id() == walker && std::abs(track.place().x() - x) < 0.15) ++found;
        EXPECT_EQ(found, 1) << "at " << x;
    }
    EXPECT_EQ(joint.tracks().size(), 1U);
}

// A laser sees the rear leg alone; the front leg appears a step ahead, outside the track's gate.
TEST(JointTracker, LegsOfOneStepAreOnePerson) {
    JointTracker joint;
    double time = 0;
    for (int k = 0; k < 10; ++k, time += 0.1) joint.update(time, {legsAt({0})});
    joint.update(time, {legsAt({0, 0.55})});
    for (int k = 1; k <= 10; ++k) {
        const double x = 0.08 * k;
        joint.update(time + 0.1 * k, {legsAt({x, x + 0.5})});
        EXPECT_EQ(joint.tracks().size(), 1U) << "at " << x;
    }
}

// A tentative track does not replace a confirmed one.
TEST(JointTracker, OfDoublesTheSureOneStays) {
    Tracks tracks;
    tracks.emplace_back(1, 0.0, Vector2d(0.1, 0));
    tracks.back().update(Vector2d(0.1, 0), 0.1, Kind::Leg);
    tracks.emplace_back(2, 0.0, Vector2d(0, 0));
    for (int k = 1; k <= 5; ++k) {
        tracks.back().predict(0.1 * k);
        tracks.back().update(Vector2d(0, 0), 0.1, Kind::Leg);
    }
    tracks.front().predict(0.6);
    tracks.back().predict(0.6);
    tracks.front().update(Vector2d(0.1, 0), 0.1, Kind::Leg);
    eraseDoubles(tracks, 0.2, 4);
    ASSERT_EQ(tracks.size(), 1U);
    EXPECT_EQ(tracks.front().id(), 2);
}

}  // namespace
}  // namespace tracker
