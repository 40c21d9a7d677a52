// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/ray_world.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "env/mesh.h"
#include "geom/box.h"
#include "trace/facet_index.h"

namespace ispace {

namespace {

/// Share of the plan's half width that roundings to float32 stay below: those of origin, corner
/// and direction and of the search itself are each some 2^-24 of it.
constexpr double kRounding = 1.0 / (1 << 21);

/// A soup without facets about the middle of a plan that reaches up or down to `height`.
FacetSoup emptySoup(const Box2& plan, double height) {
    FacetSoup soup;
    if (plan.empty()) return soup;
    soup.frame.middle = {plan.center().x, plan.center().y, 0};
    soup.slack = kRounding * std::max({plan.width() / 2, plan.depth() / 2, height});
    return soup;
}

FacetSoup soupOf(const Slice& slice) {
    Box2 plan;
    slice.forEachLine([&](const Segment2& line) {
        plan.add(line.a);
        plan.add(line.b);
    });
    FacetSoup soup = emptySoup(plan, 0);
    soup.frame.is_flat = true;
    soup.vertices_each = 4;
    slice.forEachLine([&](const Segment2& line) {
        const Point3 a = soup.frame.local({line.a.x, line.a.y, 0});
        const Point3 b = soup.frame.local({line.b.x, line.b.y, 0});
        const Facet facet = Facet::ofLine(a.onFloor(), b.onFloor());
        if (facet.empty()) return;
        soup.facets.push_back(facet);
        // An upright sheet through the plane of the rays, longer than the line by the slack at
        // both ends: no ray slips through a corner, whatever rounding does to it.
        const Vec3 more = (soup.slack / facet.size) * (b - a);
        const Point3 from = a + -1.0 * more, to = b + more;
        for (const Point3& end : {from, to}) soup.vertices.push_back({end.x, end.y, -1});
        for (const Point3& end : {to, from}) soup.vertices.push_back({end.x, end.y, 1});
    });
    return soup;
}

FacetSoup soupOf(const std::vector<Mesh>& meshes) {
    Box2 plan;
    double height = 0;
    for (const Mesh& mesh : meshes) {
        for (const Point3& vertex : mesh.vertices) {
            plan.add(vertex.onFloor());
            height = std::max(height, std::fabs(vertex.z));
        }
    }
    FacetSoup soup = emptySoup(plan, height);
    for (const Mesh& mesh : meshes) {
        const auto vertex = [&](std::uint32_t i) { return soup.frame.local(mesh.vertices[i]); };
        for (const auto& [i, j, k] : mesh.triangles) {
            const Facet facet = Facet::ofTriangle(vertex(i), vertex(j), vertex(k));
            if (facet.empty()) continue;
            soup.facets.push_back(facet);
            soup.vertices.insert(soup.vertices.end(), facet.corners.begin(), facet.corners.end());
        }
    }
    return soup;
}

}  // namespace

RayWorld::RayWorld(std::unique_ptr<FacetIndex> index) : index_(std::move(index)) {}
RayWorld::RayWorld(RayWorld&&) noexcept = default;
RayWorld& RayWorld::operator=(RayWorld&&) noexcept = default;
RayWorld::~RayWorld() = default;

RayWorld RayWorld::ofSlice(const Slice& slice, int packet_width) {
    return RayWorld(std::make_unique<FacetIndex>(soupOf(slice), packet_width));
}

RayWorld RayWorld::ofEnvironment(const Environment& environment, int packet_width) {
    std::vector<Mesh> meshes;
    for (const Element& element : environment.elements()) {
        for (Mesh& mesh : meshesOf(element.body, false)) meshes.push_back(std::move(mesh));
    }
    meshes.push_back(floorMesh(environment.indoor()));
    return RayWorld(std::make_unique<FacetIndex>(soupOf(meshes), packet_width));
}

void RayWorld::cast(Point3 origin, std::span<const Vec3> directions, double max_range,
                    std::span<float> ranges) const {
    index_->cast(origin, directions, max_range, ranges);
}

void RayWorld::look(Point3 origin, std::span<const Point3> targets,
                    std::span<std::uint8_t> seen) const {
    index_->look(origin, targets, seen);
}

}  // namespace ispace
