// SPDX-License-Identifier: GPL-3.0-or-later
// The turns of a server's clients and of its world. Each gets some 2 ms before the other (a step or
// a request that has begun is not interrupted), so that neither starves the other. Full servers
// make room by ending the connection without a role that has been silent longest; too much unread
// output is relieved by closing the slowest readers, never one within an equal share.
#include "server/server_data.h"

#include <poll.h>
#include <algorithm>
#include <chrono>
#include <utility>

#include "base/error.h"
#include "server/session.h"

namespace ispace {

namespace {

using asio::ip::tcp;
using std::chrono::steady_clock;

/// Time slice of the world and of the clients; that of the clients ends early when the world's next
/// step is due.
constexpr auto kTurn = std::chrono::milliseconds(2);
constexpr auto kShortTurn = std::chrono::microseconds(500);
/// Connections above the limit that receive a closing message.
constexpr std::size_t kMaxLingering = 64;
/// Minimum interval between updates about marks and changes between steps.
constexpr auto kNewsEvery = std::chrono::milliseconds(10);
constexpr auto kLastFlush = std::chrono::milliseconds(500);

}  // namespace

void Server::Data::join(Worlds& joined) {
    rooms.worlds = &joined;
    rooms.states.push_back(&state);
    for (const RunRoom& room : joined.rooms().subspan(1))
        rooms.states.push_back(&others.emplace_back(*room.simulation, limits));
    for (ServerState* const each : rooms.states) each->joinRooms(rooms);
    joined.onMove([this](const std::string& mover, std::size_t from, std::size_t to) {
        rooms.states[to]->takeOver(*rooms.states[from], mover);
    });
}

bool Server::Data::collect() {
    bool has_made = false;
    for (ServerState* const each : states()) has_made = each->collect() || has_made;
    return has_made;
}

bool Server::Data::hasUpdates() {
    bool has_updates = false;
    for (ServerState* const each : states()) has_updates = each->hasUpdates() || has_updates;
    return has_updates;
}

void Server::Data::welcome(tcp::socket socket) {
    sweep();
    const bool full = serving >= limits.clients && !makeRoom();
    if (connections.size() >= limits.clients + kMaxLingering) {
        // Of closing connections, the oldest has had the most time.
        const auto told = std::find_if(connections.begin(), connections.end(),
                                       [](const auto& connection) { return connection->told(); });
        if (told == connections.end()) return;
        (*told)->close();
    }
    const auto connection = std::make_shared<ClientConnection>(std::move(socket), limits);
    connections.push_back(connection);
    if (!full) {
        connection->serve(state);
    } else {
        std::string text = "ERR 429 too many clients (";
        connection->refuse(
            text.append(std::to_string(limits.clients)).append("): try again later\n"));
    }
    sweep();
}

/// Ends the connection that has been without a role longest. \returns true if the server has room
/// now
bool Server::Data::makeRoom() {
    const WallTime since = steady_clock::now() - limits.roleless_grace;
    std::vector<std::shared_ptr<ClientConnection>> idle;
    for (const auto& connection : connections)
        if (connection->roleless() && connection->heard() <= since) idle.push_back(connection);
    std::sort(idle.begin(), idle.end(),
              [](const auto& a, const auto& b) { return a->heard() < b->heard(); });
    for (const auto& connection : idle) {
        connection->makeWay(since);
        sweep();
        if (serving < limits.clients) return true;
    }
    return false;
}

void Server::Data::stepped() {
    // Writing to a thousand clients takes longer than the next step may be late. Only a clock that
    // waits leaves each client a turn before the next scan. A few are always served: load from
    // other programs must not cost them a scan.
    constexpr std::size_t kFew = 32;
    const bool may_be_late =
        simulation.clock().kind != Clock::Kind::Real || connections.size() <= kFew;
    for (const auto& role : roles) role->stepped();
    const WallTime end = steady_clock::now() + kTurn / 4;
    for (const auto& connection : connections)
        connection->stepped(may_be_late || steady_clock::now() < end);
    for (const auto& bridge : bridges) bridge->stepped();
    static_cast<void>(hasUpdates());
    has_news = false;
    next_news = steady_clock::now() + kNewsEvery;
}

/// Returns true while a client keeps the world from its next step; real time does not wait.
bool Server::Data::rolesHoldWorld() const {
    return simulation.clock().kind != Clock::Kind::Real &&
           std::any_of(roles.begin(), roles.end(),
                       [](const auto& role) { return role->holdsWorld(); });
}

/// Returns the time until which the world waits for readers at most; empty if it need not. Those
/// that have not read for too long are no longer awaited.
std::optional<WallTime> Server::Data::awaitedReader() const {
    if (!limits.waits_for_readers || simulation.clock().kind == Clock::Kind::Real) return {};
    const auto most = limits.watchdog.count() > 0 ? limits.watchdog : limits.patience;
    const WallTime earliest = steady_clock::now() - most;
    std::optional<WallTime> latest;
    const auto wait = [&](std::optional<WallTime> since) {
        if (since && *since > earliest) latest = std::max(latest.value_or(*since), *since);
    };
    for (const auto& connection : connections)
        if (connection->owes()) wait(connection->waitingSince());
    for (const auto& bridge : bridges) wait(bridge->awaitedSince(earliest));
    return latest ? std::optional(*latest + most) : std::nullopt;
}

/// Next time at which a silent client needs service.
WallTime Server::Data::nextTurn() const {
    if (state.isOnTheWay()) return steady_clock::now();
    WallTime next = has_news ? next_news : WallTime::max();
    next = std::min(next, awaitedReader().value_or(next));
    bool may_change = false;
    for (const auto& connection : connections) {
        if (connection->waitsToChange()) may_change = true;
        if (limits.watchdog.count() > 0 && connection->watched())
            next = std::min(next, connection->heard() + limits.watchdog);
    }
    for (const auto& bridge : bridges) {
        may_change = may_change || bridge->waitsToChange();
        next = std::min(next, bridge->nextTurn().value_or(next));
    }
    if (!may_change) return next;
    auto change = state.nextChange();
    for (const ServerState& other : others) change = std::max(change, other.nextChange());
    return change ? std::min(next, *change) : next;
}

/// Time slice of the world: a single step if it may have to wait for frames of that step.
std::chrono::nanoseconds Server::Data::turn() const {
    const bool may_hold = simulation.clock().kind != Clock::Kind::Real || simulation.isReplay() ||
                          simulation.paused();
    if (may_hold && !roles.empty() && serving > 0) return std::chrono::nanoseconds(0);
    if (may_hold && limits.waits_for_readers) return std::chrono::nanoseconds(0);
    const bool takes_frames =
        serving > 0 || std::any_of(bridges.begin(), bridges.end(),
                                   [](const auto& bridge) { return bridge->takesFrames(); });
    if (!may_hold || !takes_frames) return kTurn;
    const bool has_heavy = std::any_of(states().begin(), states().end(), [](ServerState* each) {
        const auto sensors = each->simulation().world().sensors();
        return std::any_of(sensors.begin(), sensors.end(), isHeavy);
    });
    return has_heavy ? std::chrono::nanoseconds(0) : kTurn;
}

/// Runs ready handlers, for at most one slice or until the world's next step is due.
void Server::Data::serveClients() {
    const WallTime now = steady_clock::now();
    WallTime end = now + kTurn;
    if (const auto due = simulation.due()) end = std::min(end, std::max(*due, now + kShortTurn));
    while (io.poll_one() > 0 && steady_clock::now() < end) continue;
    const bool has_made = collect();
    for (const auto& connection : connections)
        if (has_made || connection->waiting()) connection->proceed();
    for (const auto& bridge : bridges) bridge->serve(has_made);
    has_news = hasUpdates() || has_news;
    if (has_news && steady_clock::now() >= next_news) stepped();
    if (limits.watchdog.count() > 0) {
        const WallTime since = steady_clock::now() - limits.watchdog;
        for (const auto& connection : connections) connection->watch(since);
    }
    relieve();
    sweep();
}

/// Enforces the limit on unread output by closing the slowest readers. Clients within an equal
/// share are kept: all others then exceed theirs.
void Server::Data::relieve() {
    std::size_t replies = 0;
    for (const auto& connection : connections) replies += connection->memory();
    std::size_t stale = state.staleBytes();
    for (const ServerState& other : others) stale += other.staleBytes();
    if (replies + stale <= limits.unread) return;
    const std::size_t share = limits.unread / (limits.clients + kMaxLingering);
    std::vector<std::shared_ptr<ClientConnection>> slow;
    for (const auto& connection : connections)
        if (connection->holds() > share) slow.push_back(connection);
    std::sort(slow.begin(), slow.end(),
              [](const auto& a, const auto& b) { return a->waitingSince() < b->waitingSince(); });
    for (const auto& connection : slow) {
        stale = state.staleBytes();
        for (const ServerState& other : others) stale += other.staleBytes();
        if (replies + stale <= limits.unread) return;
        replies -= connection->memory();
        connection->cutOff("ERR 429 too much unread: the slowest readers are disconnected\n");
        replies += connection->memory();
    }
}

/// Sleeps until that time or until a handler has run.
void Server::Data::sleepUntil(WallTime time) {
    if (alarm_time != time) {
        // Once for each time: moving a timer makes a handler ready, which would end the sleep.
        alarm_time = time;
        alarm.expires_at(time);
        alarm.async_wait([](error_code) {});
    }
    io.run_one();
}

/// Removes closed connections.
void Server::Data::sweep() {
    std::erase_if(connections, [](const auto& connection) { return connection->closed(); });
    serving = static_cast<std::size_t>(
        std::count_if(connections.begin(), connections.end(),
                      [](const auto& connection) { return connection->serving(); }));
}

/// Checks for a signal that the loop may not have noticed.
bool Server::Data::isStopped() {
    if (!stopper.is_open()) return false;
    pollfd signal{stopper.native_handle(), POLLIN, 0};
    return ::poll(&signal, 1, 0) > 0;
}

/// Waits a moment for frames; false once a signal has ended the run.
bool Server::Data::await() {
    bool has_come = false;
    for (ServerState* const each : states()) has_come = each->await() || has_come;
    return has_come;
}

/// Writes the last step, with its frames unless a signal has ended the run.
void Server::Data::finishRecord() {
    while (!simulation.finishRecord(WallTime::max()) && await()) continue;
}

/// Lets bridges keep the last step likewise.
void Server::Data::finishBridges() {
    std::vector<Bridge*> keepers;
    for (const auto& bridge : bridges)
        if (bridge->keepsLastStep()) keepers.push_back(bridge.get());
    if (keepers.empty()) return;
    const auto is_making = [](const ServerState* each) { return each->isMaking(); };
    const std::vector<ServerState*> all = states();
    for (Bridge* const keeper : keepers) keeper->lastStepped();
    while (std::any_of(all.begin(), all.end(), is_making) && await())
        for (Bridge* const keeper : keepers) keeper->lastStepped();
    for (Bridge* const keeper : keepers) keeper->finish();
}

void Server::Data::end() {
    acceptor.close();
    for (const auto& connection : connections) connection->end();
    for (const auto& bridge : bridges) bridge->end();
    sweep();
    const auto busy = [this] {
        return !connections.empty() ||
               std::any_of(bridges.begin(), bridges.end(),
                           [](const auto& bridge) { return bridge->busy(); });
    };
    const WallTime deadline = steady_clock::now() + kLastFlush;
    while (busy() && steady_clock::now() < deadline) {
        io.run_one_until(deadline);
        sweep();
    }
    closeAll();
}

void Server::Data::closeAll() {
    for (const auto& connection : connections) connection->close();
    for (const auto& bridge : bridges) bridge->closeAll();
    sweep();
}

}  // namespace ispace
