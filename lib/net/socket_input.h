// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/net, since it includes Asio.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/system/error_code.hpp>

namespace ispace {

/// True if a call on a socket that does not block only has to be made again later.
bool wouldBlock(const boost::system::error_code& error);

/// Reads what has arrived and drops it, a bounded amount at a time, so that a connection about to
/// close is not reset by unread input. False once the other side has closed its end or is gone.
bool discardInput(boost::asio::ip::tcp::socket& socket);

}  // namespace ispace
