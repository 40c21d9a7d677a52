// SPDX-License-Identifier: GPL-3.0-or-later
// Indices over segments and boxes in the plane. Each is built once, immutable and thread-safe after
// that, and deterministic: candidates come in an order that depends on the input alone. They return
// candidates, never too few; the caller tests each.
//
// | index       | for                                            | query                         |
// | SegmentGrid | evenly spread segments: walls of a plan         | O(1) cells, short lists       |
// | BoxTree     | boxes of any spread                             | O(log n + answers), typically |
// | SegmentTree | crowded or rotated segments                     | likewise                      |
// | BoxOrder    | layout of an eight-wide tree for vector kernels | its owner's                   |
//
//     const SegmentGrid grid(walls, 0.01);
//     for (const std::uint32_t i : grid.near(p))
//         if (distance(p, walls[i]) <= 0.01) touched.push_back(i);
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geom/point.h"
#include "geom/polygon.h"

namespace ispace {

/// Computes the position of a cell along a Morton curve (G. M. Morton, A computer oriented geodetic
/// data base, 1966), which keeps most neighbours close: the bits of x and y alternate, those of x
/// lowest. Bijective.
std::uint64_t mortonCode(std::uint32_t x, std::uint32_t y);

/// Finds the segments near a point: square cells over their bounding box, about as many as there
/// are segments, each listing the segments that come within `margin` of it.
///
/// A side of a cell is at least the mean length of the segments and 8 margins, so that a segment
/// lies in few cells: O(n) to build and to store for lengths like each other. A few long segments
/// among many short ones lie in many cells; segments crowded in a corner share few cells, and
/// queries there take O(n): use SegmentTree.
class SegmentGrid {
  public:
    SegmentGrid(std::span<const Segment2> segments, double margin);

    /// Returns ascending indices of the segments of p's cell, including all those within `margin`
    /// of p. A point outside the segments' bounding box is looked up in the nearest cell. O(1)
    [[nodiscard]] std::span<const std::uint32_t> near(Point2 p) const;

    /// Visits cells around p in growing rings: visit(indices of one cell). After each ring, when
    /// all segments nearer than `reach` have been visited, done(reach) ends the search by returning
    /// true. An index may be visited more than once.
    template <typename Visit, typename Done>
    void searchFrom(Point2 p, Visit visit, Done done) const;

    /// Calls visit(ascending indices of segments) for each cell that has any. Segments that share a
    /// point share a cell.
    template <typename Visit>
    void forEachCell(Visit visit) const;

    /// Visits the cells that touch the box: visit(indices of one cell). All segments within the
    /// margin of the box are visited; an index may be visited more than once.
    template <typename Visit>
    void searchBox(const Box2& box, Visit visit) const;

    /// Visits the cells that the segment touches: visit(indices of one cell). All segments within
    /// the margin of a point of it are visited; an index may be visited more than once.
    template <typename Visit>
    void searchAlong(const Segment2& segment, Visit visit) const {
        forEachCellOf(segment, [&](std::int64_t c, std::int64_t r) { visit(cell(c, r)); });
    }

    /// Visits the cells below p, starting with its own, until visit(indices, bottom) returns true.
    /// By then all segments that cross the vertical from p down to `bottom` have been visited.
    template <typename Visit>
    void searchBelow(Point2 p, Visit visit) const;

  private:
    [[nodiscard]] std::int64_t column(double x) const { return cellOf(x - box_.low.x, columns_); }
    [[nodiscard]] std::int64_t row(double y) const { return cellOf(y - box_.low.y, rows_); }
    [[nodiscard]] std::int64_t cellOf(double offset, std::int64_t count) const;
    [[nodiscard]] std::size_t indexOf(std::int64_t column, std::int64_t row) const {
        return static_cast<std::size_t>(row * columns_ + column);
    }
    [[nodiscard]] std::span<const std::uint32_t> cell(std::int64_t column, std::int64_t row) const;
    template <typename Visit>
    void forEachCellOf(const Segment2& segment, Visit visit) const;

