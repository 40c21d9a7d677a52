// SPDX-License-Identifier: GPL-3.0-or-later
// The loop of a run: clients, changes, the world, sleep. While a background job, a role or a reader
// holds the world, only its record is written. The loop sleeps in Asio until a handler has run, or
// the earlier of the next step and Data::nextTurn().
#include "server/server.h"

#include <boost/asio/post.hpp>

#include <fcntl.h>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <optional>
#include <system_error>
#include <utility>

#include "server/server_data.h"
#include "server/session.h"

namespace ispace {

Server::Server(Simulation& simulation, const Endpoint& endpoint, const ServerLimits& limits,
               Worlds* joined)
    : data_(std::make_unique<Data>(simulation, endpoint, limits, joined)) {}

Server::~Server() = default;

std::string Server::address() const { return data_->acceptor.address(); }

std::uint16_t Server::port() const { return data_->acceptor.port(); }

BridgeHost Server::host() {
    return {data_->io, data_->limits, data_->state, [&io = data_->io] { asio::post(io, [] {}); }};
}

void Server::keep(std::unique_ptr<Bridge> bridge) { data_->bridges.push_back(std::move(bridge)); }

ReaderLosses Server::readerLosses() const {
    ReaderLosses all;
    for (ServerState* const each : data_->states()) {
        all.readings += each->losses().readings;
        all.messages += each->losses().messages;
    }
    return all;
}

std::vector<std::string> Server::serveRoles(std::span<const MakeRoleService> services) {
    Data& data = *data_;
    const bool may_wait = data.simulation.clock().kind != Clock::Kind::Real;
    std::vector<std::string> notes;
    const auto rooms = data.state.rooms().worlds->rooms();
    for (const MakeRoleService make : services) {
        auto service = make(rooms, data.simulation.world().options().seed);
        if (!service) continue;
        if (const std::string clients = service->waitsFor(); may_wait && !clients.empty())
            notes.push_back("the world waits for " + clients);
        for (ServerState* const each : data.states()) each->addRoleService(*service);
        data.roles.push_back(std::move(service));
    }
    return notes;
}

FrameTaker Server::frameTaker(std::size_t room) {
    ServerState* const state = data_->states()[room];
    return [state](FrameJob job) { state->takeFrame(std::move(job)); };
}

bool Server::isBusy() const {
    const auto& states = data_->states();
    return std::any_of(states.begin(), states.end(),
                       [](const ServerState* each) { return each->isBusy(); });
}

std::size_t Server::clients() const { return data_->serving; }

void Server::run() {
    Data& data = *data_;
    Simulation& simulation = data.simulation;
    simulation.onStep([&data] { data.stepped(); });
    while (!simulation.finished()) {
        data.serveClients();
        if (simulation.isDue(std::chrono::steady_clock::now())) data.state.prepareStep();
        const auto& states = data.states();
        for (ServerState* const each : states) each->changeAsScripted();
        // Last before sleeping: pending requests determine the time to wake.
        std::optional<WallTime> next;
        const bool holds = std::any_of(states.begin(), states.end(),
                                       [](const ServerState* each) { return each->holdsWorld(); });
        next = holds || data.rolesHoldWorld() || data.awaitedReader()
                   ? simulation.flushRecord()
                   : simulation.run(std::chrono::steady_clock::now(), data.turn());
        if (simulation.finished()) break;
        if (const WallTime turn = data.nextTurn(); turn < WallTime::max())
            next = std::min(next.value_or(turn), turn);
        if (!next)
            data.io.run_one();
        else if (*next > std::chrono::steady_clock::now())
            data.sleepUntil(*next);
    }
    data.serveClients();
    data.finishRecord();
    data.finishBridges();
    data.end();
}

void Server::stop() {
    asio::post(data_->io, [data = data_.get()] { data->simulation.finish(); });
}

void Server::stopOn(int descriptor) {
    // Duplicate, because the stream object closes its descriptor.
    const int own = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
    if (own < 0) throw std::system_error(errno, std::system_category(), "signals");
    data_->stopper.assign(own);
    data_->stopper.async_wait(asio::posix::descriptor_base::wait_read,
                              [data = data_.get()](error_code error) {
                                  if (!error) data->simulation.finish();
                              });
}

}  // namespace ispace
