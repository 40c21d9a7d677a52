// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor_spec.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "record/missing_keywords.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "support/test_layout.h"

namespace ispace {
namespace sensor_spec_test {

SensorSpec read(const std::string& text) {
    constexpr std::string_view kKinds[] = {"laser"};
    return readSensorSpec(text, kKinds, sceneSchemas(), testing::devices());
}

std::string errorOf(const std::string& text) {
    try {
        read(text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(SensorSpec, DeviceAndBareKind) {
    const auto device = read("urg-04lx");
    EXPECT_FALSE(device.count);
    EXPECT_EQ(formatRecord(device.record), "laser model=urg-04lx");
    EXPECT_EQ(formatRecord(read("laser").record), "laser");
}

TEST(SensorSpec, CountFollowsTheLastColon) {
    EXPECT_EQ(read("urg-04lx:3").count, 3);
    EXPECT_EQ(read("laser,range=4,fov=270:12").count, 12);
}

TEST(SensorSpec, APieceWithoutEqualsContinuesTheValueBeforeIt) {
    EXPECT_EQ(formatRecord(read("laser,range=0.1,4,fov=270:2").record),
              "laser range=0.1,4 fov=270");
    EXPECT_EQ(formatRecord(read("laser,range=50cm,4m").record), "laser range=0.5,4");
}

TEST(SensorSpec, ErrorsNameTheExtensionOfAKindThatThisBuildLacks) {
    addMissingKeyword("seismometer", "tremors");
    EXPECT_EQ(errorOf("seismometer"),
              "unknown sensor `seismometer`, which the extension tremors reads: this build lacks "
              "that extension");
}

TEST(SensorSpec, ErrorsNameWhatIsWrong) {
    EXPECT_NE(errorOf("urg-04lxx").find("did you mean `urg-04lx`"), std::string::npos);
    EXPECT_NE(errorOf("laser,rnage=4").find("did you mean `range`"), std::string::npos);
    EXPECT_NE(errorOf("laser,4").find("no KEY=VALUE"), std::string::npos);
    EXPECT_NE(errorOf("laser:0").find("no count"), std::string::npos);
    EXPECT_NE(errorOf("laser:x").find("no count"), std::string::npos);
    EXPECT_NE(errorOf("laser,fov=nan").find("fov"), std::string::npos);
    EXPECT_NE(errorOf("laser,fov=90,fov=80").find("twice"), std::string::npos);
    EXPECT_NE(errorOf("laser,id=a:2"), "");
    EXPECT_NE(errorOf(""), "");
    EXPECT_NE(errorOf("desk"), "") << "furniture is no sensor";
    EXPECT_NE(errorOf("result"), "");
    EXPECT_EQ(errorOf("robot"),
              "unknown sensor `robot` (a bare kind of ispace-3dm(5), or a device: scan "
              "--list-models names all)");
    EXPECT_EQ(
        errorOf("Slamtec"),
        "`Slamtec` is no sensor by itself, name one of these: rplidar-a1, rplidar-a2, rplidar-a3");
    EXPECT_EQ(
        errorOf("urg04lx").find("`urg04lx` is no sensor by itself, name one of these: urg-04lx"),
        0U)
        << errorOf("urg04lx");
    EXPECT_EQ(errorOf("urg:4").find("`urg` is no sensor by itself, name one of these: urg-04lx"),
              0U)
        << errorOf("urg:4");
    EXPECT_NE(errorOf("lms").find("lms111"), std::string::npos) << errorOf("lms");
    EXPECT_EQ(errorOf("pioneer-2dx"),
              "`pioneer-2dx` is a device of kind robot, which this option does not take");
    EXPECT_EQ(errorOf("sr-3000"),
              "`sr-3000` is a device of kind ranger, which this option does not take");
}

}  // namespace sensor_spec_test
}  // namespace ispace
