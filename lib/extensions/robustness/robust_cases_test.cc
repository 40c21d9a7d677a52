// SPDX-License-Identifier: GPL-3.0-or-later
// arrange --robust and --crowd: values against coverage of each case.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "env/level.h"
#include "extensions/robustness/figure_samples.h"
#include "extensions/robustness/robust_cases.h"
#include "support/test_arrange.h"

namespace ispace::robustness {
namespace robust_cases_test {

const std::string kMovedRoom =
    "#env 1\n"
    "ispace id=room size=8,6,2.5\n"
    "desk id=d1 at=-2,1.5\n"
    "pillar id=p1 at=2,-1\n"
    "screen id=s1 at=0,1 size=0.05,3,2\n"
    "zone id=left at=-2,0 size=4,6\n";

const Scene& movedRoom() {
    static const Scene moved = roomScene(kMovedRoom);
    return moved;
}

std::shared_ptr<const LayoutCases> ofRooms(bool is_worst) {
    ArrangeSite moved;
    moved.rooms.push_back({"", std::make_shared<const Scene>(movedRoom())});
    return std::make_shared<const OtherSites>(
        is_worst, "room.env",
        std::vector<NamedSite>{{"moved.env", std::make_shared<const ArrangeSite>(moved)}});
}

double gridShareOf(const Scene& scene) {
    RayScenes worlds(scene.environment);
    return measureCoverage(scene, worlds, {.exact = false}).report.coverage.grid.value_or(0);
}

constexpr std::initializer_list<const char*> kLasers = {"laser,range=4,fov=200:2"};

TEST(Robust, ValuesInRoomsAreThoseOfCoverage) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, kLasers);
    for (const bool is_worst : {true, false}) {
        ArrangeOptions options = coarse();
        options.cases = ofRooms(is_worst);
        const Arrangement found = arranged(scene, groups, options);
        ASSERT_TRUE(found.cases);
        const double here = gridShareOf(withPlaced(scene, groups, found.sensors));
        const double moved = gridShareOf(withPlaced(movedRoom(), groups, found.sensors));
        ASSERT_EQ(found.cases->shares.size(), 2U);
        EXPECT_NEAR(found.cases->shares[0], here, 1e-9);
        EXPECT_NEAR(found.cases->shares[1], moved, 1e-9);
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
    options.cases = ofRooms(true);
    const Arrangement robust = arranged(scene, groups, options);
    const Scene& moved = movedRoom();
    const double before =
        std::min(plain.coverage, gridShareOf(withPlaced(moved, groups, plain.sensors)));
    EXPECT_GT(robust.cases->worst, before + 0.001);
    EXPECT_EQ(robust.candidate_value, robust.bound);  // proven
    for (const Placement& sensor : robust.sensors) EXPECT_GT(sensor.pose.position.z, 0);
}

TEST(Robust, SitesAreFreeInAllRooms) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=4,fov=200:3"});
    ArrangeOptions options = coarse();
    options.cases = ofRooms(false);
    options.wants_trace = true;
    const Arrangement found = arranged(scene, groups, options);
    const Environment& moved = movedRoom().environment;
    for (const TriedPose& tried : found.tried)
        EXPECT_FALSE(
            moved.level(tried.pose.position.z)->isInsideSolid(tried.pose.position.onFloor()));
}

TEST(Robust, NoFailureIsThePlainSearch) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, kLasers);
    ArrangeOptions options = coarse();
    const Arrangement plain = arranged(scene, groups, options);
    for (const bool is_worst : {true, false}) {
        options.cases = std::make_shared<const SensorFailures>(is_worst, 0);
        const Arrangement robust = arranged(scene, groups, options);
        EXPECT_DOUBLE_EQ(robust.candidate_value, plain.candidate_value);
        EXPECT_NEAR(robust.cases->worst, plain.coverage, 1e-12);
        EXPECT_NEAR(robust.cases->mean, plain.coverage, 1e-12);
        EXPECT_TRUE(robust.cases->failed.empty());
    }
}

TEST(Robust, AsManyFailuresAsSensorsAreRefused) {
    const Scene scene = roomScene();
    ArrangeOptions options = coarse();
    options.cases = std::make_shared<const SensorFailures>(true, 2);
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
        const MountingTolerance tolerance{0.1, Angle::degrees(5)};
        for (const bool is_worst : {true, false}) {
            if (!is_worst && std::string(sensors) != "laser,range=4,fov=200:2") continue;
            options.cases = std::make_shared<const MountingCases>(is_worst, tolerance,
                                                                  std::vector<std::uint64_t>{3});
            const Arrangement found = arranged(scene, groups, options);
            const Scene whole = withPlaced(scene, groups, found.sensors);
            double least = 1, sum = 0;
            for (std::size_t k = 0; k < kSearchedSamples; ++k) {
                const auto errors = options.cases->errorsIn(scene.environment, 0, k);
                Scene mounted = whole;
                for (Sensor& sensor : mounted.sensors) sensor.pose = errors->actual(sensor);
                const double share = gridShareOf(mounted);
                EXPECT_NEAR(found.cases->shares[k], share, 1e-9);
                least = std::min(least, share);
                sum += share / kSearchedSamples;
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
    options.cases = std::make_shared<const MountingCases>(true, MountingTolerance{},
                                                          std::vector<std::uint64_t>{0});
    const Arrangement robust = arranged(scene, groups, options);
    EXPECT_NEAR(robust.candidate_value, plain.candidate_value, 1e-9);
    EXPECT_NEAR(robust.cases->mean, robust.cases->worst, 1e-9);
}

TEST(Robust, ValuesAmongPeopleAreThoseOfCoverage) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, kLasers);
    ArrangeOptions options = coarse();
    options.seed = 7;
    options.cases = std::make_shared<const CrowdCases>(
        false, 3, std::vector<std::vector<Crowd>>{crowdsIn(scene, 3, 7)});
    const Arrangement found = arranged(scene, groups, options);
    const Scene whole = withPlaced(scene, groups, found.sensors);
    const CrowdFloor floor(scene);
    double sum = 0;
    for (std::uint64_t k = 0; k < kSearchedSamples; ++k) {
        const Crowd crowd = floor.draw(3, {.seed = 7, .frame = k});
        const double share = gridShareOf(withCrowd(whole, crowd));
        EXPECT_NEAR(found.cases->shares[k], share, 1e-9);
        sum += share / kSearchedSamples;
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
    options.cases = std::make_shared<const CrowdCases>(
        false, 0, std::vector<std::vector<Crowd>>{crowdsIn(scene, 0, 0)});
    const Arrangement robust = arranged(scene, groups, options);
    EXPECT_NEAR(robust.candidate_value, plain.candidate_value, 1e-9);
}

TEST(Robust, MeanHasItsStandardError) {
    EXPECT_EQ(standardErrorOf({}), 0);
    const std::vector<double> values = {0.2, 0.4};
    EXPECT_NEAR(standardErrorOf(values), 0.1, 1e-15);  // sqrt(2 * 0.1^2 / 1 / 2)
}

}  // namespace robust_cases_test
}  // namespace ispace::robustness
