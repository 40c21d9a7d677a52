// SPDX-License-Identifier: GPL-3.0-or-later
// Sockets of the system, for a program's own dialogues: their waits are wall time, and hold the
// robot's cycle up if it makes them. Not safe for several threads at once.
#ifndef SIM_ARIA_TCP_SOCKET_H
#define SIM_ARIA_TCP_SOCKET_H

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

/// A socket of the program, IPv4.
class ArSocket {
  public:
    enum Type { UNKNOWN, TCP, UDP };
    enum Error { NoErr, NetFail, ConBadHost, ConNoRoute, ConRefused };

    ArSocket() {}
    ArSocket(const char* host, int port, Type type) { connect(host, port, type); }
    ArSocket(int port, bool /*doClose*/, Type type) { open(port, type); }
    virtual ~ArSocket() { close(); }
    ArSocket(const ArSocket&) = delete;
    ArSocket& operator=(const ArSocket&) = delete;

    bool connect(const char* host, int port, Type type = TCP) {
        close();
        addrinfo wanted = {}, *found = nullptr;
        wanted.ai_family = AF_INET;
        wanted.ai_socktype = kind(type);
        const int failed = getaddrinfo(host, std::to_string(port).c_str(), &wanted, &found);
        if (failed != 0) return fail(ConBadHost, gai_strerror(failed));
        std::memcpy(&myPeer, found->ai_addr, sizeof myPeer);
        freeaddrinfo(found);
        myType = type;
        myFile = ::socket(AF_INET, kind(type), 0);
        if (myFile < 0) return fail(NetFail);
        if (::connect(myFile, reinterpret_cast<const sockaddr*>(&myPeer), sizeof myPeer) == 0)
            return succeed();
        const Error error = errno == ECONNREFUSED                           ? ConRefused
                            : errno == EHOSTUNREACH || errno == ENETUNREACH ? ConNoRoute
                                                                            : NetFail;
        fail(error);
        ::close(myFile);
        myFile = -1;
        return false;
    }
    /// Listens. \param host address to listen at; null: all
    bool open(int port, Type type = TCP, const char* host = nullptr) {
        close();
        myType = type;
        myPeer = sockaddr_in();
        myPeer.sin_family = AF_INET;
        myPeer.sin_port = htons(static_cast<std::uint16_t>(port));
        if (host && inet_pton(AF_INET, host, &myPeer.sin_addr) != 1)
            return fail(ConBadHost, "no address");
        myFile = ::socket(AF_INET, kind(type), 0);
        if (myFile < 0) return fail(NetFail);
        const int on = 1;
        setsockopt(myFile, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        const auto* const address = reinterpret_cast<const sockaddr*>(&myPeer);
        if (::bind(myFile, address, sizeof myPeer) == 0 &&
            (type != TCP || ::listen(myFile, 5) == 0)) {
            socklen_t length = sizeof myPeer;
            getsockname(myFile, reinterpret_cast<sockaddr*>(&myPeer), &length);
            return succeed();
        }
        fail(NetFail);
        ::close(myFile);
        myFile = -1;
        return false;
    }
    bool accept(ArSocket* client) {
        client->close();
        socklen_t length = sizeof client->myPeer;
        client->myFile = ::accept(myFile, reinterpret_cast<sockaddr*>(&client->myPeer), &length);
        client->myType = myType;
        if (client->myFile < 0 && errno != EWOULDBLOCK) return fail(NetFail);
        return succeed();
    }
    bool close() {
        const bool good = myFile < 0 || ::close(myFile) == 0;
        myFile = -1;
        return good;
    }
    bool isOpen() const { return myFile >= 0; }

    /// \param msWait ms to wait for the first byte; 0: as the socket is set
    /// \return bytes read; 0: closed, or none in time; -1: an error
    int read(void* buffer, std::size_t length, unsigned int msWait = 0) {
        if (msWait > 0) {
            pollfd ready = {myFile, POLLIN, 0};
            if (poll(&ready, 1, static_cast<int>(msWait)) == 0) return 0;
        }
        return static_cast<int>(::recv(myFile, buffer, length, 0));
    }
    int write(const void* buffer, std::size_t length) {
        return static_cast<int>(::send(myFile, buffer, length, MSG_NOSIGNAL));
    }
    /// Writes a line.
    int writeString(const char* text, ...) __attribute__((format(printf, 2, 3))) {
        char line[10000];
        va_list values;
        va_start(values, text);
        std::vsnprintf(line, sizeof line, text, values);
        va_end(values);
        const std::string whole = std::string(line) + "\r\n";
        return write(whole.data(), whole.size());
    }
    /// Reads a line, without its end; empty if none is complete.
    std::string readString() {
        char byte = 0;
        while (::recv(myFile, &byte, 1, 0) == 1) {
            if (byte != '\n' && byte != '\r') {
                myLine += byte;
            } else if (!myLine.empty()) {
                const std::string line = myLine;
                myLine.clear();
                return line;
            }
        }
        return "";
    }
    bool setNonBlock() { return fcntl(myFile, F_SETFL, fcntl(myFile, F_GETFL) | O_NONBLOCK) == 0; }
    int getFD() const { return myFile; }
    Type getType() const { return myType; }
    Error getError() const { return myError; }
    const std::string& getErrorStr() const { return myText; }
    /// Address of the other side, or the own one of a socket that listens.
    const char* getIPString() {
        char text[INET_ADDRSTRLEN] = "";
        inet_ntop(AF_INET, &myPeer.sin_addr, text, sizeof text);
        myAddress = text;
        return myAddress.c_str();
    }
    int getPortNumber() const { return ntohs(myPeer.sin_port); }

  private:
    static int kind(Type type) { return type == UDP ? SOCK_DGRAM : SOCK_STREAM; }
    bool succeed() {
        myError = NoErr;
        myText.clear();
        return true;
    }
    bool fail(Error error, const char* text = nullptr) {
        myError = error;
        myText = text ? text : std::strerror(errno);
        return false;
    }

    int myFile = -1;
    Type myType = UNKNOWN;
    Error myError = NoErr;
    sockaddr_in myPeer = {};
    std::string myText, myAddress, myLine;
};

#endif  // SIM_ARIA_TCP_SOCKET_H
