// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geom/point.h"
#include "trace/facet.h"

namespace ispace {

/// Where float32 coordinates are counted from: the middle of the plan, and in a slice its plane.
struct PlanFrame {
    Point3 middle;
    bool is_flat = false;  ///< a slice: z is 0

    /// A point of the world in this frame.
    [[nodiscard]] Point3 local(Point3 p) const {
        return {p.x - middle.x, p.y - middle.y, is_flat ? 0 : p.z - middle.z};
    }
};

/// What a FacetIndex is built from, all in the plan's frame.
struct FacetSoup {
    PlanFrame frame;
    double slack = 0;  ///< metres; more than all roundings to float32 together
    std::vector<Facet> facets;
    std::vector<Point3> vertices;   ///< what Embree sees of each facet, facet by facet
    std::size_t vertices_each = 3;  ///< 3: triangles; 4: quadrangles
};

/// The Embree scene behind RayWorld.
class FacetIndex {
  public:
    /// \throws std::runtime_error if Embree fails
    FacetIndex(FacetSoup soup, int packet_width);
    ~FacetIndex();
    FacetIndex(const FacetIndex&) = delete;
    FacetIndex& operator=(const FacetIndex&) = delete;

    /// As of RayWorld, in world coordinates.
    void cast(Point3 origin, std::span<const Vec3> directions, double max_range,
              std::span<float> ranges) const;
    void look(Point3 origin, std::span<const Point3> targets, std::span<std::uint8_t> seen) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
