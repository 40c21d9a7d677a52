// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/scene: overlaps of shapes as seen from above.
//
// Shapes overlap if they share more than kCornerTolerance in depth: sides that touch do not. Convex
// polygons are compared along the normals of all their edges (the theorem of separating axes): the
// least depth along these is the shortest way out, up to rounding, since the edges of the
// difference of two convex polygons have no other normals. Cuts of meshes are compared by their
// lines; outlines that coincide are found by points beside their first eight edges, so that a
// shared part may be missed there.
//
//     if (const auto overlap = overlapOf(part.footprint, other.footprint)) report(overlap->place);
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "env/environment.h"
#include "env/slice.h"
#include "geom/polygon.h"
#include "geom/spatial_index.h"
#include "geom/tolerance.h"

namespace ispace {

/// The overlap of two shapes: its depth and the middle of the shared area.
struct Overlap {
    double depth = 0;  ///< the shortest translation that separates them, in metres
    Point2 place;
};

/// Computes the overlap of two convex polygons; `b` may be a line (two points). Empty if they only
/// touch. O(n + m)
std::optional<Overlap> overlapOf(const Polygon& a, const Polygon& b);

/// Returns the distance that `b` must move along `direction`, a unit vector, to lie beyond `a`;
/// negative if it lies beyond already.
double penetrationDepth(const Polygon& a, const Polygon& b, Vec2 direction);

/// Finds a point where a line runs inside a polygon, not along its edge; empty without one.
std::optional<Point2> placeWithin(const Segment2& line, const Polygon& polygon);

/// Finds a point that a cut shares with a convex polygon or a line (two points); empty without one.
std::optional<Point2> sharedPlace(const Slice& cut, const Polygon& convex);
/// Finds a point that two cuts share.
std::optional<Point2> sharedPlace(const Slice& a, const Slice& b);

/// An upright piece of an element: convex, or a line for a sheet (two points).
struct Part {
    std::size_t element = 0;  ///< index in Environment::elements()
    Polygon footprint;
    double bottom = 0, top = 0;

    [[nodiscard]] bool isSheet() const { return footprint.size() == 2; }
};

/// Heights that two elements share.
struct HeightRange {
    double bottom = 0, top = 0;
    /// Returns true if the range is higher than kCornerTolerance.
    [[nodiscard]] bool isShared() const { return top - bottom > kCornerTolerance; }
};

template <typename A, typename B>
HeightRange sharedHeights(const A& a, const B& b) {
    return {std::max(a.bottom, b.bottom), std::min(a.top, b.top)};
}

/// The prisms and sheets of all elements, in a spatial index.
class Parts {
  public:
    /// \param keep parts of which the bounds satisfy it; without it all
    explicit Parts(const Environment& environment,
                   const std::function<bool(const Box2&)>& keep = {});

    [[nodiscard]] std::span<const Part> of(std::size_t element) const;
    /// Calls visit(const Part&) for each part whose bounds meet the window.
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

/// The meshes of one element, cut at any height. Keeps up to 256 cuts; not thread-safe.
class MeshCuts {
  public:
    explicit MeshCuts(const Body& body);

    [[nodiscard]] const Box2& box() const { return box_; }
    [[nodiscard]] const HeightRange& heights() const { return heights_; }
    /// Computes the cut, or returns a kept one. The reference holds until the next call.
    const Slice& at(double height);
    /// Returns heights within a range at which to cut: up to five of 32 levels of the meshes, the
    /// same ones for ranges that share them; the middle of the range if no level lies in it.
    [[nodiscard]] std::vector<double> heightsIn(const HeightRange& heights) const;

  private:
    const Body* body_;
    Box2 box_;
    HeightRange heights_;
    std::map<double, Slice> cuts_;
};

}  // namespace ispace
