// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/ifc: an IFC file as one mesh, for records that take it as a
// body.
#pragma once

#include <string_view>

#include "base/budget.h"
#include "record/record.h"

namespace ispace::ifc {

/// Reads the surfaces of all products of an IFC file but its spaces and holes, in metres in the
/// building's coordinates: for `mesh` records. Half-spaces and holes are not subtracted;
/// unsupported geometry is skipped.
/// \throws std::runtime_error for more than kMaxMeshTriangles, and as IfcShapes
TriangleMesh ifcMesh(std::string_view bytes, Budget& work);

}  // namespace ispace::ifc
