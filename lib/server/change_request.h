// SPDX-License-Identifier: GPL-3.0-or-later
// Requests that change the world. Private to lib/server.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/server_state.h"

namespace ispace {

/// Carries out a request ADD, SET, DELETE, LOAD or RESET. \returns the answer, completed once the
/// world has changed; it begins with `verb`, if not empty, instead of the request's.
/// \param prefix of the id in the answer \pre state.mayChange(), state.mayChangeNow()
std::shared_ptr<const ServerState::Asked> changeWorld(ServerState& state, const std::string& line,
                                                      const std::string& verb = "",
                                                      const std::string& prefix = "");

/// Carries out several requests ADD, or several SET, by one change of the world, which is built
/// once. \returns the answers to all of them, as one by one; none is carried out, and `is_error` is
/// set, if one fails, or might without those that follow it: each SET is about another sensor, by
/// its id, and refers to no record. \pre as above
std::shared_ptr<const ServerState::Asked> changeWorld(ServerState& state,
                                                      std::vector<std::string> lines,
                                                      const std::string& verb = "",
                                                      const std::string& prefix = "");

/// Changes the rooms of a building together, between two steps. \pre all states mayChangeNow()
void changeRooms(const ServedRooms& rooms, const std::function<void()>& change);

/// Returns the findings about movers that were put somewhere, in one line.
std::string warningOf(const World& world, const std::vector<std::string>& movers);

}  // namespace ispace
