// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/device_connection.h"

#include <netinet/in.h>
#include <netinet/tcp.h>

#include <array>
#include <chrono>
#include <string_view>
#include <utility>

#include "net/socket_input.h"

namespace ispace {

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::steady_clock;

/// Read at once: some twenty requests, so that replies to them take little room and time.
constexpr std::size_t kBlock = 256;
/// Unsent bytes at which requests begin to wait.
constexpr std::size_t kPending = std::size_t{1} << 16;
/// A string of this size is kept for the next packets.
constexpr std::size_t kKept = std::size_t{1} << 16;
/// How long a client may take nothing of what waits for it.
constexpr auto kPatience = std::chrono::seconds(10);
/// How long a connection may take to close after its last packet; what it sends is not read.
constexpr auto kLinger = std::chrono::seconds(1);

}  // namespace

DeviceConnection::DeviceConnection(tcp::socket socket, std::unique_ptr<WireSession> session)
    : socket_(std::move(socket)),
      timer_(socket_.get_executor()),
      session_(std::move(session)),
      heard_(steady_clock::now()) {
    // A peer that acknowledges nothing: devices serve one client, who must not hold it for ever.
    using UserTimeout = asio::detail::socket_option::integer<IPPROTO_TCP, TCP_USER_TIMEOUT>;
    error_code ignored;
    socket_.set_option(UserTimeout(static_cast<int>(std::chrono::milliseconds(kPatience).count())),
                       ignored);
}

/// Does all that can be done now, and arranges to be called when more can.
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

/// Writes as much as the system takes; a handler goes on with the rest.
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
    // What is sent goes once it is the greater part, so that each byte moves once or so.
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

/// Sends what there is; then closes. With unread input that would reset the connection, and the
/// other side might lose the last packet.
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

}  // namespace ispace
