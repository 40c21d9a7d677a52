// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/gazebo: worlds and models of Gazebo (SDF) become rooms.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "io/importers.h"

namespace ispace::gazebo {

/// Returns true for XML with the root `sdf`, see xmlRootName().
bool isSdf(std::string_view bytes);

/// Reads a world of SDF, or a model: the collision shapes of all links, or the visuals of links
/// without any that every sensor sees (without `visibility_flags`), in the world and in the models
/// that it includes, with the poses of SdfFrames. Spheres, capsules, cones and ellipsoids become
/// the upright cylinders or boxes around them; writeWorldRoom() documents the rest. Meshes have to
/// be in the folders of SdfFiles. Planes are skipped. Entities are not resolved.
/// \throws FormatError with the line: bad XML, no world and no model, malformed numbers, frames
/// that are missing or depend on each other, models nested too deep, includes that include
/// themselves, more work than ImportOptions::max_work, which files that it includes raise; and if
/// no shape is left
Document readSdf(std::string_view bytes, const std::string& name, const ImportOptions& options,
                 const Schemas& schemas);

/// The row of SDF, for addImporters().
std::span<const Importer> gazeboImporters();

}  // namespace ispace::gazebo
