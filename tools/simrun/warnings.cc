// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/warnings.h"

#include <string>
#include <string_view>
#include <utility>

#include "base/number.h"
#include "layout/scene.h"

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

namespace {

/// What is measured of a camera's light always spreads.
bool isNoisy(const Sensor& sensor) {
    const auto noise_of = [&sensor]() -> const RangeNoise* {
        if (const auto* laser = std::get_if<Laser>(&sensor.model)) return &laser->noise;
        if (const auto* ranger = std::get_if<Ranger>(&sensor.model)) return &ranger->noise;
        if (const auto* receiver = std::get_if<Receiver>(&sensor.model)) return &receiver->noise;
        return nullptr;
    };
    if (const auto* tag = std::get_if<Tag>(&sensor.model)) return tag->is_simple;
    return sensor.is<Camera>() || (noise_of() != nullptr && !noise_of()->isNone());
}

}  // namespace

void warnOfNoNoise(const Scene& scene, bool moves, const CommonOptions& options) {
    const bool strays = moves && std::any_of(scene.robots.begin(), scene.robots.end(),
                                             [](const PlacedRobot& robot) {
                                                 return robot.model.noise != MotionNoise();
                                             });
    if (strays || std::any_of(scene.sensors.begin(), scene.sensors.end(), isNoisy)) return;
    warn(options, kTool,
         "--noise changes nothing: no sensor has noise, and no robot has motion_noise, "
         "odometry_noise or start_noise");
}

void LagLog::tell() {
    using std::chrono::steady_clock;
    constexpr std::chrono::seconds kCalm(1);  // without a loss, before the run is said to keep up
    constexpr int kMost = 10;
    const auto due = simulation_->due();
    if (!due) return;
    const auto now = steady_clock::now();
    const auto say = [&](const std::string& text) {
        if (count_ <= kMost)
            warn(*options_, kTool, "t=" + formatSimTime(simulation_->world().time()) + text);
    };
    if (simulation_->lost() > lost_) {
        lost_ = simulation_->lost();
        last_ = now;
        if (std::exchange(is_behind_, true)) return;
        ++count_;
        say(" the run falls behind real time, by " + formatMilliseconds(lost_) +
            " s so far: steps take longer than the clock gives them" +
            (count_ == kMost ? "; further ones are not reported" : ""));
    } else if (is_behind_ && now <= *due && now - last_ >= kCalm) {
        is_behind_ = false;
        say(" the run keeps up with real time again, " + formatMilliseconds(lost_) +
            " s behind in all");
    }
}

void FailureLog::tell() {
    if (is_told_ || replay_ == nullptr) return;
    const std::string failure = replay_->failure();
    is_told_ = !failure.empty();
    if (is_told_) warn(*options_, kTool, failure);
}

void warnOfChanges(const Replay& replay, const CommonOptions& options) {
    if (const auto& time = replay.changedAt())
        warn(options, kTool,
             "the world of the run was changed at t=" + formatMilliseconds(*time) +
                 ": the room is drawn as it was at the start");
}

}  // namespace ispace