    Box2 box_;
    double margin_;
    double size_ = 1;  // of a cell
    std::int64_t columns_ = 1, rows_ = 1;
    std::vector<std::size_t> first_;      // of each cell's indices, and the end
    std::vector<std::uint32_t> indices_;  // by cell
};

template <typename Visit, typename Done>
void SegmentGrid::searchFrom(Point2 p, Visit visit, Done done) const {
    const std::int64_t column0 = column(p.x), row0 = row(p.y);
    for (std::int64_t ring = 0; ring < std::max(columns_, rows_); ++ring) {
        for (std::int64_t r = row0 - ring; r <= row0 + ring; ++r) {
            if (r < 0 || r >= rows_) continue;
            const bool whole = r == row0 - ring || r == row0 + ring;
            for (std::int64_t c = column0 - ring; c <= column0 + ring;
                 c += whole ? 1 : std::max<std::int64_t>(1, 2 * ring)) {
                if (c >= 0 && c < columns_) visit(cell(c, r));
            }
        }
        if (done(static_cast<double>(ring) * size_)) return;
    }
}

template <typename Visit>
void SegmentGrid::forEachCell(Visit visit) const {
    const std::span<const std::uint32_t> all(indices_);
    for (std::size_t i = 0; i + 1 < first_.size(); ++i) {
        if (first_[i] != first_[i + 1]) visit(all.subspan(first_[i], first_[i + 1] - first_[i]));
    }
}

template <typename Visit>
void SegmentGrid::searchBox(const Box2& box, Visit visit) const {
    const std::int64_t last_column = column(box.high.x), last_row = row(box.high.y);
    for (std::int64_t r = row(box.low.y); r <= last_row; ++r) {
        for (std::int64_t c = column(box.low.x); c <= last_column; ++c) visit(cell(c, r));
    }
}

template <typename Visit>
void SegmentGrid::searchBelow(Point2 p, Visit visit) const {
    const std::int64_t c = column(p.x);
    for (std::int64_t r = row(p.y); r >= 0; --r) {
        // Segments listed here may lie this much above or below the cell.
        const double bottom = box_.low.y + (static_cast<double>(r) + 1.0 / 512) * size_ + margin_;
        if (visit(cell(c, r), bottom)) return;
    }
}

template <typename Visit>
void SegmentGrid::forEachCellOf(const Segment2& segment, Visit visit) const {
    auto [a, b] = segment;
    if (a.x > b.x) std::swap(a, b);
    const double low = std::min(a.y, b.y), high = std::max(a.y, b.y);
    // Widened by a part of a cell, against rounding.
    const double slack = margin_ + size_ / 1024;
    const double slope = (b.y - a.y) / (b.x - a.x);
    const std::int64_t last = column(b.x + slack);
    for (std::int64_t c = column(a.x - slack); c <= last; ++c) {
        double from = low, to = high;
        if (std::isfinite(slope)) {
            // The part of the segment over this column.
            const double left = box_.low.x + static_cast<double>(c) * size_ - slack;
            const double y0 = a.y + (left - a.x) * slope;
            const double y1 = a.y + (left + size_ + 2 * slack - a.x) * slope;
            from = std::max(low, std::min(y0, y1));
            to = std::min(high, std::max(y0, y1));
        }
        for (std::int64_t r = row(from - slack); r <= row(to + slack); ++r) visit(c, r);
    }
}

/// Finds the boxes that meet a window: a binary tree of bounding boxes over their centres, halved
/// across the longer side, with up to four boxes a leaf. O(n log n) to build, some 80 bytes a box;
/// about 30 levels for 2^32 boxes, however they lie. Empty boxes are never found.
class BoxTree {
  public:
    BoxTree() = default;
    explicit BoxTree(std::span<const Box2> boxes);

    /// Calls visit(index) for each box that meets the window, in an order that depends only on the
    /// boxes. The visitor may shrink the window as it learns more: boxes outside the new one are
    /// skipped from then on. Closed boxes meet if they share a point. Uses a stack of 256 bytes, no
    /// heap.
    template <typename Visit>
    void search(const Box2& window, Visit visit) const;

  private:
    struct Item {
        Box2 box;
        std::uint32_t index;
    };
    struct Node {
        Box2 box;
        std::uint32_t first, count;  // of items_
        std::uint32_t right;         // the second child; the first one follows; 0: a leaf
    };
    static constexpr std::uint32_t kLeaf = 4;
    static constexpr std::size_t kMaxDepth = 64;  // halving 2^32 items, and more

    void build(std::uint32_t first, std::uint32_t count);

    std::vector<Item> items_;  // leaf after leaf
    std::vector<Node> nodes_;
};

template <typename Visit>
void BoxTree::search(const Box2& window, Visit visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, kMaxDepth> open{};
    std::size_t count = 1;
    while (count > 0) {
        const std::uint32_t at = open[--count];
        const Node& node = nodes_[at];
        if (!node.box.meets(window)) continue;
        if (node.right != 0) {
            open[count++] = node.right;
            open[count++] = at + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            if (items_[i].box.meets(window)) visit(std::size_t{items_[i].index});
    }
}

/// Finds segments near a given one, however unevenly they are spread: a tree of bounding boxes
/// aligned with the direction in which most segments run, so that boxes stay thin in a rotated
/// plan. The direction is the mean of the segments' directions times four, weighted by length, as
/// all sides of a rectangle have the same. Boxes are widened by 8 ulp of the largest coordinate,
/// more than rotation errs. O(n log n) to build.
class SegmentTree {
  public:
    explicit SegmentTree(std::span<const Segment2> segments);

    /// Calls visit(index) once for each candidate: all segments within `reach` of the given one,
    /// and some others. The order depends only on the segments.
    template <typename Visit>
    void search(const Segment2& segment, double reach, Visit visit) const {
        tree_.search(boxOf(segment, reach), visit);
    }

  private:
    [[nodiscard]] Box2 boxOf(const Segment2& segment, double reach) const;

    Vec2 axis_{1, 0};   // unit, along which boxes lie
    double slack_ = 0;  // bound of the rounding error of the rotation
    BoxTree tree_;
};

/// Layout of a tree of boxes.
struct BoxOrder {
    /// Children of a node, and boxes of a leaf, at most.
    static constexpr std::size_t kWidth = 8;
    /// Nodes below each other, at most.
    static constexpr int kDepth = 24;

    /// Indices of the boxes, leaf after leaf in depth-first order from the root.
    std::vector<std::uint32_t> items;
    /// For each node, the root first: the number of its children; for each child the number of its
    /// boxes if it is a leaf, 0 if it is a node; then the same for each child that is a node.
    std::vector<std::uint8_t> shape;
};

/// Builds a tree by binned surface area heuristic, with up to `most` boxes a leaf: a cut costs the
/// half perimeter of each side, which is the chance that a line meets it, times its vectors of
/// boxes (J. Goldsmith, J. Salmon, Automatic creation of object hierarchies for ray tracing, 1987;
/// 32 bins: I. Wald, On fast construction of SAH-based bounding volume hierarchies, 2007). From
/// depth 12 on groups are halved, so that kDepth holds for any input. Deterministic. O(n log n)
/// \pre most <= BoxOrder::kWidth, and there are boxes
BoxOrder orderOf(std::span<const Box2> boxes, std::size_t most);
/// Builds a tree of the boxes of lines, BoxOrder::kWidth a leaf. \pre there are lines
BoxOrder orderOf(std::span<const Segment2> lines);

}  // namespace ispace
