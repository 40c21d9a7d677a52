// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "io/import_options.h"
#include "record/record.h"

namespace ispace {

/// Reads any environment or layout the library knows, told apart by content: GLB, `#env`, `#3dm`,
/// YAML, ROS map YAML, pictures, HouseExpo JSON, ARIA and MovingAI maps, ASCII DXF, SVG, IFC, and
/// meshes, which become a `mesh`
/// record (also GLB without records of ours); what no content tells is a mesh if its suffix says
/// so. `operand` is a file name or "-". Loads the files of `mesh` records unless
/// ImportOptions::load_meshes is false. \throws FormatError (also: empty input, or no format we
/// know, with a hint), std::system_error
Document readDocument(const std::string& operand, const ImportOptions& options,
                      const Schemas& schemas);

/// True if the bytes are a plan, map or drawing: an importer chooses the rooms of it, so what other
/// inputs and edits know of walls and inside points has to be known to it before (ImportOptions).
bool isPlan(std::string_view bytes, const std::string& operand, const ImportOptions& options,
            const Schemas& schemas);

/// The same for bytes already read.
Document parseDocument(std::string_view bytes, const std::string& operand,
                       const ImportOptions& options, const Schemas& schemas);

}  // namespace ispace
