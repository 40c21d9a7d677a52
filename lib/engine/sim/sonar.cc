// SPDX-License-Identifier: GPL-3.0-or-later
// Sonars of a robot, all at once, with few rays.
//
// Bodies come first, then surfaces. For both, each ray gets a lower bound of its distance to the
// rectangles about what stands in the cone, by vectors. Rays within 2 mm of the least bound are
// cast; the echo that they find spares all rays with a greater bound. Ranges are those of casting
// all rays: bounds are in single precision in the frame of the sonar, where their margin of 1 mm
// exceeds all rounding.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/per_thread.h"
#include "base/simd.h"
#include "sim/robot_sensors.h"
#include "sim/sonar_vicinity.h"
#include "trace/rays.h"

namespace ispace {

namespace {

constexpr int kCircles = 3, kInFirst = 6;
static_assert(kSonarRays == 1 + kInFirst * (1 + 2 + 3));
/// Of the body's height.
constexpr double kSonarHeight = 0.75;
/// Lower surfaces are the floor.
constexpr double kFloor = 1e-3;

using Cone = std::array<Vec3, kSonarRays>;

/// Computes unit vectors within a cone about x.
Cone coneOf(Angle fov) {
    // Of all cones: the direction off the axis, in the plane across it.
    static const Cone across = [] {
        Cone rays{};
        std::size_t next = 1;
        for (int circle = 1; circle <= kCircles; ++circle)
            for (int k = 0; k < kInFirst * circle; ++k) {
                const double around = 2 * std::numbers::pi * k / (kInFirst * circle);
                rays[next++] = {0, std::cos(around), std::sin(around)};
            }
        return rays;
    }();
    Cone rays;
    rays[0] = {1, 0, 0};
    std::size_t next = 1;
    for (int circle = 1; circle <= kCircles; ++circle) {
        const auto [c, s] = cosSin((0.5 * circle / kCircles) * fov);
        for (int k = 0; k < kInFirst * circle; ++k, ++next)
            rays[next] = {c, s * across[next].y, s * across[next].z};
    }
    return rays;
}

/// A sonar's cone as seen from above, in a triangle.
struct Sector {
    Point2 origin;
    CosSin axis, half;
    double range = 0;

    /// Returns true if the ends lie beyond the same edge, or the triangle on one side of the line,
    /// by more than the margin.
    [[nodiscard]] bool misses(const Segment2& line, double margin = kEchoSlack) const {
        const Vec2 a = local(line.a), b = local(line.b), along = b - a;
        const Vec2 corner{range, range * half.sin / half.cos};
        const double apart = margin * std::sqrt(dot(along, along));
        const double apex = cross(along, Vec2{} - a), left = cross(along, corner - a),
                     right = cross(along, Vec2{corner.x, -corner.y} - a);
        return (misses(a, margin) & misses(b, margin)) != 0 ||
               std::min({apex, left, right}) > apart || std::max({apex, left, right}) < -apart;
    }
    [[nodiscard]] bool misses(Point2 middle, double radius) const {
        return misses(local(middle), radius + kEchoSlack) != 0;
    }

    /// Converts to the sonar's frame.
    [[nodiscard]] Vec2 local(Point2 p) const {
        const Vec2 way = p - origin;
        return {way.x * axis.cos + way.y * axis.sin, way.y * axis.cos - way.x * axis.sin};
    }

