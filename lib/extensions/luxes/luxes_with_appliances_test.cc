// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "extensions/appliances/appliance.h"
#include "extensions/luxes/luxes_test.h"
#include "scene/placement_schemas.h"
#include "sense/selection.h"
#include "support/test_layout.h"

namespace ispace::luxes {
namespace luxes_with_appliances_test {

// Before the schemas are asked for.
const bool kAppliancesAdded = [] {
    addSceneSchemas(appliances::applianceSchemas());
    appliances::addAppliances();
    return true;
}();

TEST(Lux, SeesTheLightOfAScreen) {
    ASSERT_TRUE(kAppliancesAdded);
    const auto seen = [](const std::string& state) {
        const Scene scene = testing::scene(
            "ispace size=10,8\ncube at=0,1 size=1,1,0.9\n",
            "appliance id=k kind=tv at=0,1 state=" + state + "\nlux id=x at=3,1,1 heading=180\n");
        const Sensor meter = sensorsOf<Lux>(scene).front();
        const auto beams = meter.as<Lux>().beams;
        return beams.size() > 0 ? beams.begin()->spotAt({3, 1, 1}, {-1, 0, 0})->lux : 0;
    };
    EXPECT_EQ(seen("off"), 0);
    EXPECT_EQ(seen("standby"), 0);
    EXPECT_EQ(seen("start"), 0);
    // 260 lm over a square of 12 tan(60 deg)^2 square metres three metres ahead.
    EXPECT_NEAR(seen("hold"), 260.0 / (9 * 4 * 3), 1e-9);
}

}  // namespace luxes_with_appliances_test
}  // namespace ispace::luxes
