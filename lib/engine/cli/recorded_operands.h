// SPDX-License-Identifier: GPL-3.0-or-later
// Operands of tools that read a recorded run: its scene stands in for those left out.
#pragma once

#include <string>
#include <vector>

namespace ispace {

/// Returns the operands; without any, the site that the record in a folder holds. \param option
/// for messages; an empty folder is no record \throws UsageError unless the folder holds a record
std::vector<std::string> operandsOrRecorded(std::vector<std::string> operands,
                                            const std::string& option, const std::string& folder);

}  // namespace ispace
