// SPDX-License-Identifier: GPL-3.0-or-later
// The table of verbs, and parsers of commands and scripts. Errors have the form: what is wrong,
// what is wanted, an example.
#include "sim/command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "record/edit.h"
#include "scene/room_state.h"
#include "sim/script_lines.h"
#include "sim/world.h"

namespace ispace {

namespace {

/// Rejects a mistyped digit; also keeps poses within the resolution of doubles.
constexpr double kMaxPath = 1e6;

constexpr std::string_view kPathExample = "PATH 1,0;1,2 speed=0.3";
constexpr std::string_view kGotoExample = "GOTO 1,2 speed=0.3";

struct VerbFacts {
    Verb verb;
    std::string_view name;
    std::string_view value_name;
    std::string_view unit;      // of the value
    std::string_view opposite;  // verb of the reverse direction, if the value cannot be negative
    std::string_view example;
};

/// In the order of Verb.
constexpr std::array<VerbFacts, 10> kVerbs = {{
    {Verb::Forward, "FORWARD", "distance", "metres", "BACKWARD", "FORWARD 1.5"},
    {Verb::Backward, "BACKWARD", "distance", "metres", "FORWARD", "BACKWARD 1.5"},
    {Verb::Left, "LEFT", "angle", "degrees", "RIGHT", "LEFT 90"},
    {Verb::Right, "RIGHT", "angle", "degrees", "LEFT", "RIGHT 90"},
    {Verb::Speed, "SPEED", "speed", "metres a second", "", "SPEED 0.3"},
    {Verb::Rotspeed, "ROTSPEED", "rotspeed", "degrees a second", "", "ROTSPEED 30"},
    {Verb::Sidespeed, "SIDESPEED", "speed", "metres a second", "", "SIDESPEED 0.3"},
    {Verb::Stop, "STOP", "", "", "", "STOP"},
    {Verb::Path, "PATH", "length", "", "", kPathExample},
    {Verb::Goto, "GOTO", "length", "", "", kGotoExample},
}};

const VerbFacts& factsOf(Verb verb) { return kVerbs[static_cast<std::size_t>(verb)]; }

/// Joins pieces of text.
std::string join(std::initializer_list<std::string_view> pieces) {
    std::string text;
    for (const std::string_view piece : pieces) text += piece;
    return text;
}

ParsedCommand refuse(CommandError::Kind kind, std::string message) {
    return {std::nullopt, {kind, std::move(message)}};
}

std::string unknownCommand(std::string_view name) {
    std::vector<std::string> known;
    known.reserve(kVerbs.size());
    for (const VerbFacts& facts : kVerbs) known.emplace_back(facts.name);
    std::string hint = didYouMean(upperCase(name), known);
    if (hint.empty()) {
        hint = ", wanted one of";
        for (const std::string& verb : known) {
            hint += ' ';
            hint += verb;
        }
    }
    return join({"unknown command ", excerpt(name), hint});
}

/// Parses the single value of `facts.verb`.
ParsedCommand parseValue(const VerbFacts& facts, std::string_view text) {
    const auto value = parseDouble(text);
    if (!value) {
        return refuse(CommandError::Kind::Syntax,
                      join({excerpt(text), " is no number, ", facts.name, " wants its ",
                            facts.value_name, " in ", facts.unit, ", like ", facts.example}));
    }
    if (comesToAnEnd(facts.verb) && *value < 0) {
        return refuse(
            CommandError::Kind::Range,
            join({facts.name, " takes no negative ", facts.value_name, ", use ", facts.opposite}));
    }
    if (comesToAnEnd(facts.verb) && *value > kMaxPath) {
        return refuse(CommandError::Kind::Range,
                      join({facts.name, " takes at most ", formatDouble(kMaxPath), " ", facts.unit,
                            ", found ", excerpt(text)}));
    }
    // Adding 0 drops the sign of minus zero.
    return {Command{facts.verb, *value + 0.0}, {}};
}

ParsedCommand refusePath(const std::string& message) {
    return refuse(CommandError::Kind::Syntax, join({message, ", like ", kPathExample}));
}

/// Parses "1,0;1,2"; nullopt for other texts.
std::optional<std::vector<Point2>> parsePlaces(std::string_view text) {
    std::vector<Point2> places;
    while (true) {
        const std::size_t end = std::min(text.find(';'), text.size());
        const std::string_view place = text.substr(0, end);
        const std::size_t comma = place.find(',');
        if (comma == std::string_view::npos) return std::nullopt;
        const auto x = parseDouble(place.substr(0, comma)),
                   y = parseDouble(place.substr(comma + 1));
        if (!x || !y) return std::nullopt;
        places.push_back({*x, *y});
        if (end == text.size()) return places;
        text.remove_prefix(end + 1);
    }
}

ParsedCommand parsePath(std::span<const Piece> words) {
    const auto places = words.empty() ? std::nullopt : parsePlaces(words.front().text);
    if (!places) {
        const std::string found = words.empty() ? "" : ", found " + excerpt(words.front().text);
        return refusePath("PATH wants places x,y;x,y in metres" + found);
    }
    for (const Point2 p : *places)
        if (!(std::abs(p.x) <= kMaxPath && std::abs(p.y) <= kMaxPath))
            return refuse(CommandError::Kind::Range,
                          join({"PATH goes at most ", formatDouble(kMaxPath), " metres"}));
    Command command = pathCommand({.path = *places});
    for (const Piece& word : words.subspan(1))
        if (std::string wrong = applyPathKey(word.text, command); !wrong.empty())
            return refusePath(wrong);
    return {std::move(command), {}};
}

ParsedCommand parseGoto(std::span<const Piece> words) {
    const auto refused = [](CommandError::Kind kind, std::string_view message) {
        return refuse(kind, join({message, ", like ", kGotoExample}));
    };
    constexpr auto kSyntax = CommandError::Kind::Syntax;
    if (words.empty()) return refused(kSyntax, "GOTO wants a point x,y or x,y,heading in metres");
    const std::string_view text = words.front().text;
    const auto goal = parseDestination(text);
    if (!goal && text.find('/') != std::string_view::npos)
        return refused(kSyntax, join({"this run is of one room, without the storey of ",
                                      excerpt(text), ": GOTO takes x,y"}));
    if (!goal)
        return refused(kSyntax,
                       join({"GOTO wants a point x,y or x,y,heading in metres and degrees, found ",
                             excerpt(text)}));
    if (!(std::abs(goal->at.x) <= kMaxPath && std::abs(goal->at.y) <= kMaxPath))
        return refuse(CommandError::Kind::Range,
                      join({"GOTO goes at most ", formatDouble(kMaxPath), " metres"}));
    Command command{Verb::Goto, 0, {.path = {goal->at}}};
    command.heading = goal->heading;
    for (const Piece& word : words.subspan(1))
        if (!word.text.starts_with("speed=") || !applyPathKey(word.text, command).empty())
            return refused(kSyntax,
                           join({"GOTO takes speed= in metres a second above 0 behind its point, "
                                 "found ",
                                 excerpt(word.text)}));
    return {std::move(command), {}};
}

}  // namespace

std::optional<Destination> parseDestination(std::string_view text) {
    std::vector<double> numbers;
    for (bool is_last = false; !is_last;) {
        const std::size_t end = std::min(text.find(','), text.size());
        const auto number = parseDouble(text.substr(0, end));
        if (!number || numbers.size() == 3) return std::nullopt;
        numbers.push_back(*number);
        is_last = end == text.size();
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (numbers.size() < 2) return std::nullopt;
    Destination goal{{numbers[0], numbers[1]}};
    if (numbers.size() == 3) goal.heading = Angle::degrees(numbers[2]);
    return goal;
}

std::string applyPathKey(std::string_view text, Command& command) {
    const std::size_t sign = std::min(text.find('='), text.size());
    const std::string_view key = text.substr(0, sign);
    const std::string_view value = text.substr(std::min(sign + 1, text.size()));
    const auto number = parseDouble(value);
    if (key == "loop" && (value == "yes" || value == "no")) {
        command.course.loop = value == "yes";
    } else if (key == "speed" && number && *number > 0) {
        command.speed = *number;
    } else if (key == "pause" && number && *number >= 0) {
        command.course.pause = std::min(*number, kMaxPath);
    } else {
        return join(
            {"PATH takes speed= in metres a second above 0, pause= in seconds and "
             "loop=yes|no, found ",
             excerpt(text)});
    }
    return "";
}

Command pathCommand(MotionPlan course, double speed) {
    double length = 0;
    for (std::size_t i = 1; i < course.path.size(); ++i)
        length += distance(course.path[i - 1], course.path[i]);
    return {Verb::Path, length, std::move(course), speed};
}

bool comesToAnEnd(Verb verb) {
    return !factsOf(verb).opposite.empty() || verb == Verb::Path || verb == Verb::Goto;
}

std::string_view nameOf(Verb verb) { return factsOf(verb).name; }

std::string_view valueNameOf(Verb verb) { return factsOf(verb).value_name; }

std::optional<Verb> verbNamed(std::string_view name) {
    const auto found = std::find_if(kVerbs.begin(), kVerbs.end(),
                                    [&](const VerbFacts& facts) { return facts.name == name; });
    if (found == kVerbs.end()) return std::nullopt;
    return found->verb;
}

ParsedCommand parseCommand(std::string_view text) {
    const std::vector<Piece> words = wordsOf(text);
    if (words.empty())
        return refuse(CommandError::Kind::Syntax, "no command, wanted one like FORWARD 1.5");
    const auto verb = verbNamed(words.front().text);
    if (!verb) return refuse(CommandError::Kind::Unknown, unknownCommand(words.front().text));
    if (*verb == Verb::Path) return parsePath(std::span(words).subspan(1));
    if (*verb == Verb::Goto) return parseGoto(std::span(words).subspan(1));
    const VerbFacts& facts = factsOf(*verb);
    const std::size_t wanted = facts.value_name.empty() ? 1 : 2;
    if (words.size() < wanted) {
        return refuse(CommandError::Kind::Syntax,
                      join({facts.name, " wants its ", facts.value_name, " in ", facts.unit,
                            ", like ", facts.example}));
    }
    if (words.size() > wanted) {
        return refuse(CommandError::Kind::Syntax,
                      join({facts.name, wanted == 1 ? " takes no value" : " takes one number",
                            ", found ", excerpt(words[wanted].text), " behind it"}));
    }
    if (wanted == 1) return {Command{*verb, 0}, {}};
    return parseValue(facts, words.back().text);
}

namespace {

/// Reads a script line by line and collects all findings.
class ScriptReader {
  public:
    ScriptReader(const std::string& file, const World& world) : file_(&file), world_(&world) {
        names_.reserve(world.movers().size());
        for (const Mover& mover : world.movers()) names_.push_back(mover.id);
    }

    /// \param line without its comment
    void read(std::string_view line, int number);
    /// Sorts the commands by time. \throws FormatError with all findings
    std::vector<TimedCommand> take();

  private:
    void finding(int column, std::string message) {
        findings_.add({*file_, line_, column, std::move(message)});
    }
    std::optional<SimTime> readTime(const Piece& word);
    std::optional<std::size_t> readMover(const Piece& word);
    /// \param words of the line
    std::optional<std::string> readAct(std::span<const Piece> words);
    /// \param text of the command, which begins at `words`
    std::optional<Command> readCommand(std::string_view text, std::span<const Piece> words,
                                       std::optional<std::size_t> robot);

    const std::string* file_;
    const World* world_;
    std::vector<std::string> names_;
    int line_ = 0;
    Diagnostics findings_;
    std::vector<TimedCommand> commands_;
};

std::optional<SimTime> ScriptReader::readTime(const Piece& word) {
    const auto time = parseSimTime(word.text);
    if (!time)
        finding(word.column, excerpt(word.text) +
                                 " is no time, wanted seconds from the start of "
                                 "the run, like 2.5 or 500ms");
    return time;
}

std::optional<std::size_t> ScriptReader::readMover(const Piece& word) {
    const auto mover = world_->moverNamed(word.text);
    if (!mover)
        finding(word.column,
                "unknown robot or person " + excerpt(word.text) +
                    (names_.empty() ? ": the scene has none" : didYouMean(word.text, names_)));
    return mover;
}

std::optional<std::string> ScriptReader::readAct(std::span<const Piece> words) {
    if (words.size() < 4) {
        finding(words.back().column, "ACT wants a state, like 2.5 lamp1 ACT on=yes");
        return std::nullopt;
    }
    try {
        std::vector<std::string_view> states;
        for (const Piece& word : words.subspan(3)) states.push_back(word.text);
        std::string change = stateChange(world_->scene(), words[1].text, states);
        // Rejects a bad value, without a change.
        editedRecords(world_->scene(), parseEdits(change),
                      [](const std::string&) { return std::nullopt; });
        return change;
    } catch (const FormatError& error) {
        finding(words[3].column, error.diagnostics().front().message);
    } catch (const UsageError& error) {
        finding(words[1].column, error.what());
    }
    return std::nullopt;
}

std::optional<Command> ScriptReader::readCommand(std::string_view text,
                                                 std::span<const Piece> words,
                                                 std::optional<std::size_t> robot) {
    ParsedCommand parsed = parseCommand(text);
    const int value_column = words[words.size() > 1 ? 1 : 0].column;
    if (!parsed.command) {
        const bool unknown = parsed.error.kind == CommandError::Kind::Unknown;
        finding(unknown ? words.front().column : value_column, std::move(parsed.error.message));
        return std::nullopt;
    }
    if (!robot) return std::nullopt;
    if (std::string refusal = world_->refusal(*robot, *parsed.command); !refusal.empty()) {
        finding(value_column, std::move(refusal));
        return std::nullopt;
    }
    return parsed.command;
}

void ScriptReader::read(std::string_view line, int number) {
    line_ = number;
    const std::vector<Piece> words = wordsOf(line);
    if (words.empty()) return;
    if (const auto extension = missingScriptLine(words.front().text); !extension.empty())
        return finding(words.front().column,
                       excerpt(words.front().text) + " begins a line that the extension " +
                           std::string(extension) + " reads: this build lacks that extension");
    const auto time = readTime(words.front());
    if (words.size() < 3) {
        finding(words.back().column, words.size() == 1
                                         ? "a robot and a command are missing, wanted TIME ROBOT "
                                           "COMMAND, like 2.5 r1 FORWARD 1"
                                         : "a command is missing, wanted TIME ROBOT COMMAND, like "
                                           "2.5 r1 FORWARD 1");
        return;
    }
    if (upperCase(words[2].text) == "ACT") {
        const auto change = readAct(words);
        if (!time || !change) return;
        TimedCommand& timed = commands_.emplace_back();
        timed.time = *time;
        timed.change = *change;
        return;
    }
    const auto robot = readMover(words[1]);
    const auto begin = static_cast<std::size_t>(words[2].column) - 1;
    const auto command =
        readCommand(line.substr(begin), std::span<const Piece>(words).subspan(2), robot);
    if (!time || !robot || !command) return;
    TimedCommand& timed = commands_.emplace_back();
    timed.time = *time;
    timed.robot = *robot;
    timed.command = *command;
}

std::vector<TimedCommand> ScriptReader::take() {
    findings_.throwIfAny();
    std::stable_sort(commands_.begin(), commands_.end(),
                     [](const TimedCommand& a, const TimedCommand& b) { return a.time < b.time; });
    return std::move(commands_);
}

}  // namespace

std::vector<TimedCommand> readScript(std::string_view text, const std::string& file,
                                     const World& world) {
    text = withoutBom(text);
    checkTextBytes(text, file);
    ScriptReader reader(file, world);
    LineReader lines(text);
    // No word of the language holds a #.
    while (const auto line = lines.next())
        if (const auto code = line->substr(0, line->find('#')); !isDirectorsLine(code))
            reader.read(code, lines.number());
    return reader.take();
}

std::vector<Piece> wordsOf(std::string_view line) {
    constexpr std::string_view kBlanks = " \t";
    std::vector<Piece> words;
    words.reserve(4);
    for (std::size_t end = 0;;) {
        const std::size_t start = line.find_first_not_of(kBlanks, end);
        if (start == std::string_view::npos) return words;
        end = std::min(line.find_first_of(kBlanks, start), line.size());
        words.push_back({line.substr(start, end - start), static_cast<int>(start) + 1});
    }
}

std::string upperCase(std::string_view word) {
    std::string out(word);
    for (char& c : out)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return out;
}

}  // namespace ispace
