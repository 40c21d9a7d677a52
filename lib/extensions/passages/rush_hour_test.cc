// SPDX-License-Identifier: GPL-3.0-or-later
// Many robots and people in a building of three storeys: none waits for ever.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "extensions/passages/building_run.h"
#include "extensions/passages/lift.h"
#include "extensions/passages/passages_test.h"

namespace ispace::passages {
namespace rush_hour_test {

using testing::buildingOf;
using testing::kBuilding;
using testing::optionsOf;
using testing::poseOf;
using testing::step;

/// Three storeys of two halls with two doors between them, two flights of stairs in corners, each
/// with a landing of one metre at its foot, and a lift.
constexpr const char* kOffices =
    "- storey: {id: g, z: 0, height: 3.2, records: &room [{fence: {id: out, path: [[0, 0], [20, "
    "0], [20, 12], [0, 12]], closed: yes, height: 3}}, {fence: {id: mid, path: [[0, 7], [20, 7]], "
    "height: 3}}, {inside: {at: [10, 3]}}, {inside: {at: [10, 9]}}, {door: {id: da, at: [4, 7], "
    "open: yes, size: 1.2}}, {door: {id: db, at: [15, 7], open: yes, size: 1.2}}]}\n"
    "- storey: {id: m, z: 3.2, height: 3.2, records: *room}\n"
    "- storey: {id: t, z: 6.4, height: 3, records: *room}\n"
    "- stairs: {id: s1, storeys: 'g,m,t', at: [1.2, 1], heading: 90, size: [1.4, 4.5]}\n"
    "- stairs: {id: s2, storeys: 'g,m,t', at: [18.8, 1], heading: 90, size: [1.4, 4.5]}\n"
    "- lift: {id: l1, storeys: 'g,m,t', at: [10, 11], heading: -90, size: [1.8, 1.6], door: 1, "
    "speed: 1.5, capacity: 630kg}\n";

/// Robots and people that go from one random point to another for an hour.
class RushHour {
  public:
    RushHour(unsigned seed, std::size_t robots, std::size_t people) : random_(seed) {
        constexpr std::array kStoreys = {"g", "m", "t"};
        std::string layout;
        for (std::size_t i = 0; i < robots + people; ++i) {
            const std::string id = std::string(kStoreys[i % 3]) + '/' + std::to_string(i);
            const Point2 at{3.5 + 1.5 * static_cast<double>(i / 3), 8.2 + (i % 2 == 0 ? 0 : 1)};
            layout += std::string(i < robots ? "robot model=pioneer-3dx mass=9" : "human") +
                      " id=" + id + " at=" + formatDouble(at.x) + ',' + formatDouble(at.y) + '\n';
            movers_.push_back({id, {i % 3, at}, 0});
        }
        building_ = buildingOf(layout, kOffices);
    }

    /// Lets them go for an hour. \returns the longest time in seconds that one took for a trip
    double run() {
        constexpr double kHour = 3600;
        BuildingRun run(building_, optionsOf(std::chrono::milliseconds(50)));
        for (Member& mover : movers_) send(run, mover);
        double longest = 0;
        while (seconds(run.world(0).time()) < kHour) {
            step(run);
            const double now = seconds(run.world(0).time());
            const std::vector<TripEnd> ends(run.tripEnds().begin(), run.tripEnds().end());
            for (const TripEnd& end : ends) {
                if (end.outcome == Outcome::Replaced) continue;
                Member& mover =
                    *std::find_if(movers_.begin(), movers_.end(),
                                  [&](const Member& one) { return one.id == end.mover; });
                EXPECT_EQ(end.outcome, Outcome::Done) << mover.id << " at " << now << " s";
                ++done_;
                longest = std::max(longest, now - mover.began);
                send(run, mover);
            }
        }
        for (const Member& mover : movers_) longest = std::max(longest, kHour - mover.began);
        return longest;
    }
    [[nodiscard]] std::size_t done() const { return done_; }

  private:
    struct Member {
        std::string id;
        RoomPoint goal;
        double began = 0;
    };

    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(random_()) /
                         static_cast<double>(std::mt19937::max());
    }

