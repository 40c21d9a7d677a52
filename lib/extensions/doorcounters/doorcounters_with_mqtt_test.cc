// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "extensions/doorcounters/doorcounters_test.h"
#include "extensions/mqtt/mqtt_topics.h"

namespace ispace::doorcounters {
namespace doorcounters_with_mqtt_test {

TEST(DoorCounter, HasStatisticsInHomeAssistant) {
    testing::addDoorCountersOnce();
    const mqtt::MqttEntity thing{
        "c",
        "doorcounter",
        {{"entered", "i/c/entered"}, {"left", "i/c/left"}, {"present", "i/c/present"}}};
    const std::vector<mqtt::MqttMessage> messages = mqtt::discoveryOf(thing, "i");
    ASSERT_EQ(messages.size(), 3U);
    const std::vector<std::string> classes = {"total_increasing", "total_increasing",
                                              "measurement"};
    for (std::size_t i = 0; i < messages.size(); ++i)
        EXPECT_NE(messages[i].payload.find("\"state_class\":\"" + classes[i] + '"'),
                  std::string::npos)
            << messages[i].payload;
}

}  // namespace doorcounters_with_mqtt_test
}  // namespace ispace::doorcounters
