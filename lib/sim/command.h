// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/text.h"
#include "scene/robot.h"
#include "sim/sim_time.h"

namespace ispace {

class World;

/// Verbs of the thesis' Command System, table 3.5; Sidespeed is for omnidirectional robots, Path
/// goes from place to place.
enum class Verb { Forward, Backward, Left, Right, Speed, Rotspeed, Sidespeed, Stop, Path };

/// True for Forward, Backward, Left and Right (the thesis' "OK commands"), and for Path.
bool comesToAnEnd(Verb verb);
/// "FORWARD".
std::string_view nameOf(Verb verb);
/// Name of the value in replies: "distance", "angle", "speed", "rotspeed", "length"; "" for Stop.
std::string_view valueNameOf(Verb verb);
std::optional<Verb> verbNamed(std::string_view name);

/// One command to a robot or a person. `value` is in the units of the protocol: metres, degrees,
/// m/s, deg/s; it is not negative for Forward to Right, and for Path the length between its places.
struct Command {
    Verb verb = Verb::Stop;
    double value = 0;
    MotionPlan course = {};  ///< of Path: at least one place
    double speed = 0;        ///< of Path, m/s; 0: the usual one
    friend bool operator==(const Command&, const Command&) = default;
};

/// A Path over these places. \pre there is one
Command pathCommand(MotionPlan course, double speed = 0);

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

/// Reads a typed command such as "FORWARD 1.5" or "PATH 1,0;1,2 speed=0.3 pause=2 loop=yes". The
/// robot's own limits are not checked.
ParsedCommand parseCommand(std::string_view text);

/// A command of a script, given at the first step at or after its time.
struct TimedCommand {
    SimTime time{};
    std::size_t robot = 0;  ///< or person: an index of World::movers()
    Command command;
};

/// Reads lines `TIME ROBOT COMMAND …`: seconds (or with a unit: 500ms), the id of a robot or a
/// person, a command of the Command System. `#` begins a comment; empty lines are allowed. The
/// result is in the order of time, equal times in the order of the file. \throws FormatError with
/// all findings (file:line:column): bad times, unknown robots and commands,
///         values beyond what the robot can do
std::vector<TimedCommand> readScript(std::string_view text, const std::string& file,
                                     const World& world);

// Shared by commands, scripts and requests.

/// The words of a line, separated by blanks and tabs.
std::vector<Piece> wordsOf(std::string_view line);
/// The word with its letters a to z as capitals: verbs are written so, and people may forget it.
std::string upperCase(std::string_view word);

}  // namespace ispace
