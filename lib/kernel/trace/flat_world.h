// SPDX-License-Identifier: GPL-3.0-or-later
// Level rays against the plan at one height: RayWorld::ofSlice() is built of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geom/curve.h"
#include "geom/polygon.h"
#include "trace/rays.h"

namespace ispace {

/// Lines and round bodies of a slice, in metres.
struct FlatBodies {
    std::vector<Segment2> lines;
    std::vector<Ellipse> rounds;
};

/// A bounding volume hierarchy over lines on the floor, with eight boxes or lines per node, one
/// array per component for vector units. Skips lines without length. Round bodies form a second
/// hierarchy in the same nodes, traversed after that of the lines. Built by the binned surface area
/// heuristic, see orderOf() in geom/spatial_index.h.
struct FlatTree {
    static constexpr int kWidth = 8;
    /// Maximum depth; traversals stack fewer than kWidth nodes per level.
    static constexpr int kDepth = 25;
    static constexpr int kStack = kWidth * kDepth;

    /// Child i is node child[i], or leaf ~child[i] if that is negative. Boxes beyond `count` repeat
    /// the first one.
    struct alignas(64) Node {
        double left[kWidth], right[kWidth], low[kWidth], high[kWidth];
        std::int32_t child[kWidth];
        std::int32_t count;
    };
    /// Up to kWidth lines, padded by lines without length. a precedes b by lexLess, so that a line
    /// and its reverse give identical results.
    struct alignas(64) Leaf {
        double ax[kWidth], ay[kWidth], bx[kWidth], by[kWidth], length[kWidth];

        /// Number of lines.
        [[nodiscard]] int count() const {
            int lines = 0;
            for (const double one : length) lines += one > 0 ? 1 : 0;
            return lines;
        }
    };

    /// Maps a round body's plane, as (x - cx, y - cy), to the frame of the unit disc.
    struct Round {
        double cx, cy, xx, xy, yx, yy;
        friend bool operator==(const Round&, const Round&) = default;
    };

    /// Builds the tree, skipping lines that are points. O(n log n)
    explicit FlatTree(std::span<const Segment2> lines, std::span<const Ellipse> round_bodies = {});
    /// Copies a tree that was built from lines, without some of its lines and bodies, and adds a
    /// tree of others. O(lines) to copy; the removed ones are found by their boxes.
    /// \pre `base` has the removed ones
    FlatTree(const FlatTree& base, const FlatBodies& removed, const FlatBodies& added);

    /// Returns the node of a child.
    [[nodiscard]] const Node& node(std::int32_t child) const {
        return nodes[static_cast<std::uint32_t>(child)];
    }
    [[nodiscard]] const Leaf& leaf(std::int32_t child) const {
        return leaves[~static_cast<std::uint32_t>(child)];
    }

    /// Returns the round body of a child among those of round bodies.
    [[nodiscard]] const Round& round(std::int32_t child) const {
        return rounds[~static_cast<std::uint32_t>(child)];
    }

    /// The first node is the root of the lines, without children if there are none; empty without
    /// lines and round bodies.
    std::vector<Node> nodes;
    std::vector<Leaf> leaves;
    std::int32_t round_root =
        -1;  ///< root of the round bodies, with one body per leaf; -1: no round bodies
    std::vector<Round> rounds;
};

/// The lines and round bodies of a slice, for level rays: exact to rounding of doubles, and faster
/// than a general ray tracer.
///
/// A scan is rasterised like a picture with one row: a bounding volume hierarchy is traversed front
/// to back, boxes behind the farthest range they could shorten are skipped, and each remaining line
/// is drawn into the beams between its ends. A beam meets a line if it crosses it or passes one of
/// its ends within a nanometre (less for lines seen almost edge-on, see flat_kernels.h), decided in
/// doubles per beam and line: beams cannot slip between lines with a common end, and a beam that
/// touches a corner meets it.
///
/// Rays ignore lines nearer to the origin than `ray_epsilon` and their continuations within it, and
/// lines seen exactly edge-on (whose straight continuation passes the origin within a nanometre); a
/// round body that near is met at its far side only. Thread-safe; results depend only on the lines
/// and the ray, not on the order of lines, the scan a ray is part of, or the processor.
///
///     const FlatWorld world(lines);
///     world.cast({0, 0}, beams, 8, kRayEpsilon, ranges, {});
class FlatWorld {
  public:
    explicit FlatWorld(std::span<const Segment2> lines, std::span<const Ellipse> rounds = {});
    /// \pre `base` was built from bodies, which include the removed ones
    FlatWorld(const FlatWorld& base, const FlatBodies& removed, const FlatBodies& added);

    /// Computes the distance to the first line or round body along each direction (x and y count),
    /// up to max_range inclusive; +infinity without return. Fastest for directions with an arc,
    /// fast for similar neighbours. `cosines`, if not empty: |cosine| of the angle between ray and
    /// normal, 1 without return; the larger one where two lines meet. \pre ranges.size() ==
    /// directions.size(), cosines.size() as well or 0
    void cast(Point2 origin, const Directions& directions, double max_range, double ray_epsilon,
              std::span<float> ranges, std::span<float> cosines) const;
    /// The same with an origin for each ray.
    void cast(std::span<const Point2> origins, const Directions& directions, double max_range,
              double ray_epsilon, std::span<float> ranges, std::span<float> cosines) const;

  private:
    struct Data;
    std::shared_ptr<const Data> data_;
};

}  // namespace ispace
