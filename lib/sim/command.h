// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/text.h"
#include "sim/sim_time.h"

namespace ispace {

class World;

/// Verbs of the thesis' Command System, table 3.5.
enum class Verb { Forward, Backward, Left, Right, Speed, Rotspeed, Stop };

/// True for Forward, Backward, Left and Right (the thesis' "OK commands").
bool comesToAnEnd(Verb verb);
/// "FORWARD".
std::string_view nameOf(Verb verb);
/// Name of the value in replies: "distance", "angle", "speed", "rotspeed"; "" for Stop.
std::string_view valueNameOf(Verb verb);
std::optional<Verb> verbNamed(std::string_view name);

/// One command to a robot. `value` is in the units of the protocol: metres, degrees, m/s, deg/s; it
/// is not negative for Forward to Right.
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

/// Reads a typed command such as "FORWARD 1.5". The robot's own limits are not checked.
ParsedCommand parseCommand(std::string_view text);

/// A command of a script, given at the first step at or after its time.
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

// Shared by commands, scripts and requests.

/// The words of a line, separated by blanks and tabs.
std::vector<Piece> wordsOf(std::string_view line);
/// The word with its letters a to z as capitals: verbs are written so, and people may forget it.
std::string upperCase(std::string_view word);

}  // namespace ispace
