// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "extensions/appliances/appliance.h"
#include "extensions/thermometers/thermometers_test.h"
#include "scene/placement_schemas.h"
#include "sense/selection.h"
#include "support/test_layout.h"

namespace ispace::thermometers {
namespace thermometers_with_appliances_test {

// Before the schemas are asked for.
const bool kAppliancesAdded = [] {
    addSceneSchemas(appliances::applianceSchemas());
    appliances::addAppliances();
    return true;
}();

TEST(Thermometer, FeelsTheHeatOfAnAppliance) {
    ASSERT_TRUE(kAppliancesAdded);
    const auto power = [](const std::string& state) {
        const Scene scene = testing::scene(
            "ispace size=10,8\nzone id=z at=0,0 size=4,4\ncube at=0,1 size=1,1,0.9\n",
            "appliance id=k kind=tv at=0,1 heat=50% state=" + state +
                "\nthermometer id=t at=1,0,1\n");
        const Sensor thermometer = sensorsOf<Thermometer>(scene).front();
        return thermometer.as<Thermometer>().heat.power;
    };
    EXPECT_EQ(power("off"), 0);
    EXPECT_EQ(power("standby"), 0.2);
    EXPECT_EQ(power("start"), 45);
    EXPECT_EQ(power("hold"), 34);
}

}  // namespace thermometers_with_appliances_test
}  // namespace ispace::thermometers
