// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "extensions/curtains/curtains_test.h"
#include "extensions/mqtt/mqtt_topics.h"
#include "scene/placement_schemas.h"

namespace ispace::curtains {
namespace curtains_with_mqtt_test {

TEST(Curtain, IsACoverOfHomeAssistant) {
    testing::addCurtainsOnce();
    const Schema& schema = *sceneSchemas().find("curtain");
    const mqtt::MqttEntity thing{"c", "curtain", {{"drawn", "i/c/drawn", schema.find("drawn")}}};
    const std::vector<mqtt::MqttMessage> messages = mqtt::discoveryOf(thing, "i");
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_TRUE(messages[0].topic.starts_with("homeassistant/cover/")) << messages[0].topic;
    for (const char* part : {R"("device_class":"curtain")", R"("position_topic":"i/c/drawn")",
                             R"("set_position_topic":"i/c/drawn/set")", R"("payload_open":"0")",
                             R"("payload_close":"1")"})
        EXPECT_NE(messages[0].payload.find(part), std::string::npos) << messages[0].payload;
    EXPECT_EQ(messages[0].payload.find("state_topic"), std::string::npos);
}

}  // namespace curtains_with_mqtt_test
}  // namespace ispace::curtains
