// SPDX-License-Identifier: GPL-3.0-or-later
// Connections of browsers and of other clients of WebSockets. Includes Asio.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <memory>
#include <optional>

#include "extensions/web/web_dialogue.h"
#include "server/server_state.h"

namespace ispace::web {

/// The transport of a browser, or of another client of a WebSite: HTTP requests for files, until
/// one upgrades it to a WebSocket with a WebDialogue.
///
/// Non-blocking. Pending handlers keep it alive until it is closed.
class WebConnection {
  public:
    virtual ~WebConnection() = default;

    /// As in WebDialogue.
    virtual void stepped() = 0;
    virtual void proceed() = 0;
    [[nodiscard]] virtual bool waiting() const = 0;
    [[nodiscard]] virtual bool waitsToChange() const = 0;
    [[nodiscard]] virtual bool wantsFrame() const = 0;
    [[nodiscard]] virtual bool expires() const = 0;
    /// Sends the newest frame if it is wanted and was not sent already.
    virtual void offerFrame() = 0;
    /// Time since which the peer has left a message unread for which the world may wait.
    [[nodiscard]] virtual std::optional<WallTime> awaitedSince() const = 0;
    /// Closes it if the peer has not read for too long.
    virtual void checkPatience(WallTime now) = 0;
    /// True once it is a WebSocket.
    [[nodiscard]] virtual bool isSocket() const = 0;
    /// Time of the last request of a WebSocket without a role; otherwise empty.
    [[nodiscard]] virtual std::optional<WallTime> idleSince() const = 0;
    /// Sends the reason and closes.
    virtual void dismiss() = 0;
    /// Ends pending requests, sends pending output and closes.
    virtual void end() = 0;
    virtual void close() = 0;
    [[nodiscard]] virtual bool closed() const = 0;
};

/// Serves a client on this socket. The site outlives the connection.
std::shared_ptr<WebConnection> serveBrowser(boost::asio::ip::tcp::socket socket, WebSite& site,
                                            const ServerLimits& limits);

}  // namespace ispace::web
