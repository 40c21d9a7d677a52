// SPDX-License-Identifier: GPL-3.0-or-later
// The command line of envc, and the products that it writes of a room.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/common_options.h"
#include "cli/option_group.h"
#include "cli/report_group.h"
#include "io/exporters.h"
#include "io/importers.h"
#include "record/edit.h"
#include "record/record.h"
#include "scene/findings/remedies.h"
#include "scene/scene.h"

namespace ispace {

struct EnvcOptions {
    CommonOptions common;
    std::vector<std::string> inputs;  ///< "-" by default
    const ExportFormat* format =
        nullptr;  ///< of the product; null with info, check or list, or for a report alone
    bool info = false, json = false, check = false;
    std::string report;                               ///< file; "": no file
    std::shared_ptr<const ReportExtensions> reports;  ///< of extensions, for people
    std::optional<int> suggestions;                   ///< of a check
    std::string changing;            ///< the command for more edits: all that made the room
    bool list_rooms = false;         ///< instead of writing the room; format is null then, too
    std::optional<double> slice;     ///< height of the obstacle map, which is the product then
    int width = 1200;                ///< pixels of a PNG
    std::vector<std::string> zones;  ///< to omit, or to add
    SceneRules rules;
    ImportOptions import;
    std::string rooms;        ///< "" or a word of --rooms
    std::vector<Edit> edits;  ///< in their order
    std::string history_line;
    ExtensionTask task;  ///< instead of a product; empty: none
};

/// Opens no file. \throws UsageError, TextRequested
EnvcOptions parseEnvcOptions(int argc, const char* const* argv);

/// Returns the file that accompanies the product; "" without one.
std::string besideOf(const EnvcOptions& options);

/// Writes the product and its accompanying file. \throws as OutputFile and the format's writer
void writeProduct(const EnvcOptions& options, const Scene& scene, const Document& document,
                  const FoundRooms* found);

/// Returns remedies as suggestionsText() writes suggestions. \param findings their number before
std::string remediesText(const EnvcOptions& options, std::size_t findings,
                         const std::vector<Remedy>& remedies);

}  // namespace ispace
