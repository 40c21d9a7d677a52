// SPDX-License-Identifier: GPL-3.0-or-later
// A small run for the fuzzers of devices' languages.
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "extensions/wire/wire_session.h"
#include "fuzz_room.h"

namespace ispace::fuzz {

/// A room in which each client may hold each device.
class RoomHost : public wire::WireHost {
  public:
    /// \param layout records
    explicit RoomHost(const std::string& layout) : room_(layout) {}

    [[nodiscard]] World& world() override { return room_.world(); }
    [[nodiscard]] bool isReplay() const override { return false; }
    [[nodiscard]] bool isPaused() const override { return true; }
    Change change(std::span<const std::string> /*assignments*/) override { return Change::Refused; }
    std::optional<std::int64_t> hold(std::string_view /*robot*/) override { return 1; }
    [[nodiscard]] bool holds(std::string_view /*robot*/, std::int64_t /*hold*/) override {
        return true;
    }
    void release(std::string_view /*robot*/, std::int64_t /*hold*/) override {}
    [[nodiscard]] std::chrono::nanoseconds clock() const override { return room_.world().time(); }

  private:
    FuzzRoom room_;
};

/// Returns the answer of a session to bytes in pieces of this size, read meanwhile.
inline std::string answered(wire::WireSession& session, std::string_view bytes, std::size_t piece) {
    std::string out;
    while (!bytes.empty() && !session.closing()) {
        session.receive(bytes.substr(0, piece));
        bytes.remove_prefix(std::min(piece, bytes.size()));
        out += session.take();
    }
    return out;
}

}  // namespace ispace::fuzz
