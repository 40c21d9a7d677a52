// SPDX-License-Identifier: GPL-3.0-or-later
// Browsers: requests of HTTP from the first byte, where the input begins like one, else the frames
// of a WebSocket after its handshake, in pieces. A connection ends with its client, and sends whole
// frames.
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "extensions/web/web_connection.h"
#include "extensions/web/web_page.h"
#include "fuzz.h"
#include "served_room.h"

namespace {

using namespace ispace;

constexpr std::string_view kHandshake =
    "GET /ws HTTP/1.1\r\nHost: 127.0.0.1:8000\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";

/// A connection and the browser's end of it.
class Browser {
  public:
    Browser() {
        std::array<int, 2> ends{};
        fuzz::require(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data()) == 0,
                      "no pair of sockets");
        end_ = ends[0];
        boost::asio::ip::tcp::socket socket(io_);
        socket.assign(boost::asio::ip::tcp::v4(), ends[1]);
        page_.settle("127.0.0.1", 8000);
        connection_ = web::serveBrowser(std::move(socket), page_, room_.state().limits());
    }
    ~Browser() {
        connection_->close();
        io_.poll();
        ::close(end_);
    }
    Browser(const Browser&) = delete;
    Browser& operator=(const Browser&) = delete;

    void send(std::string_view bytes) {
        while (!bytes.empty() && !connection_->closed()) {
            const ssize_t sent = ::send(end_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent > 0) bytes.remove_prefix(static_cast<std::size_t>(sent));
            serve();
        }
    }
    /// The browser sends no more: all that the server still says.
    std::string finish() {
        ::shutdown(end_, SHUT_WR);
        constexpr int kRounds = 64;
        for (int i = 0; i < kRounds && !connection_->closed(); ++i) serve();
        if (!connection_->closed()) connection_->end();
        for (int i = 0; i < kRounds && !connection_->closed(); ++i) serve();
        fuzz::require(connection_->closed(), "a connection outlives its client");
        return take();
    }
    std::string take() { return std::exchange(received_, {}); }

  private:
    /// One turn of the server's loop.
    void serve() {
        io_.restart();
        io_.poll();
        room_.run([this] { connection_->stepped(); });
        if (connection_->waiting()) connection_->proceed();
        if (connection_->wantsFrame()) {
            page_.look(std::chrono::steady_clock::now());
            connection_->offerFrame();
        }
        std::array<char, 65536> block{};
        for (;;) {
            const ssize_t n = ::recv(end_, block.data(), block.size(), 0);
            if (n <= 0) return;
            received_.append(block.data(), static_cast<std::size_t>(n));
        }
    }

    fuzz::ServedRoom room_;
    web::WebPage page_{room_.state(), "room.env", {}};
    boost::asio::io_context io_;
    std::shared_ptr<web::WebConnection> connection_;
    int end_ = -1;
    std::string received_;
};

/// Frames of a server: known kinds, unmasked, each whole but the last.
void checkFrames(std::string_view bytes) {
    constexpr std::size_t kShort = 126, kLong = 127;
    while (bytes.size() >= 2) {
        const auto kind = static_cast<unsigned char>(bytes[0]) & 0x7fU;
        fuzz::require(kind <= 2 || (kind >= 8 && kind <= 10), "a frame of an unknown kind");
        std::size_t size = static_cast<unsigned char>(bytes[1]);
        fuzz::require(size <= kLong, "a masked frame of a server");
        const std::size_t more = size == kShort ? 2 : size == kLong ? 8 : 0;
        if (bytes.size() < 2 + more) return;
        if (more > 0) size = 0;
        for (std::size_t i = 0; i < more; ++i)
            size = size << 8U | static_cast<unsigned char>(bytes[2 + i]);
        bytes.remove_prefix(std::min(2 + more + size, bytes.size()));
    }
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    const std::size_t piece = takePieceSize(bytes);
    Browser browser;
    const bool is_http = bytes.starts_with("GET") || bytes.starts_with("HEAD");
    if (!is_http) {
        browser.send(kHandshake);
        std::string answer = browser.take();
        const std::size_t end = answer.find("\r\n\r\n");
        require(answer.starts_with("HTTP/1.1 101 ") && end != std::string::npos, "no WebSocket");
    }
    for (; !bytes.empty(); bytes.remove_prefix(std::min(piece, bytes.size())))
        browser.send(bytes.substr(0, piece));
    const std::string answer = browser.finish();
    if (is_http)
        require(answer.empty() || answer.starts_with("HTTP/1.1 "), "an answer that is no HTTP");
    else
        checkFrames(answer);
}
