// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/warnings.h"

#include <iostream>

#include "base/number.h"

namespace ispace {

namespace {

constexpr int kMostCollisions = 100;
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
        if (count_ == kMostCollisions) return;
        say(*world_, collision);
        if (++count_ == kMostCollisions) std::cerr << kWarning << "no more of these are told\n";
    }
}

void warnOfPending(const Scene& scene, bool quiet) {
    if (quiet) return;
    for (const PendingSensor& sensor : scene.pending)
        std::cerr << kWarning << sensor.id
                  << " has no place and is left out: give it `at` or `on`, or let arrange place "
                     "it\n";
}

}  // namespace ispace
