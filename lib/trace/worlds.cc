// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/worlds.h"

#include <algorithm>
#include <cassert>
#include <mutex>
#include <utility>
#include <vector>

#include "env/level.h"

namespace ispace {

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

// Only the thread that prepares adds worlds, so that it reads without a lock; others read on while
// it builds one.

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
