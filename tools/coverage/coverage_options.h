// SPDX-License-Identifier: GPL-3.0-or-later
// The command line of coverage: the core's options, and those of its extensions.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/batch.h"
#include "cli/common_options.h"
#include "cli/coverage_group.h"
#include "cli/option_group.h"
#include "cli/report_group.h"
#include "coverage/requirement.h"
#include "report/coverage_formats.h"
#include "report/map/map.h"

namespace ispace {

struct CoverageToolOptions {
    CommonOptions common;
    std::vector<std::string> operands;
    CoverageOptions measure;
    std::vector<Requirement> requirements;
    std::vector<std::string> zones;  ///< to report besides those of the room
    std::string junit;               ///< file for the verdicts on requirements; "": no file
    std::string command;             ///< its history line, without operands
    BatchOptions batch;              ///< a list of scenes to report on
    std::string other;               ///< LAYOUT to compare with; "": no comparison
    bool json = false;
    std::string report;                      ///< file for the report besides stdout; "": no file
    const CoverageFormat* format = nullptr;  ///< of the product; null without one
    std::string trace;  ///< file of tried poses of a search, for the map; "" without
    MapOptions map;
    std::vector<double> speeds = {0.3, 0.6, 1};  ///< of floor seen by 0, 1, ... sensors
    SceneRules rules;
    std::string history_line;
    std::shared_ptr<ReportExtensions> reports;   ///< of extensions, for people
    std::shared_ptr<CoverageExtensions> groups;  ///< of extensions
    ExtensionTask task;                          ///< instead of a report; empty: none
};

/// Opens no file. \throws UsageError, TextRequested
CoverageToolOptions parseCoverageOptions(int argc, const char* const* argv);

}  // namespace ispace
