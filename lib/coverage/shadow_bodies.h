// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "env/environment.h"
#include "geom/overlay/overlay.h"
#include "geom/point.h"
#include "geom/pose.h"

namespace ispace {

/// Triangles that throw shadows together.
struct ShadowBody {
    enum class Kind {
        Convex,  ///< the surface of a convex solid, counter-clockwise seen from outside
        Flat,    ///< triangles of one plane that do not overlap
        Loose,   ///< any
    };
    Kind kind = Kind::Loose;
    std::vector<Point3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    Box2 plan;
    double bottom = 0, top = 0;
    /// Of a round prism: the triangles are those of the inscribed one.
    std::optional<Ellipse> curve = {};
};

/// The body as it is seen from a place, made in `memory` if need be: the outline of a round prism
/// has corners where lines of sight touch its curve, and the area of the curve.
const ShadowBody& seenFrom(Point3 place, const ShadowBody& body, ShadowBody& memory);

/// Adds a prism: as one body if it is convex, else face by face.
void addPrism(const Prism& prism, std::vector<ShadowBody>& bodies);
/// Clear glass, which throws shadows of sound alone.
std::vector<ShadowBody> clearBodiesOf(const Environment& environment);
/// Everything else that stands, and as the last the floor.
std::vector<ShadowBody> opaqueBodiesOf(const Environment& environment);

/// An edge of a shadow, which lies on its left.
struct ShadowEdge {
    Point2 from, to;
};

/// Where light comes from, and where shadows fall.
class Shadows {
  public:
    /// Shadows on the level plane at `height`, cut off at the box, which counts from the foot of
    /// the sensor. \pre height is not that of the sensor
    Shadows(std::span<const ShadowBody> bodies, Point3 sensor, double height, const Box2& box);

    /// The shadow of a standing body as layers that count from the foot of the sensor. Surfaces in
    /// contact with the sensor (and what continues them) or with the plane throw none.
    [[nodiscard]] std::vector<Layer> of(const ShadowBody& standing) const;

  private:
    /// A place between sensor and plane: the way from the sensor along the floor, and how much of
    /// the way to the plane it is (0 at the sensor). Its shadow falls at (x, y) / share.
    struct Place {
        double x, y, share;
        friend auto operator<=>(const Place&, const Place&) = default;
    };
    using Corners = std::array<Place, 3>;

    [[nodiscard]] Place placeOf(Point3 p) const;
    [[nodiscard]] double sideOf(const Place& p, int plane) const;
    [[nodiscard]] bool isOutOfTheWay(const ShadowBody& body) const;
    [[nodiscard]] bool mayTouch(const ShadowBody& body) const;
    [[nodiscard]] bool isPassed(const std::array<Point3, 3>& triangle) const;
    [[nodiscard]] bool isClear(const Corners& corners) const;
    void clip(std::vector<Place>& polygon, int plane) const;
    [[nodiscard]] Point2 shadowOf(const Place& p) const;
    void addShadow(const Corners& corners, double turn, std::vector<ShadowEdge>& edges) const;

    Point3 sensor_;
    double drop_;
    Box2 box_;
    std::vector<Vec3> touched_;  // unit normals of what is in contact with the sensor
};

/// The lines in which everything meets a plane, in its own axes (forward, left) from its origin.
/// What lies in the plane is left out, but not the sides of what only touches it.
std::vector<Segment2> cutsOf(std::span<const ShadowBody> bodies, const Frame3& plane,
                             double max_range);

}  // namespace ispace
