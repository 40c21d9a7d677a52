// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/sim_time.h"

namespace ispace {

class World;

/// The Command System of the thesis, table 3.5.
enum class Verb { Forward, Backward, Left, Right, Speed, Rotspeed, Stop };

/// Forward, Backward, Left, Right: they come to an end (the thesis' "OK commands").
bool comesToAnEnd(Verb verb);
/// "FORWARD".
std::string_view nameOf(Verb verb);
/// What the value is called in replies: "distance", "angle", "speed", "rotspeed"; "" for Stop.
std::string_view valueNameOf(Verb verb);
std::optional<Verb> verbNamed(std::string_view name);

/// One command to a robot. `value` is in the units of the protocol: metres, degrees, m/s, deg/s; of
/// Forward to Right it is not negative.
struct Command {
    Verb verb = Verb::Stop;
    double value = 0;
    friend bool operator==(const Command&, const Command&) = default;
};

/// Why a text is no command.
struct CommandError {
    enum class Kind { Unknown, Syntax, Range } kind = Kind::Syntax;
    std::string message;  ///< with the hint that helps
};

/// A command, or why it is none.
struct ParsedCommand {
    std::optional<Command> command;
    CommandError error;
};

/// "FORWARD 1.5" as it is typed, words apart by blanks. The robot's own limits are not checked.
ParsedCommand parseCommand(std::string_view text);

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
