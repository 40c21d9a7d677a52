// SPDX-License-Identifier: GPL-3.0-or-later
// Walls with two faces, for programs that know no single faces.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "env/environment.h"
#include "env/openings.h"
#include "env/walls.h"
#include "geom/planar_map.h"
#include "geom/polygon.h"

namespace ispace::ifc {

/// Walls without thickness become this thick, in metres: readers do not recognise single faces.
constexpr double kThinWall = 0.005;

/// A wall whose faces are lines without thickness, as buildings are imported.
struct SolidWall {
    Region footprint;
    double bottom = 0, top = 0;
    std::size_t line = 0;  ///< one of its faces
};

/// An opening through a solid wall.
struct SolidHole {
    std::size_t opening = 0, solid = 0;
    Segment2 middle;   ///< along the wall, between its faces
    double depth = 0;  ///< between the faces
};

/// Walls before any opening is cut.
struct WholeWalls {
    WallPlan plan;
    std::vector<Opening> openings;
    std::vector<OpeningCut> cuts;   ///< those in bodies; of each opening, that of its line first
    std::vector<SolidWall> solids;  ///< the floor between faces that an opening joins
    std::vector<SolidHole> holes;   ///< by opening
    std::vector<Body> bodies;       ///< of each line that is no face of a solid wall
    std::vector<double> lengths;    ///< of each body

    /// O(n log n) for n walls and openings, but each hole is compared with the faces of all solids.
    explicit WholeWalls(const Environment& environment);
    /// Returns footprints of walls that have a thickness and stand on the floor.
    [[nodiscard]] std::vector<Polygon> footprints() const;

  private:
    /// Finds solids and holes. \returns the parts that are no faces of solids
    std::vector<WallPart> outsideSolids(std::vector<WallPart> parts, const Environment& environment,
                                        const WeldedLines& welded);
    /// Adds the holes of an opening's cuts. \param solid_at finds the solid around a point
    void addHoles(std::span<const OpeningCut> of_opening,
                  const std::function<std::optional<std::size_t>(Point2)>& solid_at);
    /// Returns true if the line has a body at the opening: of coincident lines only one has.
    [[nodiscard]] bool stands(const OpeningCut& cut) const;
};

}  // namespace ispace::ifc
