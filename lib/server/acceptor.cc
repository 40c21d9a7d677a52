// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/acceptor.h"

#include <boost/asio/ip/address.hpp>
#include <boost/system/system_error.hpp>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <chrono>
#include <system_error>
#include <utility>

namespace ispace {

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

/// System send buffer of a client: larger ones would hold outdated scans.
constexpr int kSendBuffer = 1 << 16;
/// Keepalive: a silent peer is probed after a minute and dropped after another.
constexpr int kKeepIdle = 60, kKeepInterval = 10, kKeepCount = 6;
constexpr auto kAcceptPause = std::chrono::milliseconds(100);

template <int kName>
using TcpOption = asio::detail::socket_option::integer<IPPROTO_TCP, kName>;

void prepare(tcp::socket& socket) {
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    socket.set_option(tcp::socket::send_buffer_size(kSendBuffer), ignored);
    socket.set_option(tcp::socket::keep_alive(true), ignored);
    socket.set_option(TcpOption<TCP_KEEPIDLE>(kKeepIdle), ignored);
    socket.set_option(TcpOption<TCP_KEEPINTVL>(kKeepInterval), ignored);
    socket.set_option(TcpOption<TCP_KEEPCNT>(kKeepCount), ignored);
    socket.non_blocking(true, ignored);
}

}  // namespace

Acceptor::Acceptor(asio::io_context& io, const Endpoint& endpoint, Welcome welcome)
    : acceptor_(io), pause_(io), welcome_(std::move(welcome)) {
    try {
        const tcp::endpoint wanted(asio::ip::make_address(endpoint.address), endpoint.port);
        acceptor_.open(wanted.protocol());
        acceptor_.set_option(tcp::acceptor::reuse_address(true));
        acceptor_.bind(wanted);
        acceptor_.listen();
        local_ = acceptor_.local_endpoint();
    } catch (const boost::system::system_error& error) {
        std::string where = "cannot listen on ";
        where.append(endpoint.address).append(":").append(std::to_string(endpoint.port));
        // Asio's own category knows no std::errc.
        throw std::system_error(error.code().value(), std::system_category(), where);
    }
    accept();
}

std::string Acceptor::host() const {
    std::string out = local_.address().to_string();
    if (local_.address().is_v6()) out.insert(0, 1, '[').append("]");
    return out;
}

void Acceptor::close() {
    error_code ignored;
    acceptor_.close(ignored);
    pause_.cancel();
}

void Acceptor::accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
        if (error == asio::error::operation_aborted) return;
        if (!error) {
            prepare(socket);
            welcome_(std::move(socket));
            return accept();
        }
        // Out of descriptors, or the client has already gone: retry later.
        pause_.expires_after(kAcceptPause);
        pause_.async_wait([this](error_code aborted) {
            if (!aborted) accept();
        });
    });
}

}  // namespace ispace
