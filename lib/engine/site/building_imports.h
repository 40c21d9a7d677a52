// SPDX-License-Identifier: GPL-3.0-or-later
// Buildings of other programs.
//
// Importers of extensions are added at the start of a program, before any thread reads files: the
// list is not guarded.
#pragma once

#include <span>
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

/// A format of other programs in which one file holds the storeys of a building: one row. A room of
/// one storey of it is read by its Importer.
struct BuildingImporter {
    bool (*recognises)(std::string_view bytes) = nullptr;
    /// Returns false for files that are certainly one room unless storeys are chosen. O(bytes)
    bool (*may_have_storeys)(std::string_view bytes) = nullptr;
    StoreyedDocument (*read)(std::string_view bytes, const std::string& operand,
                             const ImportOptions& options) = nullptr;
};

/// Adds formats; a program does so before it reads a file.
void addBuildingImporters(std::span<const BuildingImporter> importers);

/// Returns the format of a file; null if there is none.
const BuildingImporter* buildingImporter(std::string_view bytes);

}  // namespace ispace
