// SPDX-License-Identifier: GPL-3.0-or-later
// One connection to simrun: sends requests and sorts the server's lines into answers, scans and
// events. The classes of roles are built on it; programs need it for requests that these lack.
#ifndef ISPACE_CLIENT_CONNECTION_H
#define ISPACE_CLIENT_CONNECTION_H

#include <cstddef>
#include <deque>
#include <string>

#include <ispace_client/message.h>
#include <ispace_client/socket.h>

namespace ispace {
namespace client {

/// Settings of a connection.
struct Options {
    double timeout = 10;  ///< seconds to wait for each answer
    std::string token;    ///< required by a server with --token-file
};

/// A dialogue in the Simulator TCP Protocol, version 1 (simrun(1)): requests, answers, and
/// unsolicited messages, which are stored until they are requested.
///
/// One thread at a time may use it. Open a connection for each robot and sensor, and take a role
/// soon: the server closes one that asks for none within a minute (408).
///
/// Unsolicited messages wait in queues of 10 000 ends and events and 64 scans; beyond these the
/// oldest is dropped. After the Timeout of an answer the connection remains usable: one that comes
/// late is recognised and dropped. It is not after a Timeout while sending ("takes no requests"),
/// which may leave a part of a line, nor after ConnectionError and ProtocolError.
///
///     Connection server("127.0.0.1:7001");
///     server.ask("WORLD");
///     const double t = server.ask("TIME").fields.number("t");
class Connection {
  public:
    /// Connects, reads the greeting and shows the token, if Options has one.
    /// \throws ConnectionError, Timeout, ProtocolError (another version), Refused (full, token)
    explicit Connection(const Address& address, const Options& options = Options())
        : options_(options), socket_(address, Deadline(options.timeout)) {
        const Deadline deadline(options_.timeout);
        Message greeting;
        if (!read(greeting, deadline)) throw Timeout("no greeting from " + address.text());
        if (greeting.line.compare(0, 7, "ISPACE ") != 0) {
            if (greeting.word(0) == "ERR") throwRefusal(greeting);
            throw ProtocolError(address.text() + " is no simrun: it says `" +
                                greeting.line.substr(0, 60) + "`");
        }
        if (greeting.line != "ISPACE 1")
            throw ProtocolError("the server speaks `" + greeting.line + "`, wanted ISPACE 1");
        if (!options_.token.empty()) ask("TOKEN " + options_.token);
    }

    /// Sends one request and waits for its answer, for Options::timeout.
    /// \throws Refused, Timeout, ConnectionError, ProtocolError
    Message ask(const std::string& request) { return ask(request, options_.timeout); }
    /// \param timeout seconds; infinity: no limit
    Message ask(const std::string& request, double timeout) {
        if (request.find('\n') != std::string::npos)
            throw Error("a request is one line, found two in `" + request + "`");
        const Deadline deadline(timeout);
        socket_.send(request + "\n", deadline);
        ++awaited_;
        while (answers_.empty() || awaited_ > 1) {
            if (!answers_.empty()) {
                // Answers an earlier request that timed out.
                answers_.pop_front();
                --awaited_;
                continue;
            }
            if (!take(deadline)) throw Timeout("no answer in time to " + request);
        }
        const Message answer = pop(answers_);
        --awaited_;
        if (answer.word(0) == "ERR") throwRefusal(answer);
        return answer;
    }

    /// Ends the dialogue; held robots are released when this returns. Later requests fail. Without
    /// it the server detects the end of a connection slightly later.
    void quit() { ask("QUIT"); }

    /// Waits for the next DONE or FAIL, EVENT, or scan of a stream.
    /// \return false on timeout, in seconds
    bool nextEnd(Message& message, double timeout) { return next(ends_, message, timeout); }
    bool nextEvent(Message& message, double timeout) { return next(events_, message, timeout); }
    bool nextScan(Message& message, double timeout) { return next(scans_, message, timeout); }
    /// Takes the next event that has been received, without waiting. \return false if there is none
    bool storedEvent(Message& message) {
        if (events_.empty()) return false;
        message = pop(events_);
        return true;
    }
    /// Drops unread scans of a stream.
    void dropScans() { scans_.clear(); }

