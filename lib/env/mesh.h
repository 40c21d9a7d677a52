// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "env/material.h"
#include "geom/polygon.h"

namespace ispace {

struct Body;
struct Plate;
struct Sheet;

/// Triangles of one material, counter-clockwise seen from outside; sheets and plates once.
struct Mesh {
    Material material = Material::Wood;
    std::vector<Point3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    bool open = false;  ///< has a rim, as sheets and plates: is seen from both sides
};

/// Which surfaces of a body count. Slices follow the rule for light, as level beams do.
enum class Surfaces {
    Drawn,  ///< all, patterns on the floor as well
    Solid,  ///< all that stands: what stops sound
    Opaque  ///< what stops light: all that stands but clear glass
};

/// True if a sheet is among these surfaces.
bool isAmong(Surfaces surfaces, const Sheet& sheet);
/// True for a plate.
bool isAmong(Surfaces surfaces, const Plate& plate);

/// The body's triangles, one mesh per material, in the order of first use.
std::vector<Mesh> meshesOf(const Body& body, Surfaces surfaces);

/// True if every edge is met as often in one direction as in the other: the triangles then bound
/// something. O(triangles) for edges that are well spread over the vertices.
bool isWatertight(const Mesh& mesh);

/// The floor of an indoor region at z = 0.
Mesh floorMesh(const Regions& indoor);

}  // namespace ispace
