// SPDX-License-Identifier: GPL-3.0-or-later
// A port for topics over WebSockets, and the clients that may use it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "extensions/ros/ros_feed.h"
#include "extensions/web/web_dialogue.h"
#include "server/server_state.h"

namespace ispace::ros {

/// Protocols that carry topics of ROS over WebSockets.
enum class RosLanguage { Foxglove, Rosbridge };

/// True for programs that are no browsers, and for pages of this machine: those of a server on it,
/// or of a file, as the desktop viewers have.
bool isLocalOrigin(std::string_view origin);

/// Returns the token in the query of a request's target, with its escapes decoded: "x y" of
/// "/?token=x%20y". Empty without one.
std::optional<std::string> tokenOf(std::string_view target);

/// A port for clients of topics. Pages of other machines, and all clients of a port for other
/// machines, present the token of the run in the address: ws://127.0.0.1:8765/?token=x.
class RosSite final : public web::WebSite {
  public:
    /// \param title of the run; the feed outlives the site
    RosSite(ServerState& state, RosFeed& feed, RosLanguage language, std::string title,
            bool is_loopback);

    void settle(const std::string& host, std::uint16_t port) override;
    [[nodiscard]] bool isHost(std::string_view host) const override {
        return !is_loopback_ || origin_->isHost(host);
    }
    web::WebAdmission open(const web::WebRequest& request) override;
    void stepped() override { feed_->stepped(); }

  private:
    ServerState* state_;
    RosFeed* feed_;
    RosLanguage language_;
    std::string title_, session_;
    bool is_loopback_;
    std::optional<web::WebOrigin> origin_;
};

}  // namespace ispace::ros
