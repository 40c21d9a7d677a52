// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of the server: a server in a thread, and clients of it.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <string>
#include <string_view>
#include <thread>

#include "server/server.h"
#include "support/test_world.h"

namespace ispace::testing {

/// Far more than any test here takes: a test that reaches it has failed.
constexpr int kPatience = 60;

/// A blocking client that is driven line by line.
class Client {
  public:
    explicit Client(std::uint16_t port, int receive_buffer = 0)
        : socket_(::socket(AF_INET, SOCK_STREAM, 0)), port_(port) {
        EXPECT_GE(socket_, 0);
        const timeval patience{kPatience, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        if (receive_buffer > 0)
            ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    ~Client() { close(); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    Client& connect() {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port_);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address),
                  0);
        return *this;
    }
    /// Connects and requests a role.
    Client& take(const std::string& role) {
        connect();
        EXPECT_EQ(line(), "ISPACE 1");
        EXPECT_EQ(ask(role).substr(0, 3), "OK ");
        return *this;
    }
    /// Resets the connection, so that the other side sees its end at once.
    void reset() {
        const linger at_once{1, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
        close();
    }
    /// Returns false if the other side has closed.
    bool send(std::string_view text) {
        while (!text.empty()) {
            const auto sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
            if (sent <= 0) return false;
            text.remove_prefix(static_cast<std::size_t>(sent));
        }
        return true;
    }
    /// Reads a line without its newline, or the remaining bytes if the other side has closed.
    std::string line() {
        std::string out;
        for (char c = 0; bytes(&c, 1) && c != '\n';) out += c;
        return out;
    }
    std::string ask(std::string_view request) {
        EXPECT_TRUE(send(std::string(request) + "\n"));
        return line();
    }
    /// Reads all bytes up to the end of the connection.
    std::string rest() {
        std::string out;
        for (char c = 0; bytes(&c, 1);) out += c;
        return out;
    }
    /// Reads `count` bytes; returns false at the end of the connection.
    bool bytes(char* to, std::size_t count) {
        while (count > 0) {
            if (begin_ == end_) {
                const auto got = ::recv(socket_, block_.data(), block_.size(), 0);
                EXPECT_FALSE(got < 0 && errno == EAGAIN) << "no answer";
                if (got <= 0) return false;
                begin_ = 0;
                end_ = static_cast<std::size_t>(got);
            }
            const std::size_t some = std::min(count, end_ - begin_);
            std::copy_n(block_.data() + begin_, some, to);
            begin_ += some;
            to += some;
            count -= some;
        }
        return true;
    }
    /// Returns the client's port.
    [[nodiscard]] std::uint16_t port() const {
        sockaddr_in address{};
        socklen_t size = sizeof address;
        EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
        return ntohs(address.sin_port);
    }
    void finishSending() { ::shutdown(socket_, SHUT_WR); }
    /// Disconnects with a reset.
    void vanish() {
        const linger none{1, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &none, sizeof none);
        close();
    }
    void close() {
        if (socket_ >= 0) ::close(std::exchange(socket_, -1));
    }
    /// Returns true if no bytes are waiting.
    bool quiet() {
        pollfd state{socket_, POLLIN, 0};
        return begin_ == end_ && ::poll(&state, 1, 0) == 0;
    }

  private:
    int socket_;
    std::uint16_t port_;
    std::array<char, 65536> block_{};
    std::size_t begin_ = 0, end_ = 0;
};

/// A server in a separate thread.
class Running {
  public:
    explicit Running(Clock clock = {Clock::Kind::Step, 1}, const ServerLimits& limits = {},
                     const std::string& more = "")
        : room_(clock, {}, "", more),
          server_(room_.simulation, parseEndpoint("127.0.0.1:0"), limits),
          thread_([this] { server_.run(); }) {}
    ~Running() { stop(); }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    void stop() {
        if (!thread_.joinable()) return;
        server_.stop();
        thread_.join();
    }
    /// Waits for its end without requesting it.
    void join() { thread_.join(); }
    Server& server() { return server_; }
    std::uint16_t port() { return server_.port(); }

  private:
    TestWorld room_;
    Server server_;
    std::thread thread_;
};

/// Waits until the condition holds.
template <typename Condition>
bool soon(Condition is_so) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(kPatience);
    while (std::chrono::steady_clock::now() < deadline)
        if (is_so()) return true;
    return false;
}

/// Repeats a request until the answer is the expected one.
inline bool comes(Client& client, const std::string& request, std::string_view wanted) {
    return soon([&] { return client.ask(request).starts_with(wanted); });
}

inline std::string step(Client& world, int count) {
    return world.ask("STEP " + std::to_string(count));
}

}  // namespace ispace::testing
