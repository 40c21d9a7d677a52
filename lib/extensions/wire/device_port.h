// SPDX-License-Identifier: GPL-3.0-or-later
// TCP for the protocols of devices: connections, their patience, and the world of a robot or
// sensor. Includes Asio.
//
// As with the devices, one client (or WireProtocol::clients) is served; others are disconnected
// silently. A client that is not engaged and has made no request for a second yields to a newcomer.
// A device's protocol carries no token: addresses decide (ServerLimits::allowed).
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

#include "extensions/wire/wire_session.h"
#include "server/acceptor.h"
#include "server/server.h"
#include "server/server_state.h"
#include "sim/simulation.h"

namespace ispace::wire {

/// The transport of a WireSession. Non-blocking; pending handlers keep it alive until it is closed.
///
/// Stops reading from a client that leaves much output unread, and closes the connection after ten
/// seconds without progress or if the peer's machine is gone.
class DeviceConnection : public std::enable_shared_from_this<DeviceConnection> {
  public:
    DeviceConnection(boost::asio::ip::tcp::socket socket, std::unique_ptr<WireSession> session);

    void serve() { pump(); }
    /// Call after each step or change of the world.
    void stepped();
    /// True if the client's request changes the world and must wait for its turn.
    [[nodiscard]] bool waitsToChange() const { return session_ && session_->waitsToChange(); }
    /// Retries the waiting request.
    void proceed();
    /// Closes the connection if the client has stopped reading.
    void checkPatience(WallTime now);
    /// Ends the session, sends pending output and closes.
    void end();
    void close();
    [[nodiscard]] bool closed() const { return !socket_.is_open(); }
    /// False once the session has ended: only pending output is still sent.
    [[nodiscard]] bool serving() const { return session_ != nullptr; }
    /// Time of the last request if the session is not engaged, else empty. Bytes that the device
    /// does not understand are not requests.
    [[nodiscard]] std::optional<WallTime> idleSince() const {
        return session_ && !session_->isEngaged() ? std::optional(heard_) : std::nullopt;
    }
    /// True once the client has closed its sending side; it may still read.
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
    std::unique_ptr<WireSession> session_;  // null: the connection is about to end
    std::string out_;
    std::size_t sent_ = 0;      // bytes of out_
    WallTime heard_, stuck_{};  // heard_: last request, initially the start of the connection
    bool ended_ = false;
    bool reading_ = false, writing_ = false;  // handlers pending
    bool lingering_ = false;
};

/// The view of a server's run for the sessions of a device port, in the world of its robot or
/// sensor.
class DeviceHost : public WireHost {
  public:
    /// \param id of the robot or sensor in the world of that state \param pictures of all ports
    DeviceHost(ServerState& state, std::string id, PictureFiles& pictures)
        : state_(&state), id_(std::move(id)), pictures_(&pictures) {}

    [[nodiscard]] World& world() override { return state().simulation().world(); }
    [[nodiscard]] std::int64_t changes() override;
    [[nodiscard]] bool isReplay() const override { return state_->simulation().isReplay(); }
    bool mayDrive(std::string_view robot) override;
    [[nodiscard]] bool isPaused() const override;
    [[nodiscard]] PictureFiles& pictures() override { return *pictures_; }
    Change change(std::span<const std::string> assignments) override;
    std::optional<std::int64_t> hold(std::string_view robot) override;
    [[nodiscard]] bool holds(std::string_view robot, std::int64_t hold) override;
    void release(std::string_view robot, std::int64_t hold) override;
    [[nodiscard]] std::chrono::nanoseconds clock() const override;
    void runInBackground(std::function<void()> work,
                         std::function<void(const std::exception_ptr& failure)> deliver) override {
        state().runInBackground({std::move(work), std::move(deliver)});
    }

  private:
    /// A requested change.
    struct Changing {
        std::vector<std::string> assignments;
        std::optional<Change> result = {};
        std::int64_t changes = 0;  // change count of the world after it
    };

    [[nodiscard]] ServerState& state();

    ServerState* state_;
    std::string id_;
    PictureFiles* pictures_;
    std::shared_ptr<Changing> changing_;
    WallTime began_ = std::chrono::steady_clock::now();
};

/// Serves a robot or sensor of the running world through the protocol of a real device. Belongs to
/// a Server and runs in its thread and event loop.
class DevicePort {
  public:
    /// Starts listening. \throws std::system_error naming the endpoint
    DevicePort(boost::asio::io_context& io, DeviceHost& host, const ServerLimits& limits,
               const WireProtocol& protocol, std::string id, const Endpoint& endpoint);

    /// "127.0.0.1:10940"
    [[nodiscard]] std::string address() const { return acceptor_.address(); }
    /// Call after each step or change of the world.
    void stepped();
    /// True if a client awaits its turn to change the world.
    [[nodiscard]] bool waitsToChange() const;
    /// Call between steps.
    void serve(WallTime now);
    void end();
    void closeAll();
    /// True while connections remain.
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
    std::vector<std::shared_ptr<DeviceConnection>> connections_;  // in order of arrival
};

}  // namespace ispace::wire
