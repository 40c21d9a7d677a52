// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/worlds.h"

#include <cassert>

namespace ispace {

void Worlds::prepare(const Pose3& pose) {
    if (!pose.isLevel()) {
        if (!mesh_) mesh_.emplace(RayWorld::ofEnvironment(*environment_));
        return;
    }
    const double height = pose.position.z;
    if (!slices_.contains(height))
        slices_.emplace(height, RayWorld::ofSlice(environment_->slice(height)));
}

const RayWorld& Worlds::at(const Pose3& pose) const {
    if (!pose.isLevel()) {
        assert(mesh_);
        return *mesh_;
    }
    const auto slice = slices_.find(pose.position.z);
    assert(slice != slices_.end());
    return slice->second;
}

}  // namespace ispace
