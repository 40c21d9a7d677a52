// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/socket_input.h"

#include <array>

namespace ispace {

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
