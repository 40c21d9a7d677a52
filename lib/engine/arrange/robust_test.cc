// SPDX-License-Identifier: GPL-3.0-or-later
// arrange --robust and --crowd: values against coverage of each case.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "arrange/case_room.h"
#include "coverage/crowd.h"
#include "support/test_arrange.h"

namespace ispace {
namespace {

const std::string kMovedRoom =
    "#env 1\n"
    "ispace id=room size=8,6,2.5\n"
    "desk id=d1 at=-2,1.5\n"
    "pillar id=p1 at=2,-1\n"
    "screen id=s1 at=0,1 size=0.05,3,2\n"
    "zone id=left at=-2,0 size=4,6\n";

RobustChoice ofRooms(bool is_worst) {
    RobustChoice robust;
    robust.of = RobustChoice::Of::Rooms;
    robust.is_worst = is_worst;
    robust.name = "room.env";
    ArrangeSite moved;
    moved.rooms.push_back({"", std::make_shared<const Scene>(roomScene(kMovedRoom))});
    robust.rooms.push_back({"moved.env", std::make_shared<const ArrangeSite>(std::move(moved))});
    return robust;
}

const Scene& movedRoom(const ArrangeOptions& options) {
    return *options.robust.rooms[0].site->rooms[0].scene;
}

double coverageOf(const Scene& scene) {
    RayScenes worlds(scene.environment);
    return measureCoverage(scene, worlds, {.exact = false}).report.coverage.grid.value_or(0);
}

constexpr std::initializer_list<const char*> kLasers = {"laser,range=4,fov=200:2"};

TEST(Robust, ValuesInRoomsAreThoseOfCoverage) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, kLasers);
    for (const bool is_worst : {true, false}) {
        ArrangeOptions options = coarse();
        options.robust = ofRooms(is_worst);
        const Arrangement found = arranged(scene, groups, options);
        ASSERT_TRUE(found.robust);
        const double here = coverageOf(withPlaced(scene, groups, found.sensors));
        const double moved = coverageOf(withPlaced(movedRoom(options), groups, found.sensors));
        ASSERT_EQ(found.robust->shares.size(), 2U);
        EXPECT_NEAR(found.robust->shares[0], here, 1e-9);
        EXPECT_NEAR(found.robust->shares[1], moved, 1e-9);
        const double value = is_worst ? std::min(here, moved) : (here + moved) / 2;
        EXPECT_NEAR(*found.value, value, 1e-6);
        EXPECT_NEAR(found.candidate_value, value, 1e-6);
        EXPECT_GE(found.bound, value - 1e-9);
        EXPECT_EQ(found.coverage, here);
    }
}

TEST(Robust, TheWorstRoomGainsAgainstThePlainSearch) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=4,fov=200"});
    ArrangeOptions options = coarse(Optimizer::Exact);
    const Arrangement plain = arranged(scene, groups, options);
    options.robust = ofRooms(true);
    const Arrangement robust = arranged(scene, groups, options);
    const Scene& moved = movedRoom(options);
    const double before =
        std::min(plain.coverage, coverageOf(withPlaced(moved, groups, plain.sensors)));
    EXPECT_GT(robust.robust->worst, before + 0.001);
    EXPECT_EQ(robust.candidate_value, robust.bound);  // proven
    for (const Placement& sensor : robust.sensors) EXPECT_GT(sensor.pose.position.z, 0);
}

TEST(Robust, SitesAreFreeInAllRooms) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=4,fov=200:3"});
    ArrangeOptions options = coarse();
    options.robust = ofRooms(false);
    options.wants_trace = true;
    const Arrangement found = arranged(scene, groups, options);
    const Environment& moved = movedRoom(options).environment;
    for (const TriedPose& tried : found.tried)
        EXPECT_FALSE(
            moved.level(tried.pose.position.z)->isInsideSolid(tried.pose.position.onFloor()));
}

TEST(Robust, NoFailureIsThePlainSearch) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, kLasers);
    ArrangeOptions options = coarse();
    const Arrangement plain = arranged(scene, groups, options);
    options.robust.of = RobustChoice::Of::Failures;
    for (const bool is_worst : {true, false}) {
        options.robust.is_worst = is_worst;
        const Arrangement robust = arranged(scene, groups, options);
        EXPECT_DOUBLE_EQ(robust.candidate_value, plain.candidate_value);
        EXPECT_NEAR(robust.robust->worst, plain.coverage, 1e-12);
        EXPECT_NEAR(robust.robust->mean, plain.coverage, 1e-12);
        EXPECT_TRUE(robust.robust->failed.empty());
    }
}

