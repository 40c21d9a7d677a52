// SPDX-License-Identifier: GPL-3.0-or-later
// Foxglove's viewers, and programs that speak as these.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "extensions/ros/ros_dialogue.h"

namespace ispace::ros {

/// Bytes at the beginning of a server's binary messages.
enum class FoxgloveOpcode : std::uint8_t { Message = 1, Time = 2, Response = 3, Asset = 4 };

/// The Foxglove WebSocket protocol: subprotocols foxglove.sdk.v1 and foxglove.websocket.v1.
///
/// Text messages are JSON objects with `op`. Binary messages begin with an opcode; their numbers
/// are little-endian.
class FoxgloveDialogue final : public RosDialogue {
  public:
    /// \param title name of the server \param session_id differs from run to run
    FoxgloveDialogue(ServerState& state, RosFeed& feed, const std::string& title,
                     const std::string& session_id, std::string peer = {});

    void receive(std::string_view message, bool is_text) override;
    void stepped() override;
    std::optional<web::WebMessage> next() override;

  private:
    using Json = nlohmann::json;
    /// A topic to which the client may publish. Viewers advertise more than they use, so the first
    /// message to a topic that is not read draws a warning.
    struct ClientChannel {
        std::string topic;
        std::optional<RosType> type;  ///< empty if messages are not read
        bool is_json = false;
    };
    struct Op;
    using Topics = std::set<std::string>;
    /// What the run writes and reads.
    struct Graph {
        Topics written, read;
        [[nodiscard]] bool has(const std::string& topic) const {
            return written.contains(topic) || read.contains(topic);
        }
    };

    web::WebMessage write(std::uint32_t key, const RosFeed::Entry& topic,
                          const RosMessage& message) override;
    void report(Level level, const std::string& text) override;
    void topicsChanged() override {
        advertise();
        sendGraph(false);
    }

    void greet(const std::string& title, const std::string& session_id);
    void advertise();
    void advertiseServices();
    void obeyText(std::string_view text);
    void subscribeAll(const Json& request);
    void unsubscribeAll(const Json& request);
    void addChannels(const Json& request);
    void removeChannels(const Json& request);
    void getParameters(const Json& request);
    void setParameters(const Json& request);
    void watchParameters(const Json& request);
    void unwatchParameters(const Json& request);
    void fetchAsset(const Json& request);
    void watchGraph(const Json& request);
    void unwatchGraph(const Json& request);
    /// Sends what has changed of the graph since the client was told.
    void sendGraph(bool with_services);
    void obeyMessage(std::string_view payload);
    void callService(std::string_view payload);
    void sendParameters(const std::set<std::string>& names, const std::string& id);

    std::set<std::uint32_t> advertised_;
    std::uint32_t newest_ = 0;  // number of a topic that was advertised or is an input
    std::map<std::uint32_t, ClientChannel> channels_;
    std::set<std::string> watched_;    // parameters
    std::optional<Graph> told_graph_;  // of clients that watch it
    bool was_paused_ = false;
    std::int64_t seen_changes_ = 0;
    std::int64_t time_period_ = -1;
    bool is_time_due_ = false;
    int fetches_ = 0;  // assets under way
    // Guards deliveries that outlive the dialogue.
    std::shared_ptr<FoxgloveDialogue*> self_ = std::make_shared<FoxgloveDialogue*>(this);
};

}  // namespace ispace::ros
