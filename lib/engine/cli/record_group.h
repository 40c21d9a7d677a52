// SPDX-License-Identifier: GPL-3.0-or-later
// What a folder of lib/extensions makes of the record of a run at its end: options of simrun, the
// work that they ask for, and sections of its report. The run has ended and its clients are gone,
// so the work may take long. See cli/extension.h.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command_line.h"
#include "cli/common_options.h"
#include "cli/site_operands.h"
#include "site/site_coverage.h"

namespace ispace {

/// A run that has ended, and its record.
struct RecordedRun {
    const SiteInput& input;
    const std::string& record;  ///< its folder
    const CommonOptions& common;
    const SceneRules& rules;
};

/// The options of one extension, and their values: an object is made for each command line. One
/// without options has report() alone.
class RecordGroup {
  public:
    virtual ~RecordGroup() = default;
    /// Declares the options, bound to members. The group begins with line.group(HEADING).
    virtual void declare(CommandLine& /*line*/) {}
    /// Checks the options; opens no file. \throws UsageError, also without a record
    virtual void take(const CommandLine& /*line*/) {}
    [[nodiscard]] virtual bool isAsked() const { return false; }
    /// Prints or writes what was asked for. \pre isAsked(); the files of the record are complete
    virtual void conclude(const RecordedRun& /*run*/) const {}
    /// Adds its sections to `simrun --report`, asked or not; they live as long as the group.
    /// \pre the files of the record are complete
    virtual void report(const RecordedRun& /*run*/, SiteParts& /*parts*/) {}
};

/// A row of Extensions, see cli/extensions.h.
struct RecordRow {
    std::string_view extension;
    std::unique_ptr<RecordGroup> (*make)();
};

/// The groups that extensions add to one command line.
class RecordExtensions {
  public:
    /// \param rows in the order of `--help`
    explicit RecordExtensions(std::span<const RecordRow> rows);
    void declare(CommandLine& line) const;
    /// As those of RecordGroup, for all of them.
    void take(const CommandLine& line) const;
    [[nodiscard]] bool isAsked() const;
    void conclude(const RecordedRun& run) const;
    void report(const RecordedRun& run, SiteParts& parts) const;

  private:
    std::span<const RecordRow> rows_;
    std::vector<std::shared_ptr<RecordGroup>> groups_;
};

}  // namespace ispace
