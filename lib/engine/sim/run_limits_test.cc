// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/run_limits.h"

#include <gtest/gtest.h>

#include <string>

#include "support/test_source.h"

namespace ispace {
namespace run_limits_test {

using std::chrono::milliseconds;
using testing::findings;

RunLoad loadOf(const std::string& layout, const RecordOptions* record = nullptr) {
    return loadOf(testing::scene("ispace size=8,6\n", layout), milliseconds(5), record);
}

TEST(RunLimits, AddsUpWhatAScenesSensorsDo) {
    const RunLoad load = loadOf(
        "laser at=0,0 fov=100 step=1 rate=10\nlaser at=0,0 fov=10 step=1 rate=1\n"
        "camera at=0,0,1 pixels=8,6 rate=10\nranger at=0,0,1 pixels=4,3 rate=4\n");
    EXPECT_EQ(load.records, 5);
    EXPECT_EQ(load.beams, 101 + 11);
    EXPECT_EQ(load.beam_rate, 1010 + 11);
    EXPECT_EQ(load.pixels, 48 + 12);
    EXPECT_EQ(load.pixel_rate, 480 + 48);
    EXPECT_EQ(load.recorded_bytes, 0);
}

TEST(RunLimits, EchoesOfRobotsAndTagsCount) {
    const RunLoad load = loadOf(
        "robot model=pioneer-2dx at=0,0\n"
        "tag at=0,2,1\ntag at=0,-2,1\nultrasound at=1,0,2\nultrasound at=2,0,2\n");
    EXPECT_EQ(load.beams, 16 * 37 + 2 * 2 * 2);
}

/// Frames count as often as they are recorded, not as often as they can be read.
TEST(RunLimits, RecordsTakeBytes) {
    RecordOptions record;
    record.frame_rate = 0;
    const double rows = loadOf("robot at=0,0\n", &record).recorded_bytes;
    EXPECT_GT(rows, 200 * 50);
    const std::string camera = "robot at=0,0\ncamera at=0,2,1 pixels=1000,1000 rate=10\n";
    EXPECT_EQ(loadOf(camera, &record).recorded_bytes, rows);
    record.frame_rate = 2;
    EXPECT_EQ(loadOf(camera, &record).recorded_bytes, rows + 2 * 3e6);
}

TEST(RunLimits, RefusesWhatGrowsBeyondABound) {
    RunLoad small, large;
    small.beams = 1000;
    large.beams = 5e6;
    checkLoad(small, small);
    EXPECT_EQ(findings([&] { checkLoad(small, large); }),
              "error: the world would have 5000000 beams of lasers and sonars, more than "
              "4000000\n");
    // As its user began it.
    checkLoad(large, large);
    checkLoad(large, small);
}

}  // namespace run_limits_test
}  // namespace ispace
