// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "coverage/shadow_bodies.h"
#include "geom/tolerance.h"

namespace ispace {

namespace {

/// Computes the segment in which a triangle cuts the plane z = 0. The triangle is closed: one that
/// only touches the plane with a side cuts it there; one in the plane is cut along its edge.
std::optional<Segment2> cutOf(const std::vector<Vec3>& local,
                              const std::array<std::uint32_t, 3>& triangle) {
    std::array<Point2, 3> on;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& p = local[triangle[i]];
        if (p.z == 0) on[count++] = {p.x, p.y};
        // The same end for both triangles of a side.
        const Vec3& a = local[std::min(triangle[i], triangle[(i + 1) % 3])];
        const Vec3& b = local[std::max(triangle[i], triangle[(i + 1) % 3])];
        if (!((a.z > 0 && b.z < 0) || (a.z < 0 && b.z > 0))) continue;
        const double t = a.z / (a.z - b.z);
        on[count++] = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
    }
    if (count != 2) return std::nullopt;
    return Segment2{on[0], on[1]};
}

}  // namespace

std::vector<Segment2> cutsOf(std::span<const ShadowBody* const> bodies, const Frame3& plane,
                             double max_range) {
    std::vector<Segment2> cuts;
    std::vector<Vec3> local;
    ShadowBody memory;
    const Vec2 reach{max_range, max_range};
    const Point2 foot = plane.origin.onFloor();
    for (const ShadowBody* const standing : bodies) {
        if (!standing->plan.meets({foot - reach, foot + reach})) continue;
        const ShadowBody& body = seenFrom(plane.origin, *standing, memory);
        local.clear();
        for (const Point3& p : body.vertices) {
            Vec3 place = plane.toLocal(p);
            if (std::fabs(place.z) <= kContactTolerance) place.z = 0;
            local.push_back(place);
        }
        for (const auto& [i, j, k] : body.triangles) {
            const std::optional<Segment2> cut = cutOf(local, {i, j, k});
            if (cut && cut->a != cut->b) cuts.push_back(*cut);
        }
    }
    return cuts;
}

}  // namespace ispace
