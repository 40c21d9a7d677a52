// SPDX-License-Identifier: GPL-3.0-or-later
// Lifts as topics: the storey at which one stands, and the share by which its doors are open.
#include <algorithm>

#include "extensions/ros/ros_source.h"

namespace ispace::ros {

namespace {

class LiftTopics final : public RosSource {
  public:
    std::vector<RosSourceTopic> topics(const RosRun& run) override {
        std::vector<RosSourceTopic> out;
        for (const LiftState& lift : run.worlds.lifts())
            for (const RoomState& state : statesOf(lift)) {
                const std::string topic = '/' + rosName(lift.id) + '/' + state.key;
                const bool is_flag = state.key == "open";
                out.push_back({.topic = topic,
                               .type = is_flag ? RosType::Bool : RosType::String,
                               .about = lift.id});
                if (!is_flag)
                    out.push_back({.topic = topic + "/set",
                                   .type = RosType::String,
                                   .about = lift.id,
                                   .is_input = true});
            }
        return out;
    }

    std::string message(const RosSourceTopic& topic, const RosRun& run) override {
        const std::string key = topic.topic.substr(topic.topic.rfind('/') + 1);
        for (const LiftState& lift : run.worlds.lifts())
            if (lift.id == topic.about)
                for (const RoomState& state : statesOf(lift))
                    if (state.key == key) return stateMessage(topic.type, state.value);
        return "";
    }

    std::string request(const RosSourceTopic& topic, std::string_view message) override {
        return "CALL " + topic.about + ' ' + stateValue(topic.type, message);
    }
};

}  // namespace

std::shared_ptr<RosSource> liftTopics() { return std::make_shared<LiftTopics>(); }

}  // namespace ispace::ros
