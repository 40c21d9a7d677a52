// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/server.h"

#include <algorithm>
#include <array>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <atomic>
#include <optional>
#include <system_error>
#include <vector>

#include "net/conversation.h"
#include "net/line_buffer.h"
#include "net/outbox.h"

namespace ispace {

namespace {

using asio::ip::tcp;
using std::chrono::steady_clock;

constexpr std::size_t kBlock = 4096;
/// Of the world, and of the clients, before it is the other's turn.
constexpr auto kTurn = std::chrono::milliseconds(2);
/// Requests of one client before it is the next one's turn.
constexpr int kRequestsInTurn = 256;
/// What the system may hold for a client: much of it would be scans that are no longer new.
constexpr int kSendBuffer = 1 << 16;
/// How long a connection that was told of its end may take to close, what it still sends unread.
constexpr auto kLinger = std::chrono::seconds(1);
/// Connections in that state beyond those that are served.
constexpr std::size_t kMostLingering = 64;
constexpr auto kAcceptPause = std::chrono::milliseconds(100);
constexpr auto kLastFlush = std::chrono::milliseconds(500);

bool wouldBlock(const std::error_code& error) {
    return error == asio::error::would_block || error == asio::error::try_again ||
           error == asio::error::interrupted;
}

/// One connection. It reads, answers, writes, and at the end waits for the other side to close;
/// handlers keep it alive until then.
class Session : public std::enable_shared_from_this<Session> {
  public:
    Session(tcp::socket socket, const ServerLimits& limits)
        : socket_(std::move(socket)),
          timer_(socket_.get_executor()),
          limits_(limits),
          lines_(limits.line) {}

    void serve(Hall& hall) {
        conversation_.emplace(hall);
        out_.append(Conversation::greeting());
        pump();
    }
    /// Sends a text and closes.
    void refuse(std::string_view text) {
        out_.append(text);
        pump();
    }
    /// The world took a step.
    void stepped();
    [[nodiscard]] bool waiting() const { return conversation_ && conversation_->waiting(); }
    [[nodiscard]] bool serving() const { return conversation_.has_value(); }
    [[nodiscard]] bool closed() const { return !socket_.is_open(); }
    /// Sends what is pending and closes, without waiting for the other side.
    void end();
    void close();

  private:
    [[nodiscard]] bool mayAnswer() const {
        return conversation_ && !conversation_->waiting() && !conversation_->closing() &&
               out_.unsent() <= limits_.pending;
    }
    void pump();
    void pumpLater();
    void answer();
    void flush();
    std::string_view nextPiece();
    void listen();
    void receive();
    void linger();
    void discard();

