// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ispace {

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

}  // namespace ispace
