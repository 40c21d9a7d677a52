// SPDX-License-Identifier: GPL-3.0-or-later
// Embree returns the triangle that a ray in float32 meets; its plane is met in doubles, sixteen
// lanes at once. That decides rays well inside a triangle. Rays near a rim, near a surface that
// they may ignore, or on a round body are looked at one by one: the exact intersection first, and a
// second search that skips surfaces which do not stop the ray.
#include "trace/embree_scene.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "trace/embree_query.h"
#include "trace/rays.h"
#include "trace/round_view.h"

namespace ispace {

namespace {

/// The shortest that a ray of the plane through a picture is, at most.
double shortestRay(const RayGrid& grid) {
    const Vec3 normal = cross(grid.right, grid.down);
    const double size = length(normal);
    const double corner = length(grid.corner);
    return size > 0 ? std::min(corner, std::fabs(dot(normal, grid.corner)) / size) : corner;
}

double longestRay(const RayGrid& grid) {
    const int right = grid.columns - 1, low = grid.rows - 1;
    return std::max({length(grid.corner), length(grid.ray(right, 0)), length(grid.ray(0, low)),
                     length(grid.ray(right, low))});
}

void copyLanes(const Directions& directions, std::size_t first, std::size_t lanes,
               RayPacket& packet) {
    const auto copy = [first, lanes](const std::vector<double>& from, RayPacket::Lanes& to) {
        const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
        if (lanes == kLanes) {
            std::copy_n(begin, kLanes, to.begin());
        } else {
            to.fill(begin[static_cast<std::ptrdiff_t>(lanes) - 1]);
            std::copy_n(begin, lanes, to.begin());
        }
    };
    copy(directions.x, packet.x);
    copy(directions.y, packet.y);
    copy(directions.z, packet.z);
}

}  // namespace

/// Traces the packets of one thread.
struct EmbreeScene::Caster {
    const EmbreeScene& scene;
    const IgnoredSurfaces& ignored;
    PassingQuery query;
    double tail;  ///< see roundReach()
    float most;
    SureMeeting sure;
    bool is_alike = true;  ///< all rays have one origin and one reach
    alignas(64) std::array<float, kLanes> far{};
    alignas(64) RTCRayHit16 hits{};
    alignas(64) std::array<int, kLanes> valid{};
    RayPacket packet;
    bool needs_slopes = true;
    RoundView round;  ///< the round body of the previous hit

    Caster(const EmbreeScene& traced, const IgnoredSurfaces& surfaces, Point3 origin,
           double farthest)
        : scene(traced),
          ignored(surfaces),
          query(surfaces, origin),
          tail(8 * traced.set_.tolerance()),
          most(static_cast<float>(farthest)),
          sure{.clear = std::max(surfaces.reach(), traced.set_.tolerance()),
               .longest = 1 + kFloatTolerance,
               .near = static_cast<float>(farthest >= 0 ? farthest * (1 - kFloatTolerance) : -1)} {
        // A NaN limit, like a negative one, is never reached.
        packet.reach.fill(farthest >= 0 ? farthest * (1 + kFloatTolerance) : -1);
        roundReach(packet, tail, far);
        setOrigins({&origin, 1});
        query.rays = {&packet, true, surfaces.rayEpsilon()};
        valid.fill(-1);
        for (unsigned lane = 0; lane < kLanes; ++lane) {
            hits.ray.id[lane] = lane;
            hits.ray.mask[lane] = ~0U;
            hits.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
    }

    /// Computes the lengths of the rays' directions.
    void setLengths(double shortest, double longest) {
        tail = shortest > 0 ? tail / shortest : kMaxRayReach;
        sure.longest = longest * (1 + kFloatTolerance);
        roundReach(packet, tail, far);
    }

    /// Repeats the last ray in all further lanes.
    void setOrigins(std::span<const Point3> origins) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const Point3 origin = origins[std::min(lane, origins.size() - 1)];
            packet.origin_x[lane] = origin.x;
            packet.origin_y[lane] = origin.y;
            packet.origin_z[lane] = origin.z;
        }
        roundOrigins(packet, hits);
    }

