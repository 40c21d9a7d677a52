// SPDX-License-Identifier: GPL-3.0-or-later
// Buildings of other programs.
#pragma once

#include <string>
#include <string_view>

#include "base/budget.h"
#include "io/importers.h"
#include "site/storeys.h"

namespace ispace {

struct YamlNode;

/// Returns true for the top of a site of Open-RMF: `levels` with `vertices`.
bool isRmfSite(const YamlNode& top);

/// Reads a site of Open-RMF, as its traffic editor writes it (building.yaml).
///
/// - Levels with walls become storeys, in metres by the mean of their measurements (0.05 m a pixel
///   without any, with a warning), y up. Fiducials of the same names lay a level on the reference
///   level, or the first, by a rigid motion; without measurements they also give its scale.
/// - Doors are gaps between ends of walls and become open doors. All closed rooms are kept.
/// - Lifts become `lift` records with the first of their doors; those that stop at one level are
///   left out, and so are models, lanes and floors.
/// \param work of the site, for all levels
/// \throws FormatError with the line, and as the importers of plans
StoreyedDocument readRmfSite(const YamlNode& top, const std::string& operand,
                             const ImportOptions& import, Budget& work);

/// Reads all storeys of an IFC building that have walls or spaces, see readIfcStoreys().
///
/// A flight of stairs from one of them to the next becomes `stairs`: the file gives the box around
/// it, and the end with free floor before it is the foot. A transport element becomes a `lift` of
/// the storeys with a door before one side of its box; one with a single door is left out.
/// \throws FormatError as readIfc(), if no storey has walls, and if lifts and doors take more than
///         a budget
StoreyedDocument readIfcBuilding(std::string_view bytes, const std::string& operand,
                                 const ImportOptions& options);

}  // namespace ispace
