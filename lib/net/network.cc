// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/network.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <optional>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace {

namespace {

namespace ip = boost::asio::ip;

constexpr int kBits = 128, kBits4 = 32;

std::optional<ip::address_v6> asV6(const std::string& text) {
    boost::system::error_code bad;
    const auto address = ip::make_address(text, bad);
    if (bad) return std::nullopt;
    return address.is_v6() ? address.to_v6() : ip::make_address_v6(ip::v4_mapped, address.to_v4());
}

/// With all bits behind the first ones 0.
std::array<std::uint8_t, 16> cut(std::array<std::uint8_t, 16> address, int bits) {
    for (int i = bits; i < kBits; ++i) {
        auto& byte = address.at(static_cast<std::size_t>(i / 8));
        byte = static_cast<std::uint8_t>(byte & ~(0x80U >> (static_cast<unsigned>(i) % 8U)));
    }
    return address;
}

}  // namespace

Network parseNetwork(const std::string& text) {
    const auto slash = text.find('/');
    const std::string host = text.substr(0, slash);
    const auto address = asV6(host);
    if (!address)
        throw UsageError(excerpt(text) +
                         ": wanted a numeric address or a range of them, like 192.168.1.20, "
                         "192.168.1.0/24 or fd00::/8");
    Network network;
    network.address = address->to_bytes();
    if (slash == std::string::npos) return network;
    const bool is_v4 = address->is_v4_mapped();
    const std::string count = text.substr(slash + 1);
    const bool is_plain = count.find_first_not_of("0123456789") == std::string::npos;
    const auto bits = parseInteger(count);
    const int most = is_v4 ? kBits4 : kBits;
    if (!bits || !is_plain || *bits > most)
        throw UsageError(excerpt(text) + ": wanted a number of bits from 0 to " +
                         std::to_string(most) + " behind the slash");
    network.bits = static_cast<int>(*bits) + kBits - most;
    const auto begin = cut(network.address, network.bits);
    if (begin != network.address) {
        const ip::address_v6 first(begin);
        const std::string name =
            is_v4 ? ip::make_address_v4(ip::v4_mapped, first).to_string() : first.to_string();
        throw UsageError(excerpt(text) + " is not the beginning of a range, did you mean " + name +
                         text.substr(slash) + "?");
    }
    return network;
}

bool isAllowed(std::span<const Network> allowed, const std::string& address) {
    const auto found = asV6(address);
    if (!found) return false;
    if (found->is_loopback()) return true;
    if (found->is_v4_mapped() && ip::make_address_v4(ip::v4_mapped, *found).is_loopback())
        return true;
    return std::any_of(allowed.begin(), allowed.end(), [&](const Network& network) {
        return cut(found->to_bytes(), network.bits) == network.address;
    });
}

}  // namespace ispace
