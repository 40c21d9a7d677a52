// SPDX-License-Identifier: GPL-3.0-or-later
// One loop for all clients: each gets 64 requests or 0.2 ms before the next one's turn. Output is
// bounded: scans are sent only when earlier output is gone, the newest one alone; a client that
// does not read is cut off by its limits. Closing sends all output, then reads on for up to a
// second, as a reset would cost the peer the last message.
#include "server/client_connection.h"

#include <boost/asio/post.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <utility>

namespace ispace {

namespace {

std::string_view withoutReturn(std::string_view line) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

}  // namespace

void LineBuffer::append(std::string_view bytes) {
    bytes_.erase(0, begin_);
    begin_ = 0;
    const std::size_t old = ready() ? 0 : bytes_.size();  // no LF before
    bytes_ += bytes;
    end_ = bytes_.find('\n', old);
}

bool LineBuffer::tooLong() const {
    const std::size_t end = ready() ? end_ : bytes_.size();
    return withoutReturn(std::string_view(bytes_).substr(begin_, end - begin_)).size() > limit_;
}

std::string_view LineBuffer::front() const {
    return withoutReturn(std::string_view(bytes_).substr(begin_, end_ - begin_));
}

std::string_view LineBuffer::take() {
    const std::string_view line = front();
    begin_ = end_ + 1;
    end_ = bytes_.find('\n', begin_);
    return line;
}

void Outbox::append(std::string_view text) {
    // Erase sent bytes only when they are the greater part: amortised one move per byte.
    if (!scan_ && sent_ > text_.size() / 2) text_.erase(0, std::exchange(sent_, 0));
    text_ += text;
}

std::string_view Outbox::front() const {
    std::string_view piece = scan_ ? *scan_ : text_;
    piece.remove_prefix(sent_);
    return piece;
}

bool Outbox::abandon() {
    scan_.reset();
    std::string().swap(text_);
    sent_ = 0;
    return in_line_;
}

void Outbox::pop(std::size_t bytes) {
    constexpr std::size_t kKept = std::size_t{1} << 16;
    if (bytes > 0) in_line_ = front()[bytes - 1] != '\n';
    sent_ += bytes;
    if (scan_ && sent_ == scan_->size()) {
        scan_.reset();
        sent_ = 0;
    } else if (!scan_ && sent_ == text_.size()) {
        text_.clear();
        sent_ = 0;
        if (text_.capacity() > kKept) text_.shrink_to_fit();
    }
}

namespace {

using asio::ip::tcp;
using std::chrono::steady_clock;

constexpr std::size_t kBlock = 4096;
/// Requests of one client, and their time, before the next client's turn.
constexpr int kRequestsInTurn = 64;
constexpr auto kTimeInTurn = std::chrono::microseconds(200);
/// Time limit for closing after the last message; input is discarded.
constexpr auto kLinger = std::chrono::seconds(1);

}  // namespace

/// Ends the connection unless it takes a role in time.
void ClientConnection::expectRole() {
    timer_.expires_at(heard_ + limits_.roleless);
    timer_.async_wait([self = shared_from_this()](auto aborted) {
        if (aborted || !self->roleless()) return;
        self->makeWay(steady_clock::now() - self->limits_.roleless);
        if (self->roleless()) self->expectRole();
    });
}

void ClientConnection::makeWay(WallTime since) {
    if (!roleless() || heard_ > since) return;
    catchUp();
    if (!roleless() || heard_ > since) return;
    refuse("ERR 408 no role taken in time: ROBOT id, SENSOR id or WORLD comes first\n");
}

/// Reads input that arrived during the world's step.
void ClientConnection::catchUp() {
    if (mayAnswer() && !lines_.ready() && !eof_) receive();
}

void ClientConnection::cutOff(std::string_view text) {
    if (out_.abandon()) out_.append("\n");
    owed_ = 0;
    refuse(text);
}

/// Does all work that is ready, and schedules the rest.
void ClientConnection::pump() {
    answer();
    flush();
    if (closed()) return;
    if (session_ && !session_->waiting()) {
        const bool left = eof_ && !lines_.ready();
        if (left || session_->closing()) session_.reset();
    }
    if (!session_) return linger();
    if (mayAnswer() && lines_.ready()) return pumpLater();
    listen();
}

void ClientConnection::pumpLater() {
    if (std::exchange(posted_, true)) return;
    asio::post(socket_.get_executor(), [self = shared_from_this()] {
        self->posted_ = false;
        if (!self->closed()) self->pump();
    });
}

void ClientConnection::answer() {
    const auto end = steady_clock::now() + kTimeInTurn;
    for (int i = 0; i < kRequestsInTurn && mayAnswer() && steady_clock::now() < end; ++i) {
        if (lines_.tooLong())
            session_->tooLong(limits_.line);
        else if (lines_.ready())
            answerNext();
        else
            return;
        const std::string reply = session_->take();
        if (!reply.empty()) heard_ = steady_clock::now();
        out_.append(reply);
    }
}

void ClientConnection::answerNext() {
    const std::string_view line = lines_.take();
    std::size_t more = session_->mayJoin(line);
    while (more > 0 && lines_.ready() && !lines_.tooLong() &&
           Session::isAlike(line, lines_.front())) {
        session_->join(lines_.take());
        --more;
    }
    session_->request(line);
}

void ClientConnection::stepped(bool has_time) {
    if (!session_) return;
    const bool waited = session_->waiting();
    session_->stepped(out_.unsent() <= limits_.pending / 4);
    if (has_time) return goOn(waited);
    out_.append(session_->take());
    const bool sends = !writing_ && (!out_.front().empty() || session_->scanBytes() > 0);
    if (sends || (waited && !session_->waiting())) pumpLater();
}

void ClientConnection::proceed() {
    if (!session_) return;
    const bool waited = session_->waiting();
    session_->proceed();
    goOn(waited);
}

void ClientConnection::watch(WallTime since) {
    if (!watched() || heard_ > since) return;
    silent_since_ = heard_;
    session_->silent();
    goOn(session_->waiting());
}

void ClientConnection::goOn(bool waited) {
    out_.append(session_->take());
    flush();
    if (waited && !closed() && !session_->waiting()) pumpLater();
}

/// Returns the next bytes to send; a scan only if no other output is pending.
std::string_view ClientConnection::nextPiece() {
    if (out_.front().empty() && session_) out_.put(session_->takeScan());
    return out_.front();
}

/// Writes as much as the system accepts; a handler continues with the rest.
void ClientConnection::flush() {
    while (!writing_ && !closed()) {
        const std::string_view piece = nextPiece();
        if (piece.empty()) return;
        if (owed_ == 0) {
            owed_ = out_.unsent() + out_.scanBytes();
            waiting_since_ = steady_clock::now();
        }
        error_code error;
        const std::size_t sent = socket_.write_some(asio::buffer(piece), error);
        out_.pop(sent);
        owed_ -= std::min(owed_, sent);
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

void ClientConnection::listen() {
    // During a STEP, read only to detect the end of the connection, while there is room.
    const bool waits = waiting() && !lines_.ready() && !lines_.tooLong();
    if (reading_ || eof_ || !(mayAnswer() || waits)) return;
    reading_ = true;
    socket_.async_wait(tcp::socket::wait_read, [self = shared_from_this()](auto failed) {
        self->reading_ = false;
        if (!failed && !self->closed() && self->session_) self->receive();
    });
}

void ClientConnection::receive() {
    std::array<char, kBlock> block;
    error_code error;
    const std::size_t size = socket_.read_some(asio::buffer(block), error);
    if (error == asio::error::eof)
        eof_ = true;
    else if (error && !wouldBlock(error))
        return close();
    lines_.append({block.data(), size});
    pump();
}

/// Sends pending output, then closes. Closing with unread input would reset the connection, and the
/// peer might lose the last message.
void ClientConnection::linger() {
    if (!std::exchange(ending_, true)) closeAfter(limits_.patience);
    if (writing_ || std::exchange(discarding_, true)) return;
    if (eof_) return close();
    closeAfter(kLinger);
    error_code ignored;
    socket_.shutdown(tcp::socket::shutdown_send, ignored);
    discard();
}

void ClientConnection::closeAfter(std::chrono::nanoseconds time) {
    timer_.expires_after(time);
    timer_.async_wait([self = shared_from_this()](auto aborted) {
        if (!aborted) self->close();
    });
}

void ClientConnection::discard() {
    if (!discardInput(socket_) || last_) return close();
    socket_.async_wait(tcp::socket::wait_read, [self = shared_from_this()](auto failed) {
        if (!failed && !self->closed()) self->discard();
    });
}

void ClientConnection::end() {
    last_ = true;
    if (session_) {
        session_->finish();
        out_.append(session_->take());
        session_.reset();
    }
    if (closed()) return;
    discarding_ ? discard() : pump();
}

void ClientConnection::close() {
    error_code ignored;
    timer_.cancel();
    socket_.close(ignored);
    session_.reset();
}

namespace asio = boost::asio;
using boost::system::error_code;

bool wouldBlock(const error_code& error) {
    return error == asio::error::would_block || error == asio::error::try_again ||
           error == asio::error::interrupted;
}

bool discardInput(asio::ip::tcp::socket& socket) {
    constexpr int kBlocksInTurn = 16;
    std::array<char, 4096> block;
    for (int i = 0; i < kBlocksInTurn; ++i) {
        error_code error;
        socket.read_some(asio::buffer(block), error);
        if (error) return wouldBlock(error);
    }
    return true;
}

}  // namespace ispace
