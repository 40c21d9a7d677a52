// SPDX-License-Identifier: GPL-3.0-or-later
// Coverage in the formats of other programs: CSV, GeoJSON (RFC 7946), glTF, maps of ROS, NumPy
// arrays (NEP 1). A format is a row of a table, to which extensions add theirs. Formats of cells
// hold the figures by cells, formats of outlines the exact ones where these are known. Equal input
// gives equal bytes; metres, headings in degrees; rows of tables and arrays from the lowest y on,
// those of pictures from the highest.
//
//     const CoverageFormat& csv = coverageFormat("csv");
//     writeAll("seen.csv", csv.write({.scene = scene, .coverage = coverage}).product);
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "coverage/coverage.h"
#include "record/record.h"
#include "report/map/map.h"

namespace ispace {

/// Writes the cells as a CSV table: `column,row,x,y,indoor,free,seen`, where x and y are the cell
/// centre, indoor and free 0 or 1, seen the number of sensors; row by row, the lowest first. With
/// cameras it has a column `density`: the finest of pixelDensities() that one of them reaches, or
/// empty.
std::string coverageCsv(const Coverage& coverage);

/// Writes the plan as a GeoJSON FeatureCollection in metres: the indoor region and the free floor,
/// the floor seen by exactly 1, 2, ... sensors (`keyword` "seen", with `sensors` and `area`), the
/// floor that cameras see with the pixels of each of pixelDensities() (`keyword` "density", with
/// `pixels_per_metre` and `area`), each sensor as a Point with `heading`, its view as an area
/// (`keyword` "view"), and the unseen pieces of the free floor as Points with `area`. Arcs become
/// polygons of the same area, see withArcAreas(); if regions are not known exactly, cells are
/// outlined.
std::string coverageGeoJson(const Scene& scene, const Coverage& coverage);

/// Writes the compiled room, see writeGlb(), with a texture of the cells on its floor: unseen
/// floor, and the map's colours of redundancy, a pixel a cell (at most 4096 a side). \param
/// document the records of the scene
std::string coverageGlb(const Scene& scene, const Coverage& coverage, const Document& document);

/// A product, and the file beside it.
struct CoverageFiles {
    std::string product, beside;
};

/// Writes the cells as a map.yaml and its picture for map_server of ROS: 254 (free) for seen indoor
/// floor, 205 (unknown) for unseen floor, 0 (occupied) for cells off the free floor. \pre cells are
/// squares of `cell` metres \param image_name name of the picture in the YAML
CoverageFiles coverageRosMap(const Coverage& coverage, double cell, const std::string& image_name);

/// Writes the cells as a NumPy array (.npy) of rows and columns, the lowest first: the number of
/// sensors that see a cell as int32, -1 outside the room.
std::string coverageNpy(const Coverage& coverage);
/// Writes NumPy arrays (.npz): seen (uint32), indoor and free (bool), x of the columns' middles, y
/// of the rows' middles, and with cameras density, the pixels a metre of the finest of
/// pixelDensities(), or 0.
std::string coverageNpz(const Coverage& coverage);

/// The input of a product's writer.
struct CoverageProduct {
    const Scene& scene;
    const Coverage& coverage;
    const Coverage* other = nullptr;  ///< compared with it; null: not compared
    MapOptions map = {};
    double cell = 0;                  ///< edge of square cells, if the format requires them
    std::string beside_name = {};     ///< name by which the product refers to the file beside it
    std::vector<double> speeds = {};  ///< shares of full speed, by the number of sensors
    Document document = {};           ///< the scene's records, with their history, for glTF
};

/// A product format: a row that `coverage --to`, the choice by suffix, and the option checks read.
struct CoverageFormat {
    std::string_view name;                      ///< as --to accepts it
    std::optional<PictureFormat> picture = {};  ///< set for maps, which have further options
    double square_cell = 0;  ///< default edge of the square cells that it requires; 0: any cells
    std::string_view suffix = name;       ///< of its files, without dot
    const char* beside_suffix = nullptr;  ///< of a file beside the product, named after it
    bool takes_speeds = false;
    CoverageFiles (*write)(const CoverageProduct& product) = nullptr;
};
/// Adds formats after those of the core; a program does so before it asks for one. Those that a
/// build lacks are addMissingExporter().
void addCoverageFormats(std::span<const CoverageFormat> formats);
/// Returns all formats, in the order of `--to`.
std::span<const CoverageFormat> coverageFormats();
/// Finds a format. \pre a format has this name
const CoverageFormat& coverageFormat(std::string_view name);

}  // namespace ispace
