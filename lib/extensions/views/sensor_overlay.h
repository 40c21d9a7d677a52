// SPDX-License-Identifier: GPL-3.0-or-later
// Layers of pictures of a room: fields of view and beams, coloured floor, and the tops of walls.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "drawing/color.h"
#include "drawing/drawing.h"
#include "extensions/views/projector.h"
#include "scene/scene.h"
#include "trace/render/render.h"

namespace ispace::views {

/// Returns the colour of a sensor, by its index in Scene::sensors, in all drawings of it.
Color sensorColor(std::size_t index);
/// Converts a colour to linear values for rendering.
Rgb linearOf(const Color& color);

/// Sensors' views, as drawn in space.
struct SensorOverlay {
    struct Line {
        std::vector<Point3> places;
        Color color;
        double width = 1;  ///< thousandths of the picture's longer side
    };
    std::vector<PaintedMesh> paint;
    std::vector<Line> lines;
};

/// Returns view cubes of all sensors with an axis (thesis, fig. 3.15), up to obstacles or a quarter
/// of the plan, and with `beams` those of lasers, thinned if they would merge.
/// \param viewer position of the viewer: view cubes around it are skipped
/// \param swings of the limbs of Scene::people, see humanParts(); empty: people stand
SensorOverlay sightMarks(const Scene& scene, bool beams, std::optional<Point3> viewer,
                         std::span<const Angle> swings = {});

/// Colours of the sensors' coverage on the floor.
class FloorColors {
  public:
    /// Computes the sensors' regions at their height (lasers) or on the floor.
    explicit FloorColors(const Scene& scene);
    /// Returns the factor of the floor's colour at a point; white where it is not covered.
    [[nodiscard]] Rgb at(Point2 place) const;

  private:
    /// Sum over the sensors that see a point.
    struct Sum {
        Rgb color{};  ///< sRGB
        float sensors = 0;
    };

    void add(const std::vector<Polygon>& seen, const Color& color);

    Box2 limits_;
    double scale_ = 1;  // pixels a metre
    int columns_ = 0, rows_ = 0;
    std::vector<Sum> sums_;
};

/// Draws walls as seen from above: a dark line along the top, as in plans, and on the floor for
/// walls that are hidden.
class WallTops {
  public:
    /// Stores the references.
    WallTops(const Standpoint& standpoint, const Scene& scene)
        : standpoint_(standpoint), scene_(scene) {}

    /// True for parts of walls between the viewer and the room: the side that faces the viewer is
    /// outdoors, the other side indoors. See RenderSceneOptions::leaves_out.
    [[nodiscard]] bool isBetween(const Element& element, std::span<const Point2> footprint) const;
    [[nodiscard]] PaintedMesh paint() const;

  private:
    const Standpoint& standpoint_;
    const Scene& scene_;
};

}  // namespace ispace::views