TEST(Robust, AsManyFailuresAsSensorsAreRefused) {
    const Scene scene = roomScene();
    ArrangeOptions options = coarse();
    options.robust.of = RobustChoice::Of::Failures;
    options.robust.failures = 2;
    EXPECT_THROW(arranged(scene, groupsOf(scene, kLasers), options), UsageError);
    EXPECT_THROW(arranged(scene, groupsOf(scene, {"ultrasound:5"}), options), UsageError);
}

TEST(Robust, ValuesOfMountingsAreThoseOfTheMountedSensors) {
    for (const char* sensors : {"laser,range=4,fov=200:2", "camera:2", "laser,range=3,fov=360:2"}) {
        const Scene scene = roomScene();
        const auto groups = groupsOf(scene, {sensors});
        ArrangeOptions options = coarse();
        options.density = {2, 2, 4};
        options.seed = 3;
        options.robust.of = RobustChoice::Of::Mounting;
        options.robust.tolerance = {0.1, Angle::degrees(5)};
        for (const bool is_worst : {true, false}) {
            if (!is_worst && std::string(sensors) != "laser,range=4,fov=200:2") continue;
            options.robust.is_worst = is_worst;
            const Arrangement found = arranged(scene, groups, options);
            const Scene whole = withPlaced(scene, groups, found.sensors);
            double least = 1, sum = 0;
            for (int k = 0; k < kRobustSamples; ++k) {
                const SiteErrors errors(scene.environment, options.robust.tolerance, 3,
                                        static_cast<std::uint64_t>(k));
                Scene mounted = whole;
                for (Sensor& sensor : mounted.sensors) sensor.pose = errors.mounted(sensor);
                const double share = coverageOf(mounted);
                EXPECT_NEAR(found.robust->shares[static_cast<std::size_t>(k)], share, 1e-9);
                least = std::min(least, share);
                sum += share / kRobustSamples;
            }
            EXPECT_NEAR(found.candidate_value, is_worst ? least : sum, 1e-6) << sensors;
            EXPECT_GE(found.bound, found.candidate_value);
        }
    }
}

TEST(Robust, WithoutErrorsAllMountingsAreThePlan) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, kLasers);
    ArrangeOptions options = coarse();
    const Arrangement plain = arranged(scene, groups, options);
    options.robust.of = RobustChoice::Of::Mounting;
    const Arrangement robust = arranged(scene, groups, options);
    EXPECT_NEAR(robust.candidate_value, plain.candidate_value, 1e-9);
    EXPECT_NEAR(robust.robust->mean, robust.robust->worst, 1e-9);
}

TEST(Robust, ValuesAmongPeopleAreThoseOfCoverage) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, kLasers);
    ArrangeOptions options = coarse();
    options.seed = 7;
    options.robust = {.of = RobustChoice::Of::Crowd, .is_worst = false, .people = 3};
    const Arrangement found = arranged(scene, groups, options);
    const Scene whole = withPlaced(scene, groups, found.sensors);
    const CrowdFloor floor(scene);
    double sum = 0;
    for (std::uint64_t k = 0; k < kRobustSamples; ++k) {
        const Crowd crowd = floor.draw(3, {.seed = 7, .frame = k});
        const double share = coverageOf(withCrowd(whole, crowd));
        EXPECT_NEAR(found.robust->shares[k], share, 1e-9);
        sum += share / kRobustSamples;
    }
    EXPECT_NEAR(*found.value, sum, 1e-9);
    EXPECT_GE(found.bound, sum - 1e-9);
    EXPECT_LT(sum, found.coverage);
}

TEST(Robust, NobodyIsThePlainSearch) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, kLasers);
    ArrangeOptions options = coarse();
    const Arrangement plain = arranged(scene, groups, options);
    options.robust = {.of = RobustChoice::Of::Crowd, .is_worst = false};
    const Arrangement robust = arranged(scene, groups, options);
    EXPECT_NEAR(robust.candidate_value, plain.candidate_value, 1e-9);
}

TEST(Robust, MeanHasItsStandardError) {
    RobustValues values;
    EXPECT_EQ(values.standardError(), 0);
    values.shares = {0.2, 0.4};
    EXPECT_NEAR(values.standardError(), 0.1, 1e-15);  // sqrt(2 * 0.1^2 / 1 / 2)
}

}  // namespace
}  // namespace ispace
