// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/common_options.h"
#include "io/exporters.h"
#include "io/input.h"
#include "record/edit.h"

namespace ispace {

struct EnvcOptions {
    CommonOptions common;
    std::vector<std::string> inputs;       ///< "-" if none is given
    const ExportFormat* format = nullptr;  ///< of the product; null with info, check or list
    bool info = false, json = false, check = false;
    bool list_rooms = false;         ///< instead of writing the room; format is null then, too
    std::optional<double> slice;     ///< height of the obstacle map, which is the product then
    int width = 1200;                ///< pixels of a PNG
    std::vector<std::string> zones;  ///< to keep out of, or to add
    SceneRules rules;
    ImportOptions import;
    std::string rooms;        ///< "" or a word of --rooms
    std::vector<Edit> edits;  ///< in their order
    std::string history_line;
};

/// Opens no file. \throws UsageError, TextRequested
EnvcOptions parseEnvcOptions(int argc, const char* const* argv);

}  // namespace ispace
