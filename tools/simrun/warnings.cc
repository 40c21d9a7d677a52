// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/warnings.h"

#include <string>
#include <string_view>

#include "base/number.h"
#include "layout/scene.h"
#include "sensor/kind.h"

namespace ispace {

namespace {

constexpr int kMaxCollisions = 100;
constexpr const char* kTool = "simrun";

std::string textOf(const World& world, const Collision& collision) {
    const Point2 place = world.status(collision.robot).pose.position;
    return "t=" + formatMilliseconds(collision.time) + ' ' + world.movers()[collision.robot].id +
           " at " + formatFixed(place.x, 3) + ',' + formatFixed(place.y, 3) + " ran into " +
           std::string(collision.into);
}

}  // namespace

void CollisionLog::tell() {
    for (const Collision& collision : world_->collisions()) {
        if (count_ == kMaxCollisions) return;
        warn(*options_, kTool, textOf(*world_, collision));
        if (++count_ == kMaxCollisions) warn(*options_, kTool, "no more of these are told");
    }
}

void warnOfNoNoise(const Scene& scene, const CommonOptions& options) {
    for (const PlacedRobot& robot : scene.robots)
        if (robot.model.noise != MotionNoise()) return;
    warn(options, kTool,
         "--noise changes nothing: no robot has motion_noise, odometry_noise or start_noise");
}

void warnOfLeftOut(const Scene& scene, const CommonOptions& options) {
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const Record& record = scene.records[i];
        const SensorKind* const kind = sensorKind(record.keyword());
        if (kind == nullptr || !kind->is_read || record.has("at") || record.has("on")) continue;
        warn(options, kTool,
             scene.ids[i] + " has no place and is left out: give it `at` or `on`" +
                 (kind->is_arranged ? ", or let arrange place it" : ""));
    }
}

}  // namespace ispace
