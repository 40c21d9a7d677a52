// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "render/render.h"

namespace ispace {

/// render() band by band: what it needs for each pixel while it works (some 150 bytes) is needed
/// for a band alone. Bands overlap where light is smoothed, so that no seam is seen.
Rendering renderInBands(const RenderScene& scene, const Viewpoint& viewpoint,
                        const RenderOptions& options, int most_pixels = 1'000'000);

}  // namespace ispace
