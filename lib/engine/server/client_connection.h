// SPDX-License-Identifier: GPL-3.0-or-later
// For lib/engine/server and its bridges, since it includes Asio.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/system/error_code.hpp>

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/server.h"
#include "server/session.h"

namespace ispace {

namespace asio = boost::asio;
using boost::system::error_code;

/// Returns the address of the other side, without its port; "" once it has gone.
inline std::string peerOf(const asio::ip::tcp::socket& socket) {
    error_code error;
    const auto peer = socket.remote_endpoint(error);
    return error ? "" : peer.address().to_string();
}

/// Splits a byte stream into lines that end in LF or CRLF. Holds at most one line of the maximum
/// length and one block, provided that lines are taken before more bytes are appended.
class LineBuffer {
  public:
    /// \param limit bytes of a line without its end
    explicit LineBuffer(std::size_t limit) : limit_(limit) {}

    /// Appends bytes, and drops the lines taken so far.
    void append(std::string_view bytes);
    /// True if the buffer holds a complete line.
    [[nodiscard]] bool ready() const { return end_ != std::string::npos; }
    /// True if the next line, complete or not, exceeds the limit.
    [[nodiscard]] bool tooLong() const;
    [[nodiscard]] std::size_t memory() const { return bytes_.capacity(); }
    /// Returns the next line without its end; valid until append(). \pre ready()
    [[nodiscard]] std::string_view front() const;
    /// Likewise, and goes on to the line after it.
    std::string_view take();

  private:
    std::size_t limit_;
    std::string bytes_;
    std::size_t begin_ = 0;                // start of the next line
    std::size_t end_ = std::string::npos;  // position of its LF
};

/// Unsent output of a connection: replies in order, and a scan shared with other connections. A
/// scan that has begun is sent whole, before the replies that came meanwhile: lines never mix.
/// Amortised one move for each byte.
class Outbox {
  public:
    void append(std::string_view text);
    /// \pre front() is empty
    void put(std::shared_ptr<const std::string> scan) { scan_ = std::move(scan); }
    /// The next bytes to send, or "". Valid until the next call of another function.
    [[nodiscard]] std::string_view front() const;
    /// Removes the sent bytes from front().
    void pop(std::size_t bytes);
    /// Drops all unsent output. \returns true if that cuts a line
    bool abandon();
    /// Bytes of unsent replies.
    [[nodiscard]] std::size_t unsent() const { return text_.size() - (scan_ ? 0 : sent_); }
    /// Bytes of the scan being sent.
    [[nodiscard]] std::size_t scanBytes() const { return scan_ ? scan_->size() : 0; }
    /// Memory held by replies.
    [[nodiscard]] std::size_t textMemory() const { return text_.capacity(); }

  private:
    std::shared_ptr<const std::string> scan_;  // sent before text_, which was appended meanwhile
    std::string text_;
    std::size_t sent_ = 0;  // of scan_, else of text_
    bool in_line_ = false;  // the last byte sent did not end a line
};

/// The transport of one session. It reads requests, writes answers, and finally waits for the peer
/// to close; pending handlers keep it alive until then.
///
/// Backpressure: while more than ServerLimits::pending bytes are unsent, further requests stay in
/// the buffer of the system, and TCP slows the client. One client's turn ends after 64 requests or
/// 0.2 ms. A closing connection reads and drops input for up to a second after its last byte, since
/// closing with unread input would reset it and the peer might lose that byte.
///
/// Used by the server's thread alone.
class ClientConnection : public std::enable_shared_from_this<ClientConnection> {
  public:
    /// \param socket of Acceptor: non-blocking \pre owned by a std::shared_ptr before any call
    ClientConnection(asio::ip::tcp::socket socket, const ServerLimits& limits)
        : socket_(std::move(socket)),
          timer_(socket_.get_executor()),
          limits_(limits),
          lines_(limits.line) {}

