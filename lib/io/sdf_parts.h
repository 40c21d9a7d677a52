// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "env/body.h"
#include "geom/pose.h"
#include "layout/bodies.h"

namespace ispace {

/// A shape that SDF has a word for, upright, in the frame of a model.
struct SdfPart {
    enum class Shape { Box, Cylinder, Polyline, Mesh };
    Shape shape = Shape::Box;
    Point3 place;   ///< middle of a box or cylinder; of a polyline its foot, in the origin
    Angle heading;  ///< of a box
    double length = 0, width = 0, height = 0;  ///< of a box
    double radius = 0;                         ///< of a cylinder
    Polygon outline = {};                      ///< of a polyline, counter-clockwise
    std::string mesh = {};                     ///< name of the part of the file beside the world
    Material material = Material::Wood;
    bool is_solid = true;  ///< things run into it; patterns on the floor are only drawn
};

/// Walls without thickness are boxes this thick, in metres: there is no other word for them.
constexpr double kSheetThickness = 0.002;

/// The parts of an element in the frame of its model, at `frame` and the height `bottom`:
/// rectangles become boxes, circles cylinders, other footprints polylines, meshes of files the part
/// `mesh` of the file beside the world. \param is_framed boxes lie along the frame if they can;
/// else along their longer side
std::vector<SdfPart> sdfParts(const Body& body, const Pose2& frame, double bottom, bool is_framed,
                              const std::string& mesh);

/// A box or cylinder as a part, of cloth.
SdfPart sdfPart(const Upright& upright);

/// Adds collision and visual of each part to a link. \param mesh_file beside the world
void addSdfParts(pugi::xml_node link, const std::vector<SdfPart>& parts,
                 const std::string& mesh_file);

/// Adds colours to a visual.
void addSdfMaterial(pugi::xml_node visual, Material material);

}  // namespace ispace