    const Options& options() const { return options_; }

  private:
    static constexpr std::size_t kMaxKept = 10000;  // maximum stored events and ends
    static constexpr std::size_t kMaxScans = 64;

    [[noreturn]] static void throwRefusal(const Message& message) {
        const std::string code = message.word(1);
        const std::size_t begin = message.line.find(code, 3);
        const bool is_code = !code.empty() && code.find_first_not_of("0123456789") == code.npos;
        if (!is_code || code.size() > 3) throw ProtocolError("the server says " + message.line);
        const std::size_t text = begin + code.size() + 1;
        throw Refused(std::stoi(code), text < message.line.size() ? message.line.substr(text) : "");
    }

    static Message pop(std::deque<Message>& from) {
        Message message = from.front();
        from.pop_front();
        return message;
    }

    bool next(std::deque<Message>& from, Message& message, double timeout) {
        const Deadline deadline(timeout);
        while (from.empty())
            if (!take(deadline)) return false;
        message = pop(from);
        return true;
    }

    /// Reads one message and stores it by kind; false on timeout.
    bool take(const Deadline& deadline) {
        Message message;
        if (!read(message, deadline)) return false;
        const std::string kind = message.word(0);
        const bool streamed = kind == "SCAN" && message.fields.has("stream");
        if (kind == "DONE" || kind == "FAIL") {
            keep(ends_, message, kMaxKept);
        } else if (kind == "EVENT") {
            keep(events_, message, kMaxKept);
        } else if (streamed) {
            keep(scans_, message, kMaxScans);
        } else if (kind == "OK" || kind == "ERR" || kind == "SCAN") {
            // The server sends ERR unasked only before closing: too many clients, or no role in
            // time.
            if (awaited_ == 0 && kind == "ERR") throwRefusal(message);
            answers_.push_back(message);
        } else {
            throw ProtocolError("the server says `" + message.line.substr(0, 60) + "`");
        }
        return true;
    }

    static void keep(std::deque<Message>& where, const Message& message, std::size_t most) {
        if (where.size() >= most) where.pop_front();
        where.push_back(message);
    }

    /// Reads a line and its bytes; false if incomplete in time (keeps the partial input).
    bool read(Message& message, const Deadline& deadline) {
        std::size_t end = 0;
        while ((end = buffer_.find('\n', searched_)) == std::string::npos) {
            searched_ = buffer_.size();
            if (!socket_.receive(buffer_, deadline)) return false;
        }
        const bool carriage = end > 0 && buffer_[end - 1] == '\r';
        message = parseMessage(buffer_.substr(0, carriage ? end - 1 : end));
        std::size_t bytes = 0;
        const bool has_bytes =
            message.word(0) == "SCAN" || (message.word(0) == "OK" && message.word(1) == "RECORDS");
        if (has_bytes && message.fields.has("bytes")) {
            const double count = message.fields.number("bytes");
            if (!(count >= 0 && count <= 1e9)) throw ProtocolError("a frame of " + message.line);
            bytes = static_cast<std::size_t>(count);
        }
        searched_ = end;
        while (buffer_.size() < end + 1 + bytes)
            if (!socket_.receive(buffer_, deadline)) return false;
        message.data = buffer_.substr(end + 1, bytes);
        if (message.fields.has("base64")) message.data = fromBase64(message.fields.text("base64"));
        buffer_.erase(0, end + 1 + bytes);
        searched_ = 0;
        return true;
    }

    Options options_;
    Socket socket_;
    std::string buffer_;
    std::size_t searched_ = 0;  // the buffer before this holds no end of line
    std::deque<Message> answers_, ends_, events_, scans_;
    std::size_t awaited_ = 0;  // outstanding answers
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_CONNECTION_H
