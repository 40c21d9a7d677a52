// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "env/mesh.h"
#include "layout/scene.h"

namespace ispace {

/// What a placed sensor looks at, as a translucent sheet in its frame, open and seen from both
/// sides: the fan of a laser (of a swept one, what all fans fill), the frustum of a ranger, the
/// cone of an ultrasonic receiver, each from the least to the greatest range, but no farther than
/// the plan is wide, so that a model stays in scale. Nothing for everything else.
std::optional<Mesh> viewOf(const Scene& scene, const Placed& placed);

}  // namespace ispace
