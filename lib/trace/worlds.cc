// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/worlds.h"

#include <cassert>
#include <mutex>
#include <utility>

namespace ispace {

// Only the thread that prepares adds worlds, so that it reads without a lock; others read on while
// it builds one.

void Worlds::prepare(const Pose3& pose) {
    if (!pose.isLevel()) return prepareMesh();
    const double height = pose.position.z;
    if (slices_.contains(height)) return;
    if (slices_.size() >= kMostSlices) return prepareMesh();
    RayWorld slice = RayWorld::ofSlice(environment_->slice(height));
    const std::unique_lock lock(mutex_);
    slices_.emplace(height, std::move(slice));
}

void Worlds::prepareMesh() {
    if (mesh_) return;
    RayWorld mesh = RayWorld::ofEnvironment(*environment_);
    const std::unique_lock lock(mutex_);
    mesh_.emplace(std::move(mesh));
}

const RayWorld& Worlds::at(const Pose3& pose) const {
    if (pose.isLevel()) {
        const std::shared_lock lock(mutex_);
        const auto slice = slices_.find(pose.position.z);
        if (slice != slices_.end()) return slice->second;
    }
    return mesh();
}

const RayWorld& Worlds::mesh() const {
    const std::shared_lock lock(mutex_);
    assert(mesh_);
    return *mesh_;
}

}  // namespace ispace