  private:
    /// Returns a bit for each edge that the point lies beyond.
    [[nodiscard]] unsigned misses(Vec2 p, double apart) const {
        const double up = p.y * half.cos, ahead = p.x * half.sin;
        return (p.x < -apart ? 1U : 0U) | (p.x > range + apart ? 2U : 0U) |
               (up - ahead > apart ? 4U : 0U) | (-up - ahead > apart ? 8U : 0U);
    }
};

/// A cone's rays as seen from above, in the sonar's frame. The last one is repeated, so that loops
/// take whole vectors.
constexpr std::size_t kConeLanes = 48;
struct FlatCone {
    explicit FlatCone(const Cone& rays) {
        for (std::size_t i = 0; i < kConeLanes; ++i) {
            x[i] = static_cast<float>(rays[std::min(i, kSonarRays - 1)].x);
            y[i] = static_cast<float>(rays[std::min(i, kSonarRays - 1)].y);
        }
    }
    std::array<float, kConeLanes> x, y;
};

/// The rays of a cone; kept from robot to robot.
struct ConeRays {
    explicit ConeRays(Angle of) : fov(of), half(cosSin(0.5 * of)), rays(coneOf(of)), flat(rays) {}
    /// Returns the rays of a cone, valid until the thread's next call.
    static const ConeRays& of(Angle fov) {
        auto& kept = perThread<std::optional<ConeRays>, ConeRays>();
        if (!kept || kept->fov != fov) kept.emplace(fov);
        return *kept;
    }

    Angle fov;
    CosSin half;
    Cone rays;
    FlatCone flat;
};

/// Lower bounds of the distances along a cone's rays to some surfaces; +infinity for no surface.
using RayBounds = std::array<float, kConeLanes>;

/// A rectangle on the floor, and the sonar in its frame.
struct FlatBox {
    float half_length, half_width;
    float cos, sin;  ///< of its heading in the sonar's frame
    float x, y;      ///< the sonar
};

/// Lowers the bounds of rays that enter a rectangle.
ISPACE_SIMD_CLONES void bound(const FlatCone& rays, const FlatBox& box, RayBounds& bounds) {
    constexpr float kTiny = 1e-30F;  // no ray is exactly parallel
    for (std::size_t i = 0; i < kConeLanes; ++i) {
        const float inv_x = 1 / (rays.x[i] * box.cos + rays.y[i] * box.sin + kTiny);
        const float inv_y = 1 / (rays.y[i] * box.cos - rays.x[i] * box.sin + kTiny);
        const float x1 = (-box.half_length - box.x) * inv_x, x2 = (box.half_length - box.x) * inv_x;
        const float y1 = (-box.half_width - box.y) * inv_y, y2 = (box.half_width - box.y) * inv_y;
        const float near_x = x1 < x2 ? x1 : x2, far_x = x1 < x2 ? x2 : x1;
        const float near_y = y1 < y2 ? y1 : y2, far_y = y1 < y2 ? y2 : y1;
        float enter = near_x > near_y ? near_x : near_y;
        const float leave = far_x < far_y ? far_x : far_y;
        enter = enter > 0 ? enter : 0;
        const float nearer = enter < bounds[i] ? enter : bounds[i];
        bounds[i] = enter <= leave ? nearer : bounds[i];
    }
}

ISPACE_SIMD_CLONES float leastOf(const RayBounds& bounds) {
    RayBounds least = bounds;
    for (std::size_t count = kConeLanes; count % 2 == 0; count /= 2)
        for (std::size_t i = 0; i < count / 2; ++i)
            least[i] = least[i] < least[i + count / 2] ? least[i] : least[i + count / 2];
    return std::min({least[0], least[1], least[2]});
}

/// Bounds by the surfaces of a vicinity that lie in a sector; all 0 without a vicinity.
class ConeBounds {
  public:
    ConeBounds(const FlatCone& rays, const Sector& sector, RayBounds& bounds)
        : rays_(rays), sector_(sector), bounds_(bounds) {}

    void addLines(const SonarVicinity* near) {
        if (near == nullptr || near->is_within_solid) return addAll();
        for (const Segment2& line : near->lines) {
            if (sector_.misses(line)) continue;
            const Vec2 a = sector_.local(line.a), along = sector_.local(line.b) - a;
            const double size = std::sqrt(dot(along, along));
            const Vec2 u = size > 0 ? (1 / size) * along : Vec2{1, 0};
            add(a + 0.5 * along, u, 0.5 * size, 0);
        }
    }
    void addBodies(const SonarVicinity* near) {
        if (near == nullptr) return addAll();
        const Vec2 axis{sector_.axis.cos, sector_.axis.sin};
        for (const SonarVicinity::Body& body : near->bodies)
            if (!sector_.misses(body.middle, body.radius))
                add(sector_.local(body.middle), {dot(axis, body.ahead), cross(axis, body.ahead)},
                    body.half_length, body.half_width);
    }
    [[nodiscard]] float least() const { return is_empty_ ? kNoReturn : leastOf(bounds_); }

