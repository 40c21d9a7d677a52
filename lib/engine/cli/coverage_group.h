// SPDX-License-Identifier: GPL-3.0-or-later
// What a folder of lib/extensions adds to the reports of coverage: options, and what they find out
// about a measured site. See cli/extension.h.
//
// Order of calls: declare(), takesRequirement() for each --require, take(), and if isAsked():
// fit() before the site is measured, measure() after it. Groups that search are measured last, once
// the product is written.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/common_options.h"
#include "cli/site_operands.h"
#include "coverage/coverage.h"
#include "coverage/requirement.h"
#include "site/site_coverage.h"

namespace ispace {

/// A site with its coverage, and what the tool's own options ask for.
struct MeasuredSite {
    const SiteInput& input;
    const SiteCoverage& coverage;
    const CoverageOptions& how;
    std::span<const Requirement> requirements;
    const CommonOptions& common;
    const SceneRules& rules;
};

/// What became of a `--require` or of an option of a group that requires something.
struct JudgedShare {
    std::string requirement;  ///< as given
    std::string phrase;       ///< for a page; "": a section of it says so
    Verdict verdict;
};

/// What groups find out.
struct CoverageFindings {
    SiteParts parts = {};  ///< sections of the report; they live as long as their groups
    std::vector<JudgedShare> judged = {};
    std::vector<std::string> files = {};  ///< that were read, for -MD
    /// The signal that ended a search early, 0 without. TERM and INT are ignored afterwards: write
    /// what is there, and endBySignal().
    int signal = 0;
};

/// The options of one extension, and their values: an object is made for each command line and
/// kept until its report is written.
class CoverageGroup {
  public:
    virtual ~CoverageGroup() = default;
    /// Declares the options, bound to members. The group begins with line.group(HEADING).
    virtual void declare(CommandLine& line) = 0;
    /// Checks the options with each other and with those of the tool, and takes what these say
    /// (CommandLine::valuesOf). Opens no file. \throws UsageError
    virtual void take(const CommandLine& line) = 0;
    [[nodiscard]] virtual bool isAsked() const = 0;
    /// Returns true if it wants all densities of cameras (CoverageOptions::whole_densities). It is
    /// called before take().
    [[nodiscard]] virtual bool wantsWholeDensities() const { return false; }
    /// Returns true if it requires something without `--require`. It is called before take().
    [[nodiscard]] virtual bool judgesAlone() const { return false; }
    /// Returns the requirements that it judges, for the help of `--require`: "; of the ways of
    /// --presence presence:95%"; "" for none.
    [[nodiscard]] virtual std::string_view requirements() const { return ""; }
    /// Returns true if it judges what a `--require` says, and keeps that. It is called before
    /// take(). \throws UsageError
    [[nodiscard]] virtual bool takesRequirement(const std::string& /*text*/) { return false; }
    /// Returns the operands of the site of a record, for a command line without operands; empty if
    /// it has none. It is called after take(). \throws FormatError
    [[nodiscard]] virtual std::vector<std::string> recordedSite() const { return {}; }
    /// Checks that records belong to the site, before it is measured. \pre isAsked()
    /// \throws UsageError
    virtual void fit(const SiteInput& /*input*/) const {}
    /// Returns true for a search that may take long, and that a signal ends: it follows the others,
    /// and the product.
    [[nodiscard]] virtual bool searches() const { return false; }
    /// Adds sections to the findings. \pre isAsked() \throws UsageError for names that the site
    /// lacks
    virtual void measure(const MeasuredSite& site, CoverageFindings& findings) = 0;
};

/// A row of Extensions, see cli/extensions.h.
struct CoverageRow {
    std::string_view extension;
    std::unique_ptr<CoverageGroup> (*make)();  ///< null for requirements that this build lacks
    std::string_view missing = {};             ///< their word ("presence")
};

/// The groups that extensions add to one command line.
class CoverageExtensions {
  public:
    /// \param rows in the order of `--help` and of reports
    explicit CoverageExtensions(std::span<const CoverageRow> rows);
    void declare(CommandLine& line);
    /// As those of CoverageGroup, for all of them.
    void take(const CommandLine& line) const;
    [[nodiscard]] bool isAsked() const;
    [[nodiscard]] bool wantsWholeDensities() const;
    [[nodiscard]] bool judgesAlone() const;
    /// Returns what each group says, one after another.
    [[nodiscard]] std::string requirements() const;
    /// \throws UsageError for a requirement that this build lacks, with its extension
    [[nodiscard]] bool takesRequirement(const std::string& text) const;
    /// Returns the first operands that a group has.
    [[nodiscard]] std::vector<std::string> recordedSite() const;
    void fit(const SiteInput& input) const;
    /// Those that search, or the others.
    void measure(const MeasuredSite& site, CoverageFindings& findings, bool searches) const;
    /// Returns the names of the options ("--suggest").
    [[nodiscard]] const std::vector<std::string>& options() const { return options_; }

  private:
    struct Member {
        std::string extension;
        std::shared_ptr<CoverageGroup> group;
    };
    std::vector<Member> members_;
    std::vector<CoverageRow> missing_;
    std::vector<std::string> options_;
};

}  // namespace ispace
