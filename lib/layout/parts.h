// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/layout only: what stands in a scene, cut into pieces that are easy to compare.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "env/environment.h"
#include "geom/spatial_index.h"
#include "layout/overlap.h"

namespace ispace {

/// An upright piece of an element: convex, or a line for a sheet (two points).
struct Part {
    std::size_t element = 0;  ///< index in Environment::elements()
    Polygon footprint;
    double bottom = 0, top = 0;

    [[nodiscard]] bool isSheet() const { return footprint.size() == 2; }
};

/// Heights that two things share.
struct HeightRange {
    double bottom = 0, top = 0;
    /// More than touching.
    [[nodiscard]] bool isShared() const { return top - bottom > kTouching; }
};

template <typename A, typename B>
HeightRange sharedHeights(const A& a, const B& b) {
    return {std::max(a.bottom, b.bottom), std::min(a.top, b.top)};
}

/// The prisms and sheets of all elements, found by place.
class Parts {
  public:
    explicit Parts(const Environment& environment);

    [[nodiscard]] std::span<const Part> of(std::size_t element) const;
    /// Calls visit(const Part&) for those whose bounds meet the window.
    template <typename Visit>
    void search(const Box2& window, Visit visit) const {
        tree_.search(window, [&](std::size_t i) { visit(parts_[i]); });
    }

  private:
    void add(std::size_t element, const Prism& prism);

    std::vector<Part> parts_;         // by element
    std::vector<std::size_t> first_;  // of each element, and the end
    BoxTree tree_;
};

/// The meshes of one element, cut where somebody asks.
class MeshCuts {
  public:
    explicit MeshCuts(const Body& body);

    [[nodiscard]] const Box2& box() const { return box_; }
    [[nodiscard]] const HeightRange& heights() const { return heights_; }
    const Slice& at(double height);
    /// Heights within a range at which to look, few and the same ones for ranges that share them.
    [[nodiscard]] std::vector<double> heightsIn(const HeightRange& heights) const;

  private:
    const Body* body_;
    Box2 box_;
    HeightRange heights_;
    std::map<double, Slice> cuts_;
};

}  // namespace ispace
