// SPDX-License-Identifier: GPL-3.0-or-later
// The page of --report.
#pragma once

#include <string>

#include "cli/site_operands.h"
#include "simrun/simrun_options.h"

namespace ispace {

/// Returns the bytes of --report: the coverage of the site and of the run, as coverage --run
/// --report writes them, and the expectations. \pre the record is complete
/// \param command as in histories
std::string reportFile(const SimrunOptions& options, const SiteInput& input, const RunJudge& judge,
                       const std::string& command);

}  // namespace ispace
