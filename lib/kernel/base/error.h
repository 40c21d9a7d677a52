// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/base: errors, numbers, files, history lines, JSON, progress. zlib, TBB inside.
//
// The library throws three kinds of errors and prints none: UsageError for the command line,
// FormatError for data (each finding with file, line and column), std::system_error for the system.
// runTool alone catches them, prints one line for each finding and picks the exit status. An answer
// such as "not visible" is no error: it is an optional or an enumerator.
//
//     Diagnostics problems;
//     if (length == 0) problems.add({file, line, column, "wall has zero length"});
//     problems.throwIfAny();  // room.env:14:7: error: wall has zero length
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// An error in the command line; runTool exits with status 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A stated requirement was not met (`--require`, no valid position); exit status 3. The output is
/// written first if there is one.
class UnmetError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Severity of a finding. A warning points at a probable mistake; the data are usable. A note tells
/// a choice that the program made.
enum class Severity { Error, Warning, Note };
/// Returns "error", "warning" or "note".
std::string_view nameOf(Severity severity);

/// One finding in an input: `file:line:column: error: message`.
struct Diagnostic {
    std::string file = {};     ///< as the user named it; "-" reads as "stdin"; empty if unknown
    int line = 0;              ///< 1-based; 0: the file as a whole
    int column = 0;            ///< 1-based, in bytes; 0: the line as a whole
    std::string message = {};  ///< value found, value wanted, hint
    Severity severity = Severity::Error;

    /// "room.env:14:7: ", or "" without a file.
    [[nodiscard]] std::string place() const;
    /// "room.env:14:7: error: wall has zero length"
    [[nodiscard]] std::string text() const;
};

/// Bad data: one or more findings, in the order of the input. Exit status 1. what() is the first.
class FormatError : public std::runtime_error {
  public:
    explicit FormatError(Diagnostic diagnostic);
    explicit FormatError(std::vector<Diagnostic> diagnostics);

    [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

  private:
    std::vector<Diagnostic> diagnostics_;
};

/// Collects findings so that several are reported together.
class Diagnostics {
  public:
    /// Number of findings stored; further ones are only counted.
    static constexpr std::size_t kMax = 20;

    /// Appends a finding, or counts it if kMax are stored.
    void add(Diagnostic diagnostic);
    /// Inserts the findings of a caught error.
    void add(const FormatError& error);
    [[nodiscard]] bool empty() const { return kept_.empty(); }
    [[nodiscard]] bool full() const { return kept_.size() >= kMax; }
    /// Throws FormatError if there is any finding, warnings included; the last one tells how many
    /// were only counted.
    void throwIfAny() const;

  private:
    std::vector<Diagnostic> kept_;
    std::size_t dropped_ = 0;
};

/// Name of an operand in messages: "-" is "stdin".
std::string displayName(std::string_view operand);

/// Receives the progress of long work and tells it when to stop. The library calls it; the tool
/// decides how to show it. Phases do not nest. Progress never changes a result, but stopped() ends
/// a search early, with the best result so far.
class Progress {
  public:
    virtual ~Progress() = default;
    /// Begins a phase of `total` units; 0 if unknown.
    virtual void begin(std::string_view phase, std::int64_t total) = 0;
    /// Adds to the units done. Callable from any thread.
    virtual void advance(std::int64_t count) = 0;
    /// Reports the state in a few words: "best 85.7 %, at most 85.9 %". Callable from any thread.
    virtual void note(std::string_view /*text*/) {}
    /// Ends the phase.
    virtual void end() = 0;
    /// True once a search should return its best result so far, after a signal or at a time limit.
    /// Cheap; callable from any thread.
    [[nodiscard]] virtual bool stopped() const { return false; }
};

/// Ignores all progress.
class SilentProgress final : public Progress {
  public:
    void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
    void advance(std::int64_t /*count*/) override {}
    void end() override {}
};

}  // namespace ispace
