// SPDX-License-Identifier: GPL-3.0-or-later
// Addresses are compared as IPv6, those of IPv4 as mapped ones, with the bits of the range cut;
// loopback is always allowed. Secrets are compared without an early end, in a time that depends on
// the length given alone.
#include "server/network.h"

#include <boost/asio/ip/address.hpp>

#include <sys/stat.h>
#include <algorithm>
#include <cerrno>
#include <optional>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
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

/// Clears all bits after the prefix.
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

std::string readToken(const std::string& file) {
    constexpr std::size_t kMaxLength = 256;
    std::string token = readAll(file);
    token.resize(std::min(token.size(), token.find('\n')));
    if (token.ends_with('\r')) token.pop_back();
    const bool plain = std::all_of(token.begin(), token.end(),
                                   [](unsigned char c) { return c > ' ' && c < 0x7f; });
    if (token.empty() || token.size() > kMaxLength || !plain)
        throw FormatError({file, 1, 0,
                           "no token: wanted a line of 1 to 256 letters, digits and signs, without "
                           "blanks, as `openssl rand -hex 16` prints it"});
    return token;
}

bool isOpenToOthers(const std::string& file) {
    struct stat info {};
    if (::stat(file.c_str(), &info) != 0)
        throw std::system_error(errno, std::generic_category(), file);
    return S_ISREG(info.st_mode) && (info.st_mode & (S_IRGRP | S_IWGRP | S_IROTH | S_IWOTH)) != 0;
}

bool isSameSecret(std::string_view given, std::string_view secret) {
    if (secret.empty()) return given.empty();
    // volatile: no early end once they differ
    volatile unsigned different = given.size() == secret.size() ? 0U : 1U;
    for (std::size_t i = 0; i < given.size(); ++i) {
        const auto a = static_cast<unsigned char>(given[i]);
        const auto b = static_cast<unsigned char>(secret[i % secret.size()]);
        different = different | static_cast<unsigned>(a ^ b);
    }
    return different == 0;
}

namespace {

constexpr std::int64_t kLastPort = 65535;

bool isPort(std::string_view text) {
    const bool digits = !text.empty() && std::all_of(text.begin(), text.end(),
                                                     [](char c) { return c >= '0' && c <= '9'; });
    return digits && parseInteger(text).value_or(kLastPort + 1) <= kLastPort;
}

[[noreturn]] void fail(std::string_view text, std::string_view what) {
    throw UsageError(excerpt(text).append(what));
}

}  // namespace

Endpoint parseEndpoint(const std::string& text) {
    const auto colon = text.rfind(':');
    if (colon == std::string::npos) {
        std::string hint = " is no ADDR:PORT";
        if (isPort(text)) hint.append(", did you mean 127.0.0.1:").append(text).append("?");
        fail(text, hint);
    }
    std::string host = text.substr(0, colon);
    const std::string port = text.substr(colon + 1);
    if (!isPort(port)) fail(text, " has no port from 0 to 65535 behind the last colon");
    if (host.empty())
        fail(text,
             std::string(" has no address, did you mean 127.0.0.1:").append(port).append("?"));
    const bool bracketed = host.starts_with('[') && host.ends_with(']');
    if (bracketed) host = host.substr(1, host.size() - 2);
    if (host == "localhost" && !bracketed) host = "127.0.0.1";
    boost::system::error_code bad;
    const auto address = ip::make_address(host, bad);
    if (bad || address.is_v6() != bracketed)
        fail(text,
             ": wanted a numeric address or localhost before the port, like 127.0.0.1:8000 "
             "or [::1]:8000");
    return {address.to_string(), static_cast<std::uint16_t>(parseInteger(port).value()),
            address.is_loopback()};
}

}  // namespace ispace
