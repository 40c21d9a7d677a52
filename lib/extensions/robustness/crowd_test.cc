// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/robustness/crowd.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "env/level.h"
#include "geom/predicates.h"
#include "scene/bodies.h"
#include "support/test_scenes.h"

namespace ispace::robustness {
namespace crowd_test {

const std::string kHall =
    "ispace size=10,8,3\npillar id=p at=1,1\ndesk id=d at=-2,1.5 heading=20\n"
    "zone id=door path=-5,-3;-3,-3;-3,-1;-5,-1\n"
    "laser id=l at=-4.9,0 range=8 fov=180\n"
    "camera id=c at=4.9,3.9,2.8 heading=-140 tilt=-35 fov=80 pixels=1280,720\n";

TEST(Crowd, KeepsDigestAndSensors) {
    const Scene scene = sceneOf(kHall + "cube id=crowd1 at=3,0\n");
    const Scene filled = withCrowd(scene, {{{-1, -1}}, {{2, -2}, 1.5}});
    EXPECT_EQ(filled.digest(), scene.digest());
    EXPECT_EQ(filled.sensors.size(), scene.sensors.size());
    EXPECT_EQ(filled.environment.elements().size(), scene.environment.elements().size() + 2);
}

TEST(Crowd, DrawsFreePositionsApart) {
    const Scene scene = sceneOf(kHall + "laser id=low at=0,-1 range=3\n");
    const CrowdFloor floor(scene);
    const double radius = humanRadius(kUsualHeight);
    const Slice band = scene.environment.band(0, kUsualHeight);
    double left = 0;
    for (std::uint64_t frame = 0; frame < 50; ++frame) {
        const Crowd crowd = floor.draw(12, {.seed = 3, .frame = frame});
        ASSERT_EQ(crowd.size(), 12U);
        for (std::size_t i = 0; i < crowd.size(); ++i) {
            const Point2 place = crowd[i].place;
            EXPECT_FALSE(band.blocked(place));
            band.forEachLine(
                [&](const Segment2& line) { EXPECT_GT(distance(place, line), radius); });
            EXPECT_GT(distance(place, Point2{0, -1}), radius);
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_GT(distance(place, crowd[k].place), 2 * radius);
            left += place.x < 0 ? 1 : 0;
        }
        const Crowd again = floor.draw(12, {.seed = 3, .frame = frame});
        EXPECT_EQ(again.back().place, crowd.back().place);
    }
    EXPECT_NEAR(left / 600, 0.5, 0.1);
}

TEST(Crowd, OfMorePeopleThanFitIsRefused) {
    const Scene scene = sceneOf("ispace size=1,1,3\nlaser at=0.45,0.45 range=3\n");
    EXPECT_THROW(static_cast<void>(CrowdFloor(scene).draw(9, {})), UnmetError);
}

}  // namespace crowd_test
}  // namespace ispace::robustness
