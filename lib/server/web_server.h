// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/server, since it includes Asio.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <string>
#include <vector>

#include "server/server.h"
#include "server/web/web_connection.h"

namespace ispace {

/// The page that shows a running world, and the connections of its browsers. It is part of a Server
/// and works in the same thread, within the same loop.
class WebServer {
  public:
    /// Listens at once. \throws std::system_error naming the endpoint
    WebServer(boost::asio::io_context& io, ServerState& state, const Endpoint& endpoint,
              std::string title);

    /// "http://127.0.0.1:40123/"
    [[nodiscard]] std::string url() const { return "http://" + acceptor_.address() + "/"; }
    /// The world took a step.
    void stepped();
    /// Between steps: answers STEPs that are done, and hands out frames.
    void serve();
    /// True if a client waits for its turn to change the world.
    [[nodiscard]] bool waitsToChange() const;
    /// Says goodbye to all.
    void end();
    void closeAll();
    /// True if there is a connection still.
    bool busy();

  private:
    void welcome(boost::asio::ip::tcp::socket socket);
    void sweep();

    WebFrames frames_;
    Acceptor acceptor_;
    WebOrigin origin_;
    WebShare share_;
    boost::asio::steady_timer alarm_;  // of the next frame
    WallTime alarm_time_{};
    std::vector<std::shared_ptr<WebConnection>> connections_;  // in the order of their coming
};

}  // namespace ispace