    /// Uses the first lanes only.
    void keep(std::size_t lanes) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) valid[lane] = lane < lanes ? -1 : 0;
    }

    void trace() {
        roundRays(packet, far, hits);
        meet();
    }
    /// The rays of a picture's tile.
    void trace(const TileRow& row, int column) {
        aimTile(row, column, far, packet, hits);
        meet();
    }

    void meet() {
        const TriangleSet& set = scene.set_;
        tracePacket(query, scene.scene_.get(), scene.width_, valid.data(), hits);
        const Plane* const planes = set.planes().data();
        const double* const margins = set.margins().data();
        if (is_alike && meetOnePlane(hits, planes, margins, sure, packet)) return;
        std::uint32_t care = meetPlanes(hits, planes, margins, sure.clear, most, packet);
        if (query.rays.have_one_origin && !needs_slopes) care = meetRounds(care);
        for (; care != 0; care &= care - 1)
            lookCloser(static_cast<std::size_t>(std::countr_zero(care)));
    }

    /// Intersects round bodies hit by several rays.
    /// \return the lanes that still need the exact test
    std::uint32_t meetRounds(std::uint32_t care) {
        std::uint32_t rest = 0;
        while (care != 0) {
            const std::uint32_t alike = lanesAlike(care);
            care &= ~alike;
            alignas(64) std::array<float, kLanes> multiples;  // NOLINT: set by meet()
            if ((alike & (alike - 1)) == 0 || !round.meet(packet, multiples)) {
                rest |= alike;
                continue;
            }
            for (std::uint32_t lanes = alike; lanes != 0; lanes &= lanes - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
                packet.multiples[lane] = std::min(multiples[lane], most);
                if (!(multiples[lane] < kNoReturn)) set(lane, traceAlone(lane, packet.ray(lane)));
            }
        }
        return rest;
    }

    /// Selects the lanes that hit the same round body as the first lane, and stores it in `round`;
    /// the first lane alone if its triangle is flat.
    std::uint32_t lanesAlike(std::uint32_t lanes) {
        const std::uint32_t first = lanes & (0U - lanes);
        const auto body = [this](std::uint32_t lane) {
            return scene.set_.roundOf(
                hits.hit.primID[static_cast<std::size_t>(std::countr_zero(lane))]);
        };
        const RoundBody* const met = body(first);
        if (met == nullptr) return first;
        if (met != round.body()) {
            const Point3 origin{packet.origin_x[0], packet.origin_y[0], packet.origin_z[0]};
            round = RoundView(*met, origin, scene.ray_epsilon_);
        }
        std::uint32_t alike = 0;
        for (; lanes != 0; lanes &= lanes - 1)
            if (body(lanes) == met) alike |= lanes & (0U - lanes);
        return alike;
    }

    /// For hits near a triangle's rim, on a round body, or on a surface that may be ignored.
    void lookCloser(std::size_t lane) {
        const Ray ray = packet.ray(lane);
        RayHit hit = ignored.meet(hits.hit.primID[lane], ray);
        if (hit.isNone()) hit = traceAlone(lane, ray);
        set(lane, hit);
    }

    void set(std::size_t lane, const RayHit& hit) {
        packet.multiples[lane] = packet.slopes[lane] = kNoReturn;
        if (hit.isNone()) return;
        packet.multiples[lane] = std::min(static_cast<float>(hit.multiple), most);
        packet.slopes[lane] = static_cast<float>(hit.slope);
    }

    /// Traces one ray of the packet again, skipping surfaces that do not stop it.
    [[nodiscard]] RayHit traceAlone(std::size_t lane, const Ray& ray) const {
        RTCRayHit one{};
        one.ray.org_x = hits.ray.org_x[lane];
        one.ray.org_y = hits.ray.org_y[lane];
        one.ray.org_z = hits.ray.org_z[lane];
        one.ray.dir_x = hits.ray.dir_x[lane];
        one.ray.dir_y = hits.ray.dir_y[lane];
        one.ray.dir_z = hits.ray.dir_z[lane];
        const double reach = ray.reach * (1 + kFloatTolerance) + tail;
        one.ray.tfar = static_cast<float>(std::min(reach, kMaxRayReach));
        one.ray.mask = ~0U;
        one.ray.id = static_cast<unsigned>(lane);
        one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        SingleQuery(ignored, packet, lane).trace(scene.scene_.get(), &one);
        if (one.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
        return ignored.meet(one.hit.primID, ray);
    }

    void writeLanes(std::size_t first, std::size_t lanes, const Results& results) const {
        const auto copy = [first, lanes](const auto& from, std::span<float> to) {
            std::copy_n(from.begin(), lanes, to.begin() + static_cast<std::ptrdiff_t>(first));
        };
        copy(packet.multiples, results.ranges);
        if (results.cosines.empty()) return;
        for (std::size_t lane = 0; lane < lanes; ++lane)
            results.cosines[first + lane] = std::min(1.0F, packet.slopes[lane]);
    }

    /// Copies the first lanes of row `k` of a tile to the picture.
    void writeTileRow(std::size_t k, std::size_t first, std::size_t lanes,
                      const Results& results) const {
        const std::size_t begin = k * std::size_t{kTile};
        const float* const from = packet.multiples.data() + begin;
        float* const to = results.ranges.data() + first;
        if (lanes == std::size_t{kTile})
            std::copy_n(from, kTile, to);  // a single move
        else
            std::copy_n(from, lanes, to);
        if (results.cosines.empty()) return;
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const Vec3 d = packet.ray(begin + lane).direction;
            const auto size = static_cast<float>(std::sqrt(dot(d, d)));
            results.cosines[first + lane] = std::min(1.0F, packet.slopes[begin + lane] / size);
        }
    }
};

