// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cover/coverage.h"

namespace ispace {

/// The cells as a table for other programs: `column,row,x,y,indoor,free,seen`, x and y of the
/// middle, indoor and free 0 or 1, seen by how many; row by row, the lowest first.
std::string coverageCsv(const Coverage& coverage);

/// The plan as a GeoJSON FeatureCollection in metres of the plan: the indoor region and the free
/// floor, the floor seen by exactly 1, 2, ... sensors (`keyword` "seen", with `sensors` and
/// `area`), each sensor as a Point with `heading` and what it sees as an area (`keyword` "view"),
/// and the unseen pieces of the free floor as Points with `area`. Arcs are chords within
/// kChordError; where regions are not known exactly, cells are outlined instead.
std::string coverageGeoJson(const Scene& scene, const Coverage& coverage);

/// A map as ROS' map_server reads it.
struct CoverageRosMap {
    std::string yaml, pgm;
};
/// The cells as such a map: 254 (free) where the indoor floor is seen, 205 (unknown) where it is
/// not, 0 (occupied) where a cell is not on the free floor. \pre cells are squares of `cell` metres
/// \param image_name how the YAML names the picture
CoverageRosMap coverageRosMap(const Coverage& coverage, double cell, const std::string& image_name);

}  // namespace ispace
