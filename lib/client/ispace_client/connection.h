// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef ISPACE_CLIENT_CONNECTION_H
#define ISPACE_CLIENT_CONNECTION_H

#include <cstddef>
#include <deque>
#include <string>

#include <ispace_client/message.h>
#include <ispace_client/socket.h>

namespace ispace {
namespace client {

/// How to connect, and how long to wait.
struct Options {
    double timeout = 10;  ///< seconds to wait for each answer
    std::string token;    ///< of a server with --token-file; empty: none
};

/// A dialogue in the Simulator TCP Protocol, version 1 (simrun(1)): requests, their answers, and
/// what the server says of itself in between, which is kept until it is asked for.
///
/// One thread at a time may use it. Open a connection for each robot and sensor.
class Connection {
  public:
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
    /// \param timeout seconds; infinity waits for ever
    Message ask(const std::string& request, double timeout) {
        if (request.find('\n') != std::string::npos)
            throw Error("a request is one line, found two in `" + request + "`");
        const Deadline deadline(timeout);
        socket_.send(request + "\n", deadline);
        ++awaited_;
        while (answers_.empty() || awaited_ > 1) {
            if (!answers_.empty()) {
                // Of an earlier request whose caller did not wait for it.
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

    /// Ends the dialogue; what was held is free when this returns. Nothing can be asked after it.
    /// Without it the server learns of the end of a connection a moment later.
    void quit() { ask("QUIT"); }

    /// The next DONE or FAIL, EVENT, or scan of a stream; waits for it.
    /// \return false if none came within so many seconds
    bool nextEnd(Message& message, double timeout) { return next(ends_, message, timeout); }
    bool nextEvent(Message& message, double timeout) { return next(events_, message, timeout); }
    bool nextScan(Message& message, double timeout) { return next(scans_, message, timeout); }
    /// Drops the scans of a stream that nobody has asked for.
    void dropScans() { scans_.clear(); }

    const Options& options() const { return options_; }

  private:
    static constexpr std::size_t kMaxKept = 10000;  // events and ends that nobody asks for
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

    /// Takes one message to where it belongs; false if none came in time.
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
            // The server speaks first only to close: of too many clients, of one without a role.
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

    /// Reads a line and its bytes; false if they are not there in time (what came is kept).
    bool read(Message& message, const Deadline& deadline) {
        std::size_t end = 0;
        while ((end = buffer_.find('\n', searched_)) == std::string::npos) {
            searched_ = buffer_.size();
            if (!socket_.receive(buffer_, deadline)) return false;
        }
        const bool carriage = end > 0 && buffer_[end - 1] == '\r';
        message = parseMessage(buffer_.substr(0, carriage ? end - 1 : end));
        std::size_t bytes = 0;
        if (message.word(0) == "SCAN" && message.fields.has("bytes")) {
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
    std::size_t searched_ = 0;  // bytes of the buffer before this have no end of line
    std::deque<Message> answers_, ends_, events_, scans_;
    std::size_t awaited_ = 0;  // answers to requests that were sent
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_CONNECTION_H
