// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "extensions/appliances/appliance.h"
#include "extensions/microphones/microphones_test.h"
#include "scene/placement_schemas.h"
#include "sense/selection.h"
#include "support/test_layout.h"

namespace ispace::microphones {
namespace microphones_with_appliances_test {

// Before the schemas are asked for.
const bool kAppliancesAdded = [] {
    addSceneSchemas(appliances::applianceSchemas());
    appliances::addAppliances();
    return true;
}();

TEST(Microphone, HearsAnAppliance) {
    ASSERT_TRUE(kAppliancesAdded);
    const auto volume = [](const std::string& state) {
        const Scene scene = testing::scene(
            "ispace size=10,8\ncube at=0,1 size=1,1,0.9\n",
            "appliance id=k kind=tv at=0,1 state=" + state + "\nmicrophone id=m at=2,1,1\n");
        const Sensor microphone = sensorsOf<Microphone>(scene).front();
        const auto sounds = microphone.as<Microphone>().sources;
        return sounds.size() > 0 ? sounds.begin()->volume : 0;
    };
    EXPECT_EQ(volume("off"), 0);
    EXPECT_EQ(volume("standby"), 0);
    EXPECT_EQ(volume("start"), 0);
    EXPECT_EQ(volume("hold"), 60);
}

}  // namespace microphones_with_appliances_test
}  // namespace ispace::microphones
