// SPDX-License-Identifier: GPL-3.0-or-later
// Writers of room formats, and the table of these formats: a row each. exporters.cc holds those of
// the core, addExporters() adds those of extensions.
//
// Equal scenes give equal bytes for any number of threads. Numbers in text are the shortest
// decimals that read back as the same doubles, unless a format rounds. Tables are filled before the
// first use, by one thread; reading them is thread-safe.
//
//     const ExportFormat& format = exportFormat("geojson");
//     writeAll("room.geojson", format.write(scene, document, {}).product);
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"
#include "drawing/plan/found_rooms.h"
#include "io/glb/glb_write.h"
#include "raster/grid.h"
#include "record/record.h"
#include "scene/scene.h"

namespace ispace {

/// Options of the writers, besides the scene.
struct ExportOptions {
    std::optional<double> slice;       ///< the obstacle map at this height instead of the room
    std::optional<double> resolution;  ///< metres a cell of a ROS map; default 0.05
    int width = 1200;                  ///< pixels of a PNG
    std::string title;                 ///< of drawings; "": untitled
    std::string beside;  ///< the companion file, as the product names it; "": no companion
    std::vector<std::string> zones = {};  ///< to keep out of, as readZone() reads them
    const FoundRooms* found = nullptr;    ///< rooms of the import, for drawings; may be null
};

/// A product and its companion file; `beside` is "" if the product is self-contained.
struct ExportedFiles {
    std::string product, beside;
    /// Lists elements that the format cannot represent, as a sentence for messages; "" if complete.
    std::string left_out = "";
};

/// A format of envc: one row of exportFormats().
struct ExportFormat {
    std::string_view name;         ///< as --to takes it
    std::string_view suffix;       ///< of its files, without dot; the first row with it owns it
    std::string_view help;         ///< for the manual, whole sentences
    std::string_view binary = "";  ///< name of a binary format in messages; "" for text
    bool takes_slice = false;
    bool takes_zones = false;  ///< requires them, too
    bool draws_rooms = false;  ///< also those that an import did not keep
    /// Writes the records as given, without a scene; `write` is null then.
    std::string (*write_records)(Document&& document) = nullptr;
    ExportedFiles (*write)(const Scene&, const Document&, const ExportOptions&) = nullptr;
    /// Writes a large product without companion piece by piece; null: use `write`.
    void (*write_to)(const Scene&, const Document&, const ByteSink&) = nullptr;
    /// Suffix of the companion file, which shares the product's base name.
    std::string_view beside_suffix = "";  ///< ".pgm"; "": the format has no companion
    std::string_view beside_role = "";    ///< for messages: "materials"
    bool needs_beside = false;            ///< so that a stream cannot hold the product
    bool beside_as_needed = false;        ///< not every product has a companion
    std::string_view naming_hint = "";    ///< hint for an output name that lacks the suffix
};

/// Adds formats after those of the core; a program does so before it asks for one.
void addExporters(std::span<const ExportFormat> formats);

/// States a format that an extension would write, which this program was built without: the error
/// about `--to NAME` or a file with that suffix names the extension. \param name a literal, as the
/// extension's
void addMissingExporter(std::string_view name, std::string_view extension);

/// Returns the extension that would write a format or suffix; "" for others.
std::string_view missingExporter(std::string_view name);

/// Rejects an output whose suffix is that of a missing format. \throws UsageError
void refuseMissing(const std::string& output);

/// Returns all formats, in the order of `--to`; the default is the first that can represent the
/// requested content.
std::span<const ExportFormat> exportFormats();

/// Returns the row of a format. \pre exportFormats() has one of this name
const ExportFormat& exportFormat(std::string_view name);

/// Writes the plan as a GeoJSON FeatureCollection (RFC 7946) in metres, as its foreign member
/// `"coordinate_system": "local-metres"` says; outlines counter-clockwise, holes clockwise, doubles
/// in shortest form.
///
/// Features, each with `id`, `keyword`, `type` and the values of its record: the indoor region and
/// the free floor at kScanHeight (Polygons), then every element: walls, doors and windows as lines
/// (with `height`, `thickness`), zones and floors as Polygons, things by their footprints, with
/// `bottom` and `top`; inside points, sensors, tags, robots and people as Points with `heading`,
/// mats as Polygons, gates as lines.
///
/// With a height, only the slice there: free floor, lines of walls without thickness, and solids as
/// Polygons, each with the `id` of its element.
std::string writeGeoJson(const Scene& scene, std::optional<double> slice_height);

/// Writes the scene as Wavefront OBJ: metres, y up as most programs read it (x, z, -y of the room,
/// like writeGlb()), which the first line says; one object `o` per element, placed sensor, robot
/// and person, named by its id, and the floor; faces by material, with a normal each,
/// counter-clockwise seen from outside. Coordinates are the shortest decimals that read back as the
/// same doubles.
///
/// Sheets (walls without thickness, panes, floors) are single surfaces: viewers that cull back
/// faces show them from one side only. Faces without area are left out. Equal scenes give equal
/// bytes. O(triangles). \param mtl_name the file of materials, as the model names it; "": no
/// materials
ExportedFiles writeObj(const Scene& scene, const std::string& mtl_name);

struct ModelNode;
/// Writes nodes as Wavefront OBJ without materials, z up as Gazebo reads it.
std::string objOf(const std::vector<ModelNode>& nodes);

/// Writes the scene as binary STL: metres, z up, all elements, placed sensors, robots, people and
/// the floor in one surface; 80 bytes of header, a count, then per triangle its unit normal, three
/// corners (counter-clockwise seen from outside; 32-bit floats, little-endian) and two bytes 0.
///
/// Sheets (walls without thickness, panes, floors) are single surfaces. Triangles without area in
/// floats are left out. Equal scenes give equal bytes. O(triangles).
std::string writeStl(const Scene& scene);

/// Writes the scene as a world of SDF 1.9 (Gazebo): a static model for each element, in the frame
/// of its record if that has a position, with boxes, cylinders and polylines; a ground plane; and
/// static models of sensors, robots and people. Sensors work if SDF knows their kind, see
/// addSdfSensor(); those on a robot are in its link. Walls without thickness are kSheetThickness
/// thick.
///
/// Mesh files are merged into one OBJ beside the world. Sensors that SDF does not know are exported
/// as bodies only; mats, gates and zones are left out; ExportedFiles::left_out counts both. Equal
/// scenes give equal bytes. \param title names the world, up to its first dot \param mesh_name the
/// OBJ, as the world names it \throws UsageError if there are meshes and mesh_name is empty
ExportedFiles writeSdf(const Scene& scene, const std::string& title, const std::string& mesh_name);

/// Writes the placed sensors as URDF: a link each, named by its id, with a fixed joint from `world`
/// or from the link of the robot or person that carries it. The joint of that link from `world` is
/// floating. A robot with a differential drive has the links ID_left_wheel and ID_right_wheel, with
/// continuous joints. Frames have x forward and z up; cameras and rangers with a lens have a second
/// one, ID_optical, with z forward and x right (REP 103).
std::string writeUrdf(const Scene& scene, const std::string& title);
/// Writes a robot and the sensors on it likewise, for programs that know links by other names: the
/// root is the robot. \param frame of the robot \param wheels frames of its left and right one
/// \param sensors frames of all sensors of the scene; those without one are left out
std::string writeRobotUrdf(const Scene& scene, std::size_t robot, const std::string& frame,
                           std::span<const std::string> wheels,
                           std::span<const std::string> sensors);

/// Metres a cell of a ROS map, unless the options say otherwise.
constexpr double kMapResolution = 0.05;
/// Cells of a map along a side, and in all.
constexpr int kMaxMapSide = 30'000;
constexpr std::int64_t kMaxMapCells = 400'000'000;

/// Writes the obstacle map at a height, as ROS' map_server reads and writes it: map.yaml, and
/// beside it the picture (P5, 254 free, 0 occupied, 205 unknown). Cell edges lie on multiples of
/// the resolution, with a rim of unknown cells; only the room is on it.
///
/// A cell is free if its middle lies on the free floor (strictly inside the indoor region, in no
/// solid). Thin walls are kept: where a sheet or the edge of a solid passes between neighbouring
/// free middles, the nearer cell is occupied, so floor on both sides is not connected (by sides),
/// and every solid and hole of the region has at least one occupied cell. Cells beside free ones
/// are never unknown. An import of the map returns the region within one cell.
///
/// free_thresh is 0.196, which keeps 205 (darkness 0.19608) unknown for every reader.
/// O(cells + cells along all lines).
/// \param image_name how map.yaml names the picture
/// \throws UsageError for a resolution that is no length from 0.001 to 1000, or too many cells
ExportedFiles writeRosMap(const Scene& scene, double height, double resolution,
                          const std::string& image_name);

/// Returns the cells of a ROS map: over the box with a rim, their edges on multiples of the
/// resolution.
/// \throws UsageError as writeRosMap()
Grid rosMapCells(const Box2& box, double resolution);

/// Opens the file that `path` names, relative to its folder; std::nullopt if it does not exist.
/// \param anywhere false: it must lie in that folder, or in one of `others` (relative to it), or
/// below, links followed
/// \throws FormatError for `path` if the file may not lie there or is not regular
std::optional<RegularFile> openSideFile(const std::string& path, const std::string& name,
                                        bool anywhere, std::span<const std::string> others = {});

/// Returns the path that openSideFile() opens: `name` is relative to the folder of `path`, for "-"
/// to the current one.
std::string sideFilePath(const std::string& path, const std::string& name);

}  // namespace ispace
