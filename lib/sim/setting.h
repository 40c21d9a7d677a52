// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim.
#pragma once

#include <memory>

#include "layout/scene.h"
#include "sense/photo.h"
#include "sim/collision.h"
#include "sim/motion.h"
#include "sim/world.h"
#include "trace/worlds.h"

namespace ispace {

/// A scene with what is made of it wherever robots and people are, which takes long.
struct Setting {
    /// \param meshes that somebody will need; others are made when they are needed
    /// \throws FormatError for a texture that cannot be read, if there are cameras
    Setting(std::shared_ptr<const Scene> made_of, const RunOptions& options,
            const Worlds::Meshes& meshes);

    std::shared_ptr<const Scene> scene;
    ObstacleSets obstacles;
    FrictionMap friction;
    Worlds worlds;
    std::unique_ptr<Photographer> photographer;  // if there are cameras
};

}  // namespace ispace
