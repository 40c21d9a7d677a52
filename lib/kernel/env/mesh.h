// SPDX-License-Identifier: GPL-3.0-or-later
// Materials and meshes of bodies, and the polygons of their cuts. Triangles are counter-clockwise
// seen from outside and in the order of the body's parts, so models have the same bytes on every
// run.
//
//     for (const Mesh& mesh : meshesOf(element.body, Surfaces::Solid))
//         count += mesh.triangles.size();
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
    View  ///< field of view of a sensor
};

/// Appearance of a material: colour (linear RGB, opacity), metallic share and roughness.
struct Appearance {
    const char* name;
    std::array<double, 3> color;
    double opacity, metallic, roughness;
};

/// Returns the appearance in pictures and models.
const Appearance& lookOf(Material material);

/// Material of fields of view in models; mesh readers skip it.
inline constexpr const char* kViewMaterial = "sensor-view";

struct Body;
struct Plate;
class Record;
struct Sheet;

/// Triangles of one material, counter-clockwise seen from outside; sheets and plates appear once.
struct Mesh {
    Material material = Material::Wood;
    std::vector<Point3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    bool open = false;  ///< has a rim, as sheets and plates have; visible from both sides
};

/// Selects surfaces of a body. Slices contain the opaque ones, since level beams are light.
enum class Surfaces {
    Drawn,  ///< all, patterns on the floor as well
    Solid,  ///< all solid surfaces, which stop sound
    Opaque  ///< surfaces that stop light: all solid ones except clear glass
};

/// Returns true if the selection contains the sheet.
bool isAmong(Surfaces surfaces, const Sheet& sheet);
/// Returns true if the selection contains the plate.
bool isAmong(Surfaces surfaces, const Plate& plate);

/// Returns the body's triangles, one mesh per material, in the order of first use.
std::vector<Mesh> meshesOf(const Body& body, Surfaces surfaces);

/// Returns true if every edge occurs as often in one direction as in the other, so that the
/// triangles bound a solid. O(triangles) if no vertex has very many edges.
bool isWatertight(const Mesh& mesh);

/// Returns the floor of an indoor region at z = 0, from the triangles of its parts.
Mesh floorMesh(std::span<const Triangulation> parts);

/// Builds the body of a `mesh` record; empty while its file is not loaded.
///
/// Maps the file's coordinates to z up (y-up: (x, -z, y); x-up: (y, z, x); z and `auto`, which the
/// loader resolves: unchanged), multiplies them by unit and `scale`, rotates by `heading` and moves
/// the file's origin to `at`, height included. Merges vertices with equal coordinates, so that
/// triangles share edges even if the file repeats its vertices, and removes triangles with fewer
/// than three distinct corners. Reverses a closed mesh that is inside out.
Body meshBody(const Record& record);

/// Returns the length of the file's unit in metres, from `unit` and `scale` of a `mesh` record.
double meshScale(const Record& record);

/// Reports a mesh file that cannot be a body: not loaded, without triangles, or reaching too far.
void checkMesh(const Record& record, const Body& body, Diagnostics& findings);

/// Rotates the list of vertices so that the lowest (lexLess) comes first.
void beginAtLowest(Polygon& polygon);

/// Converts closed curves with the solid on their left to polygons: counter-clockwise curves bound
/// solids, clockwise ones cavities. A cavity is merged with the polygon around it by a seam: from
/// its leftmost vertex to the left and back, within the solid. A cavity that no solid surrounds is
/// a solid seen from inside, and is reversed. Each polygon begins at its lowest vertex (lexLess).
/// \pre each curve begins at its lowest vertex, has an area, and no two equal neighbours.
/// O(n log n) for n vertices if solids do not overlap.
std::vector<Polygon> joinCavities(std::vector<Polygon> curves);

}  // namespace ispace
