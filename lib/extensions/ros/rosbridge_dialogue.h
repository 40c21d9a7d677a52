// SPDX-License-Identifier: GPL-3.0-or-later
// The protocol of rosbridge_suite, for roslib and its kin.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "extensions/ros/ros_dialogue.h"
#include "extensions/ros/transform_goals.h"

namespace ispace::ros {

/// The rosbridge protocol, version 2.1: JSON objects with `op`, and messages of topics also in CBOR
/// or as raw CDR within CBOR, as the subscriber chooses.
class RosbridgeDialogue final : public RosDialogue {
  public:
    RosbridgeDialogue(ServerState& state, RosFeed& feed, std::string peer = {})
        : RosDialogue(state, feed, std::move(peer)), transforms_(feed) {}

    void receive(std::string_view message, bool is_text) override;
    void stepped() override;

  private:
    using Json = nlohmann::json;
    /// In ascending order: of several requests the last one counts, as in rosbridge_suite.
    enum class Form { Json, Png, Cbor, Raw };
    /// The requests of a client for one topic, which share its messages: by the name that they use
    /// for it, perhaps without its slash, and by their ids.
    struct Wish {
        struct One {
            std::chrono::nanoseconds interval{};
            std::size_t depth = 0;  ///< 0: that of the topic
            Form form = Form::Json;
            std::size_t fragment = 0;  ///< bytes of its parts; 0: whole messages
        };
        using Ids = std::map<std::string, One>;
        std::map<std::string, Ids> names = {};

        [[nodiscard]] std::size_t count() const;
    };
    static Form formOf(const Wish::Ids& ids);
    /// A goal of the action navigate_to_pose.
    struct Goal {
        std::string id, action;
        std::int64_t number = 0;
        SimTime started{}, told{};  ///< told: its newest feedback
        bool is_watched = false;    ///< the client wants feedback
    };
    struct Op;

    web::WebMessage write(std::uint32_t key, const RosFeed::Entry& topic,
                          const RosMessage& message) override;
    static web::WebMessage publication(const std::string& name, Form form,
                                       const RosMessage& message);
    std::vector<web::WebMessage> publications(const std::string& name, const Wish::Ids& ids,
                                              const RosMessage& message);
    void report(Level level, const std::string& text) override { report(level, text, ""); }
    void report(Level level, const std::string& text, const std::string& id);
    void topicsChanged() override;

    void subscribeTo(const Json& request);
    void unsubscribeFrom(const Json& request);
    void advertise(const Json& request);
    void unadvertise(const Json& request);
    void publish(const Json& request);
    void callService(const Json& request);
    void setParameter(const Json& arguments, const std::string& id, const std::string& service);
    void sendGoal(const Json& request);
    void cancelGoal(const Json& request);
    bool cancelAll(const std::string& service);
    void endGoal(const std::string& robot, std::int64_t number, RosGoalEnd end,
                 const std::string& why);
    void answerGoal(const Goal& goal, int status, const std::string& error);
    void notifyProgress(const std::string& robot, Goal& goal);
    void beginTransforms(const std::string& id, const std::string& action, const Json& arguments);
    bool publishTransforms(const std::string& topic, const Json& message);
    void notifyTransforms(const std::string& id, const std::string& feedback);
    std::string republish(const Json& arguments);
    void ignore(const Json& /*request*/) {}
    void apply(const std::string& topic, const Wish& wish, bool is_new = true);
    void answer(const std::string& id, std::string_view service, bool is_done,
                std::string_view values);

    std::map<std::string, Wish> wishes_;         // by topic, which may not exist yet
    std::uint32_t newest_ = 0;                   // number of the last topic seen
    std::map<std::string, RosType> advertised_;  // types by topic
    std::map<std::string, Goal> goals_;          // by robot
    std::int64_t next_goal_ = 1;
    TransformGoals transforms_;
    /// Names of the action of goals in transforms_, by id; "" for goals by topics, as of ROS 1.
    std::map<std::string, std::string> transform_actions_;
    /// Requests of the service republish_tfs, by the topics that answer them, oldest first.
    std::vector<std::pair<std::string, Json>> republished_;
    std::int64_t next_republished_ = 0, next_fragmented_ = 0;
};

}  // namespace ispace::ros
