// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "geom/point.h"

namespace ispace {

/// A flat piece of surface in doubles. Embree tells in float32 which one a ray meets; where it
/// meets it is computed here, so that ranges depend neither on the packet nor on the processor.
struct Facet {
    Vec3 normal;                    ///< unit length
    double offset = 0;              ///< dot(normal, p) of its points
    double size = 0;                ///< longest edge, in metres
    std::array<Point3, 3> corners;  ///< of a line: a, b, b

    /// An upright line of a slice, seen in its plane z = 0. No normal if a and b are one point.
    static Facet ofLine(Point2 a, Point2 b);
    /// No normal if the triangle has no area.
    static Facet ofTriangle(Point3 a, Point3 b, Point3 c);

    [[nodiscard]] bool empty() const { return normal == Vec3{}; }

    /// Distance along the ray to the facet's plane, kept within the facet's own extent along the
    /// ray: what rounding in the search took for a hit is one at the facet's edge.
    [[nodiscard]] double distanceAlong(Point3 origin, Vec3 direction) const;

    /// True if a ray of this direction that meets the facet stays within `slack` metres of its
    /// plane from one end to the other: it is seen from its edge.
    [[nodiscard]] bool isEdgeOn(Vec3 direction, double slack) const;

    /// Distance of a point from the closed facet.
    [[nodiscard]] double distanceTo(Point3 p) const;
};

}  // namespace ispace
