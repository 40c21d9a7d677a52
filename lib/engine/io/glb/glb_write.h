// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/io/glb: a scene as named meshes, and as glTF. Uses scene and below.
//
// The compiled form is both a model that viewers show and a room that readGlb() reads back exactly:
// triangles are floats relative to an origin near the room, records are text with their doubles.
//
//     OutputFile file("room.glb");
//     writeGlb(scene, document, [&](std::string_view bytes) { file.write(bytes); });
//     file.commit();
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"
#include "env/mesh.h"
#include "geom/pose.h"
#include "record/record.h"
#include "scene/scene.h"

namespace ispace {

/// One named thing of a model as triangles, for the writers of GLB, OBJ and STL.
struct ModelNode {
    std::string id;
    std::string keyword;               ///< "" for the floor of the indoor region (id "floor")
    std::optional<Pose3> pose;         ///< frame of the meshes; if empty, the world frame
    std::vector<Mesh> meshes;          ///< one a material; never empty, each with triangles
    const Element* element = nullptr;  ///< of the scene; null: floor, sensor, robot or person
};

/// Builds nodes of all elements in the order of their records, then of the floor, then of placed
/// sensors, robots and people. Skips elements without a body (zones, inside points). The nodes
/// point into the scene.
std::vector<ModelNode> modelOf(const Scene& scene);
/// Builds the nodes of modelOf() that come from no element: the floor, sensors, robots and people.
/// \param with_views adds the sensors' fields of view
std::vector<ModelNode> placedNodes(const Scene& scene, bool with_views = false);
/// Builds the node of an element; its meshes are empty for an element without visible body.
ModelNode nodeOf(const Element& element);

/// Returns the frame of a node's meshes.
inline Frame3 frameOf(const ModelNode& node) { return node.pose ? Frame3(*node.pose) : Frame3(); }
inline Point3 inWorld(const Frame3& frame, Point3 p) {
    return frame.origin + frame * (p - Point3());
}

/// Returns the unit normal of the face, counter-clockwise seen from its tip; the null vector if the
/// corners are collinear up to rounding.
inline Vec3 faceNormal(const std::array<Point3, 3>& corners) {
    const Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double size = length(normal);
    return size > 0 && std::isfinite(size) ? 1 / size * normal : Vec3();
}

/// A picture that covers a rectangle of the floor, its upper edge at the high y.
struct FloorPicture {
    std::string name;  ///< of the material
    Box2 limits;
    std::string png;
};

/// Writes the compiled form: binary glTF 2.0, one named node per element (and sensor body), shared
/// materials with colours, normals, metres, +Y up; the records of `document` as canonical text with
/// magic and history in a separate buffer view, named by `extras.ispace` of the top level. Equal
/// input gives equal bytes.
///
/// Each mesh file is stored once, in its original coordinates: nodes rotate, scale and translate
/// it. `extras.ispace_meshes` names digest, positions (3 floats a vertex) and indices (3 uint32 a
/// triangle) of each by their buffer views; records find theirs by `digest`.
/// \param picture laid on the floor of the indoor region instead of its colour; may be null
/// \throws FormatError for a model of more than 2 GiB
std::string writeGlb(const Scene& scene, const Document& document,
                     const FloorPicture* picture = nullptr);
/// Writes the same file piece by piece, without holding it in memory.
void writeGlb(const Scene& scene, const Document& document, const ByteSink& sink,
              const FloorPicture* picture = nullptr);
/// Writes a scene without what moves or reads: sensors, robots, people and placed things, which
/// viewers of a run draw by themselves.
std::string writeRoomGlb(const Scene& scene);

/// One of several scenes in a file.
struct GlbPart {
    std::string name, keyword;  ///< of its node
    Pose3 pose;                 ///< of its frame; level
    const Scene* scene = nullptr;
};
/// Writes several scenes to a file, each below a node of its own, which are children of the node
/// `root`. \param text is stored where writeGlb() stores records \throws as that
void writeGlb(std::span<const GlbPart> parts, std::string_view text, std::string_view root,
              const ByteSink& sink);

}  // namespace ispace
