// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/server, since it includes Asio.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <memory>
#include <optional>

#include "server/server_state.h"
#include "server/web/web_files.h"
#include "server/web/web_frames.h"

namespace ispace {

/// State shared by the connections of one web server.
struct WebShare {
    ServerState* state;
    WebFrames* frames;
    const WebOrigin* origin;
};

/// A browser's connection: HTTP requests for the page's files, until one upgrades it to a
/// WebSocket. Each message there holds one or more requests of the Simulator TCP Protocol, answered
/// by a Session, and one addition: FRAME is answered by the next frame, a JSON object, as soon as
/// it is newer than the last one; a new scene is sent before it.
///
/// Non-blocking. Memory per connection is bounded: one message each way, replies up to a limit, one
/// frame. Pending handlers keep it alive until it is closed.
class WebConnection {
  public:
    virtual ~WebConnection() = default;

    /// As in Session.
    virtual void stepped() = 0;
    virtual void proceed() = 0;
    [[nodiscard]] virtual bool waiting() const = 0;
    [[nodiscard]] virtual bool waitsToChange() const = 0;
    /// True if a FRAME request is pending.
    [[nodiscard]] virtual bool wantsFrame() const = 0;
    /// Sends the newest frame unless it was sent already.
    virtual void offerFrame() = 0;
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

/// Serves a browser on this socket.
std::shared_ptr<WebConnection> serveBrowser(boost::asio::ip::tcp::socket socket,
                                            const WebShare& share);

}  // namespace ispace
