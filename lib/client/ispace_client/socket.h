// SPDX-License-Identifier: GPL-3.0-or-later
// TCP with time limits, over sockets of POSIX: addresses, deadlines and a byte stream. Times are
// wall time.
#ifndef ISPACE_CLIENT_SOCKET_H
#define ISPACE_CLIENT_SOCKET_H

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <limits>
#include <memory>
#include <string>

#include <ispace_client/error.h>
#include <ispace_client/message.h>

namespace ispace {
namespace client {

/// Address of a server.
struct Address {
    std::string host = "127.0.0.1";
    unsigned short port = 0;

    Address() = default;
    Address(const std::string& server, unsigned short number) : host(server), port(number) {}
    /// Parses "HOST:PORT", as in `listen` of the first line of simrun, or "[::1]:7001".
    /// \throws Error for other texts
    Address(const std::string& text) {  // NOLINT: a text is an address
        const std::size_t colon = text.rfind(':');
        const std::string number = colon == std::string::npos ? "" : text.substr(colon + 1);
        const bool is_number = !number.empty() && number.size() < 6 &&
                               number.find_first_not_of("0123456789") == std::string::npos;
        const int value = is_number ? std::stoi(number) : 0;
        if (colon == 0 || value < 1 || value > 65535)
            throw Error("`" + text + "` is no address, wanted HOST:PORT, like 127.0.0.1:7001");
        host = text.substr(0, colon);
        if (host.size() > 2 && host[0] == '[') host = host.substr(1, host.size() - 2);
        port = static_cast<unsigned short>(value);
    }
    Address(const char* text) : Address(std::string(text)) {}  // NOLINT: as above

    std::string text() const { return host + ":" + std::to_string(port); }
};

/// Time limit of an operation.
class Deadline {
  public:
    /// \param seconds from now; infinity: no limit
    explicit Deadline(double seconds) {
        if (seconds < 1e9) {
            end_ = std::chrono::steady_clock::now() +
                   std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                       std::chrono::duration<double>(std::max(seconds, 0.0)));
        } else {
            never_ = true;
        }
    }
    /// Returns the remaining time for poll(): milliseconds, rounded up, 0 after the limit, -1
    /// without one.
    int left() const {
        if (never_) return -1;
        const auto time = end_ - std::chrono::steady_clock::now();
        const auto ms = std::chrono::duration_cast<std::chrono::microseconds>(time).count();
        return static_cast<int>(std::min<long long>(std::max<long long>(ms + 999, 0) / 1000,
                                                    std::numeric_limits<int>::max()));
    }

  private:
    std::chrono::steady_clock::time_point end_;
    bool never_ = false;
};

/// A TCP connection; calls block no longer than their deadline, except for the resolution of a
/// host's name, which the system bounds. Sends without delay (TCP_NODELAY), raises no SIGPIPE.
class Socket {
  public:
    /// \throws ConnectionError, Timeout
    Socket(const Address& address, const Deadline& deadline) {
        addrinfo hints;
        std::memset(&hints, 0, sizeof hints);
        hints.ai_family = AF_UNSPEC;
        hints.ai_socktype = SOCK_STREAM;
        addrinfo* found = nullptr;
        const std::string port = std::to_string(address.port);
        const int code = getaddrinfo(address.host.c_str(), port.c_str(), &hints, &found);
        if (code != 0)
            throw ConnectionError(address.text() + ": " + std::string(gai_strerror(code)));
        const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, freeaddrinfo);
        int error = 0;
        for (const addrinfo* at = found; at && fd_ < 0; at = at->ai_next)
            error = open(*at, deadline);
        if (fd_ >= 0) return;
        const std::string what = address.text() + ": " + std::strerror(error);
        if (error == ETIMEDOUT) throw Timeout(what);
        throw ConnectionError(error == ECONNREFUSED ? what + " (is simrun running?)" : what);
    }
    ~Socket() { ::close(fd_); }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;

    /// \throws ConnectionError, Timeout (after a partial write: close the connection)
    void send(const std::string& bytes, const Deadline& deadline) {
        for (std::size_t sent = 0; sent < bytes.size();) {
            const ssize_t n = ::send(fd_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
            if (n > 0) {
                sent += static_cast<std::size_t>(n);
            } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
                if (!ready(POLLOUT, deadline)) throw Timeout("the server takes no requests");
            } else if (errno != EINTR) {
                throw ConnectionError("the server is gone: " + std::string(std::strerror(errno)));
            }
        }
    }

    /// Appends available input to `bytes`. \return false on timeout
    /// \throws ConnectionError
    bool receive(std::string& bytes, const Deadline& deadline) {
        char buffer[65536];
        for (;;) {
            const ssize_t n = ::recv(fd_, buffer, sizeof buffer, 0);
            if (n > 0) {
                bytes.append(buffer, static_cast<std::size_t>(n));
                return true;
            }
            if (n == 0) throw ConnectionError("the server has closed the connection");
            if (errno == EAGAIN || errno == EWOULDBLOCK) {
                if (!ready(POLLIN, deadline)) return false;
            } else if (errno != EINTR) {
                throw ConnectionError("the server is gone: " + std::string(std::strerror(errno)));
            }
        }
    }

  private:
    /// \return 0, or the error of opening it
    int open(const addrinfo& at, const Deadline& deadline) {
        fd_ = ::socket(at.ai_family, at.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, at.ai_protocol);
        if (fd_ < 0) return errno;
        int error = ::connect(fd_, at.ai_addr, at.ai_addrlen) == 0 ? 0 : errno;
        if (error == EINPROGRESS) {
            socklen_t size = sizeof error;
            if (!ready(POLLOUT, deadline)) {
                error = ETIMEDOUT;
            } else if (::getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size) != 0) {
                error = errno;
            }
        }
        if (error == 0) {
            // Requests are short, and each awaits its answer.
            const int on = 1;
            ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
            return 0;
        }
        ::close(fd_);
        fd_ = -1;
        return error;
    }

    bool ready(short what, const Deadline& deadline) const {
        for (;;) {
            pollfd poll = {fd_, what, 0};
            const int n = ::poll(&poll, 1, deadline.left());
            if (n > 0) return true;
            if (n == 0) return false;
            if (errno != EINTR) throw ConnectionError(std::strerror(errno));
        }
    }

    int fd_ = -1;
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_SOCKET_H
