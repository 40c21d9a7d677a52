// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/sensor_group.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/test_arrange.h"

namespace ispace {
namespace sensor_group_test {

TEST(SensorGroups, RefuseIdsThatAreTakenAndPlacesThatAreGiven) {
    const Scene scene = roomScene();
    for (const char* bad : {"laser,id=d1", "laser,at=1,1", "laser,heading=30", "laser,on=d1"})
        EXPECT_THROW(groupsOf(scene, {bad}), UsageError) << bad;
    EXPECT_THROW(groupsOf(scene, {"laser,id=a", "laser,id=a"}), UsageError);
    EXPECT_THROW(groupsOf(scene, {"laser,range=4,2"}), UsageError) << "on the command line";
}

TEST(SensorGroups, CountsAreOpenOnlyWhereTheSearchFindsThem) {
    const Scene scene = roomScene();
    EXPECT_EQ(groupsOf(scene, {"laser"})[0].most, 1);
    EXPECT_EQ(groupsOf(scene, {"laser"}, true)[0].most, kMaxOpen);
    EXPECT_EQ(groupsOf(scene, {"laser:7"}, true)[0].most, 7);
    EXPECT_EQ(groupsOf(scene, {"laser,id=one"}, true)[0].most, 1);
}

TEST(SensorGroups, FixedSensorsStayAndOthersAreFreed) {
    const Document layout = layoutFrom(
        "laser id=a at=1,1 heading=20\nlaser at=2,2\nranger id=r at=0,0,1 tilt=-20\n"
        "laser id=top on=d1 at=0,0\ndesk id=d2 at=1,2\n");
    const std::string fixed[] = {"a"};
    const Document freed = withoutPlaces(layout, fixed);
    ASSERT_EQ(freed.records.size(), layout.records.size());
    EXPECT_EQ(freed.records[0], layout.records[0]);
    EXPECT_FALSE(freed.records[1].has("at"));
    EXPECT_EQ(freed.records[1].writtenId(), "laser1") << "it keeps the name others call it";
    EXPECT_FALSE(freed.records[2].has("at"));
    EXPECT_EQ(freed.records[2].angle("tilt"), Angle::degrees(-20));
    EXPECT_EQ(freed.records[3], layout.records[3]);
    EXPECT_EQ(freed.records[4], layout.records[4]);
    const std::string globs[] = {"?", "laser*"};
    EXPECT_TRUE(withoutPlaces(layout, globs).records[2].has("at"));
    const std::string riding[] = {"top", "a"};
    EXPECT_EQ(withoutPlaces(layout, riding).records[3], layout.records[3]);
    const std::string unknown[] = {"b"};
    EXPECT_THROW(withoutPlaces(layout, unknown), UsageError);
}

}  // namespace sensor_group_test
}  // namespace ispace
