// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes between a socket and a session. Requests are read in blocks of 256 bytes, so that replies
// stay small; a client that leaves 64 KiB unread is not read, and after ten seconds without
// progress it is closed.
#include "extensions/wire/device_port.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "record/edit.h"
#include "server/client_connection.h"
#include "server/network.h"

namespace ispace::wire {

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::steady_clock;

/// Block of one read: some twenty requests, so that their replies stay small.
constexpr std::size_t kBlock = 256;
/// Unsent bytes at which requests begin to wait.
constexpr std::size_t kPending = std::size_t{1} << 16;
/// Capacity kept for the next packets.
constexpr std::size_t kKept = std::size_t{1} << 16;
/// Time limit for a client that stops reading its output.
constexpr auto kPatience = std::chrono::seconds(10);
/// Time limit for closing after the last packet; input is discarded.
constexpr auto kLinger = std::chrono::seconds(1);

}  // namespace

DeviceConnection::DeviceConnection(tcp::socket socket, std::unique_ptr<WireSession> session)
    : socket_(std::move(socket)),
      timer_(socket_.get_executor()),
      session_(std::move(session)),
      heard_(steady_clock::now()) {
    // Limits the time without acknowledgement: a dead peer must not block a device that serves one
    // client.
    using UserTimeout = asio::detail::socket_option::integer<IPPROTO_TCP, TCP_USER_TIMEOUT>;
    error_code ignored;
    socket_.set_option(UserTimeout(static_cast<int>(std::chrono::milliseconds(kPatience).count())),
                       ignored);
}

/// Does all work that is ready, and schedules the rest.
void DeviceConnection::pump() {
    collect();
    flush();
    if (closed()) return;
    if (session_ && session_->closing()) session_.reset();
    session_ ? listen() : linger();
}

void DeviceConnection::collect() {
    if (session_) out_ += session_->take();
}

void DeviceConnection::stepped() {
    if (!session_ || closed()) return;
    session_->stepped(unsent());
    pump();
}

void DeviceConnection::proceed() {
    if (!waitsToChange()) return;
    session_->proceed();
    pump();
}

void DeviceConnection::checkPatience(WallTime now) {
    if (writing_ && now - stuck_ > kPatience) close();
}

/// Writes as much as the system accepts; a handler continues with the rest.
void DeviceConnection::flush() {
    while (!writing_ && !closed() && unsent() > 0) {
        error_code error;
        sent_ += socket_.write_some(asio::buffer(std::string_view(out_).substr(sent_)), error);
        if (wouldBlock(error)) {
            writing_ = true;
            stuck_ = steady_clock::now();
            socket_.async_wait(tcp::socket::wait_write, [self = shared_from_this()](auto failed) {
                self->writing_ = false;
                if (!failed && !self->closed()) self->pump();
            });
        } else if (error) {
            close();
        }
    }
    // Erase sent bytes once they are the greater part: amortised one move per byte.
    if (sent_ <= out_.size() / 2) return;
    out_.erase(0, std::exchange(sent_, 0));
    if (out_.empty() && out_.capacity() > kKept) out_.shrink_to_fit();
}

void DeviceConnection::listen() {
    if (reading_ || ended_ || unsent() > kPending) return;
    reading_ = true;
    socket_.async_wait(tcp::socket::wait_read, [self = shared_from_this()](auto failed) {
        self->reading_ = false;
        if (failed || self->closed()) return;
        if (self->session_) return self->receive();
        if (self->lingering_) self->discard();
    });
}

void DeviceConnection::receive() {
    std::array<char, kBlock> block;
    error_code error;
    const std::size_t size = socket_.read_some(asio::buffer(block), error);
    if (error && !wouldBlock(error) && error != asio::error::eof) return close();
    if (size > 0) {
        session_->receive({block.data(), size});
        if (session_->understood()) heard_ = steady_clock::now();
    }
    if (error == asio::error::eof) {
        ended_ = true;
        session_->ended();
    }
    pump();
}

/// Sends pending output, then closes. Closing with unread input would reset the connection, and the
/// peer might lose the last packet.
void DeviceConnection::linger() {
    if (writing_ || std::exchange(lingering_, true)) return;
    timer_.expires_after(kLinger);
    timer_.async_wait([self = shared_from_this()](auto aborted) {
        if (!aborted) self->close();
    });
    error_code ignored;
    socket_.shutdown(tcp::socket::shutdown_send, ignored);
    discard();
}

void DeviceConnection::discard() {
    if (!discardInput(socket_)) return close();
    if (reading_) return;
    reading_ = true;
    socket_.async_wait(tcp::socket::wait_read, [self = shared_from_this()](auto failed) {
        self->reading_ = false;
        if (!failed && !self->closed()) self->discard();
    });
}

void DeviceConnection::end() {
    if (closed()) return;
    collect();
    session_.reset();
    pump();
}

void DeviceConnection::close() {
    error_code ignored;
    timer_.cancel();
    socket_.close(ignored);
    session_.reset();
}

namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;
using std::chrono::steady_clock;

/// Maximum closing connections of a port.
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

/// Returns the state of the world in which the robot or sensor is now.
ServerState& DeviceHost::state() { return *(state_ = state_->find(id_).state); }

std::int64_t DeviceHost::changes() {
    std::int64_t changes = 0;
    for (const auto& [room, world] : state_->worlds()) changes += world->changes();
    return changes;
}

bool DeviceHost::mayDrive(std::string_view robot) {
    return !isReplay() &&
           state_->rooms().worlds->endTrip(std::string(robot), Outcome::Replaced).empty();
}

bool DeviceHost::isPaused() const { return state_->rooms().states.front()->simulation().paused(); }

/// A client repeats its request until the change is done. The result of the one asked last is kept
/// for that, as long as no other change came between.
DeviceHost::Change DeviceHost::change(std::span<const std::string> assignments) {
    // Device protocols cannot carry a token.
    if (!state_->mayChange() || state_->rooms().worlds->areCoupled() ||
        !state_->limits().token.empty())
        return Change::Refused;
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
    state().sync();
    return state_->hold(robot);
}

bool DeviceHost::holds(std::string_view robot, std::int64_t hold) {
    state().sync();
    return state_->holds(robot, hold);
}

void DeviceHost::release(std::string_view robot, std::int64_t hold) {
    // The result is no longer awaited.
    changing_.reset();
    state().sync();
    if (state_->holds(robot, hold) && !isReplay())
        state_->rooms().worlds->abandonTrip(std::string(robot));
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

/// Rejected clients are disconnected silently: the devices' protocols have no such message.
void DevicePort::welcome(tcp::socket socket) {
    error_code error;
    const auto peer = socket.remote_endpoint(error);
    if (error || !isAllowed(allowed_, peer.address().to_string())) return;
    sweep();
    const auto serving = std::count_if(connections_.begin(), connections_.end(),
                                       [](const auto& one) { return one->serving(); });
    if (static_cast<std::size_t>(serving) >= protocol_->clients && !makeRoom()) return;
    // Closing connections do not count; the first has had the most time.
    if (connections_.size() >= protocol_->clients + kMaxLeaving)
        (*std::find_if(connections_.begin(), connections_.end(), [](const auto& one) {
            return !one->serving();
        }))->close();
    if (!protocol_->refusal(host_->world(), id_).empty()) return;  // removed from the world
    connections_.push_back(
        std::make_shared<DeviceConnection>(std::move(socket), protocol_->open(*host_, id_)));
    connections_.back()->serve();
    sweep();
}

bool DevicePort::makeRoom() {
    // A client that closed its sending side may have left, unnoticed while no output is sent.
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

}  // namespace ispace::wire
