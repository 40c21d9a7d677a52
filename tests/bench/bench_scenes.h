// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "layout/scene.h"

namespace ispace::bench {

/// share/scenes/NAME, or any other environment, with the devices of share/.
Scene loadScene(const std::string& file);
std::string sceneFile(const std::string& name);
DeviceCatalogue devices();

/// An office floor as big as real ones: columns x rows rooms of 4 m x 5 m along corridors, each
/// with a door gap, a desk, a chair and a round table. Some 20 surfaces of a slice a room.
Scene officeScene(int columns, int rows);

/// Places in the free floor, drawn from a fixed seed: `count` lasers with 1081 beams over 270
/// degrees and 30 m, level at 0.15 m, or at 1.5 m and tilted down by 20 degrees.
std::vector<PlacedLaser> fans(const Scene& scene, std::size_t count, bool level);

}  // namespace ispace::bench
