// SPDX-License-Identifier: GPL-3.0-or-later
// Sockets are without delay, with a send buffer of 64 kB and probes that drop a silent peer after
// some two minutes. A failed accept, as without descriptors, is tried again after 0.1 s.
#include "server/acceptor.h"

#include <boost/asio/ip/address.hpp>
#include <boost/system/system_error.hpp>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <chrono>
#include <string>
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

/// Its text names no file, as that of a plain std::system_error would.
class ListenError : public std::system_error {
  public:
    // Asio's own category knows no std::errc.
    ListenError(const Endpoint& endpoint, const error_code& error)
        : std::system_error(error.value(), std::system_category()),
          text_("cannot listen on " + endpoint.address + ':' + std::to_string(endpoint.port) +
                " (" + error.message() + ')') {
        if (error == boost::system::errc::address_in_use)
            text_ +=
                ": stop the program that listens there, or take another port, 0 for a free one";
    }
    [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }

  private:
    std::string text_;
};

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
        throw ListenError(endpoint, error.code());
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
