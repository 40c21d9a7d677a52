// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies as casters of shadows on a level plane: central projections from a sensor, in doubles,
// which an overlay unites (shadow_footprint.h). Most bodies near a sensor indoors lie in the shadow
// of a wall and are skipped. Order and bytes depend on environment and sensor alone.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "env/environment.h"
#include "geom/overlay/overlay.h"
#include "geom/point.h"
#include "geom/pose.h"
#include "geom/spatial_index.h"

namespace ispace {

/// A group of triangles that cast one shadow.
struct ShadowBody {
    enum class Kind {
        Convex,  ///< the surface of a convex solid, counter-clockwise seen from outside
        Flat,    ///< triangles of one plane that do not overlap
        Loose,   ///< any triangles
    };
    Kind kind = Kind::Loose;
    std::vector<Point3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    Box2 plan;
    double bottom = 0, top = 0;
    /// The curve of a round prism; the triangles are those of the inscribed prism.
    std::optional<Ellipse> curve = {};
};

/// Returns the body as seen from a point, stored in `memory` if it differs: the outline of a round
/// prism gets corners where lines of sight touch its curve, and the area of the curve.
const ShadowBody& seenFrom(Point3 place, const ShadowBody& body, ShadowBody& memory);

/// Adds a prism: as one body if it is convex, else face by face.
void addPrism(const Prism& prism, std::vector<ShadowBody>& bodies);

/// The bodies of an environment. Those of an element are built when the first sensor comes near
/// it. Thread-safe.
class ShadowBodies {
  public:
    explicit ShadowBodies(const Environment& environment);

    /// A box in space.
    struct Space {
        Box2 plan;
        double bottom = 0, top = 0;
    };
    /// Returns the bodies of all elements that reach into a space: for Solid surfaces clear glass
    /// first, then the others.
    [[nodiscard]] std::vector<const ShadowBody*> near(const Space& space, Surfaces surfaces) const;

    [[nodiscard]] const ShadowBody& floor() const;

  private:
    struct Standing {
        double bottom = 0, top = 0;
        Lazy<std::vector<ShadowBody>> clear, opaque;
    };

    Environment environment_;
    BoxTree plan_;
    std::deque<Standing> elements_;
    Lazy<ShadowBody> floor_;
};

/// An edge of a shadow, which lies on its left.
struct ShadowEdge {
    Point2 from, to;
};

/// Computes the shadows that bodies cast from a sensor on a level plane.
class Shadows {
  public:
    /// Sets the level plane at `height` and the box, relative to the sensor's foot, that clips the
    /// shadows. \pre height is not that of the sensor
    Shadows(std::span<const ShadowBody* const> bodies, Point3 sensor, double height,
            const Box2& box);

    /// Returns the shadow of a standing body as layers relative to the sensor's foot. Surfaces in
    /// contact with the sensor (and those that continue them) or with the plane cast no shadow. A
    /// body well within the shadow of a wall has no layers, as most bodies near a sensor indoors.
    [[nodiscard]] std::vector<Layer> of(const ShadowBody& standing) const;

  private:
    /// A point between sensor and plane: its offset from the sensor in the plan, and its share of
    /// the drop to the plane (0 at the sensor). Its shadow falls at (x, y) / share.
    struct Place {
        double x, y, share;
        friend auto operator<=>(const Place&, const Place&) = default;
    };
    using Corners = std::array<Place, 3>;
    /// Points p of the plan with dot(normal, p) > offset.
    struct HalfPlane {
        Vec2 normal;  // of unit length
        double offset;
    };

    [[nodiscard]] Place placeOf(Point3 p) const;
    [[nodiscard]] double sideOf(const Place& p, int plane) const;
    void addScreen(const ShadowBody& body);
    [[nodiscard]] bool isHidden(const ShadowBody& body) const;
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
    std::vector<Vec3> touched_;  // unit normals of surfaces in contact with the sensor
    std::vector<std::array<HalfPlane, 3>> screens_;  // shadows of walls, less a margin
};

/// Returns the segments in which bodies cut a plane, in its axes (forward, left) from its origin.
/// Skips faces in the plane, but not the sides of faces that only touch it.
std::vector<Segment2> cutsOf(std::span<const ShadowBody* const> bodies, const Frame3& plane,
                             double max_range);

}  // namespace ispace
