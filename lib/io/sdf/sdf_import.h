// SPDX-License-Identifier: GPL-3.0-or-later
// lib/io/sdf: Gazebo's worlds and robots in URDF become rooms.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geom/polygon.h"
#include "io/mesh/mesh_file.h"
#include "io/plan/plan_rooms.h"
#include "io/sdf/sdf_shapes.h"
#include "record/schema.h"

namespace ispace {

/// Bodies that stand on the floor may begin this far from it, in metres.
constexpr double kMaxFoot = 0.1;

/// Returns true for an axis, of length 1, that points up or down.
bool isUpright(const Eigen::Vector3d& axis);
/// Returns the direction on the floor, without the rounding of poses.
Angle headingOf(const Eigen::Vector3d& axis);
Point2 floorOf(const Eigen::Vector3d& place);

/// An upright box or cylinder of a world of SDF.
struct SdfBlock {
    Point2 center;
    Angle heading;  ///< of the length
    double length = 0, width = 0;
    double bottom = 0, top = 0;
    bool is_round = false;
    std::string model;
    int line = 0;  ///< of the file
};

/// Converts a box or cylinder to a block; std::nullopt if it is tilted.
std::optional<SdfBlock> blockOf(const SdfShape& shape, const SdfBox& box);
std::optional<SdfBlock> blockOf(const SdfShape& shape, const SdfCylinder& cylinder);

/// A wall of a world, as lines of a plan.
struct SdfWall {
    std::vector<PlanPath> paths;  ///< of a box its mid-line
    double thickness = 0, top = 0;
    std::string model;
    int line = 0;  ///< of the file
};

/// Returns true for a box with the form of a wall: at most 0.5 m thick, three times as long and
/// twice as high. It stands on the floor, or reaches through the height of a cut.
bool isWall(const SdfBlock& block, std::optional<double> cut);
SdfWall wallOf(const SdfBlock& block);
/// Moves the end of a mid-line along it onto the mid-line of another wall if it ends within that
/// wall's thickness: boxes meet at their faces, rooms at mid-lines.
/// \pre each wall is one straight piece
void joinEnds(std::vector<SdfWall>& walls, Budget& work);

/// Returns the upward axis of a mesh file for its `mesh` record: Gazebo takes COLLADA and OBJ
/// unrotated, whatever axis those name.
std::string sdfMeshUp(const std::string& file);

/// A mesh of a world, cut into lines.
struct SdfMeshCut {
    std::size_t shape = 0;  ///< index in SdfWorld::shapes
    SdfWall wall;
};

/// Cuts the available meshes at a height of the world; skips those that do not reach it, and bad
/// files. \param files those that are read already \param name the world's file \param limit of
/// each file, of which `whole` pays for all, and for files that shapes repeat
/// \throws FormatError if fewer units are left, std::system_error as loadMesh
std::vector<SdfMeshCut> cutMeshes(std::span<const SdfShape> shapes, const std::string& name,
                                  double height, const WorkLimit& limit, const Schemas& schemas,
                                  MeshFiles& files);

/// Returns the bounds of a box of these sizes, seen from above.
Box2 boundsOf(const SdfShape& shape, const std::array<double, 3>& size);

/// Returns the cuts that are walls; others are objects in the room. Prefers the cut that, with
/// other walls of the world, encloses half of the world's extent; then those at the edge of the
/// room that all enclose together; then all. \param work pays for crowded outlines \param choose
/// the rooms among lines
std::vector<SdfMeshCut> wallsAmong(
    std::vector<SdfMeshCut> cuts, std::span<const Segment2> others, Budget& work,
    const std::function<PlanRooms(std::span<const Segment2>)>& choose);

}  // namespace ispace
