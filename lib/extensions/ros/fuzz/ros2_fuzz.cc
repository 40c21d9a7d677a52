// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of nodes of ROS 2 to a running world: each file of an input begins with a letter for its
// topic, as listed below. Every answer of a service has the header of its request.
#include <array>
#include <chrono>
#include <memory>
#include <string>

#include "extensions/ros/ros_node.h"
#include "extensions/ros/tests/fake_participant.h"
#include "fuzz.h"
#include "served_room.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    ServedRoom room;
    ros::RosFeed feed(room.state(), {});
    auto made = std::make_unique<testing::FakeParticipant>();
    testing::FakeParticipant& dds = *made;
    ros::RosNode node(room.state(), feed, std::move(made));
    const auto step = [&] {
        room.simulation().allow(1);
        room.run([&] { node.stepped(); });
        room.state().collect();
        node.serve();
    };
    const auto send = [&](char letter, std::string_view message) {
        const std::string type = "geometry_msgs::msg::dds_::";
        constexpr std::array<const char*, 3> kServices{"reset", "pause", "resume"};
        if (letter == 't') {
            dds.end("rt/cmd_vel", type + "Twist_").arrived.push_back({std::string(message)});
        } else if (letter == 's') {
            dds.end("rt/r1/cmd_vel", type + "TwistStamped_")
                .arrived.push_back({std::string(message)});
        } else if (letter == 'p') {
            dds.end("rt/r1/initialpose").arrived.push_back({std::string(message)});
        } else if (letter == 'm') {
            dds.end("rq/simrun/set_parametersRequest")
                .arrived.push_back({std::string(message), ros::DdsRequest{{1}, 1}});
        } else if (letter == 'r') {
            for (auto& [number, end] : dds.ends) end.is_read = !end.is_read;
        } else {
            const std::string name = kServices.at(static_cast<unsigned char>(letter) % 3);
            dds.end("rq/" + name + "Request").arrived.push_back({std::string(message)});
            dds.is_changed = true;
            node.serve();
            for (const std::string& answer : dds.end("rr/" + name + "Reply").sent)
                require(answer.size() == 4 + 16 + 1, "an answer of another length");
            return;
        }
        dds.is_changed = true;
        node.serve();
    };
    for (const std::string_view message : filesOf(bytes)) {
        if (message.empty()) continue;
        // A scene that was reset has the same topics.
        send(message.front(), message.substr(1));
        step();
    }
    constexpr int kSteps = 20;  // the watchdog acts
    for (int i = 0; i < kSteps; ++i) step();
    node.end();
}
