// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "layout/scene.h"

namespace ispace {

/// A Wavefront model and its materials.
struct ObjFiles {
    std::string obj, mtl;
};

/// The scene as Wavefront OBJ: metres, z up, one object `o` per element, placed sensor, robot and
/// person, named by its id, and the floor; faces by material, with a normal each, counter-clockwise
/// seen from outside. Coordinates are the shortest decimals that read back as the same doubles.
///
/// Sheets (walls without thickness, panes, floors) are there once, as surfaces to be seen from both
/// sides: viewers that leave out back faces show them from one side only. Faces without area are
/// left out. Equal scenes give equal bytes. O(triangles).
/// \param mtl_name how the model names the file of its materials; "": it names none, and has no
///        materials
ObjFiles writeObj(const Scene& scene, const std::string& mtl_name);

}  // namespace ispace
