// SPDX-License-Identifier: GPL-3.0-or-later
// A client of topics in a small run, for the fuzzers of their protocols. Files of one input are
// messages: text if they begin with `t`, binary otherwise, without that byte.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "extensions/ros/ros_dialogue.h"
#include "fuzz.h"
#include "served_room.h"

namespace ispace::fuzz {

/// Hands messages to a dialogue, takes a step after each.
/// \param check called with each message that the server sends
template <typename Dialogue, typename... Arguments, typename Check>
void talkAboutTopics(std::string_view bytes, Check check, const Arguments&... arguments) {
    ServedRoom room;
    ros::RosFeed feed(room.state(), {.map =
                                         [](const Scene&) {
                                             return RosGrid{{}, 1, 1, {0}};
                                         },
                                     .room = [](const Scene&) { return std::string("glTF"); }});
    Dialogue dialogue(room.state(), feed, arguments...);
    const auto collect = [&] {
        for (auto message = dialogue.next(); message; message = dialogue.next())
            check(message->head + (message->body ? *message->body : "") + message->tail,
                  message->is_text);
    };
    const auto step = [&] {
        room.simulation().allow(1);
        room.run([&] {
            feed.stepped();
            dialogue.stepped();
        });
        room.state().collect();
        if (dialogue.waiting()) dialogue.proceed();
        collect();
    };
    for (const std::string_view message : filesOf(bytes)) {
        if (message.empty()) continue;
        dialogue.receive(message.substr(1), message.front() == 't');
        step();
    }
    constexpr int kSteps = 20;  // the watchdog acts
    for (int i = 0; i < kSteps; ++i) step();
    dialogue.finish();
    collect();
}

}  // namespace ispace::fuzz
