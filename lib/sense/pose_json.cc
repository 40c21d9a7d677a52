// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/pose_json.h"

namespace ispace {

void addPose(JsonWriter& json, const Pose3& pose) {
    json.key("pose").beginArray();
    for (const double part : {pose.position.x, pose.position.y, pose.position.z,
                              pose.heading.radians(), pose.tilt.radians(), pose.roll.radians()})
        json.value(part);
    json.endArray();
}

}  // namespace ispace
