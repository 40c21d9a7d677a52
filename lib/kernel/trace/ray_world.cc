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
    /// A world of a level, of which others are made.
    struct Base {
        Environment environment;
        Box2 plan;
        FlatWorld flat;
    };

    Point3 middle;
    // One of both; in a slice z of rays does not count.
    std::optional<FlatWorld> flat = {};
    std::optional<EmbreeScene> mesh = {};
    std::shared_ptr<const Base> base = {};

    [[nodiscard]] Point3 local(Point3 p) const { return relative(p, middle); }
};

RayWorld::RayWorld(std::unique_ptr<Data> data) : data_(std::move(data)) {}
RayWorld::RayWorld(RayWorld&&) noexcept = default;
RayWorld& RayWorld::operator=(RayWorld&&) noexcept = default;
RayWorld::~RayWorld() = default;

namespace {

Box2 planOf(const Slice& slice) {
    Box2 plan;
    slice.forEachLine([&](const Segment2& line) {
        plan.add(line.a);
        plan.add(line.b);
    });
    return plan;
}

/// Returns the lines and round bodies relative to a point.
FlatBodies bodiesOf(const Slice& slice, Point3 middle) {
    const auto local = [&](Point2 p) { return relative({p.x, p.y, 0}, middle).onFloor(); };
    FlatBodies bodies{slice.straightLines(), slice.curves()};
    for (Segment2& line : bodies.lines) line = {local(line.a), local(line.b)};
    for (Ellipse& round : bodies.rounds) round.center = local(round.center);
    return bodies;
}

/// True if the box does not touch the lines, which then do not determine it.
bool isInside(const Box2& plan, const Slice& slice) {
    const Box2 part = planOf(slice);
    return part.empty() || (plan.low.x < part.low.x && plan.low.y < part.low.y &&
                            part.high.x < plan.high.x && part.high.y < plan.high.y);
}

}  // namespace

RayWorld RayWorld::ofSlice(const Slice& slice) {
    auto data = std::make_unique<Data>(Data{middleOf(planOf(slice))});
    const FlatBodies bodies = bodiesOf(slice, data->middle);
    data->flat.emplace(bodies.lines, bodies.rounds);
    return RayWorld(std::move(data));
}

RayWorld RayWorld::ofLevel(const Environment& environment, double height, const RayWorld* before) {
    if (before != nullptr && before->data_->base) {
        const Data::Base& base = *before->data_->base;
        if (const auto changes = environment.changesSince(base.environment)) {
            const Slice removed = base.environment.slice(height, changes->removed);
            const Slice added = environment.slice(height, changes->added);
            if (isInside(base.plan, removed) && isInside(base.plan, added)) {
                auto data = std::make_unique<Data>(Data{before->data_->middle});
                data->flat.emplace(base.flat, bodiesOf(removed, data->middle),
                                   bodiesOf(added, data->middle));
                data->base = before->data_->base;
                return RayWorld(std::move(data));
            }
        }
    }
    const Slice& slice = environment.level(height)->slice();
    RayWorld world = ofSlice(slice);
    world.data_->base = std::make_shared<const Data::Base>(
        Data::Base{environment, planOf(slice), *world.data_->flat});
    return world;
}

namespace {

void addMesh(const Mesh& mesh, TriangleSoup& soup) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const auto& [a, b, c] : mesh.triangles)
        soup.triangles.push_back({first + a, first + b, first + c});
}

/// Returns the given surfaces of all bodies, and the floor.
TriangleSoup soupOf(const Environment& environment, Surfaces surfaces) {
    TriangleSoup soup;
    for (const Element& element : environment.elements()) {
        const std::size_t before = soup.rounds.size();
        for (const Prism& prism : element.body.prisms)
            if (prism.curve) soup.rounds.push_back({*prism.curve, prism.bottom, prism.top});
        const bool is_flat = soup.rounds.size() == before;
        for (const Mesh& mesh :
             meshesOf(is_flat ? element.body : withoutRounds(element.body), surfaces))
            addMesh(mesh, soup);
    }
    addMesh(environment.floor(), soup);
    return soup;
}

}  // namespace

RayWorld RayWorld::ofEnvironment(const Environment& environment, Surfaces surfaces,
                                 int packet_width) {
    TriangleSoup soup = soupOf(environment, surfaces);
    Box2 plan;
    for (const Point3& vertex : soup.vertices) plan.add(vertex.onFloor());
    for (const RoundBody& round : soup.rounds) {
        plan.add(round.curve.box().low);
        plan.add(round.curve.box().high);
    }
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
    data_->flat->cast(from.onFloor(), directions, max_range * (1 + kFloatTolerance), kRayEpsilon,
                      ranges, cosines);
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
    data_->flat->cast(from, directions, max_range * (1 + kFloatTolerance), kRayEpsilon, ranges,
                      cosines);
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

RayScenes::RayScenes(const Environment& environment, std::shared_ptr<const SurroundedRoom> around)
    : environment_(&environment),
      around_(std::move(around)),
      has_clear_(hasClearGlass(environment)) {}

const RayWorld* RayScenes::sliceAt(double height) const {
    const std::shared_lock lock(mutex_);
    const auto slice = slices_.find(height);
    return slice == slices_.end() ? nullptr : &slice->second;
}

void RayScenes::prepare(const Pose3& pose, const RayScenes* before) {
    if (!pose.isLevel()) return prepareMesh();
    const double height = pose.position.z;
    if (slices_.contains(height)) return;
    if (slices_.size() >= kMaxSlices) return prepareMesh();
    const Environment& room = around_ == nullptr ? *environment_ : around_->environment();
    RayWorld slice =
        RayWorld::ofLevel(room, height, before == nullptr ? nullptr : before->sliceAt(height));
    const std::unique_lock lock(mutex_);
    slices_.emplace(height, std::move(slice));
}

void RayScenes::prepareMesh(Surfaces surfaces) {
    if (around_ != nullptr && (surfaces == Surfaces::Opaque || !has_clear_)) {
        static_cast<void>(around_->mesh());
        is_around_prepared_ = true;
        return;
    }
    std::optional<RayWorld>& mesh = hearsMore(surfaces) ? solid_ : mesh_;
    if (mesh) return;
    RayWorld made = RayWorld::ofEnvironment(
        around_ == nullptr ? *environment_ : around_->environment(), surfaces);
    const std::unique_lock lock(mutex_);
    mesh.emplace(std::move(made));
}

const RayWorld& RayScenes::at(const Pose3& pose) const {
    if (pose.isLevel())
        if (const RayWorld* const slice = sliceAt(pose.position.z)) return *slice;
    return mesh();
}

const RayWorld& RayScenes::mesh(Surfaces surfaces) const {
    if (around_ != nullptr && (surfaces == Surfaces::Opaque || !has_clear_)) return around_->mesh();
    const std::shared_lock lock(mutex_);
    const std::optional<RayWorld>& mesh = hearsMore(surfaces) ? solid_ : mesh_;
    assert(mesh);
    return *mesh;
}

}  // namespace ispace
