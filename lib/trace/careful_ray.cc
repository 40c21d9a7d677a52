// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/careful_ray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ispace {

namespace {

constexpr Meeting kNone{std::numeric_limits<double>::infinity(),
                        std::numeric_limits<std::size_t>::max()};

void passFilter(const RTCFilterFunctionNArguments* args) {
    const auto& query =
        static_cast<const PassingQuery&>(*reinterpret_cast<const EmbreeQuery*>(args->context));
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const Plane& plane = query.set.planes()[RTCHitN_primID(args->hit, args->N, i)];
        if (query.passed.contain(plane, query.origin)) args->valid[i] = 0;
    }
}

/// Surfaces whose bounds come near the point of a query.
bool collect(RTCPointQueryFunctionArguments* args) {
    static_cast<std::vector<unsigned>*>(args->userPtr)->push_back(args->primID);
    return false;
}

/// The scene is rounded, and so is the point: all that may be so near, and more.
std::vector<unsigned> candidatesNear(RTCScene scene, const TriangleSet& set, Point3 p,
                                     double radius) {
    RTCPointQuery query{};
    query.x = static_cast<float>(p.x);
    query.y = static_cast<float>(p.y);
    query.z = static_cast<float>(p.z);
    query.radius = static_cast<float>(radius + set.slack());
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    std::vector<unsigned> near;
    rtcPointQuery(scene, &query, &context, collect, &near);
    return near;
}

/// One ray, to be asked more than once.
class CarefulRay : private EmbreeQuery {
  public:
    CarefulRay(RTCScene scene, const TriangleSet& set, const Passed& passed, const Ray& ray)
        : EmbreeQuery(filter), scene_(scene), set_(set), passed_(passed), ray_(ray) {}

    /// Where the ray meets a triangle that stops it.
    [[nodiscard]] Meeting meet(std::size_t triangle) const {
        if (set_.isRound(triangle)) {
            const auto [multiple, slope] = set_.meetRound(triangle, ray_, passed_.contact);
            return multiple == kNone.multiple ? kNone : Meeting{multiple, triangle, slope};
        }
        const Plane& plane = set_.planes()[triangle];
        if (passed_.contain(plane, ray_.origin)) return kNone;
        const double multiple = set_.meet(triangle, ray_);
        if (multiple == kNone.multiple) return kNone;
        return {multiple, triangle, std::fabs(dot(plane.normal, ray_.direction))};
    }
    /// The first of all triangles.
    Meeting first() {
        best_ = kNone;
        is_collecting_ = false;
        const double found = trace(ray_.reach);
        if (!(best_ < kNone)) return kNone;
        // Embree's order of what lies close together is not certain.
        constexpr double kMore = 1 + 1e-5;
        is_collecting_ = true;
        trace(kMore * std::max(best_.multiple, found));
        return best_;
    }

  private:
    /// \return where Embree says the hit is that it accepts
    double trace(double reach) {
        const double size = length(ray_.direction);
        // Surfaces right before the origin lie behind it once it is rounded.
        const double back = passed_.is_crowded ? 2 * set_.slack() / size : 0;
        const double ahead = set_.ball().ahead(ray_.origin, ray_.direction) - back;
        const Point3 begin = ray_.origin + ahead * ray_.direction;
        const double far = reach - ahead + 8 * set_.slack() / size;
        RTCRayHit ray{};
        ray.ray.org_x = static_cast<float>(begin.x);
        ray.ray.org_y = static_cast<float>(begin.y);
        ray.ray.org_z = static_cast<float>(begin.z);
        ray.ray.dir_x = static_cast<float>(ray_.direction.x);
        ray.ray.dir_y = static_cast<float>(ray_.direction.y);
        ray.ray.dir_z = static_cast<float>(ray_.direction.z);
        ray.ray.tfar = static_cast<float>(far < kFarthest ? far : kFarthest);
        ray.ray.mask = ~0U;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        EmbreeQuery::trace(scene_, &ray);
        return ahead + static_cast<double>(ray.ray.tfar);
    }

