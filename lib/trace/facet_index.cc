// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/facet_index.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "trace/embree_scene.h"
#include "trace/ray_world.h"

namespace ispace {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Surfaces in contact with the origin of a query, and, as they are met, those seen edge-on.
struct Skips {
    const std::vector<Facet>* facets = nullptr;
    double slack = 0;
    std::vector<unsigned> ids;

    [[nodiscard]] bool skip(unsigned id, Vec3 direction) const {
        return std::find(ids.begin(), ids.end(), id) != ids.end() ||
               (*facets)[id].isEdgeOn(direction, slack);
    }
};

void skipFilter(const RTCFilterFunctionNArguments* args);

// One query to Embree 3 or 4: the context comes first, as it is what the filter gets back. Beams
// of a scan are neighbours, what one gazes at may lie anywhere.
#if RTC_VERSION_MAJOR >= 4

constexpr int kNeighbours = RTC_RAY_QUERY_FLAG_COHERENT;
constexpr int kScattered = RTC_RAY_QUERY_FLAG_INCOHERENT;

struct Query {
    RTCRayQueryContext context;
    const Skips* skips;
    int flags;

    Query(int hint, const Skips& skipped) : skips(&skipped), flags(hint) {
        rtcInitRayQueryContext(&context);
        if (!skips->ids.empty()) flags |= RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    }
};
inline void init(RTCIntersectArguments& arguments) { rtcInitIntersectArguments(&arguments); }
inline void init(RTCOccludedArguments& arguments) { rtcInitOccludedArguments(&arguments); }

template <typename Arguments>
Arguments argumentsOf(Query& query) {
    Arguments arguments;
    init(arguments);
    arguments.flags = static_cast<RTCRayQueryFlags>(query.flags);
    arguments.context = &query.context;
    if (!query.skips->ids.empty()) arguments.filter = skipFilter;
    return arguments;
}
template <typename Rays, typename Arguments>
void ask(void (*embree)(const int*, RTCScene, Rays*, Arguments*), const int* valid, RTCScene scene,
         Rays& rays, Query& query) {
    Arguments arguments = argumentsOf<Arguments>(query);
    embree(valid, scene, &rays, &arguments);
}
template <typename Rays, typename Arguments>
void ask(void (*embree)(RTCScene, Rays*, Arguments*), const int* valid, RTCScene scene, Rays& rays,
         Query& query) {
    Arguments arguments = argumentsOf<Arguments>(query);
    if (*valid != 0) embree(scene, &rays, &arguments);
}

#else

constexpr auto kNeighbours = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
constexpr auto kScattered = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;

struct Query {
    RTCIntersectContext context;
    const Skips* skips;

    Query(RTCIntersectContextFlags hint, const Skips& skipped) : skips(&skipped) {
        rtcInitIntersectContext(&context);
        context.flags = hint;
        if (!skips->ids.empty()) context.filter = skipFilter;
    }
};
template <typename Rays>
void ask(void (*embree)(const int*, RTCScene, RTCIntersectContext*, Rays*), const int* valid,
         RTCScene scene, Rays& rays, Query& query) {
    embree(valid, scene, &query.context, &rays);
}
template <typename Rays>
void ask(void (*embree)(RTCScene, RTCIntersectContext*, Rays*), const int* valid, RTCScene scene,
         Rays& rays, Query& query) {
    if (*valid != 0) embree(scene, &query.context, &rays);
}

#endif

void skipFilter(const RTCFilterFunctionNArguments* args) {
    const Skips& skips = *reinterpret_cast<const Query*>(args->context)->skips;
    for (unsigned lane = 0; lane < args->N; ++lane) {
        if (args->valid[lane] == 0) continue;
        const Vec3 direction{RTCRayN_dir_x(args->ray, args->N, lane),
                             RTCRayN_dir_y(args->ray, args->N, lane),
                             RTCRayN_dir_z(args->ray, args->N, lane)};
        if (skips.skip(RTCHitN_primID(args->hit, args->N, lane), direction)) args->valid[lane] = 0;
    }
}

template <typename R, typename H, auto kIntersectN, auto kOccludedN>
struct PacketOf {
    using Ray = R;
    using RayHit = H;
    static constexpr auto kIntersect = kIntersectN;
    static constexpr auto kOccluded = kOccludedN;
};
template <int kWidth>
struct Packet;
template <>
struct Packet<1> : PacketOf<RTCRay, RTCRayHit, rtcIntersect1, rtcOccluded1> {};
template <>
struct Packet<4> : PacketOf<RTCRay4, RTCRayHit4, rtcIntersect4, rtcOccluded4> {};
template <>
struct Packet<8> : PacketOf<RTCRay8, RTCRayHit8, rtcIntersect8, rtcOccluded8> {};
template <>
struct Packet<16> : PacketOf<RTCRay16, RTCRayHit16, rtcIntersect16, rtcOccluded16> {};

/// A lane of a packet's field; a single ray has plain fields.
template <typename T>
T& at(T& field, std::size_t /*lane*/) {
    return field;
}
template <typename T, std::size_t kWidth>
T& at(T (&field)[kWidth], std::size_t lane) {
    return field[lane];
}

/// What all rays of a query share; Embree leaves it as it is.
template <int kWidth, typename Ray>
void setOrigin(Ray& rays, Point3 origin) {
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
        at(rays.org_x, lane) = static_cast<float>(origin.x);
        at(rays.org_y, lane) = static_cast<float>(origin.y);
        at(rays.org_z, lane) = static_cast<float>(origin.z);
        at(rays.tnear, lane) = 0;
        at(rays.time, lane) = 0;
        at(rays.mask, lane) = ~0U;
        at(rays.id, lane) = 0;
        at(rays.flags, lane) = 0;
    }
}

