// SPDX-License-Identifier: GPL-3.0-or-later
// Commands to movers: their verbs, texts and scripts.
//
// The verbs are those of the thesis' Command System (table 3.5), with a path, a way to a point and
// a sideways speed besides. The parsers return errors with hints instead of throwing, since a
// client that types a wrong command gets a reply; scripts are files and throw FormatError with all
// findings. Metres and degrees, as in the protocol.
//
//     const ParsedCommand parsed = parseCommand("FORWARD 1.5");
//     if (parsed.command && world.refusal(robot, *parsed.command).empty())
//         world.command(robot, *parsed.command);
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

/// Verbs of the thesis' Command System, table 3.5. Sidespeed requires an omnidirectional robot;
/// Path follows a list of points, and Goto a way round bodies to one point.
enum class Verb { Forward, Backward, Left, Right, Speed, Rotspeed, Sidespeed, Stop, Path, Goto };

/// Returns true for Forward, Backward, Left and Right (the thesis' "OK commands"), Path and Goto.
bool comesToAnEnd(Verb verb);
/// Returns the name of a verb: "FORWARD".
std::string_view nameOf(Verb verb);
/// Returns the name of the value in replies: "distance", "angle", "speed", "rotspeed", "length"; ""
/// for Stop.
std::string_view valueNameOf(Verb verb);
std::optional<Verb> verbNamed(std::string_view name);

/// One command to a mover. `value` is in the units of the protocol: metres, degrees, m/s, deg/s. It
/// is not negative for Forward to Right; for Path and Goto it holds the length of the path.
struct Command {
    Verb verb = Verb::Stop;
    double value = 0;
    /// Of Path: at least one point. Of Goto: the goal, and once World::findPath() has found the way
    /// to it, all points after the start.
    MotionPlan course = {};
    double speed = 0;  ///< of Path and Goto, m/s; 0: the default
    /// Of Path: one attempt of several, whose failure World::unreached() leaves out.
    bool is_attempt = false;
    std::optional<Angle> heading = {};  ///< of Goto, to which it turns at the goal
    friend bool operator==(const Command&, const Command&) = default;
};

/// Creates a Path over these points. \pre the plan has at least one
Command pathCommand(MotionPlan course, double speed = 0);

/// A goal to which a mover finds its way.
struct Destination {
    Point2 at;
    std::optional<Angle> heading = {};  ///< to which it turns there
};

/// Parses "1.5,2" or, with a heading in degrees, "1.5,2,90".
std::optional<Destination> parseDestination(std::string_view text);

/// Parses a key of PATH, as "speed=0.3". Returns the reason why it is none, or "".
std::string applyPathKey(std::string_view text, Command& command);

/// Reason for which a text is rejected as a command.
struct CommandError {
    enum class Kind { Unknown, Syntax, Range } kind = Kind::Syntax;
    std::string message;  ///< with a hint
};

/// A command, or the reason for which the text is rejected.
struct ParsedCommand {
    std::optional<Command> command;
    CommandError error;
};

/// Parses a typed command such as "FORWARD 1.5" or "PATH 1,0;1,2 speed=0.3 pause=2 loop=yes". The
/// robot's own limits are not checked.
ParsedCommand parseCommand(std::string_view text);

/// A command of a script, or a change of the world, issued at the first step at or after its time.
struct TimedCommand {
    SimTime time{};
    std::size_t robot = 0;  ///< or person: an index of World::movers()
    Command command;
    std::string change = {};  ///< of a change the request of the protocol: "SET l1.on=yes"
};

/// Parses lines `TIME ROBOT COMMAND …`: seconds (or with a unit: 500ms), the id of a robot or a
/// person, a command of the Command System; and `TIME ID ACT KEY=VALUE`, which sets the state of an
/// actuator (see room_state.h). Lines of extensions (see script_lines.h) are skipped. `#` begins a
/// comment; empty lines are allowed. Sorts the result by time, equal times in file order.
/// \throws FormatError with all findings (file:line:column): bad times, unknown robots and
/// commands, values beyond the robot's limits
std::vector<TimedCommand> readScript(std::string_view text, const std::string& file,
                                     const World& world);

// Shared by commands, scripts and requests.

/// Returns the words of a line, separated by blanks and tabs.
std::vector<Piece> wordsOf(std::string_view line);
/// Converts the letters a to z to capitals: verbs are accepted in either case.
std::string upperCase(std::string_view word);

}  // namespace ispace
