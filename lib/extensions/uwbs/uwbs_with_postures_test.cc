// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/number.h"
#include "extensions/postures/postures_test.h"
#include "extensions/uwbs/uwb_ranges.h"
#include "extensions/uwbs/uwbs_test.h"
#include "support/test_readings.h"

namespace ispace::uwbs {
namespace uwbs_with_postures_test {

// Before the schemas are asked for.
const bool kPosturesAdded = [] {
    testing::addPosturesOnce();
    return true;
}();

constexpr double kHeight = 1.7;  // of a person
constexpr const char* kRoom = "ispace size=10,8\n";

/// Tags of `tag=` are on the chest, which is above a person on its back and below one on its belly.
TEST(UwbRanges, OfPeopleAreThoseOfTheChest) {
    ASSERT_TRUE(kPosturesAdded);
    const double h = kHeight, chest = 0.48 + 0.75 * 0.39, ahead = 0.06 * h + 0.02;
    const auto expect = [](const std::string& posture, Point3 local) {
        SCOPED_TRACE(posture);
        const Scene scene =
            testing::scene(kRoom, "human id=ann at=1,2 heading=90 tag=7 " + posture +
                                      "\nuwb at=-3,-2,2.4\nuwb at=4,-3,0.5\nuwb at=2,-2,1\n");
        const std::vector<Reading> readings = testing::readings(scene);
        ASSERT_EQ(readings.size(), 3U);
        for (const Reading& reading : readings) {
            const auto& added = std::get<AddedReading>(reading);
            const auto& tags = added.as<UwbRanges>().tags;
            ASSERT_EQ(tags.size(), 1U);
            const Point3 tag{1 - local.y, 2 + local.x, local.z};
            EXPECT_NEAR(tags.front().range, length(tag - added.pose.position), 1e-6);
        }
    };
    expect("", {ahead, 0, chest * h});
    expect("right_arm=0,0", {ahead, 0, chest * h});
    expect("posture=sit support=0.45", {ahead, 0, 0.45 + 0.75 * 0.39 * h});
    expect("posture=lie support=0.5", {0.25 * 0.39 * h, 0, 0.5 + 0.12 * h + 0.02});
    expect("posture=fallen", {0.25 * 0.39 * h, 0, 0.02});
}

/// The tag of a thing in the hand is where the thing is.
TEST(UwbRanges, OfThingsAreThoseOfTheHand) {
    const std::string room =
        std::string(kRoom) + "cylinder id=cup at=3,3 size=0.1,0.1 height=0.2 tag=cup carried=ann\n";
    for (const char* const keys : {"", "right_arm=20,40", "right_arm=0,0 posture=sit"}) {
        const std::string ann = std::string("human id=ann at=0,0 heading=90 ") + keys + '\n';
        const Point3 load = testing::scene(room, ann).people.front().figure->load;
        // The person faces +y.
        const Point3 tag{-load.y, load.x, load.z + 0.2 + 0.01};
        for (const Point3 at : {Point3{2, 2, 2}, Point3{0.5, 3, 0.3}}) {
            const Scene scene =
                testing::scene(room, ann + "uwb at=" + formatDouble(at.x) + ',' +
                                         formatDouble(at.y) + ',' + formatDouble(at.z) + '\n');
            const Reading reading = testing::readings(scene).front();
            const auto& tags = std::get<AddedReading>(reading).as<UwbRanges>().tags;
            ASSERT_EQ(tags.size(), 1U) << keys;
            EXPECT_NEAR(tags.front().range, length(tag - at), 1e-9) << keys;
        }
    }
}

}  // namespace uwbs_with_postures_test
}  // namespace ispace::uwbs
