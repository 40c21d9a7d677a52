// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "record/record.h"

namespace ispace {

/// The surfaces of all products of an IFC file but its spaces and holes, in metres where they
/// stand: for `mesh` records. What half-spaces and holes take away is left whole, and geometry that
/// is not read is missing. \throws std::runtime_error for more than kMaxMeshTriangles
TriangleMesh ifcMesh(std::string_view bytes);

}  // namespace ispace
