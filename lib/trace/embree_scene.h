// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geom/point.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace ispace {

/// Triangles in float32.
struct TriangleSoup {
    std::vector<std::array<float, 3>> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    /// \return the vertex' index
    std::uint32_t add(Point3 corner) {
        vertices.push_back({static_cast<float>(corner.x), static_cast<float>(corner.y),
                            static_cast<float>(corner.z)});
        return static_cast<std::uint32_t>(vertices.size() - 1);
    }
    [[nodiscard]] Point3 corner(std::size_t triangle, std::size_t i) const {
        const auto& [x, y, z] = vertices[triangles[triangle][i]];
        return {x, y, z};
    }
};

/// A built Embree scene: ROBUST, so that no ray slips between triangles with a common edge (corners
/// in the same places, whether or not they are the same vertices) and the packet width changes no
/// result by more than rounding; high quality.
///
/// Each scene has a device of its own: one costs some 50 microseconds, and scenes share nothing.
class EmbreeScene {
  public:
    /// `packet_width`: 4, 8 or 16 rays together, 0 for what the processor traces natively.
    /// \throws std::runtime_error if Embree fails
    EmbreeScene(TriangleSoup soup, int packet_width);

    /// Distance of the first surface in (0, reach[i]] along unit vector i; +infinity without. A
    /// surface seen exactly from its edge stops nothing, nor do surfaces within `contact` of the
    /// origin and those that continue their plane. Neighbouring directions should be alike.
    void intersect(Point3 origin, std::span<const Vec3> directions, std::span<const float> reach,
                   double contact, std::span<float> distances) const;

  private:
    struct Release {
        void operator()(RTCDeviceTy* device) const;
        void operator()(RTCSceneTy* scene) const;
    };
    TriangleSoup soup_;
    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
    std::size_t width_ = 4;
};

}  // namespace ispace
