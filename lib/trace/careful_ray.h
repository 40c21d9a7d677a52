// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "trace/embree_query.h"
#include "trace/triangle_set.h"

namespace ispace {

/// What rounding to float32 moves a corner by in a building, in metres: a surface whose plane is
/// this near to the origin of a ray is seen from its edge.
constexpr double kEdgeOn = 5e-6;

/// The surfaces that stop no ray of an origin: those seen exactly from their edge, those in contact
/// with the origin, and those that continue the plane of one in contact.
struct Passed {
    double contact = 0;
    std::vector<Vec3> touched = {};  ///< unit normals of the surfaces in contact
    /// Other surfaces are so near that float32 does not tell on which side of them rays begin.
    bool is_crowded = false;

    /// Surfaces farther away than this stop rays.
    [[nodiscard]] double clear() const { return touched.empty() ? kEdgeOn : contact; }
    [[nodiscard]] bool contain(const Plane& plane, Point3 origin) const;
};

/// Those of an origin.
Passed passedFrom(RTCScene scene, const TriangleSet& set, Point3 origin, double contact);

/// True if a triangle comes within `radius` of the point.
bool isNear(RTCScene scene, const TriangleSet& set, Point3 p, double radius);

/// Filter for packets of rays from one origin: skips what is passed.
struct PassingQuery : EmbreeQuery {
    const TriangleSet& set;
    const Passed& passed;
    Point3 origin;

    /// Without anything in contact no filter is needed.
    PassingQuery(const TriangleSet& triangles, const Passed& surfaces, Point3 from);
};

/// Where a ray meets a triangle.
struct Meeting {
    double multiple;  ///< of the ray's direction; +infinity if it meets nothing
    std::size_t triangle = 0;
    double slope = 0;  ///< |normal times direction|

    /// Nearer; of two equally near the first.
    friend bool operator<(const Meeting& a, const Meeting& b) {
        return a.multiple < b.multiple || (a.multiple == b.multiple && a.triangle < b.triangle);
    }
};

/// Decides in doubles what a ray meets first, given a hit of Embree's whose triangle, or whether
/// it is one, is not certain; of a crowded origin any hit, or none. Which of the triangles about
/// one place Embree hit changes nothing. A round body that is hit is met where its curve is,
/// without asking whether something else begins between that and the triangle, which lies up to
/// kCurveTolerance aside; a ray that misses the curve goes on.
Meeting meetCarefully(RTCScene scene, const TriangleSet& set, const Passed& passed, const Ray& ray,
                      const RTCRayHit16& hits, std::size_t lane);

}  // namespace ispace