EmbreeScene::EmbreeScene(const TriangleSoup& soup, double ray_epsilon, int packet_width)
    : set_(soup), ray_epsilon_(ray_epsilon) {
    device_ = makeEmbreeDevice();
    scene_ = buildSurfaces(device_.get(), set_, 0);
    width_ =
        packet_width > 0 ? static_cast<std::size_t>(packet_width) : nativeWidthOf(device_.get());
}

void EmbreeScene::cast(Point3 origin, const Directions& directions, double most,
                       const Results& results) const {
    if (set_.size() == 0) {
        std::fill(results.ranges.begin(), results.ranges.end(), kNoReturn);
        std::fill(results.cosines.begin(), results.cosines.end(), 1.0F);
        return;
    }
    const IgnoredSurfaces ignored(scene_.get(), set_, ray_epsilon_, origin);
    Caster caster(*this, ignored, origin, most);
    caster.needs_slopes = !results.cosines.empty();
    for (std::size_t first = 0; first < directions.size(); first += kLanes) {
        const std::size_t lanes = std::min(kLanes, directions.size() - first);
        if (lanes < kLanes) caster.keep(lanes);
        copyLanes(directions, first, lanes, caster.packet);
        caster.trace();
        caster.writeLanes(first, lanes, results);
    }
}

void EmbreeScene::cast(std::span<const Point3> origins, const Directions& directions, double most,
                       const Results& results) const {
    if (set_.size() == 0 || origins.empty()) return cast(Point3{}, directions, most, results);
    const IgnoredSurfaces nothing(set_, ray_epsilon_);
    const bool may_touch = !surfacesAbout(origins).empty();
    Caster caster(*this, nothing, origins.front(), most);
    caster.is_alike = caster.query.rays.have_one_origin = false;
    caster.needs_slopes = !results.cosines.empty();
    for (std::size_t first = 0; first < directions.size(); first += kLanes) {
        const std::size_t lanes = std::min(kLanes, directions.size() - first);
        if (may_touch && touches(origins.subspan(first, lanes))) {
            // The rays of each origin ignore other surfaces.
            for (std::size_t i = first, end = i; i < first + lanes; i = end) {
                while (end < first + lanes && origins[end] == origins[i]) ++end;
                const auto part = [i, end](const std::vector<double>& all) {
                    const double* const begin = all.data();
                    return std::vector<double>(begin + i, begin + end);
                };
                cast(origins[i], {part(directions.x), part(directions.y), part(directions.z)}, most,
                     {results.ranges.subspan(i, end - i),
                      results.cosines.empty() ? results.cosines
                                              : results.cosines.subspan(i, end - i)});
            }
        } else {
            caster.keep(lanes);
            copyLanes(directions, first, lanes, caster.packet);
            caster.setOrigins(origins.subspan(first, lanes));
            caster.trace();
            caster.writeLanes(first, lanes, results);
        }
    }
}