    tcp::socket socket_;
    asio::steady_timer timer_;  // of lingering
    ServerLimits limits_;
    LineBuffer lines_;
    std::optional<Conversation> conversation_;  // none: the connection is about to end
    Outbox out_;
    bool reading_ = false, writing_ = false, posted_ = false;  // handlers on their way
    bool eof_ = false, lingering_ = false, ending_ = false;
};

/// Does all that can be done now, and arranges to be called when more can.
void Session::pump() {
    answer();
    flush();
    if (closed()) return;
    if (conversation_ && !conversation_->waiting()) {
        const bool left = eof_ && !lines_.ready();
        if (left || conversation_->closing()) conversation_.reset();
    }
    if (!conversation_ && !writing_) return linger();
    if (mayAnswer() && lines_.ready()) return pumpLater();
    listen();
}

void Session::pumpLater() {
    if (std::exchange(posted_, true)) return;
    asio::post(socket_.get_executor(), [self = shared_from_this()] {
        self->posted_ = false;
        if (!self->closed()) self->pump();
    });
}

void Session::answer() {
    for (int i = 0; i < kRequestsInTurn && mayAnswer(); ++i) {
        if (lines_.tooLong())
            conversation_->tooLong(limits_.line);
        else if (lines_.ready())
            conversation_->request(lines_.take());
        else
            return;
        out_.append(conversation_->take());
    }
}

void Session::stepped() {
    if (!conversation_) return;
    const bool waited = conversation_->waiting();
    conversation_->stepped();
    out_.append(conversation_->take());
    flush();
    if (waited && !closed() && !conversation_->waiting()) pumpLater();
}

/// What to send next; a scan only when there is nothing else.
std::string_view Session::nextPiece() {
    if (out_.front().empty() && conversation_) out_.put(conversation_->takeScan());
    return out_.front();
}

/// Writes as much as the system takes; a handler goes on with the rest.
void Session::flush() {
    while (!writing_ && !closed()) {
        const std::string_view piece = nextPiece();
        if (piece.empty()) return;
        std::error_code error;
        out_.pop(socket_.write_some(asio::buffer(piece), error));
        if (wouldBlock(error)) {
            writing_ = true;
            socket_.async_wait(tcp::socket::wait_write, [self = shared_from_this()](auto failed) {
                self->writing_ = false;
                if (!failed && !self->closed()) self->pump();
            });
        } else if (error) {
            close();
        }
    }
}

void Session::listen() {
    if (reading_ || eof_ || !mayAnswer()) return;
    reading_ = true;
    socket_.async_wait(tcp::socket::wait_read, [self = shared_from_this()](auto failed) {
        self->reading_ = false;
        if (!failed && !self->closed() && self->conversation_) self->receive();
    });
}

void Session::receive() {
    std::array<char, kBlock> block;
    std::error_code error;
    const std::size_t size = socket_.read_some(asio::buffer(block), error);
    if (error == asio::error::eof)
        eof_ = true;
    else if (error && !wouldBlock(error))
        return close();
    lines_.append({block.data(), size});
    pump();
}

/// Closing with unread input would reset the connection, and the other side might lose what it was
/// told last.
void Session::linger() {
    if (std::exchange(lingering_, true)) return;
    if (eof_) return close();
    std::error_code ignored;
    socket_.shutdown(tcp::socket::shutdown_send, ignored);
    timer_.expires_after(kLinger);
    timer_.async_wait([self = shared_from_this()](auto) { self->close(); });
    discard();
}

void Session::discard() {
    constexpr int kBlocksInTurn = 16;
    std::array<char, kBlock> block;
    for (int i = 0; i < kBlocksInTurn; ++i) {
        std::error_code error;
        socket_.read_some(asio::buffer(block), error);
        if (wouldBlock(error)) break;
        if (error) return close();
    }
    if (ending_) return close();
    socket_.async_wait(tcp::socket::wait_read, [self = shared_from_this()](auto failed) {
        if (!failed && !self->closed()) self->discard();
    });
}

void Session::end() {
    ending_ = true;
    if (conversation_) {
        conversation_->finish();
        out_.append(conversation_->take());
        conversation_.reset();
    }
    if (closed()) return;
    lingering_ ? discard() : pump();
}

void Session::close() {
    std::error_code ignored;
    timer_.cancel();
    socket_.close(ignored);
    conversation_.reset();
}

}  // namespace

struct Server::Data {
    Data(Simulation& the_simulation, const ServerLimits& the_limits)
        : simulation(the_simulation), limits(the_limits), hall(the_simulation) {}
    ~Data() { closeAll(); }

    void accept();
    void welcome(tcp::socket socket);
    void stepped();
    void serveClients();
    void sleepUntil(WallTime time);
    void sweep();
    void end();
    void closeAll();

