// SPDX-License-Identifier: GPL-3.0-or-later
// The page of --report.
#pragma once

#include <string>
#include <vector>

#include "arrange/suggestion.h"
#include "cli/site_operands.h"
#include "simrun/simrun_options.h"

namespace ispace {

/// Returns the bytes of --report: the coverage of the scene and of the run, as coverage --run
/// --report writes them, and the expectations. \pre the record is complete
/// \param command as in histories
std::string reportFile(const SimrunOptions& options, const SiteInput& input, const RunJudge& judge,
                       const std::string& command);
/// That of a building.
std::string buildingReportFile(const SimrunOptions& options, const SiteInput& input,
                               const RunJudge& judge, const std::string& command);

/// A change of a sensor, and the share of the time of all movers for which a sensor sees them after
/// it.
struct RunSuggestion {
    Suggestion change;
    double seen = 0;
};
/// Returns the lines of --suggest. \param before the share without a change
/// \param named operands of the command that makes a change
std::string suggestionsText(const SimrunOptions& options, const std::vector<std::string>& named,
                            std::vector<RunSuggestion> found, double before);

/// Returns the lines of --suggest, in the form of coverage --suggest. \pre the record is complete
std::string suggestionsText(const SimrunOptions& options, const SiteInput& input);
/// Those of a building, with changes of any storey.
std::string buildingSuggestionsText(const SimrunOptions& options, const SiteInput& input);

}  // namespace ispace
