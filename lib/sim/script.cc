// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/script.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/suggest.h"
#include "base/utf8.h"
#include "sim/words.h"

namespace ispace {

namespace {

/// Reads lines one by one and collects what is wrong with them.
class ScriptReader {
  public:
    ScriptReader(const std::string& file, const World& world) : file_(&file), world_(&world) {
        names_.reserve(world.robots().size());
        for (const PlacedRobot& robot : world.robots()) names_.push_back(robot.id);
    }

    /// \param line without its comment
    void read(std::string_view line, int number);
    /// The commands in the order of time. \throws FormatError with all findings
    std::vector<TimedCommand> take();

  private:
    void finding(int column, std::string message) {
        findings_.add({*file_, line_, column, std::move(message)});
    }
    std::optional<SimTime> readTime(const Piece& word);
    std::optional<std::size_t> readRobot(const Piece& word);
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

std::optional<std::size_t> ScriptReader::readRobot(const Piece& word) {
    const auto robot = world_->robotNamed(word.text);
    if (!robot)
        finding(word.column,
                "unknown robot " + excerpt(word.text) +
                    (names_.empty() ? ": the scene has none" : didYouMean(word.text, names_)));
    return robot;
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
    const auto time = readTime(words.front());
    if (words.size() < 3) {
        finding(words.back().column, words.size() == 1
                                         ? "a robot and a command are missing, wanted TIME ROBOT "
                                           "COMMAND, like 2.5 r1 FORWARD 1"
                                         : "a command is missing, wanted TIME ROBOT COMMAND, like "
                                           "2.5 r1 FORWARD 1");
        return;
    }
    const auto robot = readRobot(words[1]);
    const auto begin = static_cast<std::size_t>(words[2].column) - 1;
    const auto command =
        readCommand(line.substr(begin), std::span<const Piece>(words).subspan(2), robot);
    if (time && robot && command) commands_.push_back({*time, *robot, *command});
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
    text = withoutMark(text);
    checkTextBytes(text, file);
    ScriptReader reader(file, world);
    LineReader lines(text);
    // No word of the language holds a #.
    while (const auto line = lines.next())
        reader.read(line->substr(0, line->find('#')), lines.number());
    return reader.take();
}

}  // namespace ispace
