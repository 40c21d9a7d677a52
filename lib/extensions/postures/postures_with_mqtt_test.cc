// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "extensions/mqtt/mqtt_topics.h"
#include "extensions/postures/postures_test.h"
#include "scene/placement_schemas.h"

namespace ispace::postures {
namespace postures_with_mqtt_test {

TEST(Postures, AreSensorsOfHomeAssistant) {
    testing::addPosturesOnce();
    const Schema& human = *sceneSchemas().find("human");
    mqtt::MqttEntity thing{"ann", "human", {}};
    for (const char* key : {"posture", "left_arm"})
        thing.keys.push_back({key, std::string("i/ann/") + key, human.find(key)});
    const std::vector<mqtt::MqttMessage> messages = mqtt::discoveryOf(thing, "i");
    ASSERT_EQ(messages.size(), 2U);
    EXPECT_TRUE(messages[0].topic.starts_with("homeassistant/sensor/")) << messages[0].topic;
    EXPECT_NE(messages[0].payload.find(R"("state_topic":"i/ann/posture")"), std::string::npos);
    EXPECT_EQ(messages[0].payload.find("command_topic"), std::string::npos);
    EXPECT_EQ(mqtt::payloadOf("posture", "fallen", true, human.find("posture")), "fallen");
}

}  // namespace postures_with_mqtt_test
}  // namespace ispace::postures
