// SPDX-License-Identifier: GPL-3.0-or-later
// envc with all storeys of a building.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "building/storeys.h"
#include "cli/operands.h"
#include "envc/envc_options.h"

namespace ispace {

/// Reads the building if one input is a building without a chosen storey, with the layouts beside
/// it; std::nullopt for rooms. \throws UsageError for options about one room, and beside rooms
std::optional<StoreyedDocument> readWholeBuilding(const EnvcOptions& options,
                                                  const std::vector<RawInput>& inputs,
                                                  const InputRequest& request);

/// Returns the options for a room alone, with the name of the product, for %s, as roomFile() gives
/// it. \param operand of the room
EnvcOptions optionsOfRoom(EnvcOptions options, const std::string& operand);

/// Checks, reports on, draws or writes the building, as the options say.
void writeBuilding(const EnvcOptions& options, StoreyedDocument document,
                   const ImportReport& report);

}  // namespace ispace
