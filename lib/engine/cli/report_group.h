// SPDX-License-Identifier: GPL-3.0-or-later
// What a folder of lib/extensions adds to `--report`: files for people beside the JSON of the core,
// with options about them, and lists that go with them. See cli/extension.h.
//
// Order of calls: declare() by tools whose reports are handed over (arrange, coverage), take(), and
// once the site is measured page(), bytesOf() and writeFiles().
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "cli/command_line.h"
#include "drawing/plan/found_rooms.h"
#include "report/page.h"
#include "site/site_coverage.h"

namespace ispace {

/// A requirement with the outcome of its check.
struct JudgedRequirement {
    std::string requirement;  ///< as given, "free:95%"
    bool is_met = false;
    std::string finding;                ///< the clause of Verdict::text
    std::optional<double> margin = {};  ///< measured less required share; empty if unknown
};

/// Contents of the report of arrange, coverage or simrun. References are kept while it is built.
struct SiteReport {
    const SiteScene& building;
    const SiteCoverage& coverage;
    std::string name;     ///< base name of ENV; "" from stdin
    std::string command;  ///< as in histories
    std::vector<JudgedRequirement> requirements = {};
    SiteParts parts = {};
    std::vector<PageSection> more = {};     ///< of the tool, before the figures
    std::vector<Diagnostic> findings = {};  ///< about sensors, with their storeys
    Progress* progress = nullptr;           ///< of the pictures; null: silent
};

/// Contents of the report of envc, likewise.
struct RoomReport {
    const SiteScene& building;
    std::string name;                       ///< base name of the input; "" from stdin
    std::string command;                    ///< as in histories
    const FoundRooms* found = nullptr;      ///< of an import of a room alone; null: no import
    std::vector<Diagnostic> warnings = {};  ///< of the import
};

/// A form of reports, and its options: an object is made for each command line.
class ReportGroup {
  public:
    virtual ~ReportGroup() = default;
    /// Returns the suffixes of its files ("html"), its default first.
    [[nodiscard]] virtual std::span<const std::string_view> formats() const = 0;
    /// Declares the options, bound to members, among those of the tool's files.
    virtual void declare(CommandLine& line) = 0;
    /// Checks the options, and reads files that they name: errors in these precede all work.
    /// \param report file of `--report`; "" without one \throws UsageError; FormatError,
    /// std::system_error
    virtual void take(const std::string& report) = 0;

    /// A file that an option asks for; "": it is not given.
    struct SideFile {
        const char* option = "";  ///< "--material"
        const std::string* file = nullptr;
    };
    /// Returns the files beside the report, which tools claim before their work.
    [[nodiscard]] virtual std::vector<SideFile> files() const = 0;
    /// Returns true if writeFiles() has work.
    [[nodiscard]] virtual bool isAsked() const = 0;
    /// Writes files(). \param scenes of all rooms \returns a warning, without full stop; "" for
    /// none
    [[nodiscard]] virtual std::string writeFiles(
        std::span<const std::shared_ptr<const Scene>> scenes) const = 0;

    /// Builds the report for a file of that name: its bytes do not need what it was made of.
    [[nodiscard]] virtual ReportPage page(const SiteReport& report,
                                          const std::string& file) const = 0;
    [[nodiscard]] virtual ReportPage page(const RoomReport& report) const = 0;
    [[nodiscard]] virtual std::string bytesOf(const ReportPage& page,
                                              const std::string& file) const = 0;
};

/// A row of Extensions, see cli/extensions.h.
struct ReportRow {
    std::string_view extension;
    std::unique_ptr<ReportGroup> (*make)();  ///< null for a format that this build lacks
    std::string_view missing = {};           ///< that format ("html")
};

/// The forms that extensions add to the reports of one command line.
class ReportExtensions {
  public:
    /// \param rows in the order of `--help`
    explicit ReportExtensions(std::span<const ReportRow> rows);
    void declare(CommandLine& line);
    /// Checks the name of a report, and its options. \param report "" without one \throws as
    /// ReportGroup::take(); UsageError for a suffix that neither the core nor an extension writes,
    /// with the extension that this build lacks
    void take(const std::string& report) const;
    /// Returns the names of the options ("--title").
    [[nodiscard]] const std::vector<std::string>& options() const { return options_; }
    /// As those of ReportGroup, for all of them.
    [[nodiscard]] std::vector<ReportGroup::SideFile> files() const;
    [[nodiscard]] bool isAsked() const;
    /// \returns warnings
    [[nodiscard]] std::vector<std::string> writeFiles(
        std::span<const std::shared_ptr<const Scene>> scenes) const;
    /// Returns the form of a report with this name; null for JSON, and without a report.
    /// \pre take()
    [[nodiscard]] const ReportGroup* of(const std::string& report) const;

  private:
    struct Member {
        std::string extension;
        std::shared_ptr<ReportGroup> group;
    };
    std::vector<Member> members_;
    std::vector<ReportRow> missing_;
    std::vector<std::string> options_;
};

}  // namespace ispace
