// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of scripts that are no commands, and what carries them out: `daily 07:30 ann goes kitchen`.
// Extensions bring them; the simulation knows neither their words nor what they do.
//
//     addScriptLines({.words = {"at", "daily"}, .read = readDays});       // by an extension
//     for (auto& director : readDirectors(text, "week.txt", world))       // by a tool
//         simulation.follow(std::move(director));
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

class Simulation;
class World;

/// Carries out the lines of a script in one run.
class Director {
  public:
    virtual ~Director() = default;
    /// Called after each step, by the thread that runs the simulation. It may give commands, ask
    /// for changes and raise events; the same steps give the same ones.
    virtual void stepped(Simulation& simulation) = 0;
    /// Returns true for a door that it has opened for people and shuts behind them.
    [[nodiscard]] virtual bool hasOpened(const std::string& door) const = 0;
};

/// A kind of lines, recognised by their first words.
struct ScriptLines {
    std::vector<std::string_view> words = {};  ///< literals, none of which begins a command
    /// Reads those of a script, and skips all others. Null if there are none.
    /// \throws FormatError with all findings
    std::shared_ptr<Director> (*read)(std::string_view text, const std::string& file,
                                      const World& world) = nullptr;
};

/// Adds a kind of lines, for the program, unless one with these words is known. Called by one
/// thread before the first script is read, as is addMissingScriptLine().
void addScriptLines(ScriptLines lines);
/// States a first word of lines that an extension would read, which this program was built without:
/// the error about such a line names it. \param word, extension literals
void addMissingScriptLine(std::string_view word, std::string_view extension);

/// Returns true for a line that is read by what addScriptLines() has added. Thread-safe.
[[nodiscard]] bool isDirectorsLine(std::string_view line);
/// Returns the extension that would read lines with this first word; "" for others. Thread-safe.
[[nodiscard]] std::string_view missingScriptLine(std::string_view word);
/// Reads all such lines of a script, by kind, in the order in which these were added. Kinds without
/// a line give none. \throws FormatError with all findings of the first kind that has some
[[nodiscard]] std::vector<std::shared_ptr<Director>> readDirectors(std::string_view text,
                                                                   const std::string& file,
                                                                   const World& world);

}  // namespace ispace
