// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sim/simulation.h"

namespace ispace {

/// A range of addresses, as in 192.168.1.0/24 or fd00::/8.
struct Network {
    std::array<std::uint8_t, 16> address{};  ///< IPv4 as ::ffff:a.b.c.d
    int bits = 128;                          ///< of it that count
};

/// A numeric address, alone or with the number of bits that count. \throws UsageError
Network parseNetwork(const std::string& text);

/// True if one of them holds this numeric address, or if it is one of this machine.
bool isAllowed(std::span<const Network> allowed, const std::string& address);

/// The token in a file: its first line, of 1 to 256 characters without blanks.
/// \throws FormatError, std::system_error
std::string readToken(const std::string& file);

/// True if others than its owner may read or replace what the file holds.
bool isOpenToOthers(const std::string& file);

/// Takes as long for any `given` of a length.
bool isSameSecret(std::string_view given, std::string_view secret);

/// When clients that hold no place by what they do have to go, for all listeners: those without a
/// role, and programs that let a device send nothing. See ServerLimits::roleless.
///
/// Of connections with `std::optional<WallTime> idleSince() const`, nothing for those that are not
/// idle, the one that has been idle longest, if that is so since then; else the end.
template <typename Connections>
auto longestIdle(const Connections& connections, WallTime since) {
    const auto time = [](const auto& connection) {
        return connection->idleSince().value_or(WallTime::max());
    };
    const auto found =
        std::min_element(connections.begin(), connections.end(),
                         [&](const auto& a, const auto& b) { return time(a) < time(b); });
    return found != connections.end() && time(*found) <= since ? found : connections.end();
}

}  // namespace ispace
