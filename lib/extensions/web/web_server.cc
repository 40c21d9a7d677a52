// SPDX-License-Identifier: GPL-3.0-or-later
// Connections of a site, in order of arrival. A full server drops the oldest one that only fetches
// files, then the WebSocket that has been idle longest.
#include "extensions/web/web_server.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "server/network.h"

namespace ispace::web {

namespace {

using boost::asio::ip::tcp;
using std::chrono::steady_clock;

/// A browser uses some six connections for files and one for each robot it drives.
constexpr std::size_t kMaxConnections = 64;

}  // namespace

WebServer::WebServer(boost::asio::io_context& io, const Endpoint& endpoint,
                     const ServerLimits& limits, std::unique_ptr<WebSite> site)
    : limits_(limits),
      site_(std::move(site)),
      acceptor_(io, endpoint, [this](tcp::socket socket) { welcome(std::move(socket)); }),
      alarm_(io) {
    site_->settle(acceptor_.host(), acceptor_.port());
}

/// When the server is full, drops the oldest connection that is not a WebSocket, else the WebSocket
/// that has been idle longest.
void WebServer::welcome(tcp::socket socket) {
    sweep();
    if (connections_.size() >= kMaxConnections) {
        auto leaves = std::find_if(connections_.cbegin(), connections_.cend(),
                                   [](const auto& connection) { return !connection->isSocket(); });
        if (leaves == connections_.cend())
            leaves = longestIdle(connections_, steady_clock::now() - limits_.roleless_grace);
        if (leaves == connections_.cend()) return;
        (*leaves)->close();
        sweep();
    }
    connections_.push_back(serveBrowser(std::move(socket), *site_, limits_));
}

void WebServer::stepped() {
    site_->stepped();
    for (const auto& connection : connections_) connection->stepped();
}

void WebServer::serve(bool has_made) {
    if (has_made) stepped();
    const auto now = steady_clock::now();
    bool wanted = false;
    for (const auto& connection : connections_) {
        if (connection->waiting()) connection->proceed();
        connection->checkPatience(now);
        // A client that awaits a frame of a paused world is not idle.
        const auto idle = connection->idleSince();
        const bool is_late = idle && *idle <= now - limits_.roleless;
        if (is_late && connection->expires() && !connection->wantsFrame()) connection->dismiss();
        wanted = wanted || connection->wantsFrame();
    }
    sweep();
    if (!wanted) return;
    const WallTime next = site_->look(now);
    for (const auto& connection : connections_) connection->offerFrame();
    if (alarm_time_ == next) return;
    // Wakes the loop, which then comes here.
    alarm_time_ = next;
    alarm_.expires_at(alarm_time_);
    alarm_.async_wait([](boost::system::error_code) {});
}

std::optional<WallTime> WebServer::awaitedSince(WallTime earliest) const {
    std::optional<WallTime> latest;
    for (const auto& connection : connections_)
        if (const auto since = connection->awaitedSince(); since && *since > earliest)
            latest = std::max(latest.value_or(*since), *since);
    return latest;
}

bool WebServer::waitsToChange() const {
    return std::any_of(connections_.begin(), connections_.end(),
                       [](const auto& connection) { return connection->waitsToChange(); });
}

void WebServer::sweep() {
    std::erase_if(connections_, [](const auto& connection) { return connection->closed(); });
}

bool WebServer::busy() {
    sweep();
    return !connections_.empty();
}

void WebServer::end() {
    acceptor_.close();
    alarm_.cancel();
    site_->lookAtEnd();
    for (const auto& connection : connections_) connection->end();
    sweep();
}

void WebServer::closeAll() {
    for (const auto& connection : connections_) connection->close();
    sweep();
}

}  // namespace ispace::web
