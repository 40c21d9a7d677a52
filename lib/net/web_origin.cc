// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/web_origin.h"

#include <algorithm>

namespace ispace {

namespace {

constexpr std::uint16_t kHttpPort = 80;
constexpr std::string_view kScheme = "http://";

bool equalIgnoringCase(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

WebOrigin::WebOrigin(const std::string& address, std::uint16_t port) {
    const std::string suffix = ":" + std::to_string(port);
    for (const std::string& name : {address, std::string("localhost")}) {
        hosts_.push_back(name + suffix);
        if (port == kHttpPort) hosts_.push_back(name);
    }
}

bool WebOrigin::isHost(std::string_view host) const {
    return std::any_of(hosts_.begin(), hosts_.end(),
                       [&](const std::string& known) { return equalIgnoringCase(host, known); });
}

bool WebOrigin::mayConnect(std::string_view origin) const {
    return origin.empty() || (origin.starts_with(kScheme) && isHost(origin.substr(kScheme.size())));
}

std::string contentPolicy(std::string_view host) {
    std::string out =
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src "
        "'self' ws://";
    return out.append(host).append("; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
}

}  // namespace ispace
