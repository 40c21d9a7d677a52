// SPDX-License-Identifier: GPL-3.0-or-later
// What a folder of lib/extensions adds to the judgement of runs: options of simrun that say what a
// run must do, and the judge that watches it. See cli/extension.h. An unmet requirement is exit
// status 3, once the run has ended and its files are written.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "server/client_role.h"
#include "sim/sim_time.h"

namespace ispace {

/// Result of a requirement on a run.
struct RunVerdict {
    std::string expectation;  ///< the requirement, as given
    bool is_met = false;
    SimTime time{};           ///< when it was decided
    std::string reason = {};  ///< why it is not met: "r1 was 1.2 m away at t=4.500, never nearer"
};

/// Returns one line for each unmet requirement; "" if all are met.
std::string unmetText(const std::vector<RunVerdict>& verdicts);

/// Watches a run. The same run gets the same verdicts, at any speed and with any number of clients.
class RunJudge {
  public:
    virtual ~RunJudge() = default;
    /// Reads the worlds: call it before the first step and after every step.
    virtual void observe() = 0;
    /// Returns verdicts in the order of the requirements, as if the run ended now.
    [[nodiscard]] virtual std::vector<RunVerdict> verdicts() const = 0;
    /// Writes files at the end of the run. \param record folder of the run, "" without; it is
    /// complete
    virtual void report(const std::string& record) const = 0;
};

/// Options that say what a run must do: an object is made for each command line.
class JudgeGroup {
  public:
    virtual ~JudgeGroup() = default;
    /// Declares the options, bound to members, in the tool's group of tests.
    virtual void declare(CommandLine& line) = 0;
    /// Checks the options; opens no file. \throws UsageError
    virtual void take(const CommandLine& line) = 0;
    /// Returns true if the parsed options state a requirement.
    [[nodiscard]] virtual bool isAsked() const = 0;
    /// Reserves the outputs before the run.
    virtual void claim() const = 0;
    /// \param rooms of the run, which outlive the judge \throws UsageError, FormatError for names
    /// that the run lacks
    [[nodiscard]] virtual std::unique_ptr<RunJudge> judge(std::span<const RunRoom> rooms) const = 0;
};

/// A row of Extensions, see cli/extensions.h.
using MakeJudge = std::unique_ptr<JudgeGroup> (*)();

/// The judges that extensions add to one command line.
class JudgeExtensions {
  public:
    /// \param rows in the order of `--help`
    explicit JudgeExtensions(std::span<const MakeJudge> rows);
    void declare(CommandLine& line);
    /// As those of JudgeGroup, for all of them.
    void take(const CommandLine& line) const;
    [[nodiscard]] bool isAsked() const;
    void claim() const;
    /// Returns the names of the options ("--expect").
    [[nodiscard]] const std::vector<std::string>& options() const { return options_; }
    /// Returns the judge of those that are asked, with their verdicts one after another.
    [[nodiscard]] std::unique_ptr<RunJudge> judge(std::span<const RunRoom> rooms) const;

  private:
    std::vector<std::shared_ptr<JudgeGroup>> groups_;
    std::vector<std::string> options_;
};

}  // namespace ispace
