// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/worlds: the solids of a simulator's world become a room. Readers of worlds
// (gazebo, webots) find the solids; this folder knows no format of theirs.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "extensions/worlds/world_shapes.h"
#include "geom/polygon.h"
#include "io/import_records.h"
#include "io/mesh_files.h"
#include "io/plan/plan_rooms.h"
#include "record/schema.h"

namespace ispace::worlds {

/// Bodies that stand on the floor may begin this far from it, in metres.
constexpr double kMaxFoot = 0.1;

/// Returns true for an axis, of length 1, that points up or down.
bool isUpright(const Eigen::Vector3d& axis);
/// Returns the direction on the floor, without the rounding of poses.
Angle headingOf(const Eigen::Vector3d& axis);
Point2 floorOf(const Eigen::Vector3d& place);

/// An upright box or cylinder of a world.
struct WorldBlock {
    Point2 center;
    Angle heading;  ///< of the length
    double length = 0, width = 0;
    double bottom = 0, top = 0;
    bool is_round = false;
    std::string model;
    std::optional<WorldOpening> opening = {};
    bool is_wall = false;  ///< by its name
    int line = 0;          ///< of the file
};

/// Converts a box or cylinder to a block; std::nullopt if it is tilted.
std::optional<WorldBlock> blockOf(const WorldShape& shape, const WorldBox& box);
std::optional<WorldBlock> blockOf(const WorldShape& shape, const WorldCylinder& cylinder);
/// Converts a polyline that is the outline of an ellipse, as this program writes round things;
/// std::nullopt for another form, or if it is tilted.
std::optional<WorldBlock> blockOf(const WorldShape& shape, const WorldPolyline& polyline);

/// A wall of a world, as lines of a plan.
struct WorldWall {
    std::vector<PlanPath> paths;  ///< of a box its mid-line
    double thickness = 0, top = 0;
    std::string model;
    int line = 0;  ///< of the file
    /// Of a box, and its line on the mid-line.
    std::optional<std::pair<WorldOpening, Segment2>> opening = {};
};

/// Returns true for a box with the name or the form of a wall: at most 0.5 m thick, three times as
/// long and twice as high. It stands on the floor, or reaches through the height of a cut.
bool isWall(const WorldBlock& block, std::optional<double> cut);
WorldWall wallOf(const WorldBlock& block);
/// Moves the end of a mid-line along it onto the mid-line of another wall if it ends within that
/// wall's thickness: boxes meet at their faces, rooms at mid-lines.
/// \pre each wall is one straight piece
void joinEnds(std::vector<WorldWall>& walls, Budget& work);

/// Returns the upward axis of a mesh file for its `mesh` record: Gazebo takes COLLADA and OBJ
/// unrotated, whatever axis those name.
std::string worldMeshUp(const std::string& file);

/// A mesh of a world, cut into lines.
struct WorldMeshCut {
    std::size_t shape = 0;  ///< index in WorldShapes::shapes
    WorldWall wall;
};

/// Cuts the available meshes at a height of the world; skips those that do not reach it, and bad
/// files. \param files those that are read already \param name the world's file \param limit of
/// each file, of which `whole` pays for all, and for files that shapes repeat
/// \throws FormatError if fewer units are left, std::system_error as loadMesh
std::vector<WorldMeshCut> cutMeshes(std::span<const WorldShape> shapes, const std::string& name,
                                    double height, const WorkLimit& limit, const Schemas& schemas,
                                    MeshFiles& files);

/// Returns the bounds of a box of these sizes, seen from above.
Box2 boundsOf(const WorldShape& shape, const std::array<double, 3>& size);

/// Returns the cuts that are walls; others are objects in the room. Prefers the cut that, with
/// other walls of the world, encloses half of the world's extent; then those at the edge of the
/// room that all enclose together; then all. \param work pays for crowded outlines \param choose
/// the rooms among lines
std::vector<WorldMeshCut> wallsAmong(
    std::vector<WorldMeshCut> cuts, std::span<const Segment2> others, Budget& work,
    const std::function<PlanRooms(std::span<const Segment2>)>& choose);

/// Writes the room that the solids of a world enclose.
///
/// - Upright boxes on the floor, at most 0.5 m thick, three times as long and twice as high, become
/// walls; ends within the thickness of another wall are moved onto its mid-line, and the
/// room is chosen by chooseRooms(). Other upright boxes become cubes, upright cylinders and
/// elliptic polylines cylinders, other polylines on the floor closed fences. Walls have their
/// openings, and doors join rooms.
/// - Meshes become `mesh` records if their files are there, and are else left out with a warning.
/// Where boxes and polylines enclose no room, or with ImportOptions::slice_walls, those that bound
/// one are cut into walls, see wallsAmong().
/// - Slabs of floor, among them low boxes that most of a room stands on, tilted shapes and all
/// others are skipped, with a note; so is what WorldShapes::left_out counts. \param name the
/// world's file \param work of the world \throws FormatError if no shape is left, or the walls take
/// too much work
void writeWorldRoom(WorldShapes world, const std::string& name, const ImportOptions& options,
                    const Schemas& schemas, Budget& work, ImportRecords& out);

}  // namespace ispace::worlds
