// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "layout/scene.h"
#include "render/render.h"
#include "view/eye.h"

namespace ispace {

/// Walls as one sees them who looks into a room: a dark line along the top, as in plans, and on the
/// floor for those that are left out.
class WallTops {
  public:
    /// Keeps the references.
    WallTops(const Standpoint& standpoint, const Scene& scene)
        : standpoint_(standpoint), scene_(scene) {}

    /// True for parts of walls between the viewer and the room: the side that faces the viewer is
    /// not indoors, the other one is. See RenderSceneOptions::leaves_out.
    [[nodiscard]] bool isBetween(const Element& element, std::span<const Point2> footprint) const;
    [[nodiscard]] PaintedMesh paint() const;

  private:
    const Standpoint& standpoint_;
    const Scene& scene_;
};

}  // namespace ispace
