// SPDX-License-Identifier: GPL-3.0-or-later
// For lib/engine/server and its bridges, since it includes Asio.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include <cstdint>
#include <functional>
#include <string>

#include "server/network.h"

namespace ispace {

/// Listens at an endpoint and passes on accepted sockets in non-blocking mode.
///
/// They send without delay (TCP_NODELAY) from a system buffer of 64 KiB, since a larger one would
/// hold outdated scans. Keepalive drops a peer that has vanished after two minutes: it is probed
/// after 60 s of silence, six times, 10 s apart. If accepting fails, as without a free descriptor,
/// it is tried again each 100 ms. An address in TIME_WAIT can be used at once (SO_REUSEADDR).
///
/// Handlers run in the thread of `io`, which outlives the acceptor.
class Acceptor {
  public:
    using Welcome = std::function<void(boost::asio::ip::tcp::socket)>;

    /// \throws std::system_error naming the endpoint
    Acceptor(boost::asio::io_context& io, const Endpoint& endpoint, Welcome welcome);

    /// "127.0.0.1", "[::1]"
    [[nodiscard]] std::string host() const;
    /// "127.0.0.1:40123", "[::1]:40123"
    [[nodiscard]] std::string address() const { return host() + ":" + std::to_string(port()); }
    /// The port in use, which the system chose if the endpoint's was 0.
    [[nodiscard]] std::uint16_t port() const { return local_.port(); }
    /// Stops listening; sockets passed on stay open.
    void close();

  private:
    void accept();

    boost::asio::ip::tcp::acceptor acceptor_;
    boost::asio::steady_timer pause_;
    boost::asio::ip::tcp::endpoint local_;
    Welcome welcome_;
};

}  // namespace ispace
