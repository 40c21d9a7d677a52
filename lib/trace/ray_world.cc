// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/ray_world.h"

#include <algorithm>
#include <cassert>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/simd.h"
#include "env/level.h"
#include "geom/point.h"
#include "trace/embree_scene.h"
#include "trace/flat_world.h"
#include "trace/rays.h"

namespace ispace {

namespace {

/// Middle of the input geometry; coordinates are stored relative to it.
Point3 middleOf(const Box2& plan) {
    if (plan.empty()) return {};
    return {plan.center().x, plan.center().y, 0};
}

Point3 relative(Point3 p, Point3 middle) { return {p.x - middle.x, p.y - middle.y, p.z}; }

Body withoutRounds(Body body) {
    std::erase_if(body.prisms, [](const Prism& prism) { return prism.curve != nullptr; });
    return body;
}

/// Clamps ranges that rounding puts slightly above max_range.
ISPACE_SIMD_CLONES void limit(std::span<float> ranges, float far) {
    float* const range = ranges.data();
    const std::size_t count = ranges.size();
    for (std::size_t i = 0; i < count; ++i)
        range[i] = range[i] > far && range[i] < kNoReturn ? far : range[i];
}

}  // namespace

struct RayWorld::Data {
    Point3 middle;
    // One of both; in a slice z of rays does not count.
    std::optional<FlatWorld> flat = {};
    std::optional<EmbreeScene> mesh = {};

    [[nodiscard]] Point3 local(Point3 p) const { return relative(p, middle); }
};

RayWorld::RayWorld(std::unique_ptr<Data> data) : data_(std::move(data)) {}
RayWorld::RayWorld(RayWorld&&) noexcept = default;
RayWorld& RayWorld::operator=(RayWorld&&) noexcept = default;
RayWorld::~RayWorld() = default;

RayWorld RayWorld::ofSlice(const Slice& slice) {
    Box2 plan;
    slice.forEachLine([&](const Segment2& line) {
        plan.add(line.a);
        plan.add(line.b);
    });
    auto data = std::make_unique<Data>(Data{middleOf(plan)});
    const auto local = [&](Point2 p) { return data->local({p.x, p.y, 0}).onFloor(); };
    std::vector<Segment2> straight = slice.straightLines();
    for (Segment2& line : straight) line = {local(line.a), local(line.b)};
    std::vector<Ellipse> rounds = slice.curves();
    for (Ellipse& round : rounds) round.center = local(round.center);
    data->flat.emplace(straight, rounds);
    return RayWorld(std::move(data));
}

namespace {

/// Adds a mesh. Its triangles represent a round body or flat surfaces.
void addMesh(const Mesh& mesh, std::uint32_t round, TriangleSoup& soup) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const auto& [a, b, c] : mesh.triangles)
        soup.triangles.push_back({first + a, first + b, first + c});
    soup.round_of.resize(soup.triangles.size(), round);
}

/// Adds the given surfaces of all bodies, then the floor, then round bodies.
TriangleSoup soupOf(const Environment& environment, Surfaces surfaces) {
    TriangleSoup soup;
    std::vector<const Prism*> rounds;
    for (const Element& element : environment.elements()) {
        const std::size_t before = rounds.size();
        for (const Prism& prism : element.body.prisms)
            if (prism.curve) rounds.push_back(&prism);
        const bool is_flat = rounds.size() == before;
        for (const Mesh& mesh :
             meshesOf(is_flat ? element.body : withoutRounds(element.body), surfaces))
            addMesh(mesh, TriangleSoup::kFlat, soup);
    }
    addMesh(environment.floor(), TriangleSoup::kFlat, soup);
    for (const Prism* const round : rounds) {
        addMesh(meshAround(*round), static_cast<std::uint32_t>(soup.rounds.size()), soup);
        soup.rounds.push_back({*round->curve, round->bottom, round->top});
    }
    return soup;
}

}  // namespace

RayWorld RayWorld::ofEnvironment(const Environment& environment, Surfaces surfaces,
                                 int packet_width) {
    TriangleSoup soup = soupOf(environment, surfaces);
    Box2 plan;
    for (const Point3& vertex : soup.vertices) plan.add(vertex.onFloor());
    auto data = std::make_unique<Data>(Data{middleOf(plan)});
    for (Point3& vertex : soup.vertices) vertex = data->local(vertex);
    for (RoundBody& round : soup.rounds) {
        const Point2 center = round.curve.center;
        round.curve.center = data->local({center.x, center.y, 0}).onFloor();
    }
    data->mesh.emplace(soup, kRayEpsilon, packet_width);
    return RayWorld(std::move(data));
}

