// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/scene only: whether things seen from above reach into each other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "env/environment.h"
#include "env/slice.h"
#include "geom/polygon.h"
#include "geom/spatial_index.h"

namespace ispace {

/// Things may reach into each other by this much, in metres: what is written side by side touches
/// in spite of rounding, as wall ends that are this near are welded.
constexpr double kTouching = 1e-6;

/// How far two things reach into each other, and the middle of what they share.
struct Overlap {
    double depth = 0;  ///< the shortest way that parts them, in metres
    Point2 place;
};

/// Of two convex polygons; `b` may be a line (two points). Nothing if they touch at most.
/// O(n + m)
std::optional<Overlap> overlapOf(const Polygon& a, const Polygon& b);

/// How far `b` has to move along `direction`, a unit vector, until it is beyond `a`; negative if it
/// is beyond already.
double penetrationDepth(const Polygon& a, const Polygon& b, Vec2 direction);

/// A place where a line runs within a polygon, not just along its edge; nothing if it does not.
std::optional<Point2> placeWithin(const Segment2& line, const Polygon& polygon);

/// A place that a cut shares with a convex polygon or a line (two points), or nothing.
std::optional<Point2> sharedPlace(const Slice& cut, const Polygon& convex);
/// A place that two cuts share.
std::optional<Point2> sharedPlace(const Slice& a, const Slice& b);

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

/// The meshes of one element, cut at any height.
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
