// SPDX-License-Identifier: GPL-3.0-or-later
// Addresses and the token of a server. Names are never resolved: an address is numeric or
// "localhost", so that no answer of a name server decides over access. IPv4 is compared as
// ::ffff:a.b.c.d (RFC 4291, 2.5.5.2), prefixes as in RFC 4632. Pure functions, but for those that
// read the file of the token.
//
//     const Network lab = parseNetwork("192.168.1.0/24");
//     const bool is_known = isAllowed({&lab, 1}, "192.168.1.20");  // true
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

/// A TCP endpoint; port 0 lets the system choose.
struct Endpoint {
    std::string address = "127.0.0.1";
    std::uint16_t port = 0;
    bool is_loopback = true;  ///< other machines cannot connect
};
/// Parses ADDR:PORT with a numeric address (127.0.0.1, [::1], 0.0.0.0) or localhost, which is
/// 127.0.0.1. IPv6 needs brackets. \throws UsageError with a hint
Endpoint parseEndpoint(const std::string& text);

/// A range of addresses, as in 192.168.1.0/24 or fd00::/8.
struct Network {
    std::array<std::uint8_t, 16> address{};  ///< IPv4 as ::ffff:a.b.c.d
    int bits = 128;                          ///< leading bits that are compared
};

/// Parses a numeric address, alone or with a prefix length. \throws UsageError, also if bits behind
/// the prefix are set: 192.168.1.20/24 is more likely an error than a range
Network parseNetwork(const std::string& text);

/// True if a network contains this numeric address, or if it is a loopback address. Other text is
/// not allowed.
bool isAllowed(std::span<const Network> allowed, const std::string& address);

/// Reads the token from a file: its first line, of 1 to 256 characters without blanks.
/// \throws FormatError, std::system_error as readAll()
std::string readToken(const std::string& file);

/// True for a regular file that group or others may read or write; its folder is not checked.
/// \throws std::system_error
bool isOpenToOthers(const std::string& file);

/// Compares in time that depends on the lengths alone, so that a client cannot find a token letter
/// by letter. \pre secret is not empty
bool isSameSecret(std::string_view given, std::string_view secret);

/// Finds the connection that must make room, for all listeners: one without a role, or an idle
/// client of a device port. See ServerLimits::roleless.
///
/// Requires connections with `std::optional<WallTime> idleSince() const`, empty while not idle.
/// \returns the one idle longest, if at least since the given time; else end
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
