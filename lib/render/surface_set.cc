// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/surface_set.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "trace/embree_query.h"

namespace ispace {

namespace {

void throwIfFailed(RTCDevice device) {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE) return;
    if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error("Embree failed with error " + std::to_string(static_cast<int>(code)));
}

}  // namespace

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
    scene_ = buildTriangles(device, triangles_, geometry_id, [device] { throwIfFailed(device); });
}

SurfaceSet::SurfaceSet(RTCDeviceTy* device, FinishedBodies bodies, unsigned geometry_id)
    : triangles_({}), bodies_(std::move(bodies.bodies)), finishes_(std::move(bodies.finishes)) {
    addLabels();
    scene_ = buildBodies(device, bodies_, geometry_id, [device] { throwIfFailed(device); });
}

void SurfaceSet::addLabels() {
    labels_.reserve(finishes_.size());
    for (const Finish& finish : finishes_)
        labels_.push_back(static_cast<std::uint16_t>(std::min(finish.label, std::uint32_t{65535})));
}

}  // namespace ispace
