// SPDX-License-Identifier: GPL-3.0-or-later
// What a folder of lib/extensions asks of the layouts of arrange besides an objective: options,
// rules for the search or the cases that judge a layout, and what becomes of them in a layout. See
// cli/extension.h.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arrange/arrange.h"
#include "cli/command_line.h"
#include "cli/common_options.h"
#include "cli/site_operands.h"
#include "site/site_coverage.h"

namespace ispace {

/// The inputs of a search, as they were read.
struct ArrangeInput {
    const SiteInput& site;
    const CommonOptions& common;
    const SceneRules& rules;  ///< for further sites
    std::span<const std::string>
        fixed;                        ///< sensors of the layout that keep their poses, see --fixed
    std::vector<std::string>& files;  ///< receives those that are read, for -MD
};

/// Returns the site of a search, which owns all but the scenes of the input. \param goals by room;
/// empty: all floor
std::shared_ptr<const ArrangeSite> searchedSite(const SiteInput& input, const ArrangeOptions& how,
                                                std::vector<RoomGoals> goals = {});

/// A layout that was found, and the site with it.
struct ArrangedSite {
    const SiteInput& input;
    const ArrangeSite& site;  ///< in which it was searched
    const std::vector<SensorGroup>& groups;
    const ArrangeOptions& how;
    const Arrangement& found;
    const SiteScene& placed;
    const SiteCoverage* coverage = nullptr;  ///< of `placed`; null: not measured yet
};

/// What groups find out about a layout.
struct ArrangeFindings {
    /// A sentence without full stop, for stderr.
    struct Line {
        std::string text;
        bool is_unmet = false;  ///< the tool exits with 3
    };
    std::vector<Line> lines = {};
    SiteParts parts = {};  ///< sections of the report, which own what they write
};

/// The options of one extension, and their values: an object is made for each command line. The
/// layouts of a batch share it: const functions are thread-safe.
class ArrangeGroup {
  public:
    virtual ~ArrangeGroup() = default;
    /// Where its options stand in --help, and their words in histories: after those of goals, or
    /// before those of the search.
    enum class Place { Goals, Cases };
    [[nodiscard]] virtual Place place() const { return Place::Goals; }
    /// Declares the options, bound to members. The group begins with line.group(HEADING).
    virtual void declare(CommandLine& line) = 0;
    /// Checks the options with each other and with those of the tool. Opens no file.
    /// \throws UsageError
    virtual void take(const CommandLine& line, const ArrangeOptions& how) = 0;
    [[nodiscard]] virtual bool isAsked() const = 0;
    /// Returns those of its options that say which floor counts: objectives that count something
    /// else refuse them.
    [[nodiscard]] virtual std::vector<std::string_view> ofFloor() const { return {}; }
    /// Returns sentences for stderr before the search. \pre isAsked()
    [[nodiscard]] virtual std::vector<std::string> notes(const ArrangeOptions& /*how*/) const {
        return {};
    }
    /// Adds its rules to the goals of the rooms, and to the options what is asked of any room, or
    /// the cases (ArrangeOptions::cases).
    /// \pre isAsked() \throws UsageError for names that the site lacks, and as readers of files
    virtual void aim(const ArrangeInput& input, ArrangeOptions& how,
                     std::span<RoomGoals> goals) const = 0;
    /// Judges a layout; groups whose rules the search itself keeps do not. \pre isAsked()
    virtual void judge(const ArrangedSite& /*site*/, ArrangeFindings& /*findings*/) const {}
};

/// A row of Extensions, see cli/extensions.h.
struct ArrangeRow {
    std::string_view extension;
    std::unique_ptr<ArrangeGroup> (*make)();
};

/// The groups that extensions add to one command line.
class ArrangeExtensions {
  public:
    /// \param rows in the order of `--help` and of reports
    explicit ArrangeExtensions(std::span<const ArrangeRow> rows);
    void declare(CommandLine& line, ArrangeGroup::Place place);
    /// As those of ArrangeGroup, for all of them, or those that are asked.
    void take(const CommandLine& line, const ArrangeOptions& how) const;
    [[nodiscard]] bool isAsked() const;
    [[nodiscard]] std::vector<std::string_view> ofFloor() const;
    [[nodiscard]] std::vector<std::string> notes(const ArrangeOptions& how) const;
    void aim(const ArrangeInput& input, ArrangeOptions& how, std::span<RoomGoals> goals) const;
    [[nodiscard]] ArrangeFindings judge(const ArrangedSite& site) const;

  private:
    struct Member {
        std::string extension;
        std::unique_ptr<ArrangeGroup> group;
    };
    std::vector<Member> members_;
};

}  // namespace ispace