    /// Accepts what the ray meets in doubles; while it collects it keeps the nearest and goes on.
    static void filter(const RTCFilterFunctionNArguments* args) {
        auto& self = static_cast<CarefulRay&>(*reinterpret_cast<EmbreeQuery*>(args->context));
        if (args->valid[0] == 0) return;
        const Meeting met = self.meet(RTCHitN_primID(args->hit, 1, 0));
        if (!(met < kNone) || self.is_collecting_) args->valid[0] = 0;
        if (met < kNone && (!self.is_collecting_ || met < self.best_)) self.best_ = met;
    }

    RTCScene scene_;
    const TriangleSet& set_;
    const Passed& passed_;
    const Ray& ray_;
    Meeting best_ = kNone;
    bool is_collecting_ = false;
};

}  // namespace

bool Passed::contain(const Plane& plane, Point3 origin) const {
    constexpr double kParallel = 1 - 1e-6;  // cosine
    const double height = std::fabs(plane.heightOver(origin));
    if (height <= kEdgeOn) return true;
    return height <= contact && std::any_of(touched.begin(), touched.end(), [&](Vec3 normal) {
               return std::fabs(dot(normal, plane.normal)) >= kParallel;
           });
}

Passed passedFrom(RTCScene scene, const TriangleSet& set, Point3 origin, double contact) {
    Passed passed{contact, {}};
    const double near = std::max(contact, set.slack());
    for (const unsigned triangle : candidatesNear(scene, set, origin, near)) {
        const double distance = set.distance(triangle, origin);
        if (distance <= contact)
            passed.touched.push_back(set.planes()[triangle].normal);
        else if (distance <= near)
            passed.is_crowded = true;
    }
    return passed;
}

bool isNear(RTCScene scene, const TriangleSet& set, Point3 p, double radius) {
    const std::vector<unsigned> near = candidatesNear(scene, set, p, radius);
    return std::any_of(near.begin(), near.end(),
                       [&](unsigned triangle) { return set.distance(triangle, p) <= radius; });
}

PassingQuery::PassingQuery(const TriangleSet& triangles, const Passed& surfaces, Point3 from)
    : EmbreeQuery(surfaces.touched.empty() ? nullptr : passFilter),
      set(triangles),
      passed(surfaces),
      origin(from) {}

Meeting meetCarefully(RTCScene scene, const TriangleSet& set, const Passed& passed, const Ray& ray,
                      const RTCRayHit16& hits, std::size_t lane) {
    CarefulRay careful(scene, set, passed, ray);
    if (passed.is_crowded) return careful.first();
    const std::size_t triangle = hits.hit.primID[lane];
    if (set.isRound(triangle)) {
        const Meeting met = careful.meet(triangle);
        return met < kNone ? met : careful.first();
    }
    const Plane& plane = set.planes()[triangle];
    if (passed.contain(plane, ray.origin)) return careful.first();

    // Corner i is opposite to a side that the hit is near to.
    const float u = hits.hit.u[lane], v = hits.hit.v[lane];
    const std::array<float, 3> weights{1 - u - v, u, v};
    const double cosine = std::fabs(dot(plane.normal, ray.direction)) / length(ray.direction);
    const double margin = set.margins()[triangle];
    std::array<std::size_t, 3> sides{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i)
        if (!(static_cast<double>(weights[i]) * cosine > margin)) sides[count++] = i;
    if (count == 0) {
        const Meeting met = careful.meet(triangle);
        return met < kNone ? met : careful.first();
    }
    if (count == 3) return careful.first();

    Meeting best = kNone;
    std::size_t candidates = 0;
    const auto consider = [&](std::size_t index) {
        ++candidates;
        best = std::min(best, careful.meet(index));
    };
    if (count == 1)
        set.forEachAtSide(triangle, (sides[0] + 1) % 3, (sides[0] + 2) % 3, consider);
    else
        set.forEachAtCorner(triangle, 3 - sides[0] - sides[1], consider);
    // At the rim of a surface, or beside it, all that is near counts; as does, where the neighbours
    // lie farther along the ray than Embree's hit, what may stand before them.
    const double hit =
        set.ball().ahead(ray.origin, ray.direction) + static_cast<double>(hits.ray.tfar[lane]);
    const double aside = std::fabs(best.multiple - hit) * length(ray.direction);
    return candidates > 1 && aside <= 8 * set.slack() ? best : careful.first();
}

}  // namespace ispace
