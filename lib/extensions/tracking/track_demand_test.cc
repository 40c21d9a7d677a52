// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/tracking/track_demand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "extensions/presence/people_paths.h"
#include "sense/detection.h"
#include "support/test_arrange.h"

namespace ispace::tracking {
namespace track_demand_test {

/// Two halves, which a narrow gap joins.
constexpr const char* kTwoRooms = "#env 1\nispace size=8,6,2.5\nwall from=0,-3 to=0,2.9\n";

/// Draws numbers; the same ones for a seed.
class Draws {
  public:
    explicit Draws(unsigned seed) : engine_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
    }
    Point2 place(double half_length, double half_width) {
        const double x = between(-half_length, half_length);
        return {x, between(-half_width, half_width)};
    }

  private:
    std::mt19937 engine_;
};

/// A person stands at each place for this number of moments.
PeopleMoments standing(const std::vector<Point2>& places, int moments = 10) {
    MomentSampler sampler;
    for (int i = 0; i < moments; ++i)
        for (std::size_t k = 0; k < places.size(); ++k)
            sampler.add("p" + std::to_string(k), i * presence::kPathStep, places[k]);
    return sampler.finish();
}

/// A walk along the wall at y = -2.5, from x to the right by 0.2 m a moment, `times` times over.
PeopleMoments walking(double x, int moments, int times = 1) {
    MomentSampler sampler;
    for (int lap = 0; lap < times; ++lap)
        for (int i = 0; i < moments; ++i) {
            const int far = lap % 2 == 0 ? i : moments - 1 - i;
            sampler.add("ann", (lap * moments + i) * presence::kPathStep, {x + 0.2 * far, -2.5});
        }
    return sampler.finish();
}

Sensor laserAt(Point2 place, double heading = 0, const char* spec = "laser,range=5,fov=360") {
    const SensorModel model = groupsOf(roomScene(kTwoRooms), {spec}).front().model;
    return {"", model, {{place.x, place.y, 0.15}, Angle::degrees(heading), {}, {}}};
}

CellSet servedIn(const Scene& scene, const Sensor& sensor, const TrackDemand& demand) {
    RayScenes worlds(scene.environment);
    worlds.prepare(sensor.pose);
    worlds.prepareMesh(kindOf(sensor.model).stopped_by);
    return demand.servedBy(sensor, worlds);
}

TEST(MomentSampler, TakesMomentsApartAndBreaksAtJumps) {
    MomentSampler sampler;
    for (int i = 0; i < 20; ++i) {
        sampler.add("ann", 0.1 * i, {0.1 * i, 0});
        if (i != 10) sampler.add("bob", 0.1 * i, {i < 14 ? 0.0 : 50.0, 1});
    }
    const PeopleMoments moments = sampler.finish();
    EXPECT_EQ(moments.people, (std::vector<std::string>{"ann", "bob"}));
    ASSERT_EQ(moments.times.size(), 10U);
    ASSERT_EQ(moments.places.size(), 19U) << "bob is away at 1 s";
    std::vector<double> begins;
    for (const PersonMoment& place : moments.places)
        if (!place.continues) begins.push_back(moments.times[place.moment]);
    ASSERT_EQ(begins.size(), 4U);
    EXPECT_NEAR(begins[2], 1.2, 1e-9) << "he comes back";
    EXPECT_NEAR(begins[3], 1.4, 1e-9) << "and is put elsewhere";
    EXPECT_NEAR(moments.duration(9), 0.2, 1e-9);
}

TEST(Meetings, LastWhileTwoPeopleAreWithinAMetre) {
    MomentSampler sampler;
    for (int i = 0; i <= 40; ++i) {
        sampler.add("ann", i * presence::kPathStep, {-2 + 0.1 * i, 0});
        sampler.add("bob", i * presence::kPathStep, {2 - 0.1 * i, 0});
        sampler.add("eve", i * presence::kPathStep, {0, 5});
    }
    const PeopleMoments moments = sampler.finish();
    const std::vector<Meeting> meetings = meetingsOf(moments);
    ASSERT_EQ(meetings.size(), 1U);
    EXPECT_EQ(meetings[0].places.size(), 2 * 11U) << "from -0.5 to 0.5 m, each";
    const TrackDemand demand(moments, {.crossing = 5});
    EXPECT_NEAR(demand.whole().time, 3 * 41 * 0.2, 1e-9);
    EXPECT_EQ(demand.whole().crossings, 1);
    EXPECT_NEAR(demand.whole().loss, 3 * 41 * 0.2 + 5, 0.02) << "in whole milliseconds";
}

TEST(TrackDemand, SeesWhereTheMonitorOfRunsSees) {
    const Scene room = roomScene();
    Draws draws(3);
    for (const char* spec : {"laser,range=3,fov=200", "camera,range=4", "ranger,range=4"}) {
        for (int trial = 0; trial < 20; ++trial) {
            const Point2 place = draws.place(3.9, 2.9);
            Sensor sensor = laserAt(place, draws.between(-180, 180), spec);
            if (std::string(spec).starts_with("laser")) {
                sensor.pose.position.z = 0.3;
            } else {
                sensor.pose.position.z = 2.2;
                sensor.pose.tilt = Angle::degrees(-40);
            }
            std::vector<Point2> places;
            places.reserve(50);
            for (int i = 0; i < 50; ++i) places.push_back(draws.place(3.9, 2.9));
            // Of a laser the whole figure must be within range.
            Scene watched = room;
            watched.sensors = {sensor};
            if (auto* const laser = std::get_if<Laser>(&watched.sensors.front().model))
                laser->max_range -= bodyRadiusAt(0.3);
            const DetectionMonitor monitor(watched);
            for (const Point2 at : places) {
                const TrackDemand alone(standing({at}, 1), {});
                EXPECT_EQ(servedIn(room, sensor, alone).test(0), monitor.seenBy({at}) > 0)
                    << spec << " at " << place.x << ',' << place.y << " sees " << at.x << ','
                    << at.y;
            }
        }
    }
}

TEST(TrackDemand, CoastsOverShortGapsOnly) {
    // Ann goes behind a wall for 4 s, and comes out again.
    const Scene scene = roomScene("#env 1\nispace size=20,6,2.5\nwall from=-1,-1 to=1,-1\n");
    MomentSampler sampler;
    for (int i = 0; i <= 60; ++i) sampler.add("ann", i * presence::kPathStep, {-6 + 0.2 * i, -2});
    const PeopleMoments moments = sampler.finish();
    const Sensor sensor = laserAt({0, 0}, 0, "laser,range=20,fov=360");
    const auto lost = [&](double coast) {
        const TrackDemand demand(moments, {.coast = coast});
        return demand.lossOf(servedIn(scene, sensor, demand)).time;
    };
    const double hidden = lost(0);
    ASSERT_NEAR(hidden, 4, 0.4);
    EXPECT_NEAR(lost(1), hidden - 1, 1e-9);
    EXPECT_NEAR(lost(60), 0, 1e-9) << "the way begins in sight";
}

TEST(TrackDemand, NoCoastOverAJump) {
    MomentSampler sampler;
    for (int i = 0; i < 10; ++i)
        sampler.add("ann", i * presence::kPathStep, {i < 5 ? -3.0 : 90.0, 0});
    const TrackDemand demand(sampler.finish(), {.coast = 60});
    const Scene scene = roomScene(kTwoRooms);
    EXPECT_NEAR(demand.lossOf(servedIn(scene, laserAt({-2, 0}), demand)).time, 1, 1e-9);
}

TEST(TrackDemand, LossOfASetIsThatOfTheirUnionWithCoast) {
    // Two sensors that see disjoint parts of a way: together they coast over the gap between them.
    const Scene scene = roomScene("#env 1\nispace size=40,6,2.5\n");
    MomentSampler sampler;
    for (int i = 0; i < 100; ++i) sampler.add("ann", i * presence::kPathStep, {-10 + 0.2 * i, 0});
    const PeopleMoments moments = sampler.finish();
    const TrackDemand demand(moments, {.coast = 1});
    CellSet served = servedIn(scene, laserAt({-5, 0}), demand);
    served |= servedIn(scene, laserAt({5.2, 0}), demand);
    std::vector<bool> seen(moments.places.size());
    const double reach = 5 - bodyRadiusAt(0.15);
    for (std::size_t i = 0; i < seen.size(); ++i)
        seen[i] = distance(moments.places[i].place, {-5, 0}) <= reach ||
                  distance(moments.places[i].place, {5.2, 0}) <= reach;
    int lost = 0, gap = 1000;
    for (const bool one : seen) {
        gap = one ? 0 : gap + 1;
        lost += gap > 5 ? 1 : 0;
    }
    EXPECT_NEAR(demand.lossOf(served).time, lost * presence::kPathStep, 1e-9);
    EXPECT_EQ(lost, 1) << "before the first sight, not in the gap of half a metre";
}

TEST(TrackDemand, PeopleHideEachOther) {
    const Scene scene = roomScene("#env 1\nispace size=20,6,2.5\n");
    const PeopleMoments two = standing({{2, 0}, {4, 0}});
    const TrackDemand demand(two, {.coast = 0});
    EXPECT_NEAR(demand.lossOf(servedIn(scene, laserAt({0, 0}), demand)).time, 2, 1e-9);
    EXPECT_NEAR(demand.lossOf(servedIn(scene, laserAt({3, 2}), demand)).time, 0, 1e-9);
    EXPECT_NEAR(demand.lossOf(servedIn(scene, laserAt({0, 0.6}), demand)).time, 0, 1e-9)
        << "legs hide less than a metre beside them";
    Sensor above = laserAt({0, 0}, 0, "camera,range=20,fov=120");
    above.pose.position.z = 2.4;
    above.pose.tilt = Angle::degrees(-30);
    EXPECT_NEAR(demand.lossOf(servedIn(scene, above, demand)).time, 2, 1e-9)
        << "the line to 4 m passes 1.2 m above the floor at 2 m";
    above.pose.position = {3.5, 0, 2.4};
    above.pose.tilt = Angle::degrees(-90);
    EXPECT_NEAR(demand.lossOf(servedIn(scene, above, demand)).time, 0, 1e-9);
}

TEST(TrackDemand, LasersAboveHeadsAndAslantSeeNobody) {
    const Scene scene = roomScene("#env 1\nispace size=20,6,2.5\n");
    const TrackDemand demand(standing({{2, 0}}), {});
    Sensor laser = laserAt({0, 0});
    EXPECT_NEAR(demand.lossOf(servedIn(scene, laser, demand)).time, 0, 1e-9);
    laser.pose.position.z = 1.8;
    EXPECT_NEAR(demand.lossOf(servedIn(scene, laser, demand)).time, 2, 1e-9);
    laser.pose.position.z = 1;
    laser.pose.tilt = Angle::degrees(-30);
    EXPECT_NEAR(demand.lossOf(servedIn(scene, laser, demand)).time, 2, 1e-9);
}

TEST(BodyRadius, IsThatOfLegsTrunkAndHead) {
    EXPECT_NEAR(bodyRadiusAt(0.15), (0.055 + 0.035) * 1.7, 1e-9);
    EXPECT_GT(bodyRadiusAt(1.2), 0.2);
    EXPECT_LT(bodyRadiusAt(1.65), 0.15);
    EXPECT_EQ(bodyRadiusAt(1.75), 0);
}

/// Returns the least loss over all sets of `count` candidates of lasers.
double leastLoss(const Scene& scene, const TrackDemand& demand, const std::vector<Pose3>& poses,
                 const Sensor& sensor, int count) {
    std::vector<CellSet> views;
    views.reserve(poses.size());
    for (const Pose3& pose : poses) {
        Sensor placed = sensor;
        placed.pose = pose;
        views.push_back(servedIn(scene, placed, demand));
    }
    double least = demand.whole().loss;
    for (std::size_t i = 0; i < views.size(); ++i)
        for (std::size_t k = count > 1 ? i + 1 : i; k < (count > 1 ? views.size() : i + 1); ++k) {
            CellSet served = views[i];
            served |= views[k];
            least = std::min(least, demand.lossOf(served).loss);
        }
    return least;
}

TEST(ArrangeForTracks, BoundIsNoMoreThanTheLeastLossOfAllPairs) {
    const Scene scene = roomScene();
    ArrangeOptions options = coarse();
    options.density = {2, 2, 4};
    options.wants_trace = true;
    for (const unsigned seed : {1U, 2U, 3U}) {
        Draws draws(seed);
        std::vector<Point2> places(4);
        for (Point2& place : places) place = draws.place(3.5, 2.5);
        MomentSampler sampler;
        for (int i = 0; i < 40; ++i)
            for (std::size_t k = 0; k < places.size(); ++k) {
                const Point2 to = places[(k + 1) % places.size()];
                sampler.add("p" + std::to_string(k), i * presence::kPathStep,
                            places[k] + (i / 40.0) * (to - places[k]));
            }
        const auto demand = std::make_shared<TrackDemand>(sampler.finish(), LossRule{});
        options.demand = demand;
        for (const int count : {1, 2}) {
            const auto groups =
                groupsOf(scene, {count == 1 ? "laser,range=3,fov=120" : "laser,range=3,fov=120:2"});
            options.search.optimizer = Optimizer::Greedy;
            const Arrangement fast = arranged(scene, groups, options);
            options.search.optimizer = Optimizer::Exact;
            const Arrangement best = arranged(scene, groups, options);
            std::vector<Pose3> poses;
            for (const TriedPose& tried : best.tried) poses.push_back(tried.pose);
            const double least =
                leastLoss(scene, *demand, poses, {"", groups.front().model, {}}, count);
            const double whole = demand->whole().loss;
            EXPECT_NEAR(whole * (1 - *best.value), least, 1e-6) << "seed " << seed;
            EXPECT_NEAR(demand->lossOf(best.served).loss, least, 1e-6);
            EXPECT_LE(whole * (1 - best.bound), least + 1e-6);
            EXPECT_LE(whole * (1 - fast.bound), least + 1e-6);
            EXPECT_GE(whole * (1 - *fast.value), least - 1e-6);
        }
    }
}

TEST(ArrangeForTracks, AWallBetweenTwoPeopleNeedsASensorOnEitherSide) {
    const Scene scene = roomScene(kTwoRooms);
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.demand =
        std::make_shared<TrackDemand>(standing({{-3, 0}, {-2, -1.5}, {3, 0}}), LossRule{});
    const Arrangement one = arranged(scene, groupsOf(scene, {"laser,fov=360"}), options);
    EXPECT_LT(one.sensors.at(0).pose.position.x, 0) << "two are on the left";
    EXPECT_NEAR(*one.value, 2.0 / 3, 1e-6);
    options.target = 1;
    const Arrangement few = arranged(scene, groupsOf(scene, {"laser,fov=360"}, true), options);
    EXPECT_TRUE(few.is_reached);
    EXPECT_EQ(few.sensors.size(), 2U);
    EXPECT_EQ(few.least.value_or(0), 2);
}

TEST(ArrangeForTracks, WaysOverAndOverChooseTheSamePlace) {
    const Scene scene = roomScene(kTwoRooms);
    const auto groups = groupsOf(scene, {"laser,range=2,fov=120"});
    ArrangeOptions options = coarse(Optimizer::Exact);
    const auto placed = [&](int times) {
        options.demand =
            std::make_shared<TrackDemand>(walking(0.5, 16, times), LossRule{.coast = 0});
        const Arrangement found = arranged(scene, groups, options);
        return std::pair(found.sensors.at(0).pose, *found.value);
    };
    const auto [pose, value] = placed(1);
    const auto [again, same] = placed(4);
    EXPECT_EQ(pose, again);
    EXPECT_NEAR(value, same, 1e-9);
    EXPECT_GT(pose.position.x, 0);
}

TEST(ArrangeForTracks, CountsSensorsThatStand) {
    const Document layout = layoutFrom("laser id=l1 at=-3.9,0,0.15 fov=360\n");
    const Scene scene = roomScene(kTwoRooms, &layout);
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.demand =
        std::make_shared<TrackDemand>(standing({{-3, 0}, {-2, -1.5}, {3, 0}}), LossRule{});
    const Arrangement other = arranged(scene, groupsOf(scene, {"laser,fov=360"}), options);
    EXPECT_GT(other.sensors.at(0).pose.position.x, 0) << "l1 watches the left";
    EXPECT_NEAR(*other.value, 1, 1e-9);
}

TEST(ArrangeForTracks, RefusesWaysWithoutPeople) {
    const Scene scene = roomScene(kTwoRooms);
    ArrangeOptions options = coarse();
    options.demand = std::make_shared<TrackDemand>(PeopleMoments(), LossRule{});
    EXPECT_THROW(arranged(scene, groupsOf(scene, {"laser"}), options), UnmetError);
}

TEST(TrackDemand, FindingSaysWhatIsLostAndTheLeastLoss) {
    const Scene scene = roomScene(kTwoRooms);
    const TrackDemand demand(standing({{-3, 0}, {3, 0}}), {.crossing = 5});
    const CellSet served = servedIn(scene, laserAt({-2, 0}), demand);
    EXPECT_EQ(demand.finding(std::vector<ServedDemand>{{&demand, served}}, 0.75),
              "people are lost for 2.0 of 4.0 s; no layout of these candidates loses less than "
              "1.0 s");
    const TrackDemand near(standing({{-3, 0}, {-3, 0.5}, {3, 0}}), {.crossing = 5});
    EXPECT_EQ(near.finding(std::vector<ServedDemand>{{&near, CellSet(near.weights().size())}}, 1),
              "people are lost for 6.0 of 6.0 s and at 1.0 of 1 crossings: a loss of 11.0 s; no "
              "layout of these candidates loses less than 0.0 s");
    // Rooms of a site add up.
    EXPECT_EQ(demand.finding(std::vector<ServedDemand>{{&demand, served},
                                                       {&near, CellSet(near.weights().size())}},
                             1),
              "people are lost for 8.0 of 10.0 s and at 1.0 of 1 crossings: a loss of 13.0 s; no "
              "layout of these candidates loses less than 0.0 s");
}

}  // namespace track_demand_test
}  // namespace ispace::tracking