    /// Greets the client and answers its requests from now on. \pre `state` outlives the session
    void serve(ServerState& state) {
        session_.emplace(state, peerOf(socket_));
        out_.append(Session::greeting());
        heard_ = std::chrono::steady_clock::now();
        expectRole();
        pump();
    }
    /// Sends pending output and a line, then closes.
    void refuse(std::string_view text) {
        out_.append(text);
        session_.reset();
        pump();
    }
    /// Drops pending output, sends a line, then closes.
    void cutOff(std::string_view text);
    /// Ends the connection if it has no role and made no request since that time.
    void makeWay(WallTime since);
    /// Call after each step or change of the world. Without time for it now, the new output waits
    /// for the client's turn.
    void stepped(bool has_time);
    /// Call after other clients were served.
    void proceed();
    /// Stops the client's robot or person if the client made no request since that time.
    void watch(WallTime since);
    /// True if the client drives a mover and was not found silent since its last request.
    [[nodiscard]] bool watched() const {
        return session_ && session_->drives() && silent_since_ != heard_;
    }
    [[nodiscard]] bool waitsToChange() const { return session_ && session_->waitsToChange(); }
    [[nodiscard]] bool waiting() const { return session_ && session_->waiting(); }
    /// False also for a client that awaits a STEP and has finished sending: it may be gone, so it
    /// does not count towards the limit of clients.
    [[nodiscard]] bool serving() const { return session_ && !(eof_ && waiting()); }
    [[nodiscard]] bool roleless() const { return session_ && !session_->hasRole(); }
    /// Time of the last request, initially of the connection.
    [[nodiscard]] WallTime heard() const { return heard_; }
    [[nodiscard]] bool closed() const { return !socket_.is_open(); }
    /// True once all output is sent and the connection only waits for the peer to close.
    [[nodiscard]] bool told() const { return discarding_; }

    /// Memory held by this connection alone.
    [[nodiscard]] std::size_t memory() const { return out_.textMemory() + lines_.memory(); }
    /// memory() plus scans, which may be shared with other connections.
    [[nodiscard]] std::size_t holds() const {
        return memory() + out_.scanBytes() + (session_ ? session_->scanBytes() : 0);
    }
    /// Time since which the oldest unsent byte has been waiting, or a little later.
    [[nodiscard]] WallTime waitingSince() const { return waiting_since_; }
    /// True while the peer leaves output unread.
    [[nodiscard]] bool owes() const { return session_ && writing_ && owed_ > 0; }
    /// Ends pending requests, sends their answers and closes without waiting for the peer.
    void end();
    /// Closes at once; unsent output is lost.
    void close();

  private:
    [[nodiscard]] bool mayAnswer() const {
        return session_ && !session_->waiting() && !session_->closing() &&
               out_.unsent() <= limits_.pending;
    }
    void expectRole();
    void catchUp();
    void goOn(bool waited);
    void pump();
    void pumpLater();
    void answer();
    void answerNext();
    void flush();
    std::string_view nextPiece();
    void listen();
    void receive();
    void linger();
    void discard();
    void closeAfter(std::chrono::nanoseconds time);

    asio::ip::tcp::socket socket_;
    asio::steady_timer timer_;  // limits the time without a role, then lingering
    ServerLimits limits_;
    LineBuffer lines_;
    std::optional<Session> session_;  // empty: the connection is about to end
    Outbox out_;
    WallTime heard_{};
    WallTime silent_since_{};  // heard_ at the time the client was found silent
    // Reference time for the age of unsent output: at or shortly after the oldest byte was queued.
    WallTime waiting_since_{};
    std::size_t owed_ = 0;
    bool reading_ = false, writing_ = false, posted_ = false;  // handlers pending
    bool eof_ = false;
    bool ending_ = false;      // closes once all output is sent, or after a timeout
    bool discarding_ = false;  // all output is sent: waits for the peer to close
    bool last_ = false;        // closes without waiting for the peer
};

/// True if a call on a non-blocking socket must be repeated later: no data, no room, a signal.
bool wouldBlock(const boost::system::error_code& error);

/// Reads and drops arrived bytes, at most 64 KiB per call, so that unread input does not reset a
/// closing connection. \returns false once the peer has closed its end or is gone
bool discardInput(boost::asio::ip::tcp::socket& socket);

}  // namespace ispace