template <typename Ray>
void aim(Ray& rays, std::size_t lane, Vec3 direction, float reach) {
    at(rays.dir_x, lane) = static_cast<float>(direction.x);
    at(rays.dir_y, lane) = static_cast<float>(direction.y);
    at(rays.dir_z, lane) = static_cast<float>(direction.z);
    at(rays.tfar, lane) = reach;
}

/// Surfaces that may be in contact with the point of a query.
bool collect(RTCPointQueryFunctionArguments* args) {
    static_cast<std::vector<unsigned>*>(args->userPtr)->push_back(args->primID);
    return false;
}

}  // namespace

struct FacetIndex::Data {
    EmbreeScene scene;
    PlanFrame frame;
    std::vector<Facet> facets;
    double slack;
    int packet_width;

    Data(FacetSoup soup, int width)
        : scene(soup),
          frame(soup.frame),
          facets(std::move(soup.facets)),
          slack(soup.slack),
          packet_width(width != 0 ? width : scene.widestPacket()) {}

    [[nodiscard]] Skips inContact(Point3 origin) const;

    template <int kWidth>
    void cast(Point3 origin, std::span<const Vec3> directions, double max_range,
              std::span<float> ranges) const;
    [[nodiscard]] const Facet* nextFacing(unsigned id, Point3 origin, Vec3 direction, float reach,
                                          Skips skips) const;
    template <int kWidth>
    void look(Point3 origin, std::span<const Point3> targets, std::span<std::uint8_t> seen) const;
};

/// The surfaces within kContact of the origin.
Skips FacetIndex::Data::inContact(Point3 origin) const {
    Skips skips{&facets, slack, {}};
    RTCPointQuery query{};
    query.x = static_cast<float>(origin.x);
    query.y = static_cast<float>(origin.y);
    query.z = static_cast<float>(origin.z);
    query.radius = static_cast<float>(kContact + 4 * slack);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene.get(), &query, &context, collect, &skips.ids);
    std::erase_if(skips.ids, [&](unsigned id) { return facets[id].distanceTo(origin) > kContact; });
    return skips;
}

/// The first surface that is not seen from its edge, after `id`, which is; null if there is none.
const Facet* FacetIndex::Data::nextFacing(unsigned id, Point3 origin, Vec3 direction, float reach,
                                          Skips skips) const {
    constexpr int kValid = -1;
    for (;;) {
        skips.ids.push_back(id);
        Query query(kNeighbours, skips);
        RTCRayHit ray;
        setOrigin<1>(ray.ray, origin);
        aim(ray.ray, 0, direction, reach);
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        ask(rtcIntersect1, &kValid, scene.get(), ray, query);
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return nullptr;
        id = ray.hit.primID;
        if (!facets[id].isEdgeOn(direction, slack)) return &facets[id];
    }
}

