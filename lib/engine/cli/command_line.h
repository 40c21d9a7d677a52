// SPDX-License-Identifier: GPL-3.0-or-later
// Declares, parses and prints the options and operands of a tool.
//
//     CommandLine line("scan", "ENV [LAYOUT]", "Writes what the sensors of a layout measure.");
//     double height = 0.3;
//     line.meters("--height", height, 0, 10, "height of the plane", Enters::History);
//     std::vector<std::string> operands;
//     line.operands(operands, 2);
//     line.parse(argc, argv);  // opens no file
//
// Errors are UsageError with the option's name, the bad value, the wanted ones and a hint: the
// option with the most similar name, or advice for options that other programs have (guesses.h).
// An option with a value that is given twice is an error unless it is repeatable. CLI11 parses; no
// type of it leaves command_line.cc.
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "record/record.h"

namespace ispace {

/// Form in which an option enters the history line of the product: only options that change its
/// bytes do, a file by its base name, and so the files of a list, `word:FILE,FILE`. Products made
/// in different folders, or by different numbers of threads, then have equal bytes.
enum class Enters { History, BaseName, BaseNames, Nothing };

/// A rule for make that lists the sources of the product.
struct DependencyOptions {
    bool wanted = false;  ///< -MD
    std::string file;     ///< -MF; "": the product's full name and .d
};

/// One tool's options and operands. Each option is declared once, in the man page's order, bound
/// to its variable; `--help` and the history line come from that table.
///
/// Numbers are parsed whole, without locale, and checked at once. Options may stand before, between
/// and after operands; `--` ends them. Variables keep their values, the defaults, without the
/// option; they outlive the object. Not thread-safe.
class CommandLine {
  public:
    /// `synopsis` follows the tool's name, `summary` holds one or two lines for `--help`.
    CommandLine(std::string tool, std::string synopsis, std::string summary);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// Puts the options declared from here on under this heading of `--help`, "Main options" at
    /// first.
    /// `--help WORD` prints the group alone, by a word of the heading.
    void group(const std::string& title);
    /// The groups from here on belong to this extension, "" to the tool.
    void extension(const std::string& name);
    /// Names the extensions of this build, for --version.
    void built(std::span<const std::string_view> extensions);
    /// Names the options that `--help` lists ("--output"); the others are a line for each group.
    /// Without this call it lists all. \pre they are declared
    void essential(std::initializer_list<std::string_view> names);
    /// Adds a command to the examples at the end of `--help`.
    void example(const std::string& command, const std::string& effect);
    /// `names` as CLI11 takes them ("-o,--output"), `value` names the value in help ("FILE").
    void text(const std::string& names, const std::string& value, std::string& variable,
              const std::string& help, Enters enters);
    /// A file name; rejects an empty one, as of an unset shell variable.
    void file(const std::string& names, const std::string& value, std::string& variable,
              const std::string& help, Enters enters);
    /// May be given several times.
    void texts(const std::string& names, const std::string& value,
               std::vector<std::string>& variable, const std::string& help, Enters enters);
    void flag(const std::string& names, bool& variable, const std::string& help, Enters enters);
    /// Counts the flag (-vv).
    void flag(const std::string& names, int& variable, const std::string& help, Enters enters);
    /// A pair --name / --no-name; `off` wins if both are given, and neither leaves it empty.
    void switchFlag(const std::string& on, const std::string& off, std::optional<bool>& variable,
                    const std::string& help, const std::string& off_help, Enters enters);
    /// Any other option: `take` receives the text; its UsageError is prefixed with the option's
    /// name.
    void parsed(const std::string& names, const std::string& value,
                std::function<void(const std::string&)> take, const std::string& help,
                Enters enters);
    /// Repeatable options that keep their relative order: `take` and the history line receive them
    /// in the order of the command line. `take` is called once all other options are set.
    void ordered(const std::string& names, const std::string& value,
                 std::function<void(const std::string&)> take, const std::string& help);
    /// -MD and -MF FILE, as compilers have them, for the product `output`.
    void dependencies(DependencyOptions& options, const std::string& output);
    /// A whole number in [lowest, highest].
    void count(const std::string& names, const std::string& value, std::optional<int>& variable,
               int lowest, int highest, const std::string& help, Enters enters);
    void count(const std::string& names, const std::string& value, int& variable, int lowest,
               int highest, const std::string& help, Enters enters);
    /// The same, with `otherwise` if no number follows the option.
    void countOr(const std::string& name, std::optional<int>& variable, int otherwise, int lowest,
                 int highest, const std::string& help, Enters enters);
    /// A length in metres (suffixes m, cm, mm, km), within [lowest, highest].
    void meters(const std::string& names, std::optional<double>& variable, double lowest,
                double highest, const std::string& help, Enters enters);
    void meters(const std::string& names, double& variable, double lowest, double highest,
                const std::string& help, Enters enters);
    /// A time in seconds (suffixes s, ms, us, ns, min, h), within [lowest, highest].
    void duration(const std::string& names, std::optional<double>& variable, double lowest,
                  double highest, const std::string& help, Enters enters);
    void duration(const std::string& names, double& variable, double lowest, double highest,
                  const std::string& help, Enters enters);
    /// One of a fixed set of words. \param missing returns the extension of a word that this build
    /// lacks, "" for others; may be null
    void choice(const std::string& names, std::string& variable, std::vector<std::string> words,
                const std::string& help, Enters enters,
                std::string_view (*missing)(std::string_view word) = nullptr);
    /// A removed option, with its replacement as a hint.
    void renamed(const std::string& name, const std::string& hint);
    /// Replaces the usual description of the exit status in `--help`.
    void exitStatus(const std::string& text);
    /// The operands in order; at most `most`.
    void operands(std::vector<std::string>& variable, std::size_t most);
    /// Allows any number of operands with this flag.
    void manyOperandsWith(const bool& flag);

