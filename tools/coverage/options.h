// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cover/map.h"

namespace ispace {

struct CoverageToolOptions {
    CommonOptions common;
    std::vector<std::string> operands;
    bool json = false;
    int columns = 100, rows = 100;
    double height = kScanHeight;
    std::optional<double> require;  ///< least coverage.grid, a fraction
    std::string require_text;
    std::string to;
    MapOptions map;
    bool draw = false;  ///< a map is wanted (-o)
    bool any_environment = false;
};

/// Opens no file. \throws UsageError, TextRequested
CoverageToolOptions parseCoverageOptions(int argc, const char* const* argv);

}  // namespace ispace
