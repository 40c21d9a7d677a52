// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "drawing/color.h"
#include "drawing/drawing.h"
#include "report/view/projector.h"
#include "scene/scene.h"
#include "trace/render/render.h"

namespace ispace {

/// The colour of a sensor, by its index in Scene::sensors, in all that is drawn of it.
Color sensorColor(std::size_t index);
/// For what is rendered: linear.
Rgb linearOf(const Color& color);

/// What sensors look at, as drawn in space.
struct SensorOverlay {
    struct Line {
        std::vector<Point3> places;
        Color color;
        double width = 1;  ///< thousandths of the picture's longer side
    };
    std::vector<PaintedMesh> paint;
    std::vector<Line> lines;
};

/// View cubes of all sensors with an axis (thesis, fig. 3.15), up to what stops them or a quarter
/// of the plan, and with `beams` those of lasers, thinned where they would run together.
/// \param viewer where one looks from: the view cubes about it are left out
/// \param swings of the limbs of Scene::people, see humanParts(); none: they stand
SensorOverlay sightMarks(const Scene& scene, bool beams, std::optional<Point3> viewer,
                         std::span<const Angle> swings = {});

/// What sensors cover, as colours on the floor.
class FloorColors {
  public:
    /// The sensors' regions at their own height (lasers) or on the floor.
    explicit FloorColors(const Scene& scene);
    /// By which the floor's colour is multiplied there; white where nothing is covered.
    [[nodiscard]] Rgb at(Point2 place) const;

  private:
    /// Of the sensors that see a place.
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

/// Walls as one sees them who looks into a room: a dark line along the top, as in plans, and on the
/// floor for those that are left out.
class WallTops {
  public:
    /// Keeps the references.
    WallTops(const Standpoint& standpoint, const Scene& scene)
        : standpoint_(standpoint), scene_(scene) {}

    /// True for parts of walls between the viewer and the room: the side that faces the viewer is
    /// not indoors, the other one is. See RenderSceneOptions::leaves_out.
    [[nodiscard]] bool isBetween(const Element& element, std::span<const Point2> footprint) const;
    [[nodiscard]] PaintedMesh paint() const;

  private:
    const Standpoint& standpoint_;
    const Scene& scene_;
};

}  // namespace ispace
