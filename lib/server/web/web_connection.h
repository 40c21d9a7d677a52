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

/// What the connections of one web server share.
struct WebShare {
    ServerState* state;
    WebFrames* frames;
    const WebOrigin* origin;
};

/// A browser's connection: requests of HTTP for the page's files, until one of them makes it a
/// WebSocket. There each message is a request of the Simulator TCP Protocol (or several lines),
/// answered by a Session as there, with one more: FRAME is answered by the next frame, a JSON
/// object, as soon as it is newer than the last one; a new scene comes before it.
///
/// Nothing blocks, and what one connection takes of memory is bounded: one message each way,
/// replies up to a limit, one frame. Handlers keep it alive until it is closed.
class WebConnection {
  public:
    virtual ~WebConnection() = default;

    /// Like those of Session.
    virtual void stepped() = 0;
    virtual void proceed() = 0;
    [[nodiscard]] virtual bool waiting() const = 0;
    [[nodiscard]] virtual bool waitsToChange() const = 0;
    /// True if it is to get the next frame.
    [[nodiscard]] virtual bool wantsFrame() const = 0;
    /// Sends it the newest frame, if it has not got that.
    virtual void offerFrame() = 0;
    /// Closes it if the other side has not read for too long.
    virtual void checkPatience(WallTime now) = 0;
    /// True once it is a WebSocket.
    [[nodiscard]] virtual bool isSocket() const = 0;
    /// Of a WebSocket without a role: since when nothing has been asked; else nothing.
    [[nodiscard]] virtual std::optional<WallTime> idleSince() const = 0;
    /// Says why, and closes.
    virtual void dismiss() = 0;
    /// Ends what is under way, sends what is pending and closes.
    virtual void end() = 0;
    virtual void close() = 0;
    [[nodiscard]] virtual bool closed() const = 0;
};

/// Serves a browser from now on.
std::shared_ptr<WebConnection> serveBrowser(boost::asio::ip::tcp::socket socket,
                                            const WebShare& share);

}  // namespace ispace
