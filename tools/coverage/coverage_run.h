// SPDX-License-Identifier: GPL-3.0-or-later
// Computes coverage of the rooms of a site, judges requirements, and writes maps.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "arrange/tried_pose.h"
#include "cli/batch.h"
#include "cli/coverage_group.h"
#include "cli/site_operands.h"
#include "coverage/coverage_options.h"
#include "site/site_coverage.h"

namespace ispace {

/// What the tool finds out about a site: of each room, and of all floor.
struct SiteResults {
    SiteCoverage coverage;
    std::optional<SiteCoverage> other;  ///< of --compare
    std::vector<TriedPose> tried;       ///< of --trace
    CoverageFindings found;             ///< of extensions

    /// Returns the parts of a report that were asked for. They refer to the results.
    [[nodiscard]] SiteParts parts() const;
};

/// Takes the storey from the zones of requirements of a room that is one: of `ground/entry`
/// the room has `entry`.
void nameInRoom(CoverageToolOptions& options, const SiteInput& input);

/// Checks that records, products and traces fit the site, and names zones as nameInRoom(), and the
/// product of a room, for %s, as roomFile() does. \throws UsageError
void fitOptions(CoverageToolOptions& options, const SiteInput& input);

/// Warns of the sensors and the size of the cells, and measures, with the other layout of
/// --compare. \param files receives those that were read
/// \throws UsageError for requirements of unknown zones, FormatError if the other layout is one of
/// another room
void measure(const CoverageToolOptions& options, const SiteInput& input,
             std::vector<std::string>& files, SiteResults& results);

/// Reads --trace, from stdin only if no other input is. \throws UsageError for candidates of
/// another room or building
std::vector<TriedPose> readTried(const CoverageToolOptions& options, const SiteInput& input);

/// Writes -o: a file of a room, a page of all storeys, or a file for each. \pre there is a format
void writeProducts(const CoverageToolOptions& options, const SiteInput& input,
                   const SiteResults& results);

/// Returns the findings about the sensors, robots and people of a site.
std::vector<Diagnostic> sensorFindings(const SiteScene& building);

/// Returns one verdict for each requirement, with the measured value as its message; `name`
/// precedes the requirement's text. \pre mustHaveZone()
std::vector<JunitCase> judge(std::span<const Requirement> requirements, const SiteScene& building,
                             const SiteCoverage& coverage, const std::string& name = "");
/// Returns a verdict for each that extensions judge, too.
std::vector<JunitCase> judgeAll(const CoverageToolOptions& options, const SiteScene& building,
                                const SiteResults& results);

/// Joins the messages of those that are unmet; "" if all are met.
std::string unmetText(std::span<const JunitCase> verdicts);

}  // namespace ispace
