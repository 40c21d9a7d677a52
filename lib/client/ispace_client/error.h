// SPDX-License-Identifier: GPL-3.0-or-later
// The exceptions of this library. Error is the base of all; Refused has the server's code.
//
//     try {
//         Robot robot("127.0.0.1:7001", "r1");
//     } catch (const Refused& refused) {
//         if (refused.code() == 409) waitForTurn();  // another client drives it
//     }
#ifndef ISPACE_CLIENT_ERROR_H
#define ISPACE_CLIENT_ERROR_H

#include <stdexcept>
#include <string>

namespace ispace {
namespace client {

/// Base of all exceptions of this library; what() is a sentence for people, and not stable.
class Error : public std::runtime_error {
  public:
    explicit Error(const std::string& what) : std::runtime_error(what) {}
};

/// No server at this address, or it has closed the connection.
class ConnectionError : public Error {
  public:
    explicit ConnectionError(const std::string& what) : Error(what) {}
};

/// The answer has not arrived in time; the server may still do what was asked. The connection
/// remains usable: a late answer is dropped. Not so if the request could not be sent in time, see
/// Connection.
class Timeout : public Error {
  public:
    explicit Timeout(const std::string& what) : Error(what) {}
};

/// The server's message does not follow the protocol known to this library.
class ProtocolError : public Error {
  public:
    explicit ProtocolError(const std::string& what) : Error(what) {}
};

/// The server answered `ERR code text`; what() is its text.
class Refused : public Error {
  public:
    Refused(int code, const std::string& text) : Error(text), code_(code) {}
    /// 400 syntax, 401 token, 403 not allowed in this run, 404 unknown name or one that is gone,
    /// 405 not in this role or not now, 408 no role in time, 409 held by another client or
    /// impossible as the world is, 413 too long, 416 out of range, 429 too many. The server closes
    /// the connection after 408 and 413, after 429 for clients or unread data, after the third
    /// wrong token, and after a first line that is no request.
    int code() const { return code_; }

  private:
    int code_;
};

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_ERROR_H
