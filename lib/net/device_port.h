// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/net, since it includes Asio.
#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "net/acceptor.h"
#include "net/device_connection.h"
#include "net/server_state.h"
#include "wire/wire_session.h"

namespace ispace {

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
    void doAside(std::function<void()> work,
                 std::function<void(const std::exception_ptr& failure)> deliver) override {
        state_->doAside({std::move(work), std::move(deliver)});
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
