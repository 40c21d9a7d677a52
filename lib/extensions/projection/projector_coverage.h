// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/projection: the surfaces of a room on which projectors can show pictures. Uses
// record, env, scene, trace, sense.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "env/projector_model.h"
#include "extensions/projection/surfaces.h"
#include "geom/point.h"
#include "geom/pose.h"
#include "record/record.h"
#include "scene/scene.h"

namespace ispace::projection {

/// Pixels a metre of a picture at a point of a surface: its densities across the direction in which
/// pixels are widest, and across the one in which they are narrowest.
struct PictureDensity {
    double least = 0, most = 0;
};

/// A projector that is turned: how its picture lies on surfaces.
class SurfacePicture {
  public:
    SurfacePicture(const ProjectorModel& model, const Frame3& lens) : model_(&model), lens_(lens) {}
    /// Computes the density at a point of a plane with these unit vectors; empty beside the picture
    /// and behind the lens. It is exact: the singular values of the derivative of the pixel by the
    /// place. \pre the model outlives the picture
    [[nodiscard]] std::optional<PictureDensity> at(Point3 place, Vec3 along, Vec3 across) const;
    [[nodiscard]] const Frame3& lens() const { return lens_; }

  private:
    const ProjectorModel* model_;
    Frame3 lens_;
};

/// An upright rectangle on a flat surface within one picture, without shadow.
struct PictureRectangle {
    Point3 middle;
    double left = 0, bottom = 0;   ///< of its corner, on the surface, see FlatFace
    double width = 0, height = 0;  ///< metres
    Angle pan, tilt;               ///< of the projector
    double least = 0, most = 0;    ///< pixels a metre in it
    Angle slant;                   ///< between the axis of the projector and the surface's normal
    double lux = 0;                ///< the least of a white picture at full level

    /// Returns the distortion: largest over smallest density, 1 for a picture from straight ahead.
    [[nodiscard]] double ratio() const { return most / least; }
};

/// What a projector does with a cell of a surface.
enum class CellState : char {
    Dark,              ///< it cannot face it, or only with fewer pixels and in a shadow
    Coarse,            ///< it lights it with fewer pixels a metre
    Carries,           ///< it shows pictures on it
    Shadowed,          ///< an element of the room is between
    ShadowedByMovers,  ///< only a robot or a person is
};

/// How a projector covers a surface. Areas are in m2.
struct SurfaceProjection {
    std::size_t surface = 0;        ///< index in ProjectionReport::surfaces
    double carries = 0;             ///< area with the density, in some pose of the projector
    double shadowed = 0;            ///< further area that elements of the room shadow
    double shadowed_by_movers = 0;  ///< area that robots and people shadow, and elements do not
    double best = 0;  ///< largest density of a lit point, pixels a metre; 0 without one
    std::optional<PictureRectangle> rectangle = {};  ///< the largest one; of flat surfaces
    std::vector<std::vector<CellState>> cells = {};  ///< of each facet, as FlatFace::cells
};

struct ProjectorCoverage {
    std::string id;
    std::string model;  ///< "" without one
    ProjectorModel figures;
    double carries = 0;                       ///< m2
    std::vector<SurfaceProjection> surfaces;  ///< those that it reaches, in the order of surfaces
};

struct ProjectionReport {
    double density = 0, cell = 0;
    std::vector<ProjectionSurface> surfaces;
    std::vector<ProjectorCoverage> projectors;
    std::vector<double> carried;  ///< area of each surface that some projector covers
};

/// Computes the surfaces on which the projectors of a scene can show pictures of at least `density`
/// pixels a metre in every direction, on or off.
///
/// A projector shows a point in the poses within its pan_range and tilt_range; one that does not
/// turn in its present pose. Of those that put the point at one of 5 x 5 positions of the picture,
/// of the pose that faces the surface, and of those at the ends of the ranges the best counts.
/// Elements shadow, clear glass does not; robots and people stand at their starts. The largest
/// rectangle is searched over poses towards a grid of points of the surface, and around the best of
/// these in steps down to 0.1 degrees: larger ones are possible, but not by much.
/// \param cell size of the cells by which areas are summed, metres
/// \throws UsageError as projectionSurfaces()
/// O(projectors * (cells + poses * cells of a surface))
ProjectionReport projectionOf(const Scene& scene, double density, double cell);

/// Returns the cells that projectionOf() takes by default: 5 cm, larger in huge buildings.
double projectionCell(const Environment& environment);

/// The angles of a projector.
struct TurnedAngles {
    double pan = 0, tilt = 0;  ///< degrees, pan in (-180, 180]
};

/// Finds the angles that turn a projector so that a direction lies at a position of its picture.
/// Returns empty if no tilt up to 90 degrees does.
/// \param direction not necessarily of unit length
/// \param across, upright of the position, as tangents to the left and upwards
/// \param heading of the projector
std::optional<TurnedAngles> anglesTowards(Vec3 direction, double across, double upright,
                                          Angle heading);

/// The largest rectangle of cells that are all true.
struct CellRectangle {
    std::size_t column = 0, row = 0, columns = 0, rows = 0;
    [[nodiscard]] std::size_t size() const { return columns * rows; }
};
/// Returns the first of the largest ones, row by row; of size 0 if no cell is true. O(cells)
CellRectangle largestRectangle(const std::vector<char>& cells, std::size_t columns);

}  // namespace ispace::projection
