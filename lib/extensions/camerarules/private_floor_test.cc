// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/camerarules/private_floor.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "support/test_layout.h"

namespace ispace::camerarules {
namespace private_floor_test {

// One zone reaches out of the room, one lies behind a wall of boxes, two overlap, one is outdoors.
constexpr const char* kRoom =
    "ispace size=10,8,3\nzone id=za path=-6,-1;-3,-1;-3,1;-6,1\nzone id=zb path=0,0;2,0;2,2;0,2\n"
    "zone id=zc path=1,1;3,1;3,3;1,3\nzone id=zd path=7,7;8,7;8,8;7,8\n"
    "zone id=door path=3,-3.5;4.5,-3.5;4.5,-2\ncube id=box at=2,-2.5 size=0.5,2,2\n";

TEST(PrivateFloor, IsThatOfMeasurePrivacyForEachCameraAlone) {
    const std::vector<PrivacyRule> rules = {parsePrivacy("z*"), parsePrivacy("door,250")};
    std::mt19937_64 random(5);
    const auto any = [&](double low, double high) {
        return std::to_string(std::uniform_real_distribution<double>(low, high)(random));
    };
    int seers = 0, blind = 0;
    for (int i = 0; i < 60; ++i) {
        Scene scene = testing::scene(kRoom, ("camera id=c at=" + any(-4.9, 4.9) + ',' +
                                             any(-3.9, 3.9) + ",2.5 heading=" + any(-180, 180) +
                                             " tilt=" + any(-60, -20) + " fov=60 pixels=1280,720\n")
                                                .c_str());
        PrivateFloor floor(scene.environment, 0, rules);
        double broken = 0, all = 0;
        for (const PrivacyResult& result : measurePrivacy(scene, 0, rules)) {
            all += result.seen.value_or(result.area);
            if (!isMet(result)) broken += result.seen.value_or(result.area);
        }
        const PrivateFloor::Sight sight = floor.seenBy(scene.sensors.at(0));
        EXPECT_NEAR(sight.broken, broken, 1e-5) << i;
        EXPECT_NEAR(sight.all, all, 1e-5) << i;
        ++(broken > 0 ? seers : blind);
    }
    EXPECT_GT(seers, 10);
    EXPECT_GT(blind, 10);
}

TEST(PrivateFloor, MeasuresEqualCamerasOnce) {
    const std::vector<PrivacyRule> rules = {parsePrivacy("z*")};
    const std::string model = " tilt=-35 fov=80 pixels=1280,720\n";
    const Scene scene = testing::scene(
        kRoom,
        ("camera id=a at=-3,0,2.5 heading=10" + model + "camera id=b at=-3,0,2.5 heading=10" +
         model + "camera id=c at=-3,0,2.5 heading=11" + model + "laser id=l at=0,0 range=5\n")
            .c_str());
    PrivateFloor floor(scene.environment, 0, rules);
    for (int i = 0; i < 3; ++i)
        for (const Sensor& sensor : scene.sensors)
            EXPECT_EQ(floor.knownSight(sensor).all, floor.seenBy(sensor).all) << sensor.id;
    EXPECT_EQ(floor.measured(), 2U) << "two views, and a laser sees no private floor";
}

}  // namespace private_floor_test
}  // namespace ispace::camerarules
