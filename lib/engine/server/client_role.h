// SPDX-License-Identifier: GPL-3.0-or-later
// Roles of the protocol that extensions add to a run: such a role has further requests, may read
// sensors by its own clock, and may make the world wait for its clients. All functions are called
// in the server's thread, and none may block. Answers are lines of ispace-protocol(7) with their
// LF: "OK …" or, by errorText() of role_answer.h, "ERR CODE reason".
//
// A service lives as long as its run; a client's role lives from the request that takes it to the
// end of the connection, so the destructor of ClientRole gives the id back.
//
//     NODE n1         -> RoleService::take("n1", answer), of the service whose verb() is NODE
//     SEND hello      -> ClientRole::request({"SEND", "hello"})
//     closed          -> ~ClientRole()
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/room_state.h"
#include "server/role_maker.h"
#include "sim/simulation.h"
#include "sim/worlds.h"

namespace ispace {

/// A request of a role, as a row for HELP.
struct RoleRequest {
    std::string_view verb, arguments;
    std::size_t least = 0, most = 0;  ///< number of arguments
};

/// Answer to a request: a line with its end, or a wait. With waits the line is ignored.
struct RoleAnswer {
    std::string line;
    bool waits = false;  ///< asked again, with the same words, once ClientRole::waits() is false
};

/// One client in a role. SCAN, STREAM, STOP, TRACK, HELP and QUIT are answered by the server.
class ClientRole {
  public:
    virtual ~ClientRole() = default;
    [[nodiscard]] virtual std::span<const RoleRequest> requests() const = 0;
    /// \pre words has the verb of a row of requests(), and a permitted number of arguments
    virtual RoleAnswer request(std::span<const std::string_view> words) = 0;
    /// Returns true while a request must wait.
    [[nodiscard]] virtual bool waits() const = 0;
    /// Returns lines for the client, after each step of the world. \param has_room false: the
    /// client reads slowly; lines are kept for later, a bounded number of them
    virtual std::string stepped(bool has_room) = 0;
    /// Returns the names of the sensors that the role may read, across the run.
    [[nodiscard]] virtual std::span<const std::string> sensors() const = 0;
    /// Returns the time on the client's clock, seconds.
    [[nodiscard]] virtual double clock(SimTime time) const = 0;
};

/// A kind of role, and what its clients share.
class RoleService {
  public:
    virtual ~RoleService() = default;
    [[nodiscard]] virtual std::string_view verb() const = 0;  ///< "NODE"
    /// Takes the role for one client until the result is destroyed. \param answer the line for the
    /// client \returns null if it is refused
    virtual std::unique_ptr<ClientRole> take(std::string_view id, std::string& answer) = 0;
    /// Called after each step of the world, before the clients' turn.
    virtual void stepped() = 0;
    /// Returns true while a client keeps the world from its next step; ignored with a real clock.
    [[nodiscard]] virtual bool holdsWorld() const = 0;
    /// Names the clients that the world will wait for; "" if it waits for no client.
    [[nodiscard]] virtual std::string waitsFor() const = 0;
    /// Returns the states of its things, by ids across the run, which STATE lists.
    [[nodiscard]] virtual std::vector<RoomState> states() const { return {}; }
};

}  // namespace ispace
