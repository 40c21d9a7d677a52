// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/ray_world.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "env/mesh.h"
#include "geom/box.h"
#include "trace/embree_scene.h"

namespace ispace {

namespace {

constexpr float kNoReturn = std::numeric_limits<float>::infinity();

/// Slack for rounding to float32 at the far end of a ray, relative to its length.
constexpr double kFarSlack = 1e-6;

/// The middle of what is built from; coordinates are kept relative to it.
Point3 middleOf(const Box2& plan) {
    if (plan.empty()) return {};
    return {plan.center().x, plan.center().y, 0};
}

Point3 relative(Point3 p, Point3 middle) { return {p.x - middle.x, p.y - middle.y, p.z}; }

}  // namespace

struct RayWorld::Data {
    Point3 middle;
    bool is_flat = false;  ///< a slice: z of rays does not count
    EmbreeScene scene;

    Data(Point3 origin, bool flat, TriangleSoup soup, int packet_width)
        : middle(origin), is_flat(flat), scene(std::move(soup), packet_width) {}

    [[nodiscard]] Point3 local(Point3 p) const {
        const Point3 near = relative(p, middle);
        return is_flat ? Point3{near.x, near.y, 0} : near;
    }
};

RayWorld::RayWorld(std::unique_ptr<Data> data) : data_(std::move(data)) {}
RayWorld::RayWorld(RayWorld&&) noexcept = default;
RayWorld& RayWorld::operator=(RayWorld&&) noexcept = default;
RayWorld::~RayWorld() = default;

RayWorld RayWorld::ofSlice(const Slice& slice, int packet_width) {
    Box2 plan;
    slice.forEachLine([&](const Segment2& line) {
        plan.add(line.a);
        plan.add(line.b);
    });
    const Point3 middle = middleOf(plan);
    // Each line stands upright about the plane of the rays, high enough for any rounding. Lines
    // that meet have equal corners, through which a ROBUST scene lets no ray slip.
    constexpr double kHalfHeight = 1;
    TriangleSoup soup;
    slice.forEachLine([&](const Segment2& line) {
        const auto corner = [&](Point2 p, double z) {
            return soup.add(relative({p.x, p.y, z}, middle));
        };
        const std::uint32_t a = corner(line.a, -kHalfHeight), b = corner(line.b, -kHalfHeight);
        const std::uint32_t c = corner(line.b, kHalfHeight), d = corner(line.a, kHalfHeight);
        soup.triangles.push_back({a, b, c});
        soup.triangles.push_back({a, c, d});
    });
    return RayWorld(std::make_unique<Data>(middle, true, std::move(soup), packet_width));
}

RayWorld RayWorld::ofEnvironment(const Environment& environment, int packet_width) {
    std::vector<Mesh> meshes;
    for (const Element& element : environment.elements())
        for (Mesh& mesh : meshesOf(element.body, false)) meshes.push_back(std::move(mesh));
    meshes.push_back(floorMesh(environment.indoor()));
    Box2 plan;
    for (const Mesh& mesh : meshes)
        for (const Point3& vertex : mesh.vertices) plan.add(vertex.onFloor());
    const Point3 middle = middleOf(plan);
    TriangleSoup soup;
    for (const Mesh& mesh : meshes) {
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        for (const Point3& vertex : mesh.vertices) soup.add(relative(vertex, middle));
        for (const auto& [i, j, k] : mesh.triangles)
            soup.triangles.push_back({first + i, first + j, first + k});
    }
    return RayWorld(std::make_unique<Data>(middle, false, std::move(soup), packet_width));
}

void RayWorld::cast(Point3 origin, std::span<const Vec3> directions, double max_range,
                    std::span<float> ranges) const {
    const auto far = static_cast<float>(max_range);
    const std::vector<float> reach(directions.size(),
                                   static_cast<float>(max_range * (1 + kFarSlack)));
    data_->scene.intersect(data_->local(origin), directions, reach, kContact, ranges);
    for (float& range : ranges)
        if (range != kNoReturn) range = std::min(range, far);
}

void RayWorld::look(Point3 origin, std::span<const Point3> targets,
                    std::span<std::uint8_t> seen) const {
    const Point3 from = data_->local(origin);
    std::vector<Vec3> directions(targets.size());
    std::vector<float> reach(targets.size()), distances(targets.size());
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const Vec3 way = data_->local(targets[i]) - from;
        const double distance = length(way);
        // Nothing stands on a way so short: a ray of no length meets nothing.
        const bool is_short = distance <= 2 * kContact;
        directions[i] = is_short ? Vec3{1, 0, 0} : (1 / distance) * way;
        reach[i] = is_short ? 0 : static_cast<float>(distance - kContact);
    }
    data_->scene.intersect(from, directions, reach, kContact, distances);
    for (std::size_t i = 0; i < targets.size(); ++i) seen[i] = distances[i] == kNoReturn ? 1 : 0;
}

}  // namespace ispace
