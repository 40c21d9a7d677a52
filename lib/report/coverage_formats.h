// SPDX-License-Identifier: GPL-3.0-or-later
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

/// The cells as a table for other programs: `column,row,x,y,indoor,free,seen`, x and y of the
/// middle, indoor and free 0 or 1, seen by how many; row by row, the lowest first. With cameras
/// there is `density`, too: the finest of pixelDensities() that one of them has there, or nothing.
std::string coverageCsv(const Coverage& coverage);

/// The plan as a GeoJSON FeatureCollection in metres of the plan: the indoor region and the free
/// floor, the floor seen by exactly 1, 2, ... sensors (`keyword` "seen", with `sensors` and
/// `area`), that which cameras see with the pixels of each of pixelDensities() (`keyword`
/// "density", with `pixels_per_metre` and `area`), each sensor as a Point with `heading` and what
/// it sees as an area (`keyword` "view"), and the unseen pieces of the free floor as Points with
/// `area`. Arcs are polygons of the same area, see withArcAreas(); where regions are not known
/// exactly, cells are outlined instead.
std::string coverageGeoJson(const Scene& scene, const Coverage& coverage);

/// The plan as DXF in metres: walls, doors, windows and objects, sensors, what each sees ("views",
/// closed polylines with true arcs), and as solid fillings the indoor floor seen by exactly 1, 2,
/// ... ("seen-1", ...) and by none ("unseen"), each on a layer of its own. Fillings have
/// polygons of the same area for arcs.
std::string coverageDxf(const Scene& scene, const Coverage& coverage);

/// The compiled room, see writeGlb(), whose floor has a picture of the cells on it: unseen floor,
/// and the colours of the map by how many sensors see it, a pixel a cell (at most 4096 a side).
/// \param document its records, those of the scene
std::string coverageGlb(const Scene& scene, const Coverage& coverage, const Document& document);

/// A product, and the file that stands beside it.
struct CoverageFiles {
    std::string product, beside;
};

/// The cells as a map.yaml that ROS' map_server reads, and its picture: 254 (free) where the indoor
/// floor is seen, 205 (unknown) where it is not, 0 (occupied) where a cell is not on the free
/// floor. \pre cells are squares of `cell` metres \param image_name how the YAML names the picture
CoverageFiles coverageRosMap(const Coverage& coverage, double cell, const std::string& image_name);

/// A mask for Nav2's speed filter, as nav2MaskFiles() writes it: free floor that k sensors see has
/// the k-th of `speeds`, or the last one; there is no limit elsewhere. \param speeds shares of full
/// speed, 0.01 to 1, to a hundredth \pre cells are squares of `cell` metres
CoverageFiles coverageSpeedMask(const Coverage& coverage, double cell,
                                std::span<const double> speeds, const std::string& picture_name);
/// A mask for Nav2's keep-out filter: free floor that no sensor sees.
CoverageFiles coverageKeepoutMask(const Coverage& coverage, double cell,
                                  const std::string& picture_name);

/// The cells as a NumPy array (.npy) of rows and columns, the lowest first: by how many sensors a
/// cell is seen as int32, -1 outside the room.
std::string coverageNpy(const Coverage& coverage);
/// As arrays (.npz): seen (uint32), indoor and free (bool), x of the middles of columns, y of those
/// of rows, and with cameras density, the pixels a metre of the finest of pixelDensities(), or 0.
std::string coverageNpz(const Coverage& coverage);

/// What a product is made of.
struct CoverageProduct {
    const Scene& scene;
    const Coverage& coverage;
    const Coverage* other = nullptr;  ///< what it is compared with, if it is
    MapOptions map = {};
    double cell = 0;                  ///< edge of square cells where the format wants them
    std::string beside_name = {};     ///< by which the product names the file beside it
    std::vector<double> speeds = {};  ///< see coverageSpeedMask()
    Document document = {};           ///< the scene's records, with their history, for models
};

/// One format of products: a row that `coverage --to`, the choice by suffix, and the checks of
/// options read.
struct CoverageFormat {
    std::string_view name;                      ///< as --to takes it
    std::optional<PictureFormat> picture = {};  ///< it is a map, which has options of its own
    double square_cell = 0;                     ///< it wants square cells, of this edge unless told
    std::string_view suffix = name;             ///< of its files, without dot
    const char* beside_suffix = nullptr;        ///< of a file beside the product, named after it
    bool takes_speeds = false;
    CoverageFiles (*write)(const CoverageProduct& product) = nullptr;
};
std::span<const CoverageFormat> coverageFormats();
/// \pre a format has this name
const CoverageFormat& coverageFormat(std::string_view name);

}  // namespace ispace
