// SPDX-License-Identifier: GPL-3.0-or-later
// Maps for screens, whose readers switch layers on and off: all layers are in one picture.
#pragma once

#include "coverage/coverage.h"
#include "drawing/drawing.h"

namespace ispace::pages {

/// A map with a layer for each subject, and its legend beside it.
struct ScreenMap {
    Picture map, legend;
    PageView view;
};

/// Draws the plan with the layers `redundancy` and, with cameras, `density`, `views` with a group
/// for each sensor that holds its region as one path, the room, `sensors`, `unseen spots` and
/// `labels`. For pages that switch layers; equal input gives equal pictures.
ScreenMap drawScreenMap(const Scene& scene, const Coverage& coverage);

}  // namespace ispace::pages