    /// Sends a mover to a point off the walls that is no other's goal.
    void send(BuildingRun& run, Member& mover) {
        constexpr double kApart = 1.5;
        for (int tries = 0; tries < 1000; ++tries) {
            const bool is_south = random_() % 2 == 0;
            const RoomPoint goal{
                random_() % 3,
                {uniform(0.6, 19.4), is_south ? uniform(0.6, 6.4) : uniform(7.6, 11.4)}};
            const bool is_apart =
                std::all_of(movers_.begin(), movers_.end(), [&](const Member& other) {
                    return other.id == mover.id || other.goal.room != goal.room ||
                           distance(other.goal.at, goal.at) > kApart;
                });
            if (!is_apart || !run.travel(mover.id, {{goal}}).refusal.empty()) continue;
            mover.goal = goal;
            mover.began = seconds(run.world(0).time());
            return;
        }
        ADD_FAILURE() << "no goal for " << mover.id;
    }

    std::mt19937 random_;
    std::vector<Member> movers_;
    SiteScene building_;
    std::size_t done_ = 0;
};

void expectAllArrive(unsigned seed) {
    constexpr double kMost = 1500;  // seconds
    RushHour hour(seed, 8, 20);
    EXPECT_LT(hour.run(), kMost) << "seed " << seed;
    EXPECT_GT(hour.done(), 1000U) << "seed " << seed;
}

TEST(BuildingRun, EverybodyArrivesInARushHour) { expectAllArrive(1); }

/// Half a minute: the pipeline rush_hours runs it.
TEST(BuildingRun, DISABLED_EverybodyArrivesInTwentyRushHours) {
    for (unsigned seed = 1; seed <= 20; ++seed) expectAllArrive(seed);
}

TEST(BuildingRun, TwentyPeopleShareStairsWithLandingsOfAMetre) {
    constexpr double kMost = 900;  // seconds
    RushHour hour(1, 0, 20);
    EXPECT_LT(hour.run(), kMost);
    EXPECT_GT(hour.done(), 1000U);
}

/// Seconds for a way or a turn from rest to rest, with constant acceleration.
double timeFor(double way, double speed, double accel) {
    if (way * accel < speed * speed) return 2 * std::sqrt(way / accel);
    return way / speed + speed / accel;
}

/// From the lane before the door of a storey to that of another one: walking, doors and travel.
TEST(BuildingRun, ARideAloneTakesTheTimeOfItsClosedForm) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    BuildingRun run(building, optionsOf());
    ASSERT_EQ(run.travel("ground/r1", {{{1, {9, 6}}}}).via, "l1");
    const auto model = run.world(0).movers().front().model;
    double entered = -1, left = -1;
    std::vector<Pose2> stands;  // poses at which it stood in the cabin
    while (left < 0 && seconds(run.world(0).time()) < 120) {
        step(run);
        const double now = seconds(run.world(0).time());
        const std::size_t room = run.roomOf("ground/r1").value();
        if (room == 2 && entered < 0) {
            entered = now;
            stands.push_back(poseOf(run, "ground/r1"));
        }
        if (room == 2 && run.lifts().front().height > 1 && stands.size() == 1)
            stands.push_back(poseOf(run, "ground/r1"));
        if (room == 1 && entered >= 0) {
            left = now;
            stands.push_back(poseOf(run, "ground/r1"));
        }
    }
    ASSERT_EQ(stands.size(), 3U);
    const Point2 threshold{1.2 + 0.9 - model.radius - 0.05, 4};
    double expected = 2 * doorTime(1.2) + liftRide(3, 1);
    Pose2 at = stands[0];
    for (const Point2 to : {threshold, stands[1].position, threshold, stands[2].position}) {
        const Vec2 way = to - at.position;
        const Angle heading = Angle::radians(std::atan2(way.y, way.x));
        expected += timeFor(std::abs(wrapped(heading - at.heading).degrees()),
                            model.rotspeed.degrees(), model.rotaccel.degrees());
        expected += timeFor(length(way), model.speed, model.accel);
        at = {to, heading};
    }
    EXPECT_NEAR(left - entered, expected, 0.1 * expected);
}

}  // namespace rush_hour_test
}  // namespace ispace::passages
