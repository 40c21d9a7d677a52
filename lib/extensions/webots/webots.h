// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/webots: worlds of Webots (.wbt) become rooms.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "io/importers.h"

namespace ispace::webots {

/// Returns true if the bytes begin with `#VRML_SIM`.
bool isWebotsWorld(std::string_view bytes);

/// Reads a world of Webots R2022a or later, in metres, as writeWorldRoom() documents for its
/// solids.
///
/// - Of a Solid its boundingObject counts, or without one its shapes, by the poses of all nodes
/// around it (Solid, Pose, Transform with scale, Group, Slot, joints), and by USE. Angles within
/// 1e-5 of a multiple of a quarter turn are that: files have six digits.
/// - Box, Cylinder, Capsule, Cone and Sphere are read, of IndexedFaceSet boxes. Other
/// IndexedFaceSets, Mesh and CadShape are left out with a warning if they may be walls.
/// - Of PROTOs Wall, Door, Window, SolidBox, RectangleArena and Floor are known, by their fields in
/// R2023b; a Wall is a wall, whatever its form. Doors are shut unless their `position` opens them.
/// Others are left out, with a note that names and counts them, as are robots, planes and floors.
/// - A world with `coordinateSystem` NUE or EUN (y up) is turned to z up.
///
/// Files that the world names are not read.
/// \throws FormatError with the line: bad syntax, an older version with other axes, sizes that
/// are not above 0, nodes nested too deep, no solid; more work than ImportOptions::max_work
Document readWebots(std::string_view bytes, const std::string& name, const ImportOptions& options,
                    const Schemas& schemas);

/// The row of Webots, for addImporters().
std::span<const Importer> webotsImporters();

}  // namespace ispace::webots
