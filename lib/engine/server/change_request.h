// SPDX-License-Identifier: GPL-3.0-or-later
// Requests that change the world: ADD, SET, DELETE, ACT, LOAD and RESET. Private to
// lib/engine/server.
//
// A change is all or none: a request that fails leaves the world as it was. Codes of errors: 400
// for a request that is wrong by itself, 403 for one that the run forbids, 404 for an unknown
// record, 409 for a file that cannot be loaded, and for records that contradict each other or
// exceed memory.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/server_state.h"

namespace ispace {

/// A request to change a thing of a room, or the room, with plain ids; or the reason why it is
/// none.
struct RoomRequest {
    std::size_t room = 0;
    std::string id, line;
    int code = 0;  ///< of an error; 0: none
    std::string fault = {};
};

/// Finds the room of a request ADD, SET, DELETE or ACT, and takes it off the ids; of a sole world,
/// that of any request. In a building ids are "ROOM/ID" without globs, and a request is about one
/// storey. \pre words has a verb and the arguments that its row requires, adjacent in one string
RoomRequest roomRequest(const Worlds& worlds, std::span<const std::string_view> words);

/// Carries out a request ADD, SET, DELETE, LOAD or RESET. \returns the answer, completed once the
/// world has changed; it begins with `verb`, if not empty, instead of the request's.
/// \pre state.mayChange(), state.mayChangeNow()
std::shared_ptr<const ServerState::PendingReply> changeWorld(ServerState& state,
                                                             const std::string& line,
                                                             const std::string& verb = "");

/// Carries out several requests ADD, or several SET, by one change of the world, which is built
/// once. \returns the answers to all of them, as one by one; none is carried out, and `is_error` is
/// set, if one fails, or might without those that follow it: each SET is about another sensor, by
/// its id, and refers to no record. \param room of ids in the answer \pre as above
std::shared_ptr<const ServerState::PendingReply> changeWorld(ServerState& state,
                                                             std::vector<std::string> lines,
                                                             const std::string& verb = "",
                                                             const std::string& room = "");

/// Changes the rooms of a building together, between two steps. \pre all states mayChangeNow()
void changeRooms(const ServedRooms& rooms, const std::function<void()>& change);

/// Returns the findings about movers that were put somewhere, in one line.
std::string warningOf(const World& world, const std::vector<std::string>& movers);

}  // namespace ispace
