// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/warnings.h"

#include <iostream>
#include <string_view>
#include <variant>

#include "base/number.h"
#include "layout/scene.h"

namespace ispace {

namespace {

constexpr int kMaxCollisions = 100;
constexpr const char* kWarning = "simrun: warning: ";

void say(const World& world, const Collision& collision) {
    const Point2 place = world.status(collision.robot).pose.position;
    std::cerr << kWarning << "t=" << formatMilliseconds(collision.time) << ' '
              << world.robots()[collision.robot].id << " at " << formatFixed(place.x, 3) << ','
              << formatFixed(place.y, 3) << " ran into " << collision.into << '\n';
}

}  // namespace

void CollisionLog::tell() {
    if (quiet_) return;
    for (const Collision& collision : world_->collisions()) {
        if (count_ == kMaxCollisions) return;
        say(*world_, collision);
        if (++count_ == kMaxCollisions) std::cerr << kWarning << "no more of these are told\n";
    }
}

void warnOfLeftOut(const Scene& scene, bool quiet) {
    if (quiet) return;
    for (const PendingSensor& sensor : scene.pending)
        if (std::holds_alternative<Laser>(sensor.model))
            std::cerr << kWarning << sensor.id
                      << " has no place and is left out: give it `at` or `on`, or let arrange "
                         "place it\n";
    constexpr std::string_view kKinds[] = {"ranger", "camera", "ultrasound", "tag", "mat", "gate"};
    std::vector<std::string> phrases = leftOut(scene, kKinds, "simulated");
    for (const char* key : {"path", "walk"}) {
        std::vector<std::string> ids;
        for (std::size_t i = 0; i < scene.records.size(); ++i) {
            const Record& record = scene.records[i];
            const bool goes = record.keyword() == "robot" || record.keyword() == "human";
            if (goes && record.has(key)) ids.push_back(scene.ids[i]);
        }
        if (!ids.empty()) phrases.push_back(leftOutText(key, "simulated", ids));
    }
    for (const std::string& phrase : phrases) std::cerr << kWarning << phrase << '\n';
}

}  // namespace ispace
