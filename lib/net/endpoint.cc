// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <asio/ip/address.hpp>

#include "base/error.h"
#include "base/number.h"
#include "base/utf8.h"
#include "net/server.h"

namespace ispace {

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
    std::error_code bad;
    const auto address = asio::ip::make_address(host, bad);
    if (bad || address.is_v6() != bracketed)
        fail(text,
             ": wanted a numeric address or localhost before the port, like 127.0.0.1:8000 "
             "or [::1]:8000");
    if (!address.is_loopback())
        fail(text,
             ": other machines can only be served with a token, which this version does not "
             "have; listen on 127.0.0.1");
    return {address.to_string(), static_cast<std::uint16_t>(parseInteger(port).value())};
}

}  // namespace ispace
