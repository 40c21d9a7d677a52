// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "env/body.h"
#include "env/slice.h"

namespace ispace {

/// Adds the exact cut of the body's meshes (`Body::meshes`, not its prisms) by the plane z = height
/// to `out`.
///
/// Loops are joined along the edges that triangles share, never by distance. What a closed mesh
/// encloses becomes solids; a cavity is a loop within the polygon, reached by a seam of no width
/// (there and back along the same line, inside the solid), so that blocked(), difference() and
/// beams are right. Where the surface is open its curve becomes sheets. Meshes are closed sets, as
/// prisms are: a level face counts at its height, whichever side of it is solid; a level face of an
/// open mesh does not, like a plate. O(triangles + k log k) for k triangles that are cut.
/// `owner` is entered for each piece.
void cutMeshes(const Body& body, double height, Slice& out, std::size_t owner = 0);

/// Adds what the body's meshes fill between two heights, ends included, seen from above: the cut at
/// `bottom`, and the projection of each triangle between the heights: a solid, or a sheet where it
/// stands upright. `owner` is entered for each. O(triangles). \pre bottom <= top
void bandOfMeshes(const Body& body, double bottom, double top, Slice& out, std::size_t owner);

}  // namespace ispace
