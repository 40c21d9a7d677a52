// SPDX-License-Identifier: GPL-3.0-or-later
// People that stand in the way of sight, as bodies of a scene.
//
// Draws are keyed by seed and frame (base/random.h): crowd k is the same whatever was drawn before.
//
//     const Crowd crowd = CrowdFloor(scene).draw(10, {.seed = 7, .frame = k});
//     const Scene filled = withCrowd(scene, crowd);
#pragma once

#include <cstddef>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "scene/scene.h"

namespace ispace::robustness {

/// Height of people whose height is not known, metres.
constexpr double kUsualHeight = 1.7;

/// A person who blocks sight: an upright cylinder on the floor of humanRadius(height).
struct Bystander {
    Point2 place;
    double height = kUsualHeight;
};

/// People who are in the room at the same time.
using Crowd = std::vector<Bystander>;

/// Returns the scene with a cylinder for each person; sensors and digest stay. The environment
/// shares its walls with that of `scene`.
Scene withCrowd(const Scene& scene, const Crowd& crowd);

/// Draws positions of `count` people of the default height, independent and uniform over those
/// where a person touches no wall, no body below the height, no sensor there and no one drawn
/// before. \throws UnmetError if a thousand draws find no such position for one of them
class CrowdFloor {
  public:
    /// Stores the reference.
    explicit CrowdFloor(const Scene& scene);
    [[nodiscard]] Crowd draw(std::size_t count, RandomKey key) const;

  private:
    [[nodiscard]] bool isFree(Point2 place) const;

    const Scene& scene_;
    Slice band_;
    std::vector<Segment2> lines_;
};

}  // namespace ispace::robustness
