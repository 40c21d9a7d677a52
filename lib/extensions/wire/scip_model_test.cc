// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/wire/scip.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/test_layout.h"

namespace ispace::wire {
namespace scip_model_test {

constexpr float kNone = std::numeric_limits<float>::infinity();

Laser laser(const std::string& keys) {
    const Scene scene = testing::scene("ispace size=8,6\n", "laser id=l at=0,0 " + keys + "\n");
    return std::get<Laser>(scene.sensors.front().model);
}

TEST(ScipModel, DevicesAsTheyDescribeThemselves) {
    const ScipModel urg = ScipModel::of(laser("model=urg-04lx"));
    EXPECT_EQ(urg.name, "URG-04LX(Hokuyo Automatic Co.,Ltd.)");
    EXPECT_EQ(urg.min_mm, 20);
    EXPECT_EQ(urg.max_mm, 5600);
    EXPECT_EQ(urg.turn, 1024);
    EXPECT_EQ(urg.first, 44);
    EXPECT_EQ(urg.last, 725);
    EXPECT_EQ(urg.front, 384);
    EXPECT_EQ(urg.rpm, 600);
    for (const char* model :
         {"model=utm-30lx", "model=utm-30lx-ew", "model=ust-10lx", "model=ust-20lx"}) {
        const ScipModel other = ScipModel::of(laser(model));
        EXPECT_EQ(other.turn, 1440) << model;
        EXPECT_EQ(other.first, 0) << model;
        EXPECT_EQ(other.last, 1080) << model;
        EXPECT_EQ(other.front, 540) << model;
        EXPECT_EQ(other.rpm, 2400) << model;
    }
}

TEST(ScipModel, NumbersInPlaceOfADistance) {
    const ScipModel urg = ScipModel::of(laser("model=urg-04lx"));
    EXPECT_EQ(urg.number(1.2344F), 1234);
    EXPECT_EQ(urg.number(1.2346F), 1235);
    EXPECT_EQ(urg.number(kNone), 0);
    EXPECT_EQ(urg.number(0.01F), 19);
    EXPECT_EQ(ScipModel::of(laser("model=utm-30lx")).number(kNone), 1);
    EXPECT_EQ(ScipModel::of(laser("model=utm-30lx")).number(0.01F), 2);
    EXPECT_EQ(ScipModel::of(laser("model=ust-10lx")).number(kNone), 65533);
}

TEST(ScipModel, LasersOfOthers) {
    const ScipModel bare = ScipModel::of(laser(""));
    EXPECT_EQ(bare.turn, 360);
    EXPECT_EQ(bare.first, 1);
    EXPECT_EQ(bare.front, 91);
    EXPECT_EQ(bare.last, 181);
    EXPECT_EQ(bare.max_mm, 5000);
    EXPECT_EQ(bare.number(kNone), 0);
    // All beams to the left of the front.
    const ScipModel left = ScipModel::of(laser("first=10 beams=20 step=1"));
    EXPECT_EQ(left.front, 1);
    EXPECT_EQ(left.first, 11);
    EXPECT_EQ(left.last, 30);
    EXPECT_EQ(ScipModel::refusal(laser("")), "");
    EXPECT_NE(ScipModel::refusal(laser("step=0.7 fov=70")), "");
    EXPECT_NE(ScipModel::refusal(laser("first=0.5 step=1 beams=20")), "");
    EXPECT_NE(ScipModel::refusal(laser("step=0.01 fov=180")), "");
    // Numbers that are none of an int any more.
    for (const char* keys :
         {"first=0 beams=3 step=1e-7", "first=0 beams=3 step=1e-9", "first=-360 beams=3 step=1e-9"})
        EXPECT_EQ(ScipModel::refusal(laser(keys)), "it has more steps than SCIP can number");
    EXPECT_NE(ScipModel::refusal(laser("sweep=tilt sweep_span=10 sweep_step=1")), "");
}

TEST(ScipModel, ClustersAreTheLeastDistance) {
    const ScipModel urg = ScipModel::of(laser("model=urg-04lx"));
    std::vector<float> ranges(682, 3);
    ranges[0] = kNone;
    ranges[1] = 2;
    ranges[2] = 1.5F;
    ranges[3] = kNone;
    ranges[4] = kNone;
    EXPECT_EQ(urg.numbers(ranges, 44, 49, 1), (std::vector<int>{0, 2000, 1500, 0, 0, 3000}));
    EXPECT_EQ(urg.numbers(ranges, 44, 49, 3), (std::vector<int>{1500, 3000}));
    EXPECT_EQ(urg.numbers(ranges, 44, 49, 4), (std::vector<int>{1500, 3000}));
    EXPECT_EQ(urg.numbers(ranges, 47, 48, 2), (std::vector<int>{0}));
    EXPECT_EQ(urg.numbers(ranges, 42, 45, 1), (std::vector<int>{19, 19, 0, 2000}));
    EXPECT_EQ(urg.numbers(ranges, 725, 725, 99), (std::vector<int>{3000}));
}

}  // namespace scip_model_test
}  // namespace ispace::wire
