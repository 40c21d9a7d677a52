// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/device_port.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "base/error.h"
#include "net/idle_rule.h"
#include "record/edit.h"

namespace ispace {

namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;
using std::chrono::steady_clock;

/// Connections of a port that only have to close.
constexpr std::size_t kMaxLeaving = 8;

WireHost::Change resultOf(const std::exception_ptr& failure) {
    try {
        if (failure) std::rethrow_exception(failure);
        return WireHost::Change::Done;
    } catch (const UsageError&) {
        return WireHost::Change::Refused;
    } catch (const FormatError&) {
        return WireHost::Change::Refused;
    }
}

}  // namespace

DeviceHost::Change DeviceHost::change(std::span<const std::string> assignments) {
    // Nobody shows a token here.
    if (!state_->mayChange() || !state_->limits().token.empty()) return Change::Refused;
    const bool is_asked =
        changing_ && std::equal(assignments.begin(), assignments.end(),
                                changing_->assignments.begin(), changing_->assignments.end());
    const auto asked = is_asked ? changing_ : nullptr;
    if (asked && asked->result && asked->changes == state_->simulation().world().changes()) {
        changing_.reset();
        return *asked->result;
    }
    if (!state_->mayChangeNow(steady_clock::now())) return Change::Later;
    std::vector<Edit> edits;
    try {
        for (const std::string& assignment : assignments)
            edits.push_back(parseEdit(Edit::Kind::Set, assignment));
    } catch (const UsageError&) {
        return Change::Refused;
    } catch (const FormatError&) {
        return Change::Refused;
    }
    const auto changing = std::make_shared<Changing>();
    changing->assignments.assign(assignments.begin(), assignments.end());
    changing_ = changing;
    state_->change(state_->editor().edit(std::move(edits)),
                   [changing, state = state_](const std::exception_ptr& failure) {
                       changing->result = resultOf(failure);
                       Simulation& simulation = state->simulation();
                       changing->changes = simulation.world().changes();
                       if (failure) return;
                       for (const std::string& assignment : changing->assignments)
                           simulation.events().add(EventKind::Change, "SET " + assignment);
                   });
    if (!changing->result) return Change::Later;
    changing_.reset();
    return *changing->result;
}

std::optional<std::int64_t> DeviceHost::hold(std::string_view robot) {
    state_->sync();
    return state_->hold(robot);
}

bool DeviceHost::holds(std::string_view robot, std::int64_t hold) {
    state_->sync();
    return state_->holds(robot, hold);
}

void DeviceHost::release(std::string_view robot, std::int64_t hold) {
    // Nobody asks what became of it any more.
    changing_.reset();
    state_->sync();
    state_->release(robot, hold);
}

std::chrono::nanoseconds DeviceHost::clock() const {
    if (state_->limits().wall_clock) return steady_clock::now() - began_;
    return state_->simulation().world().time();
}

DevicePort::DevicePort(boost::asio::io_context& io, DeviceHost& host, const ServerLimits& limits,
                       const WireProtocol& protocol, std::string id, const Endpoint& endpoint)
    : host_(&host),
      roleless_(limits.roleless),
      grace_(limits.roleless_grace),
      allowed_(limits.allowed),
      protocol_(&protocol),
      id_(std::move(id)),
      acceptor_(io, endpoint, [this](tcp::socket socket) { welcome(std::move(socket)); }) {}

/// Who may not come, or finds no place, is closed without a word: the devices' languages have none
/// for it.
void DevicePort::welcome(tcp::socket socket) {
    error_code error;
    const auto peer = socket.remote_endpoint(error);
    if (error || !isAllowed(allowed_, peer.address().to_string())) return;
    sweep();
    const auto serving = std::count_if(connections_.begin(), connections_.end(),
                                       [](const auto& one) { return one->serving(); });
    if (static_cast<std::size_t>(serving) >= protocol_->clients && !makeRoom()) return;
    // Those that only have to close are no hindrance; the first of them has had the most time.
    if (connections_.size() >= protocol_->clients + kMaxLeaving)
        (*std::find_if(connections_.begin(), connections_.end(), [](const auto& one) {
            return !one->serving();
        }))->close();
    if (!protocol_->refusal(host_->world(), id_).empty()) return;  // the world has lost it
    connections_.push_back(
        std::make_shared<DeviceConnection>(std::move(socket), protocol_->open(*host_, id_)));
    connections_.back()->serve();
    sweep();
}

bool DevicePort::makeRoom() {
    // Of those that send no more some have left, unnoticed as long as nothing is sent to them.
    auto idle = std::find_if(connections_.begin(), connections_.end(), [](const auto& connection) {
        return connection->serving() && connection->ended();
    });
    if (idle == connections_.end()) {
        const auto longest = longestIdle(connections_, steady_clock::now() - grace_);
        idle = connections_.begin() + (longest - connections_.cbegin());
    }
    if (idle == connections_.end()) return false;
    (*idle)->close();
    sweep();
    return true;
}

void DevicePort::stepped() {
    for (const auto& connection : connections_) connection->stepped();
}

bool DevicePort::waitsToChange() const {
    return std::any_of(connections_.begin(), connections_.end(),
                       [](const auto& connection) { return connection->waitsToChange(); });
}

void DevicePort::serve(WallTime now) {
    for (const auto& connection : connections_) {
        connection->proceed();
        connection->checkPatience(now);
        if (const auto idle = connection->idleSince(); idle && *idle <= now - roleless_)
            connection->close();
    }
    sweep();
}

void DevicePort::sweep() {
    std::erase_if(connections_, [](const auto& connection) { return connection->closed(); });
}

bool DevicePort::busy() {
    sweep();
    return !connections_.empty();
}

void DevicePort::end() {
    acceptor_.close();
    for (const auto& connection : connections_) connection->end();
    sweep();
}

void DevicePort::closeAll() {
    for (const auto& connection : connections_) connection->close();
    sweep();
}

}  // namespace ispace
