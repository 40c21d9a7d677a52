// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/io/sdf: writers of worlds (SDF) and robots (URDF); their bodies as parts.
#pragma once

#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "env/body.h"
#include "env/environment.h"
#include "geom/pose.h"
#include "io/sdf/urdf.h"
#include "scene/bodies.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// An upright shape of SDF in the frame of a model.
struct SdfPart {
    enum class Shape { Box, Cylinder, Ball, Polyline, Mesh };
    Shape shape = Shape::Box;
    Point3 place;   ///< centre of a box, cylinder or ball; foot of a polyline, at the origin
    Angle heading;  ///< of a box
    double length = 0, width = 0, height = 0;  ///< of a box
    double radius = 0;                         ///< of a cylinder or ball
    Polygon outline = {};                      ///< of a polyline, counter-clockwise
    std::string mesh = {};                     ///< name of the part in the file beside the world
    Material material = Material::Wood;
    bool is_solid = true;  ///< collides; patterns on the floor are only drawn
};

/// SDF has no sheets: walls without thickness become boxes this thick, in metres.
constexpr double kSheetThickness = 0.002;

/// Converts an element to parts in the frame of its model, at `frame` and the height `bottom`:
/// rectangles become boxes, circles cylinders, other footprints polylines, meshes of files the part
/// `mesh` of the file beside the world. \param is_framed boxes lie along the frame if they can;
/// else along their longer side
std::vector<SdfPart> sdfParts(const Body& body, const Pose2& frame, double bottom, bool is_framed,
                              const std::string& mesh);

/// An element's frame, that of its record if it has a position, and the parts in it.
struct FramedSdfParts {
    Pose3 frame;
    std::vector<SdfPart> parts;
};
FramedSdfParts sdfParts(const Element& element);

/// Converts a part of a standing person.
SdfPart sdfPart(const BodyPart& part);

/// Adds collision and visual of each part to a link. \param mesh_file beside the world
/// \param names of the link's children, which must be unique across types
void addSdfParts(pugi::xml_node link, const std::vector<SdfPart>& parts,
                 const std::string& mesh_file, XmlNames& names);

/// Adds colours to a visual.
void addSdfMaterial(pugi::xml_node visual, Material material);

/// Bodies of sensors carry this visibility flag, and cameras mask it out: sensors see neither
/// themselves nor each other.
constexpr std::uint32_t kSensorBodies = 2;

/// Adds the sensor to a link, with the fields of view, samples, ranges, rates and noise that SDF
/// supports: gpu_lidar for lasers and spherical rangers, depth_camera for other rangers, camera, or
/// wideanglecamera for a fisheye. A sweep is its first scan. Noise that grows with distance is that
/// at half the maximum range, and a camera's that of mid-grey.
/// \return false, leaving the link unchanged, for kinds that SDF lacks: ultrasound, tags, mirrors
bool addSdfSensor(pugi::xml_node link, const std::string& name, const SensorModel& model,
                  const Pose3& link_from_sensor);

}  // namespace ispace
