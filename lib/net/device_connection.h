// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/net, since it includes Asio.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <optional>
#include <string>

#include "sim/simulation.h"
#include "wire/wire_session.h"

namespace ispace {

/// The transport of a WireSession. Nothing blocks; handlers keep it alive until it is closed.
///
/// A client that leaves much unread is not read from, and one that takes nothing of it for ten
/// seconds is closed, as is one whose machine is gone.
class DeviceConnection : public std::enable_shared_from_this<DeviceConnection> {
  public:
    DeviceConnection(boost::asio::ip::tcp::socket socket, std::unique_ptr<WireSession> session);

    void serve() { pump(); }
    /// The world took a step, or was changed.
    void stepped();
    /// True if what its client asked for changes the world and has to wait for that.
    [[nodiscard]] bool waitsToChange() const { return session_ && session_->waitsToChange(); }
    /// Tries again what has to wait.
    void proceed();
    /// Closes it if its client takes nothing any more.
    void checkPatience(WallTime now);
    /// Ends the session, sends what is pending and closes.
    void end();
    void close();
    [[nodiscard]] bool closed() const { return !socket_.is_open(); }
    /// False once its session has ended: only what is pending is still sent.
    [[nodiscard]] bool serving() const { return session_ != nullptr; }
    /// Since when its client has asked nothing of a device that does nothing for it; nothing if
    /// that is not so. Bytes that the device does not understand are no request.
    [[nodiscard]] std::optional<WallTime> idleSince() const {
        return session_ && !session_->isEngaged() ? std::optional(heard_) : std::nullopt;
    }
    /// True once its client sends no more, though it may read.
    [[nodiscard]] bool ended() const { return ended_; }

  private:
    [[nodiscard]] std::size_t unsent() const { return out_.size() - sent_; }
    void pump();
    void collect();
    void flush();
    void listen();
    void receive();
    void linger();
    void discard();

    boost::asio::ip::tcp::socket socket_;
    boost::asio::steady_timer timer_;       // of lingering
    std::unique_ptr<WireSession> session_;  // none: the connection is about to end
    std::string out_;
    std::size_t sent_ = 0;      // of out_
    WallTime heard_, stuck_{};  // heard_: of its last request, or its beginning
    bool ended_ = false;
    bool reading_ = false, writing_ = false;  // handlers on their way
    bool lingering_ = false;
};

}  // namespace ispace