  private:
    void addAll() {
        bounds_.fill(0);
        is_empty_ = false;
    }
    /// Adds a rectangle with a margin.
    void add(Vec2 middle, Vec2 u, double half_length, double half_width) {
        if (std::exchange(is_empty_, false)) bounds_.fill(kNoReturn);
        bound(rays_,
              {static_cast<float>(half_length + kEchoSlack),
               static_cast<float>(half_width + kEchoSlack), static_cast<float>(u.x),
               static_cast<float>(u.y), static_cast<float>(-dot(u, middle)),
               static_cast<float>(-cross(u, middle))},
              bounds_);
    }

    const FlatCone& rays_;
    const Sector& sector_;
    bool is_empty_ = true;
    RayBounds& bounds_;  // unset while it is empty
};

/// Rays of a robot's sonars that are cast together; kept to reuse its memory.
struct SonarRays {
    std::vector<std::size_t> sonars;  ///< of each ray
    std::vector<Point3> origins;
    Directions directions;
    std::vector<float> ranges;

    void clear() {
        sonars.clear();
        origins.clear();
        directions.resize(0);
        ranges.clear();
    }
};

/// Searches the nearest echo of each sonar of a robot.
class RingSearch {
  public:
    RingSearch(const RobotModel& model, const Pose2& pose)
        : cone_(ConeRays::of(model.sonar.fov)),
          height_(kSonarHeight * model.height),
          rays_(perThread<SonarRays, struct RaysOfRing>()),
          sonars_(perThread<std::vector<Sonar>, struct SonarsOfRing>()) {
        sonars_.resize(model.sonar.places.size());
        const auto [c, s] = cosSin(pose.heading);
        for (std::size_t k = 0; k < sonars_.size(); ++k) {
            const Pose2& place = model.sonar.places[k];
            const auto& [x, y] = place.position;
            sonars_[k].nearest = kNoReturn;
            sonars_[k].sector = {pose.position + Vec2{c * x - s * y, s * x + c * y},
                                 cosSin(pose.heading + place.heading), cone_.half,
                                 model.sonar.max_range};
        }
    }
    [[nodiscard]] std::size_t size() const { return sonars_.size(); }
    [[nodiscard]] float nearest(std::size_t sonar) const { return sonars_[sonar].nearest; }

    /// Finds nearer echoes of some surfaces.
    /// \param add_bounds sets the bounds of a cone's rays
    /// \param cast shortens the ranges of SonarRays, or sets them
    template <typename AddBounds, typename Cast>
    void search(AddBounds add_bounds, Cast cast) {
        for (Sonar& sonar : sonars_) {
            ConeBounds bounds(cone_.flat, sonar.sector, sonar.bounds);
            add_bounds(bounds);
            sonar.from = bounds.least();
            // Most echoes are about as near as the least bound, and spare all other rays.
            sonar.to = std::min(sonar.nearest, sonar.from + static_cast<float>(2 * kEchoSlack));
        }
        castSome(cast);
        for (Sonar& sonar : sonars_) sonar.from = std::exchange(sonar.to, sonar.nearest);
        castSome(cast);
    }

  private:
    struct Sonar {
        Sector sector;
        float nearest = kNoReturn;
        float from = 0, to = 0;  ///< bounds of the rays that are cast: from the first to below this
        RayBounds bounds = {};
    };

