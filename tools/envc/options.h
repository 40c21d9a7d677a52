// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "cli/command_line.h"
#include "io/import_options.h"

namespace ispace {

struct EnvcOptions {
    CommonOptions common;
    std::vector<std::string> inputs;  ///< "-" if none is given
    std::string format;               ///< glb, env or 3dm
    bool info = false, json = false;
    bool any_environment = false;
    ImportOptions import;
    std::string history_line;
};

/// Opens no file. \throws UsageError, TextRequested
EnvcOptions parseEnvcOptions(int argc, const char* const* argv);

}  // namespace ispace