    /// Sets the variables and operands. Options are set in their order of declaration, those of
    /// ordered() last. `--errors json` selects the form of messages first, so that errors of the
    /// command line have it, too. Call once. \throws UsageError with a hint, TextRequested for -h
    /// and -V
    void parse(int argc, const char* const* argv);

    /// Returns true if the option ("--output") stood in the command line; false if it is not
    /// declared, as one of an extension that the build lacks.
    [[nodiscard]] bool given(const std::string& name) const;
    /// Returns the values of an option as they were given; empty without it.
    [[nodiscard]] std::vector<std::string> valuesOf(const std::string& name) const;
    /// Returns a name of each declared option, in their order: the first long one ("--output"),
    /// else the short one.
    [[nodiscard]] std::vector<std::string> names() const;
    /// Returns "arrange room.glb --sensor urg-04lx:1 --strategy wall" for the options given, in the
    /// order of declaration (those of ordered() together, as they came), quoted for the shell.
    [[nodiscard]] std::string historyLine(const std::vector<std::string>& operands) const;
    /// Returns the words of a command line with the same result: the tool, the options that enter
    /// its history as they were given, and the operands.
    [[nodiscard]] std::vector<std::string> resultWords() const;
    /// Returns the page of `--help`, of "all", of a group by a word of its heading or by its
    /// extension, or of one option by its name. \throws UsageError for any other word
    [[nodiscard]] std::string helpText(const std::string& about = "") const;

  private:
    struct Data;
    /// Returns `take` with the option's name prefixed to its errors.
    [[nodiscard]] std::function<void(const std::string&)> guarded(
        const std::string& names, std::function<void(const std::string&)> take) const;
    std::unique_ptr<Data> data_;
};

/// A tool's options with their command line, kept for its history line: operands are known
/// only once they are read.
template <typename Options>
class ToolCommand {
  public:
    [[nodiscard]] const Options& options() const { return options_; }
    [[nodiscard]] std::string historyLine(const std::vector<std::string>& operands) const {
        return line_.historyLine(operands);
    }
    [[nodiscard]] std::vector<std::string> resultWords() const { return line_.resultWords(); }

  protected:
    ToolCommand(std::string tool, std::string synopsis, std::string summary)
        : line_(std::move(tool), std::move(synopsis), std::move(summary)) {}

    Options options_;
    CommandLine line_;
};

}  // namespace ispace