    Simulation& simulation;
    ServerLimits limits;
    Hall hall;
    asio::io_context io{1};  // one thread runs it
    tcp::acceptor acceptor{io};
    asio::steady_timer accept_pause{io}, alarm{io};
    std::optional<WallTime> alarm_time;
    tcp::endpoint local;
    std::vector<std::shared_ptr<Session>> sessions;  // in the order of their coming
    std::atomic<std::size_t> serving = 0;
};

void Server::Data::accept() {
    acceptor.async_accept([this](std::error_code error, tcp::socket socket) {
        if (error == asio::error::operation_aborted) return;
        if (!error) {
            welcome(std::move(socket));
            return accept();
        }
        // Out of descriptors, or a client that is gone already: it may go better in a while.
        accept_pause.expires_after(kAcceptPause);
        accept_pause.async_wait([this](std::error_code aborted) {
            if (!aborted) accept();
        });
    });
}

void Server::Data::welcome(tcp::socket socket) {
    std::error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    socket.set_option(tcp::socket::send_buffer_size(kSendBuffer), ignored);
    socket.non_blocking(true, ignored);
    sweep();
    const bool full = serving >= limits.clients;
    if (full && sessions.size() >= limits.clients + kMostLingering) return;
    const auto session = std::make_shared<Session>(std::move(socket), limits);
    sessions.push_back(session);
    if (!full) {
        session->serve(hall);
    } else {
        std::string text = "ERR 429 too many clients (";
        session->refuse(text.append(std::to_string(limits.clients)).append("): try again later\n"));
    }
    sweep();
}

void Server::Data::stepped() {
    for (const auto& session : sessions) session->stepped();
}

/// Runs handlers that are ready, for one turn at most.
void Server::Data::serveClients() {
    const WallTime end = steady_clock::now() + kTurn;
    while (io.poll_one() > 0 && steady_clock::now() < end) continue;
    for (const auto& session : sessions)
        if (session->waiting()) session->stepped();
    sweep();
}

/// Until then, or until one handler has run.
void Server::Data::sleepUntil(WallTime time) {
    if (alarm_time != time) {
        // Once for each time: moving a timer makes a handler ready, which would end the sleep.
        alarm_time = time;
        alarm.expires_at(time);
        alarm.async_wait([](std::error_code) {});
    }
    io.run_one();
}

/// Forgets connections that are closed.
void Server::Data::sweep() {
    std::erase_if(sessions, [](const auto& session) { return session->closed(); });
    serving = static_cast<std::size_t>(std::count_if(
        sessions.begin(), sessions.end(), [](const auto& session) { return session->serving(); }));
}

void Server::Data::end() {
    std::error_code ignored;
    acceptor.close(ignored);
    accept_pause.cancel();
    for (const auto& session : sessions) session->end();
    sweep();
    const WallTime deadline = steady_clock::now() + kLastFlush;
    while (!sessions.empty() && steady_clock::now() < deadline) {
        io.run_one_until(deadline);
        sweep();
    }
    closeAll();
}

void Server::Data::closeAll() {
    for (const auto& session : sessions) session->close();
    sweep();
}

Server::Server(Simulation& simulation, const Endpoint& endpoint, const ServerLimits& limits)
    : data_(std::make_unique<Data>(simulation, limits)) {
    try {
        const tcp::endpoint wanted(asio::ip::make_address(endpoint.address), endpoint.port);
        data_->acceptor.open(wanted.protocol());
        data_->acceptor.set_option(tcp::acceptor::reuse_address(true));
        data_->acceptor.bind(wanted);
        data_->acceptor.listen();
        data_->local = data_->acceptor.local_endpoint();
    } catch (const std::system_error& error) {
        std::string where = "cannot listen on ";
        where.append(endpoint.address).append(":").append(std::to_string(endpoint.port));
        // Asio's own category knows no std::errc.
        throw std::system_error(error.code().value(), std::system_category(), where);
    }
    data_->accept();
}

Server::~Server() = default;

std::string Server::address() const {
    std::string out = data_->local.address().to_string();
    if (data_->local.address().is_v6()) out.insert(0, 1, '[').append("]");
    return out.append(":").append(std::to_string(port()));
}

std::uint16_t Server::port() const { return data_->local.port(); }

std::size_t Server::clients() const { return data_->serving; }

void Server::run() {
    Data& data = *data_;
    Simulation& simulation = data.simulation;
    simulation.onStep([&data] { data.stepped(); });
    while (!simulation.finished()) {
        data.serveClients();
        // Last before sleeping: what clients asked for decides for how long.
        const auto next = simulation.run(steady_clock::now(), kTurn);
        if (simulation.finished()) break;
        if (!next)
            data.io.run_one();
        else if (*next > steady_clock::now())
            data.sleepUntil(*next);
    }
    data.serveClients();
    data.end();
}

void Server::stop() {
    asio::post(data_->io, [data = data_.get()] { data->simulation.finish(); });
}

}  // namespace ispace
