// SPDX-License-Identifier: GPL-3.0-or-later
// The gains that arrange --heat draws.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/test_arrange.h"

namespace ispace {
namespace gain_map_test {

Arrangement withGains(std::initializer_list<const char*> sensors, int redundancy = 1) {
    const Scene scene = roomScene();
    ArrangeOptions options = coarse();
    options.wants_gains = true;
    options.wants_trace = true;
    options.redundancy = redundancy;
    return arranged(scene, groupsOf(scene, sensors), options);
}

TEST(GainMap, ChosenGainsAddUpToTheValue) {
    const Arrangement found = withGains({"laser,range=3,fov=120:3"});
    ASSERT_EQ(found.gains.size(), 3U);
    double sum = 0, last = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const GainMap& map = found.gains[i];
        EXPECT_EQ(map.before.size(), i);
        for (const Placement& placement : map.before) EXPECT_NE(placement.sensor, map.sensor);
        const auto chosen = std::find_if(map.poses.begin(), map.poses.end(),
                                         [](const TriedPose& pose) { return pose.is_chosen; });
        ASSERT_NE(chosen, map.poses.end());
        sum += chosen->value;
        EXPECT_LE(chosen->value, last + 1e-12);
        last = chosen->value;
    }
    EXPECT_NEAR(sum, found.candidate_value, 1e-9);
}

TEST(GainMap, FirstIsThatOfTheTrace) {
    const Arrangement found = withGains({"laser,range=3,fov=120:2"});
    const std::vector<TriedPose>& first = found.gains.front().poses;
    ASSERT_EQ(first.size(), found.tried.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].pose, found.tried[i].pose);
        EXPECT_EQ(first[i].value, found.tried[i].value);
    }
}

TEST(GainMap, HoldsTheCandidatesOfTheSensorsKind) {
    const Arrangement found = withGains({"laser,range=3,fov=120", "laser,range=1,fov=360"});
    ASSERT_EQ(found.gains.size(), 2U);
    EXPECT_LT(found.gains[1].poses.size(), found.gains[0].poses.size());  // one heading a site
    // Floor that two must see is half seen by the first.
    const Arrangement twice = withGains({"laser,range=3,fov=360:2"}, 2);
    ASSERT_EQ(twice.gains.size(), 2U);
    EXPECT_LE(twice.gains[0].poses[0].value, 0.5);
}

}  // namespace gain_map_test
}  // namespace ispace
