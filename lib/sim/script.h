// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/command.h"
#include "sim/sim_time.h"
#include "sim/world.h"

namespace ispace {

/// A command of a script: given at the first step at or after its time.
struct TimedCommand {
    SimTime time{};
    std::size_t robot = 0;
    Command command;
};

/// Reads lines `TIME ROBOT COMMAND …`: seconds (or with a unit: 500ms), the robot's id, a command
/// of the Command System. `#` begins a comment; empty lines are allowed. The result is in the order
/// of time, equal times in the order of the file. \throws FormatError with all findings
/// (file:line:column): bad times, unknown robots and commands,
///         values beyond what the robot can do
std::vector<TimedCommand> readScript(std::string_view text, const std::string& file,
                                     const World& world);

}  // namespace ispace
