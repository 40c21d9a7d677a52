// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/surface_set.h"

#include <algorithm>
#include <utility>

#include "trace/embree_query.h"

namespace ispace {

void FinishedSoup::add(const Mesh& mesh, Finish finish, Vec3 shift) {
    const auto first = static_cast<std::uint32_t>(triangles.vertices.size());
    for (const Point3& vertex : mesh.vertices) triangles.add(vertex + shift);
    for (const auto& [a, b, c] : mesh.triangles)
        triangles.triangles.push_back({first + a, first + b, first + c});
    triangles.round_of.resize(triangles.triangles.size(), TriangleSoup::kFlat);
    finishes.resize(triangles.triangles.size(), finish);
}

SurfaceSet::SurfaceSet(RTCDeviceTy* device, const FinishedSoup& soup, unsigned geometry_id)
    : triangles_(soup.triangles) {
    finishes_.reserve(triangles_.size());
    for (std::size_t i = 0; i < triangles_.size(); ++i)
        finishes_.push_back(soup.finishes[triangles_.source(i)]);
    addLabels();
    scene_ = buildTriangles(device, triangles_, geometry_id);
}

SurfaceSet::SurfaceSet(RTCDeviceTy* device, FinishedBodies bodies, unsigned geometry_id)
    : triangles_({}), bodies_(std::move(bodies.bodies)), finishes_(std::move(bodies.finishes)) {
    addLabels();
    scene_ = buildBodies(device, bodies_, geometry_id);
}

void SurfaceSet::addLabels() {
    labels_.reserve(finishes_.size());
    for (const Finish& finish : finishes_)
        labels_.push_back(static_cast<std::uint16_t>(std::min(finish.label, std::uint32_t{65535})));
}

}  // namespace ispace
