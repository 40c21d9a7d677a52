// SPDX-License-Identifier: GPL-3.0-or-later
// The one owner of the feed, and of all that reads it: ports, the node, the log. A step computes
// each wanted message once.
#include "extensions/ros/ros_bridge.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "base/error.h"
#include "server/server.h"
#include "server/session.h"

namespace ispace::ros {

namespace {

RosScenery checked(RosScenery scenery, ServerState& state) {
    if (const std::string& robot = scenery.robot; !robot.empty()) {
        std::vector<std::string> known;
        for (const auto& [room, world] : state.worlds())
            for (const std::string& id : idsOf(world->robots())) known.push_back(id);
        if (std::find(known.begin(), known.end(), robot) == known.end())
            throw UsageError(unknownThing("robot", robot, known));
    }
    return scenery;
}

}  // namespace

RosBridge::RosBridge(const BridgeHost& host, RosScenery scenery)
    : host_(host), feed_(host.state, checked(std::move(scenery), host.state)) {}

std::string RosBridge::open(RosLanguage language, const Endpoint& endpoint,
                            const std::string& title) {
    auto site =
        std::make_unique<RosSite>(host_.state, feed_, language, title, endpoint.is_loopback);
    return "ws://" +
           webs_.emplace_back(host_.io, endpoint, host_.limits, std::move(site)).address();
}

void RosBridge::join(std::uint32_t domain) {
    node_.emplace(
        host_.state, feed_,
        DdsSettings{.domain = domain, .allowed = host_.limits.allowed, .wake = host_.wake});
}

void RosBridge::stepped() {
    for (web::WebServer& web : webs_) web.stepped();
    if (node_) node_->stepped();
    if (log_) log_->stepped();
}

void RosBridge::serve(bool has_made) {
    for (web::WebServer& web : webs_) web.serve(has_made);
    if (node_) {
        if (has_made) node_->stepped();
        node_->serve();
    }
    if (log_ && has_made) log_->stepped();
}

bool RosBridge::waitsToChange() const {
    return (node_ && node_->waitsToChange()) ||
           std::any_of(webs_.begin(), webs_.end(),
                       [](const web::WebServer& web) { return web.waitsToChange(); });
}

std::optional<WallTime> RosBridge::awaitedSince(WallTime earliest) const {
    std::optional<WallTime> latest;
    for (const web::WebServer& web : webs_)
        if (const auto since = web.awaitedSince(earliest))
            latest = std::max(latest.value_or(*since), *since);
    return latest;
}

std::optional<WallTime> RosBridge::nextTurn() const {
    return node_ ? node_->nextSend() : std::nullopt;
}

void RosBridge::end() {
    for (web::WebServer& web : webs_) web.end();
    if (node_) node_->end();
}

bool RosBridge::busy() {
    return std::any_of(webs_.begin(), webs_.end(), [](web::WebServer& web) { return web.busy(); });
}

void RosBridge::closeAll() {
    for (web::WebServer& web : webs_) web.closeAll();
}

}  // namespace ispace::ros
