// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/meshes/meshes.h"

namespace ispace::extension {

Extension meshes() { return {.name = "meshes", .add = meshes::addMeshes}; }

}  // namespace ispace::extension
