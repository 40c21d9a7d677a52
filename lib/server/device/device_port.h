// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/server, since it includes Asio.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/device/wire_session.h"
#include "server/server.h"
#include "server/server_state.h"
#include "sim/simulation.h"

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

/// What sessions of device ports see of a server's run.
class DeviceHost : public WireHost {
  public:
    explicit DeviceHost(ServerState& state) : state_(&state) {}

    [[nodiscard]] World& world() override { return state_->simulation().world(); }
    [[nodiscard]] bool isReplay() const override { return state_->simulation().isReplay(); }
    [[nodiscard]] bool isPaused() const override { return state_->simulation().paused(); }
    Change change(std::span<const std::string> assignments) override;
    std::optional<std::int64_t> hold(std::string_view robot) override;
    [[nodiscard]] bool holds(std::string_view robot, std::int64_t hold) override;
    void release(std::string_view robot, std::int64_t hold) override;
    [[nodiscard]] std::chrono::nanoseconds clock() const override;
    void runInBackground(std::function<void()> work,
                         std::function<void(const std::exception_ptr& failure)> deliver) override {
        state_->runInBackground({std::move(work), std::move(deliver)});
    }

  private:
    /// A change that was asked for.
    struct Changing {
        std::vector<std::string> assignments;
        std::optional<Change> result = {};
        std::int64_t changes = 0;  // of the world, when it was made
    };

    ServerState* state_;
    std::shared_ptr<Changing> changing_;
    WallTime began_ = std::chrono::steady_clock::now();
};

/// A robot or sensor of the running world behind the port of a real device. It is part of a Server
/// and works in the same thread, within the same loop.
class DevicePort {
  public:
    /// Listens at once. \throws std::system_error naming the endpoint
    DevicePort(boost::asio::io_context& io, DeviceHost& host, const ServerLimits& limits,
               const WireProtocol& protocol, std::string id, const Endpoint& endpoint);

    /// "127.0.0.1:10940"
    [[nodiscard]] std::string address() const { return acceptor_.address(); }
    /// The world took a step, or was changed.
    void stepped();
    /// True if a client waits for its turn to change the world.
    [[nodiscard]] bool waitsToChange() const;
    /// Between steps.
    void serve(WallTime now);
    void end();
    void closeAll();
    /// True if there is a connection still.
    bool busy();

  private:
    void welcome(boost::asio::ip::tcp::socket socket);
    bool makeRoom();
    void sweep();

    DeviceHost* host_;
    std::chrono::nanoseconds roleless_, grace_;  // see ServerLimits
    std::vector<Network> allowed_;
    const WireProtocol* protocol_;
    std::string id_;
    Acceptor acceptor_;
    std::vector<std::shared_ptr<DeviceConnection>> connections_;  // in the order of their coming
};

}  // namespace ispace
