// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/operands.h"
#include "sim/command.h"
#include "sim/replay.h"
#include "sim/world.h"
#include "simrun/options.h"

namespace ispace {

/// The operands; a record knows its scene.
SceneInput readInput(const SimrunOptions& options);

/// Of what is shown: the room, or the record.
std::string titleOf(const SimrunOptions& options, const SceneInput& input);

/// The record to be served, and the scene as it begins; nothing without --replay.
std::optional<Replay> openReplay(const SimrunOptions& options, Scene& scene);

/// Up to where a record is to be served from.
void forward(Replay& replay, World& world, SimTime from);

History historyOf(const SimrunCommand& command, const SceneInput& input);

/// The commands of --script.
std::vector<TimedCommand> scriptOf(const SimrunOptions& options, const SceneInput& input,
                                   const World& world);

/// Robots of a record go where it says; its sensors have their noise of then, unless another is
/// asked for.
RunOptions runOptionsOf(const SimrunOptions& options, const std::optional<Replay>& replay);

}  // namespace ispace
