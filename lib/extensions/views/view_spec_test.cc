// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/views/projector.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace ispace::views {
namespace view_spec_test {

std::string errorOf(const std::string& text) {
    try {
        parseView(text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(ViewSpec, ReadsWhatIsThere) {
    EXPECT_FALSE(parseView("bird").at);
    const ViewSpec bird = parseView("bird:1,-2,6.5");
    EXPECT_EQ(bird.at, (Point2{1, -2}));
    EXPECT_EQ(bird.width, 6.5);
    const ViewSpec eyes = parseView("first-person:0,1,-90,5");
    EXPECT_EQ(eyes.heading, Angle::degrees(-90));
    EXPECT_EQ(eyes.tilt, Angle::degrees(5));
    EXPECT_EQ(parseView("omni:1,2").z, std::nullopt);
    EXPECT_EQ(parseView("omni:1,2,0.5").z, 0.5);
    const ViewSpec orbit = parseView("orbit:45,30");
    EXPECT_EQ(orbit.heading, Angle::degrees(45));
    EXPECT_EQ(orbit.tilt, Angle::degrees(30));
    EXPECT_FALSE(orbit.distance);
}

TEST(ViewSpec, CentralTakesAPlaceOrAThing) {
    EXPECT_EQ(parseView("central:1,2,90").heading, Angle::degrees(90));
    const ViewSpec robot = parseView("central:r1,90,20,3");
    EXPECT_EQ(robot.id, "r1");
    EXPECT_FALSE(robot.at);
    EXPECT_EQ(robot.distance, 3);
    EXPECT_TRUE(parseView("central").id.empty());
}

TEST(ViewSpec, NamesFitFiles) {
    EXPECT_EQ(parseView("orbit:1,2,3").name, "orbit");
    EXPECT_EQ(parseView("robot:left/r1").name, "robot-left_r1");
}

TEST(ViewSpec, RefusesWhatItCannotMean) {
    EXPECT_EQ(errorOf("orbitt"),
              "`orbitt` is none of bird|first-person|omni|central|orbit|robot|camera, did you mean "
              "`orbit`?");
    EXPECT_EQ(errorOf("bird:1"), "too few numbers, wanted bird[:X,Y[,WIDTH]]");
    EXPECT_EQ(errorOf("bird:1,2,0"),
              "WIDTH is 0, not from 0.001 to 1000000, wanted "
              "bird[:X,Y[,WIDTH]]");
    EXPECT_EQ(errorOf("first-person:1,2"),
              "too few numbers, wanted first-person:X,Y,HEADING[,PITCH]");
    EXPECT_EQ(errorOf("central:").substr(0, 11), "no id given");
    EXPECT_EQ(errorOf("omni"), "no place given, wanted omni:X,Y[,Z]");
    EXPECT_EQ(errorOf("omni:1,b"), "`b` is no number, wanted omni:X,Y[,Z]");
    EXPECT_EQ(errorOf("robot"), "no id given, wanted robot:ID");
    EXPECT_EQ(errorOf("camera:c1,2"), "too many numbers, wanted camera:ID");
    EXPECT_EQ(errorOf("orbit:0,95"),
              "ELEVATION is 95, not from 0 to 90, wanted "
              "orbit[:AZIMUTH[,ELEVATION[,DISTANCE]]]");
}

}  // namespace view_spec_test
}  // namespace ispace::views
