// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "env/mesh.h"
#include "render/render.h"
#include "trace/embree_bodies.h"
#include "trace/triangle_set.h"

namespace ispace {

/// What a triangle belongs to, and how it looks.
struct Finish {
    static constexpr std::uint32_t kNoFace = ~0U;

    std::uint32_t label = 0;       ///< index of its record, plus 1
    std::uint32_t paint = 0;       ///< of RenderScene::Data
    std::uint32_t face = kNoFace;  ///< the textured one it is a part of
};

/// Triangles with their finish, in coordinates relative to the middle of the plan.
struct FinishedSoup {
    TriangleSoup triangles;
    std::vector<Finish> finishes;

    void add(const Mesh& mesh, Finish finish, Vec3 shift);
};

/// Bodies of people, one finish each, in the same coordinates. Labels are the bodies' owners.
struct FinishedBodies {
    std::vector<TracedBody> bodies;
    std::vector<Finish> finishes;
};

/// Triangles, or bodies, ready to be traced. Hits of it have this geometry id. Bodies are traced by
/// a BodyQuery.
class SurfaceSet {
  public:
    /// \throws std::runtime_error if Embree fails, std::bad_alloc if it has no memory
    SurfaceSet(RTCDeviceTy* device, const FinishedSoup& soup, unsigned geometry);
    SurfaceSet(RTCDeviceTy* device, FinishedBodies bodies, unsigned geometry);

    [[nodiscard]] bool empty() const { return finishes_.empty(); }
    [[nodiscard]] const TriangleSet& triangles() const { return triangles_; }
    [[nodiscard]] const TracedBody& body(std::size_t index) const { return bodies_[index]; }
    /// Of a triangle, or of a body.
    [[nodiscard]] const Finish& finish(std::size_t index) const { return finishes_[index]; }
    /// Labels of the triangles or bodies as pictures hold them: 65535 stands for all from there on.
    /// Kept apart, since pictures of labels read nothing else of a finish.
    [[nodiscard]] std::span<const std::uint16_t> labels() const { return labels_; }
    [[nodiscard]] RTCSceneTy* scene() const { return scene_.get(); }

  private:
    void addLabels();

    TriangleSet triangles_;
    std::vector<TracedBody> bodies_;
    std::vector<Finish> finishes_;  // of the set's triangles, or of its bodies
    std::vector<std::uint16_t> labels_;
    EmbreeSceneHandle scene_;
};

}  // namespace ispace
