// SPDX-License-Identifier: GPL-3.0-or-later
// Programs without an origin and pages of this machine need no token on a loopback port; all others
// show it in the address. Browsers cannot set other headers of a WebSocket, hence the query.
#include "extensions/ros/ros_site.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <memory>
#include <utility>

#include "extensions/ros/foxglove_dialogue.h"
#include "extensions/ros/rosbridge_dialogue.h"

namespace ispace::ros {

bool isLocalOrigin(std::string_view origin) {
    if (origin.empty() || origin == "file://") return true;
    const std::size_t scheme = origin.find("://");
    if (scheme == std::string_view::npos || !origin.starts_with("http")) return false;
    std::string_view host = origin.substr(scheme + 3);
    const std::size_t colon = host.rfind(':');
    const bool has_port = colon != std::string_view::npos &&
                          host.find_first_not_of("0123456789", colon + 1) == std::string_view::npos;
    if (has_port) host = host.substr(0, colon);
    return host == "localhost" || host == "127.0.0.1" || host == "[::1]";
}

std::optional<std::string> tokenOf(std::string_view target) {
    constexpr std::string_view kKey = "token=";
    const std::size_t query = target.find('?');
    if (query == std::string_view::npos) return std::nullopt;
    for (std::string_view rest = target.substr(query + 1); !rest.empty();) {
        const std::string_view part = rest.substr(0, rest.find('&'));
        rest.remove_prefix(std::min(rest.size(), part.size() + 1));
        if (!part.starts_with(kKey)) continue;
        std::string out;
        for (std::size_t i = kKey.size(); i < part.size(); ++i) {
            unsigned char code = 0;
            const char* const digits = part.data() + i + 1;
            constexpr int kHex = 16;
            const bool is_escape =
                part[i] == '%' && i + 2 < part.size() &&
                std::from_chars(digits, digits + 2, code, kHex).ptr == digits + 2;
            out += is_escape ? static_cast<char>(code) : part[i];
            if (is_escape) i += 2;
        }
        return out;
    }
    return std::nullopt;
}

namespace {

/// Returns the first of the offered subprotocols that Foxglove's clients speak; "" for none.
std::string_view foxgloveProtocol(std::string_view offered) {
    constexpr std::array<std::string_view, 2> kKnown{"foxglove.sdk.v1", "foxglove.websocket.v1"};
    while (!offered.empty()) {
        std::string_view one = offered.substr(0, offered.find(','));
        offered.remove_prefix(std::min(offered.size(), one.size() + 1));
        one.remove_prefix(std::min(one.find_first_not_of(" \t"), one.size()));
        one = one.substr(0, one.find_last_not_of(" \t") + 1);
        const auto* const known = std::find(kKnown.begin(), kKnown.end(), one);
        if (known != kKnown.end()) return *known;
    }
    return "";
}

}  // namespace

RosSite::RosSite(ServerState& state, RosFeed& feed, RosLanguage language, std::string title,
                 bool is_loopback)
    : state_(&state),
      feed_(&feed),
      language_(language),
      title_(std::move(title)),
      session_(std::to_string(std::chrono::system_clock::now().time_since_epoch().count())),
      is_loopback_(is_loopback) {}

void RosSite::settle(const std::string& host, std::uint16_t port) { origin_.emplace(host, port); }

web::WebAdmission RosSite::open(const web::WebRequest& request) {
    std::string_view protocol;
    const std::string peer(request.peer);
    std::unique_ptr<RosDialogue> dialogue;
    if (language_ == RosLanguage::Foxglove) {
        protocol = foxgloveProtocol(request.protocols);
        if (protocol.empty())
            return {.status = 400,
                    .why = "the subprotocol is foxglove.sdk.v1 or foxglove.websocket.v1"};
        dialogue = std::make_unique<FoxgloveDialogue>(*state_, *feed_, title_, session_, peer);
    } else {
        dialogue = std::make_unique<RosbridgeDialogue>(*state_, *feed_, peer);
    }
    const ServerLimits& limits = state_->limits();
    const auto token = tokenOf(request.target);
    if (token) {
        constexpr unsigned kTooMany = 429;
        const unsigned status = dialogue->present(*token);
        if (status == kTooMany)
            return {.status = status, .why = "too many wrong tokens: try again in a second"};
        if (status != 0) return {.status = status, .why = "this is not the token of this run"};
    }
    if (!token || limits.token.empty()) {
        if (!is_loopback_ || limits.token_first)
            return {.status = 401, .why = "the address needs the token of this run: ?token=x"};
        if (!isLocalOrigin(request.origin))
            return {.status = 403,
                    .why = "pages of other servers need the token of this run: ?token=x"};
    }
    return {.dialogue = std::move(dialogue), .protocol = protocol};
}

}  // namespace ispace::ros
