// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of a broker of MQTT: lines TOPIC PAYLOAD, for the actuators of a small room. A line `-`
// takes a step, one `+` connects again. All that is published has a topic, and no command stops the
// bridge.
#include <algorithm>
#include <memory>
#include <string_view>

#include "extensions/mqtt/mqtt_bridge.h"
#include "extensions/mqtt/tests/memory_broker.h"
#include "fuzz.h"
#include "served_room.h"
#include "server/session.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    ServedRoom room;
    Session world(room.state());
    for (const char* request : {"WORLD", "ADD lamp id=lp at=1,1", "ADD switch id=b1 at=1,0",
                                "ADD mat id=s1 at=1,1 size=1,1"}) {
        while (world.waiting()) world.proceed();
        world.request(request);
    }
    while (world.waiting()) world.proceed();
    testing::MemoryBroker broker;
    mqtt::MqttBridge bridge(room.state(), std::make_unique<testing::MemoryClient>(broker),
                            "ispace");
    constexpr int kMaxLines = 20;
    for (int i = 0; i < kMaxLines && !bytes.empty(); ++i) {
        const std::string_view line = bytes.substr(0, bytes.find('\n'));
        bytes.remove_prefix(std::min(bytes.size(), line.size() + 1));
        if (line == "-") {
            room.simulation().allow(1);
            room.run([&] { bridge.stepped(); });
        } else if (line == "+") {
            ++broker.connections;
        } else {
            const std::size_t blank = std::min(line.find(' '), line.size());
            broker.incoming.push_back({std::string(line.substr(0, blank)),
                                       std::string(line.substr(std::min(blank + 1, line.size()))),
                                       false});
        }
        bridge.serve(false);
    }
    bridge.end();
    require(broker.is_closed, "the bridge does not disconnect");
    require(broker.last("ispace/status") == "offline", "the last word is not offline");
    for (const mqtt::MqttMessage& message : broker.published)
        require(message.topic.find_first_of("+#") == std::string::npos, "a topic with a wildcard");
}