template <int kWidth>
void FacetIndex::Data::cast(Point3 origin, std::span<const Vec3> directions, double max_range,
                            std::span<float> ranges) const {
    const auto limit = static_cast<float>(max_range);
    // Embree may find a surface a little farther than it is.
    const auto reach = static_cast<float>(max_range * (1 + 1e-6) + 4 * slack);
    const Skips skips = inContact(origin);
    Query query(kNeighbours, skips);
    alignas(64) std::array<int, kWidth> valid;
    typename Packet<kWidth>::RayHit rays;
    setOrigin<kWidth>(rays.ray, origin);
    for (std::size_t first = 0; first < directions.size(); first += kWidth) {
        const std::size_t count = std::min<std::size_t>(kWidth, directions.size() - first);
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
            valid[lane] = lane < count ? -1 : 0;
            Vec3 direction = directions[first + std::min(lane, count - 1)];
            if (frame.is_flat) direction.z = 0;
            aim(rays.ray, lane, direction, reach);
            at(rays.hit.geomID, lane) = RTC_INVALID_GEOMETRY_ID;
        }
        ask(Packet<kWidth>::kIntersect, valid.data(), scene.get(), rays, query);
        for (std::size_t lane = 0; lane < count; ++lane) {
            float& range = ranges[first + lane] = kInfinity;
            if (at(rays.hit.geomID, lane) == RTC_INVALID_GEOMETRY_ID) continue;
            const unsigned id = at(rays.hit.primID, lane);
            const Vec3 direction = directions[first + lane];
            const Facet* facet = &facets[id];
            if (facet->isEdgeOn(direction, slack))
                facet = nextFacing(id, origin, direction, reach, skips);
            if (facet == nullptr) continue;
            const auto distance = static_cast<float>(facet->distanceAlong(origin, direction));
            if (distance <= limit) range = distance;
        }
    }
}

template <int kWidth>
void FacetIndex::Data::look(Point3 origin, std::span<const Point3> targets,
                            std::span<std::uint8_t> seen) const {
    const Skips skips = inContact(origin);
    Query query(kScattered, skips);
    alignas(64) std::array<int, kWidth> valid;
    typename Packet<kWidth>::Ray rays;
    setOrigin<kWidth>(rays, origin);
    for (std::size_t first = 0; first < targets.size(); first += kWidth) {
        const std::size_t count = std::min<std::size_t>(kWidth, targets.size() - first);
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
            const Vec3 way = frame.local(targets[first + std::min(lane, count - 1)]) - origin;
            const double distance = std::sqrt(dot(way, way));
            const double reach = distance - kContact;
            valid[lane] = lane < count && reach > 0 ? -1 : 0;
            const Vec3 direction = reach > 0 ? (1 / distance) * way : Vec3{1, 0, 0};
            aim(rays, lane, direction, static_cast<float>(reach));
        }
        ask(Packet<kWidth>::kOccluded, valid.data(), scene.get(), rays, query);
        for (std::size_t lane = 0; lane < count; ++lane) {
            // Embree marks a ray that is stopped by a tfar of minus infinity.
            const bool stopped = valid[lane] != 0 && at(rays.tfar, lane) < 0;
            seen[first + lane] = stopped ? 0 : 1;
        }
    }
}

namespace {

/// Calls work(constant) with the packet width as a constant of the compiler.
template <typename Work>
void atWidth(int packet_width, Work work) {
    switch (packet_width) {
        case 16:
            return work(std::integral_constant<int, 16>{});
        case 8:
            return work(std::integral_constant<int, 8>{});
        case 4:
            return work(std::integral_constant<int, 4>{});
        default:
            return work(std::integral_constant<int, 1>{});
    }
}

}  // namespace

FacetIndex::FacetIndex(FacetSoup soup, int packet_width)
    : data_(std::make_unique<Data>(std::move(soup), packet_width)) {}

FacetIndex::~FacetIndex() = default;

void FacetIndex::cast(Point3 origin, std::span<const Vec3> directions, double max_range,
                      std::span<float> ranges) const {
    assert(ranges.size() == directions.size());
    atWidth(data_->packet_width, [&](auto width) {
        data_->cast<width>(data_->frame.local(origin), directions, max_range, ranges);
    });
}

void FacetIndex::look(Point3 origin, std::span<const Point3> targets,
                      std::span<std::uint8_t> seen) const {
    assert(seen.size() == targets.size());
    atWidth(data_->packet_width,
            [&](auto width) { data_->look<width>(data_->frame.local(origin), targets, seen); });
}

}  // namespace ispace
