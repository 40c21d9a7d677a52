// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "layout/scene.h"
#include "sim/world.h"

namespace ispace {

/// Says on stderr what robots run into, up to a number of lines that nobody reads beyond.
class CollisionLog {
  public:
    CollisionLog(const World& world, bool quiet) : world_(&world), quiet_(quiet) {}
    /// Tells the collisions of the world's last step.
    void tell();

  private:
    const World* world_;
    bool quiet_;
    int count_ = 0;
};

/// Says what takes no part: lasers without a place, and what is not simulated yet.
void warnOfLeftOut(const Scene& scene, bool quiet);

}  // namespace ispace
