// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "extensions/locks/locks_test.h"
#include "extensions/mqtt/mqtt_topics.h"
#include "scene/placement_schemas.h"

namespace ispace::locks {
namespace locks_with_mqtt_test {

TEST(LockChecks, AreLocksOfHomeAssistant) {
    testing::addLocksOnce();
    const Schema& door = *sceneSchemas().find("door");
    mqtt::MqttEntity thing{"d", "door", {}};
    for (const char* key : {"open", "locked", "forced"})
        thing.keys.push_back({key, std::string("i/d/") + key, door.find(key)});
    const std::vector<mqtt::MqttMessage> messages = mqtt::discoveryOf(thing, "i");
    ASSERT_EQ(messages.size(), 3U);
    EXPECT_TRUE(messages[0].topic.starts_with("homeassistant/cover/")) << messages[0].topic;
    EXPECT_TRUE(messages[1].topic.starts_with("homeassistant/lock/")) << messages[1].topic;
    for (const char* part :
         {R"("command_topic":"i/d/locked/set")", R"("payload_lock":"ON")", R"("state_locked":"ON")",
          R"("payload_unlock":"OFF")", R"("state_unlocked":"OFF")"})
        EXPECT_NE(messages[1].payload.find(part), std::string::npos) << messages[1].payload;
    EXPECT_TRUE(messages[2].topic.starts_with("homeassistant/binary_sensor/"));
    EXPECT_NE(messages[2].payload.find(R"("device_class":"tamper")"), std::string::npos);
    EXPECT_EQ(messages[2].payload.find("command_topic"), std::string::npos);
    EXPECT_EQ(mqtt::payloadOf("locked", "1", true, door.find("locked")), "ON");
}

}  // namespace locks_with_mqtt_test
}  // namespace ispace::locks
