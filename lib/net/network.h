// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

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

}  // namespace ispace
