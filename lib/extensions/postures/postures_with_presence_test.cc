// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "cli/common_options.h"
#include "extensions/postures/postures_test.h"
#include "extensions/presence/presence_paths.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"

namespace ispace::postures {
namespace postures_with_presence_test {

TEST(Postures, WanderersComeWithoutWhatPeopleCarry) {
    testing::addPosturesOnce();
    const Document placed =
        readRecordText("#3dm 1\nhuman id=ann at=0,0\n", "room.3dm", sceneSchemas());
    const Scene room = makeScene(
        readRecordText("#env 1\nispace size=10,8\ncube id=cup at=2,0 size=0.1 carried=ann\n",
                       "room.env", sceneSchemas()),
        &placed, shippedDevices());
    EXPECT_EQ(presence::readPaths(presence::parseWays("wander:2,5s"), room, 7).people.size(), 2U);
}

}  // namespace postures_with_presence_test
}  // namespace ispace::postures
