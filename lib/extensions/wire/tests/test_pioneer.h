// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of the Pioneer protocol: a program that drives a Pioneer, without a network.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "extensions/wire/p2os_session.h"
#include "extensions/wire/tests/test_host.h"

namespace ispace::testing {

/// A client that builds packets byte by byte.
class Pioneer {
  public:
    explicit Pioneer(TestHost& host)
        : host_(&host), session_(host, "r1", [this] { return wall_; }) {}

    wire::P2osSession& session() { return session_; }
    /// Advances the wall clock.
    void wait(std::chrono::milliseconds time) { wall_ += time; }
    void send(const std::string& bytes) {
        session_.receive(bytes);
        collect();
    }
    void command(int id) { send(wire::p2osBytes(static_cast<std::uint8_t>(id))); }
    void command(int id, int value) {
        wire::P2osWriter out;
        out.u8(value < 0 ? 0x1b : 0x3b).u16(std::abs(value));
        send(out.packet(static_cast<std::uint8_t>(id)));
    }
    Pioneer& connect() {
        for (const int id : {0, 1, 2}) command(id);
        EXPECT_EQ(packets.size(), 3U);
        command(1, 1);
        packets.clear();
        return *this;
    }
    Pioneer& drive() {
        connect();
        command(4, 1);
        return *this;
    }
    void run(double seconds) {
        host_->run(session_, seconds);
        collect();
    }
    /// Returns the newest packet with this id.
    std::string last(std::uint8_t id) const {
        for (auto packet = packets.rbegin(); packet != packets.rend(); ++packet)
            if (packet->id == id) return packet->data;
        ADD_FAILURE() << "no packet " << int{id};
        return std::string(200, '\0');
    }
    [[nodiscard]] int field(std::size_t at, std::size_t bytes) const {
        return wire::p2osInteger(last(0x32), at, bytes);
    }
    [[nodiscard]] int x() const { return field(0, 2); }
    [[nodiscard]] int y() const { return field(2, 2); }
    [[nodiscard]] int heading() const { return field(4, 2); }
    [[nodiscard]] int left() const { return field(6, 2); }
    [[nodiscard]] int right() const { return field(8, 2); }
    [[nodiscard]] int stall() const { return field(11, 2) & 0xFFFF; }
    [[nodiscard]] int flags() const { return field(15, 2); }
    [[nodiscard]] int sonars() const { return field(18, 1); }
    [[nodiscard]] int sonar(std::size_t k) const { return field(20 + 3 * k, 2); }
    [[nodiscard]] int rotspeed() const { return field(last(0x32).size() - 8, 2); }

    std::vector<wire::P2osPacket> packets;

  private:
    void collect() {
        parser_.append(session_.take());
        while (auto packet = parser_.take()) packets.push_back(std::move(*packet));
    }

    TestHost* host_;
    std::chrono::steady_clock::time_point wall_{};
    wire::P2osSession session_;
    wire::P2osParser parser_;
};

}  // namespace ispace::testing
