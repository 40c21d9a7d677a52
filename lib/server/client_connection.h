// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/server, since it includes Asio.
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

/// Cuts a stream of bytes into lines that end in LF or CRLF. Holds at most one line of the greatest
/// length and one block, provided that lines are taken before more is appended.
class LineBuffer {
  public:
    /// `limit`: bytes of a line without its end.
    explicit LineBuffer(std::size_t limit) : limit_(limit) {}

    /// Drops the lines taken so far.
    void append(std::string_view bytes);
    /// True if there is a whole line.
    [[nodiscard]] bool ready() const { return end_ != std::string::npos; }
    /// True if the next line is longer than the limit, whole or not.
    [[nodiscard]] bool tooLong() const;
    [[nodiscard]] std::size_t memory() const { return bytes_.capacity(); }
    /// The next line without its end; valid until append(). \pre ready()
    std::string_view take();

  private:
    std::size_t limit_;
    std::string bytes_;
    std::size_t begin_ = 0;                // of the next line
    std::size_t end_ = std::string::npos;  // its LF
};

/// What is still to be sent on a connection: replies in order, and a scan that many connections
/// share.
class Outbox {
  public:
    void append(std::string_view text);
    /// \pre front() is empty
    void put(std::shared_ptr<const std::string> scan) { scan_ = std::move(scan); }
    /// The next piece to send, "" if there is none. Valid until the next call of another function.
    [[nodiscard]] std::string_view front() const;
    /// The first bytes of front() are sent.
    void pop(std::size_t bytes);
    /// Drops everything not sent yet. True if that cuts a line.
    bool abandon();
    /// Bytes of replies.
    [[nodiscard]] std::size_t unsent() const { return text_.size() - (scan_ ? 0 : sent_); }
    /// Bytes of the scan that is being sent.
    [[nodiscard]] std::size_t scanBytes() const { return scan_ ? scan_->size() : 0; }
    /// Memory that replies take.
    [[nodiscard]] std::size_t textMemory() const { return text_.capacity(); }

  private:
    std::shared_ptr<const std::string> scan_;  // goes before the text, which came while it was sent
    std::string text_;
    std::size_t sent_ = 0;  // of scan_, else of text_
    bool in_line_ = false;  // the last byte sent did not end a line
};

/// The transport of one session. It reads, answers, writes, and at the end waits for the other side
/// to close; handlers keep it alive until then.
class ClientConnection : public std::enable_shared_from_this<ClientConnection> {
  public:
    ClientConnection(asio::ip::tcp::socket socket, const ServerLimits& limits)
        : socket_(std::move(socket)),
          timer_(socket_.get_executor()),
          limits_(limits),
          lines_(limits.line) {}

    void serve(ServerState& state) {
        session_.emplace(state);
        out_.append(Session::greeting());
        heard_ = std::chrono::steady_clock::now();
        expectRole();
        pump();
    }
    /// Sends a whole line after what is pending, and closes.
    void refuse(std::string_view text) {
        out_.append(text);
        session_.reset();
        pump();
    }
    /// The same, but drops what is pending.
    void cutOff(std::string_view text);
    /// Ends the connection if it has no role and made no request since that time.
    void makeWay(WallTime since);
    /// The world took a step, or was changed. Without time for it now, what that is to send waits
    /// for the client's turn.
    void stepped(bool has_time);
    /// Other clients were served.
    void proceed();
    /// Stops what the client holds if it made no request since that time.
    void watch(WallTime since);
    /// True if it drives something and was not found to be silent since its last request.
    [[nodiscard]] bool watched() const {
        return session_ && session_->drives() && silent_since_ != heard_;
    }
    [[nodiscard]] bool waitsToChange() const { return session_ && session_->waitsToChange(); }
    [[nodiscard]] bool waiting() const { return session_ && session_->waiting(); }
    /// False also for one that awaits a STEP and has finished sending: its client may be gone, so
    /// it takes no place.
    [[nodiscard]] bool serving() const { return session_ && !(eof_ && waiting()); }
    [[nodiscard]] bool roleless() const { return session_ && !session_->hasRole(); }
    /// Time of its last request, or of its beginning.
    [[nodiscard]] WallTime heard() const { return heard_; }
    [[nodiscard]] bool closed() const { return !socket_.is_open(); }
    /// True once everything is sent and it only waits for the other side to close.
    [[nodiscard]] bool told() const { return discarding_; }

    /// Memory of its own.
    [[nodiscard]] std::size_t memory() const { return out_.textMemory() + lines_.memory(); }
    /// The same with scans, which others may hold too.
    [[nodiscard]] std::size_t holds() const {
        return memory() + out_.scanBytes() + (session_ ? session_->scanBytes() : 0);
    }
    /// Since when the oldest unsent byte has been waiting, or a little later.
    [[nodiscard]] WallTime waitingSince() const { return waiting_since_; }
    /// Sends what is pending and closes without waiting for the other side.
    void end();
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
    void flush();
    std::string_view nextPiece();
    void listen();
    void receive();
    void linger();
    void discard();
    void closeAfter(std::chrono::nanoseconds time);

    asio::ip::tcp::socket socket_;
    asio::steady_timer timer_;  // of taking a role; then of lingering
    ServerLimits limits_;
    LineBuffer lines_;
    std::optional<Session> session_;  // none: the connection is about to end
    Outbox out_;
    WallTime heard_{};
    WallTime silent_since_{};  // what heard_ was when the client was found to be silent
    // What was to be sent at a time and is not yet: the age of the oldest byte, or a little less.
    WallTime waiting_since_{};
    std::size_t owed_ = 0;
    bool reading_ = false, writing_ = false, posted_ = false;  // handlers on their way
    bool eof_ = false;
    bool ending_ = false;      // closes when all is sent, or after a while
    bool discarding_ = false;  // all is sent: waits for the other side
    bool last_ = false;        // waits no more
};

/// True if a call on a socket that does not block only has to be made again later.
bool wouldBlock(const boost::system::error_code& error);

/// Reads what has arrived and drops it, a bounded amount at a time, so that a connection about to
/// close is not reset by unread input. False once the other side has closed its end or is gone.
bool discardInput(boost::asio::ip::tcp::socket& socket);

}  // namespace ispace
