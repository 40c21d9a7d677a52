// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/trace/render: the light of projectors.
#pragma once

#include "trace/render/render_scene.h"
#include "trace/render/shading.h"

namespace ispace {

/// Returns the light of all projectors on a surface, in the unit of radiance of white surfaces.
/// Bodies and people cast shadows; clear glass lets the light pass. It is computed for each line of
/// sight, not smoothed like other light, so that pictures stay sharp.
Rgb thrownLight(const RenderScene::Data& scene, const SurfacePoint& point);

}  // namespace ispace
