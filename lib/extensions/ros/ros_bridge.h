// SPDX-License-Identifier: GPL-3.0-or-later
// The topics of ROS of a run: for viewers over WebSockets, nodes over DDS, and a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <optional>
#include <string>

#include "base/file.h"
#include "extensions/ros/ros_feed.h"
#include "extensions/ros/ros_log.h"
#include "extensions/ros/ros_node.h"
#include "extensions/ros/ros_scenery.h"
#include "extensions/ros/ros_site.h"
#include "extensions/web/web_server.h"
#include "server/bridge.h"

namespace ispace::ros {

/// Carries the running world as topics of ROS 2 to all their clients, which share each message.
/// Open ports and files before Server::run().
class RosBridge final : public Bridge {
  public:
    /// \throws UsageError if the world has no robot RosScenery::robot
    RosBridge(const BridgeHost& host, RosScenery scenery);

    /// Serves the topics at a port. One for other machines requires ServerLimits::token.
    /// \param title of the run \returns "ws://127.0.0.1:8765"
    /// \throws std::system_error naming the endpoint
    std::string open(RosLanguage language, const Endpoint& endpoint, const std::string& title);
    /// Takes part in a domain of DDS as a node of ROS 2, for this machine and
    /// ServerLimits::allowed. Call at most once. \throws FormatError if the module is missing,
    /// std::runtime_error
    void join(std::uint32_t domain);
    /// Returns the number of topics that nodes of ROS 2 do not see, as there are too many.
    [[nodiscard]] std::size_t nodeTopicsLeftOut() const { return node_ ? node_->leftOut() : 0; }
    /// Writes the topics to an MCAP file, complete when Server::run() returns. Call at most once.
    void log(ByteSink write) { log_.emplace(feed_, std::move(write)); }
    /// Returns the number of topics that the MCAP file has no channel for. \pre log()
    [[nodiscard]] std::size_t topicsLeftOut() const { return log_.value().leftOut(); }
    /// Returns the text of `metadata.yaml` for that file, by its name in a folder. \pre log()
    [[nodiscard]] std::string bagMetadata(const std::string& file) const {
        return log_.value().metadata(file);
    }

    void stepped() override;
    void serve(bool has_made) override;
    [[nodiscard]] bool waitsToChange() const override;
    [[nodiscard]] std::optional<WallTime> awaitedSince(WallTime earliest) const override;
    [[nodiscard]] std::optional<WallTime> nextTurn() const override;
    [[nodiscard]] bool keepsLastStep() const override { return log_.has_value(); }
    void lastStepped() override { log_.value().stepped(); }
    void finish() override { log_.value().finish(); }
    void end() override;
    [[nodiscard]] bool busy() override;
    void closeAll() override;

  private:
    BridgeHost host_;
    RosFeed feed_;  // of all below
    std::optional<RosNode> node_;
    std::optional<RosLog> log_;
    std::list<web::WebServer> webs_;
};

}  // namespace ispace::ros
