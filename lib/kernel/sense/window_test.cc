// SPDX-License-Identifier: GPL-3.0-or-later
// Windows that open and have blinds, as sensors see them.
#include <gtest/gtest.h>

#include <string>

#include "support/test_readings.h"

namespace ispace {
namespace {

/// A wall with a window between a lamp and a tag on one side, and the sensor `s1` on the other.
Reading readingAt(const std::string& window, const std::string& sensor) {
    const Scene scene = testing::scene(
        "ispace size=10,8,2.5\nwall id=w from=0,-4 to=0,4\nlamp at=1.2,0 on=yes\n"
        "cube at=2,0 size=0.3,0.3,1.2 tag=vase\nwindow id=v wall=w at=0,0 size=2 " +
            window + '\n',
        sensor + '\n');
    return testing::readings(scene).front();
}

double luxThrough(const std::string& window) {
    return std::get<Illuminance>(readingAt(window, "lux at=-0.5,0,1")).lux;
}

std::size_t tagsThrough(const std::string& window) {
    return std::get<RfidTags>(readingAt(window, "rfid at=-0.5,0,1.2")).tags.size();
}

bool isOpen(const std::string& window) {
    return std::get<ContactState>(readingAt(window, "contact door=v at=0,0,1")).open;
}

TEST(Window, OpensForTagsAndContacts) {
    EXPECT_EQ(tagsThrough(""), 0U) << "glass stops radio here";
    EXPECT_EQ(tagsThrough("open=yes"), 1U);
    EXPECT_FALSE(isOpen(""));
    EXPECT_TRUE(isOpen("open=yes"));
}

TEST(Window, ABlindStopsLight) {
    const double lux = luxThrough("");
    EXPECT_GT(lux, 1);
    EXPECT_EQ(luxThrough("open=yes"), lux) << "clear glass is no shadow";
    EXPECT_EQ(luxThrough("blind=yes"), 0);
    EXPECT_EQ(luxThrough("blind=yes open=yes"), 0);
}

TEST(Window, AContactNamesADoorOrAWindow) {
    EXPECT_NE(testing::findings([] {
                  return readingAt("", "contact door=w at=0,0,1");
              }).find("no door or window has the id `w`"),
              std::string::npos);
}

}  // namespace
}  // namespace ispace