std::vector<std::size_t> EmbreeScene::surfacesAbout(std::span<const Point3> origins) const {
    const Point3 middle = origins[origins.size() / 2];
    double reach = 0;
    for (const Point3& origin : origins) reach = std::max(reach, length(origin - middle));
    return surfacesNear(scene_.get(), set_, reach + ray_epsilon_, middle);
}

bool EmbreeScene::touches(std::span<const Point3> origins) const {
    const std::vector<std::size_t> near = surfacesAbout(origins);
    std::vector<Vec3> touched;
    for (std::size_t i = 0; i < origins.size() && touched.empty(); ++i) {
        if (i > 0 && origins[i] == origins[i - 1]) continue;
        for (const std::size_t surface : near)
            set_.addTouched(surface, origins[i], ray_epsilon_, touched);
    }
    return !touched.empty();
}

void EmbreeScene::cast(Point3 origin, const RayGrid& grid, double most,
                       const Results& results) const {
    if (set_.size() == 0) return cast(origin, Directions(), most, results);
    const IgnoredSurfaces ignored(scene_.get(), set_, ray_epsilon_, origin);
    const auto columns = static_cast<std::size_t>(grid.columns);
    const double shortest = shortestRay(grid), longest = longestRay(grid);
    const auto cast_row = [&](Caster& caster, int row) {
        const int high = std::min(kTile, grid.rows - row);
        const TileRow tiles(grid, row);
        for (int column = 0; column < grid.columns; column += kTile) {
            const auto wide = static_cast<std::size_t>(std::min(kTile, grid.columns - column));
            caster.trace(tiles, column);
            for (int k = 0; k < high; ++k)
                caster.writeTileRow(
                    static_cast<std::size_t>(k),
                    static_cast<std::size_t>(row + k) * columns + static_cast<std::size_t>(column),
                    wide, results);
        }
    };
    const int tile_rows = (grid.rows + kTile - 1) / kTile;
    tbb::parallel_for(tbb::blocked_range<int>(0, tile_rows, 8),
                      [&](const tbb::blocked_range<int>& rows) {
                          Caster caster(*this, ignored, origin, most);
                          caster.setLengths(shortest, longest);
                          caster.needs_slopes = !results.cosines.empty();
                          for (int i = rows.begin(); i != rows.end(); ++i)
                              cast_row(caster, i * kTile);
                      });
}

void EmbreeScene::query(Point3 origin, std::span<const Point3> targets,
                        std::span<std::uint8_t> seen) const {
    if (set_.size() == 0) return std::fill(seen.begin(), seen.end(), std::uint8_t{1});
    const IgnoredSurfaces ignored(scene_.get(), set_, ray_epsilon_, origin);
    Caster caster(*this, ignored, origin, 0);
    caster.most = kNoReturn;
    caster.is_alike = caster.needs_slopes = false;
    for (std::size_t first = 0; first < targets.size(); first += kLanes) {
        const std::size_t lanes = std::min(kLanes, targets.size() - first);
        if (lanes < kLanes) caster.keep(lanes);
        for (std::size_t lane = 0; lane < kLanes; ++lane)
            caster.packet.aim(lane, targets[first + std::min(lane, lanes - 1)] - origin,
                              ray_epsilon_);
        roundReach(caster.packet, caster.tail, caster.far);
        caster.trace();
        for (std::size_t lane = 0; lane < lanes; ++lane)
            seen[first + lane] = caster.packet.multiples[lane] == kNoReturn ? 1 : 0;
    }
}

}  // namespace ispace