void RayWorld::cast(Point3 origin, const Directions& directions, double max_range,
                    std::span<float> ranges, std::span<float> cosines) const {
    assert(ranges.size() == directions.size());
    const Point3 from = data_->local(origin);
    if (!data_->flat) return data_->mesh->cast(from, directions, max_range, {ranges, cosines});
    data_->flat->cast(from.onFloor(), directions, max_range * (1 + kFarSlack), kRayEpsilon, ranges,
                      cosines);
    limit(ranges, static_cast<float>(max_range));
}

void RayWorld::cast(std::span<const Point3> origins, const Directions& directions, double max_range,
                    std::span<float> ranges, std::span<float> cosines) const {
    assert(ranges.size() == directions.size() && origins.size() == directions.size());
    if (!data_->flat) {
        std::vector<Point3> from;
        from.reserve(origins.size());
        for (const Point3& origin : origins) from.push_back(data_->local(origin));
        return data_->mesh->cast(from, directions, max_range, {ranges, cosines});
    }
    std::vector<Point2> from;
    from.reserve(origins.size());
    for (const Point3& origin : origins) from.push_back(data_->local(origin).onFloor());
    data_->flat->cast(from, directions, max_range * (1 + kFarSlack), kRayEpsilon, ranges, cosines);
    limit(ranges, static_cast<float>(max_range));
}

void RayWorld::cast(Point3 origin, const RayGrid& grid, double most, std::span<float> multiples,
                    std::span<float> cosines) const {
    assert(multiples.size() == grid.size() && !data_->flat);
    data_->mesh->cast(data_->local(origin), grid, most, {multiples, cosines});
}

void RayWorld::query(Point3 origin, std::span<const Point3> targets,
                     std::span<std::uint8_t> seen) const {
    assert(seen.size() == targets.size() && data_->mesh);
    std::vector<Point3> local;
    local.reserve(targets.size());
    for (const Point3& target : targets) local.push_back(data_->local(target));
    data_->mesh->query(data_->local(origin), local, seen);
}

namespace {

bool hasClearGlass(const Environment& environment) {
    return std::any_of(environment.elements().begin(), environment.elements().end(),
                       [](const Element& element) {
                           const std::vector<Sheet>& sheets = element.body.sheets;
                           return std::any_of(sheets.begin(), sheets.end(),
                                              [](const Sheet& sheet) { return sheet.clear; });
                       });
}

}  // namespace

// Only the preparing thread adds worlds, so it reads without a lock; other threads may read while
// it builds.

Worlds::Worlds(const Environment& environment)
    : environment_(&environment), has_clear_(hasClearGlass(environment)) {}

void Worlds::prepare(const Pose3& pose) {
    if (!pose.isLevel()) return prepareMesh();
    const double height = pose.position.z;
    if (slices_.contains(height)) return;
    if (slices_.size() >= kMaxSlices) return prepareMesh();
    RayWorld slice = RayWorld::ofSlice(environment_->level(height)->slice());
    const std::unique_lock lock(mutex_);
    slices_.emplace(height, std::move(slice));
}

void Worlds::prepareMesh(Surfaces surfaces) {
    std::optional<RayWorld>& mesh = hearsMore(surfaces) ? solid_ : mesh_;
    if (mesh) return;
    RayWorld made = RayWorld::ofEnvironment(*environment_, surfaces);
    const std::unique_lock lock(mutex_);
    mesh.emplace(std::move(made));
}

const RayWorld& Worlds::at(const Pose3& pose) const {
    if (pose.isLevel()) {
        const std::shared_lock lock(mutex_);
        const auto slice = slices_.find(pose.position.z);
        if (slice != slices_.end()) return slice->second;
    }
    return mesh();
}

const RayWorld& Worlds::mesh(Surfaces surfaces) const {
    const std::shared_lock lock(mutex_);
    const std::optional<RayWorld>& mesh = hearsMore(surfaces) ? solid_ : mesh_;
    assert(mesh);
    return *mesh;
}

}  // namespace ispace