    template <typename Cast>
    void castSome(Cast cast) {
        rays_.clear();
        for (std::size_t k = 0; k < sonars_.size(); ++k)
            if (sonars_[k].from < sonars_[k].to) addRays(k);
        if (rays_.sonars.empty()) return;
        cast(rays_);
        for (std::size_t i = 0; i < rays_.sonars.size(); ++i) {
            float& nearest = sonars_[rays_.sonars[i]].nearest;
            nearest = std::min(nearest, rays_.ranges[i]);
        }
    }

    void addRays(std::size_t k) {
        const Sonar& sonar = sonars_[k];
        const auto [origin, axis] = std::pair(sonar.sector.origin, sonar.sector.axis);
        for (std::size_t i = 0; i < kSonarRays; ++i) {
            if (sonar.bounds[i] < sonar.from || sonar.bounds[i] >= sonar.to) continue;
            const auto& [x, y, z] = cone_.rays[i];
            rays_.directions.x.push_back(x * axis.cos - y * axis.sin);
            rays_.directions.y.push_back(x * axis.sin + y * axis.cos);
            rays_.directions.z.push_back(z);
            rays_.origins.push_back({origin.x, origin.y, height_});
            rays_.ranges.push_back(sonar.nearest);
            rays_.sonars.push_back(k);
        }
    }

    const ConeRays& cone_;
    double height_;
    SonarRays& rays_;
    std::vector<Sonar>& sonars_;
};

}  // namespace

double sonarTop(const RobotModel& model) {
    const Angle half = std::min(0.5 * model.sonar.fov, Angle::degrees(90));
    return kSonarHeight * model.height + model.sonar.max_range * sin(half) + kEchoSlack;
}

Slice echoBand(const Environment& environment, double top) {
    Slice band = environment.band(0, top);
    for (std::size_t i = 0; i < environment.elements().size(); ++i)
        for (const Plate& plate : environment.elements()[i].body.plates) {
            if (plate.visual_only || plate.z <= 0 || plate.z > top) continue;
            band.solids.push_back(plate.outline);
            band.solid_owners.push_back(i);
        }
    return band;
}

double sonarReach(const RobotModel& model) {
    double offset = 0;
    for (const Pose2& place : model.sonar.places)
        offset = std::max(offset, distance(place.position, Point2()));
    return model.sonar.max_range + offset;
}

std::vector<float> sonarRanges(const RobotModel& model, const Pose2& pose,
                               const RayWorld& environment, const MovingBodies& bodies,
                               std::uint32_t own) {
    return sonarRangesNear(nullptr, model, pose, environment, bodies, own);
}

std::vector<float> sonarRangesNear(const SonarVicinity* vicinity, const RobotModel& model,
                                   const Pose2& pose, const RayWorld& environment,
                                   const MovingBodies& bodies, std::uint32_t own) {
    const SonarRing& ring = model.sonar;
    std::vector<float> ranges;
    if (ring.places.empty()) return ranges;
    // The triangles of wider cones are too large.
    if (ring.fov > Angle::degrees(150)) vicinity = nullptr;
    RingSearch search(model, pose);
    search.search([vicinity](ConeBounds& bounds) { bounds.addBodies(vicinity); },
                  [&](SonarRays& rays) {
                      bodies.shorten(rays.origins, rays.directions, 0, rays.ranges.size(),
                                     ring.max_range, own, rays.ranges);
                  });
    search.search(
        [vicinity](ConeBounds& bounds) { bounds.addLines(vicinity); },
        [&](SonarRays& rays) {
            std::vector<float>& echoes = rays.ranges;
            environment.cast(rays.origins, rays.directions, ring.max_range, echoes);
            for (std::size_t i = 0; i < echoes.size(); ++i)
                if (rays.origins[i].z + static_cast<double>(echoes[i]) * rays.directions.z[i] <
                    kFloor)
                    echoes[i] = kNoReturn;
        });
    ranges.reserve(search.size());
    for (std::size_t k = 0; k < search.size(); ++k)
        ranges.push_back(std::max(search.nearest(k), static_cast<float>(ring.min_range)));
    return ranges;
}

}  // namespace ispace
