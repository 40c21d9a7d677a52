// SPDX-License-Identifier: GPL-3.0-or-later
// lib/env: materials and meshes of bodies, and the polygons of their cuts.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/error.h"
#include "geom/polygon.h"

namespace ispace {

/// The material of a surface, for pictures and viewers.
enum class Material {
    Floor,
    FloorDark,
    Wall,
    Wood,
    WoodDark,
    Brick,
    Concrete,
    Metal,
    Fabric,
    Barrier,
    Box,
    Pillar,
    Ceiling,
    Glass,
    Screen,
    Sensor,
    Robot,
    Skin,
    Cloth,
    Mat,
    Mesh,
    View  ///< the field of view of a sensor
};

/// How a material looks: colour (linear RGB, opacity), metallic share and roughness.
struct Appearance {
    const char* name;
    std::array<double, 3> color;
    double opacity, metallic, roughness;
};

const Appearance& lookOf(Material material);

/// Material of fields of view in models; skipped when a model is read as a mesh.
inline constexpr const char* kViewMaterial = "sensor-view";

struct Body;
struct Plate;
class Record;
struct Sheet;

/// Triangles of one material, counter-clockwise seen from outside; sheets and plates once.
struct Mesh {
    Material material = Material::Wood;
    std::vector<Point3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    bool open = false;  ///< has a rim, as sheets and plates: is seen from both sides
};

/// Selects surfaces of a body. Slices follow the rule for light, as level beams do.
enum class Surfaces {
    Drawn,  ///< all, patterns on the floor as well
    Solid,  ///< all solid surfaces, which stop sound
    Opaque  ///< surfaces that stop light: all solid ones except clear glass
};

/// Returns true if a sheet is among these surfaces.
bool isAmong(Surfaces surfaces, const Sheet& sheet);
/// Returns true for a plate.
bool isAmong(Surfaces surfaces, const Plate& plate);

/// The body's triangles, one mesh per material, in the order of first use.
std::vector<Mesh> meshesOf(const Body& body, Surfaces surfaces);

/// Returns true if every edge occurs as often in one direction as in the other: the triangles then
/// bound a solid. O(triangles) for edges that are well spread over the vertices.
bool isWatertight(const Mesh& mesh);

/// The floor of an indoor region at z = 0, of the triangles of its parts.
Mesh floorMesh(std::span<const Triangulation> parts);

/// Builds the body of a `mesh` record; empty while its file is not loaded.
///
/// The file's numbers are turned so that z is up (y-up: (x, -z, y); x-up: (y, z, x); `auto` and z:
/// as they are, since the loader resolves `auto`), multiplied by unit and `scale`, turned by
/// `heading` and moved to `at`: the file's origin stays the origin, also in height. Vertices at
/// the same place are one, so that triangles share edges though the file may not say so; triangles
/// with fewer than three corners are dropped. A closed mesh that is inside out is turned.
Body meshBody(const Record& record);

/// Metres one of the file's numbers is, by `unit` and `scale` of a `mesh` record.
double meshScale(const Record& record);

/// A finding about the file of a `mesh` record if it cannot be a body: not loaded, without any
/// triangle, or reaching too far.
void checkMesh(const Record& record, const Body& body, Diagnostics& findings);

/// Turns the list of vertices so that the lowest (lexLess) comes first.
void beginAtLowest(Polygon& polygon);

/// Polygons for closed curves that have the solid on their left: counter-clockwise ones bound
/// solids, clockwise ones cavities. A cavity becomes part of the polygon around it, joined by a
/// seam to the left of its leftmost vertex, there and back, which stays in the solid; one that
/// nothing solid surrounds is a solid seen from inside, and turned. The polygons begin at their
/// lowest vertex (lexLess). \pre each curve begins so, too, has an area, and no two equal
/// neighbours.
/// O(n log n) for n vertices where solids do not overlap.
std::vector<Polygon> joinCavities(std::vector<Polygon> curves);

}  // namespace ispace
