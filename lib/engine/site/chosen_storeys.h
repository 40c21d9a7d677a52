// SPDX-License-Identifier: GPL-3.0-or-later
// Files that hold several rooms, and which of them --storey takes.
//
//     if (mayHoldStoreys(bytes, choice))
//         if (auto building = readStoreys(bytes, operand, options, choice))
//             use(chosenStoreys(*std::move(building), choice, operand));
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/importers.h"
#include "io/storey_choice.h"
#include "record/record.h"
#include "site/storeys.h"

namespace ispace {

/// Returns the building of the chosen storeys alone. Passages keep those of their storeys that are
/// left, and are left out with fewer than two; floors stay at their heights.
/// \throws UsageError for a word that fits no storey
StoreyedDocument chosenStoreys(StoreyedDocument building, const StoreyChoice& choice,
                               const std::string& operand);

/// Returns false for files that are certainly one room for this choice, as they are of a storey
/// that is named. O(bytes), without reading other files
bool mayHoldStoreys(std::string_view bytes, const StoreyChoice& choice);

/// Reads all storeys of a building in any format, of which chosenStoreys() takes those that are
/// chosen: ours, Open-RMF, those of addBuildingImporters(). std::nullopt for a file of the latter
/// with one storey if none are chosen: it is a room. \pre mayHoldStoreys() \throws FormatError as
/// readBuilding() and the importers
std::optional<StoreyedDocument> readStoreys(std::string_view bytes, const std::string& operand,
                                            const ImportOptions& options,
                                            const StoreyChoice& choice);

/// Returns the part of a layout that is about these storeys of a whole building. The whole
/// building's digest in its `environment` record becomes that of the storeys.
/// \param told gets a note with the number of records that are left out
Document layoutOfStoreys(Document layout, const StoreyedDocument& whole,
                         const StoreyedDocument& chosen, std::vector<Diagnostic>& told);

}  // namespace ispace
