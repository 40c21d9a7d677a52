// SPDX-License-Identifier: GPL-3.0-or-later
// A port for WebSockets and the files of a page: at most 64 connections, since a browser uses some
// six for files and one for each robot that it drives. Includes Asio.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "extensions/web/web_connection.h"
#include "extensions/web/web_dialogue.h"
#include "server/acceptor.h"
#include "server/bridge.h"
#include "server/server.h"

namespace ispace::web {

/// Serves a site to browsers and other clients of WebSockets. Belongs to a Server and runs in its
/// thread and event loop.
class WebServer final : public Bridge {
  public:
    /// Starts listening. \throws std::system_error naming the endpoint
    WebServer(boost::asio::io_context& io, const Endpoint& endpoint, const ServerLimits& limits,
              std::unique_ptr<WebSite> site);

    /// "127.0.0.1:40123"
    [[nodiscard]] std::string address() const { return acceptor_.address(); }
    void stepped() override;
    /// Answers finished STEPs and sends frames.
    void serve(bool has_made) override;
    [[nodiscard]] std::optional<WallTime> awaitedSince(WallTime earliest) const override;
    [[nodiscard]] bool waitsToChange() const override;
    /// Sends a closing message to all browsers.
    void end() override;
    void closeAll() override;
    [[nodiscard]] bool busy() override;

  private:
    void welcome(boost::asio::ip::tcp::socket socket);
    void sweep();

    ServerLimits limits_;
    std::unique_ptr<WebSite> site_;
    Acceptor acceptor_;
    boost::asio::steady_timer alarm_;  // wakes for the next frame
    WallTime alarm_time_{};
    std::vector<std::shared_ptr<WebConnection>> connections_;  // in order of arrival
};

}  // namespace ispace::web
