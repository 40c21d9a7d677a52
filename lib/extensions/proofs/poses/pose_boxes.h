// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/poses: the subdivision of all poses into boxes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/packed.h"
#include "extensions/proofs/poses/outer_bound.h"

namespace ispace::proofs::poses {

using BoxId = std::uint32_t;

/// Parts of the cells from `first` on; further ones hold none.
struct CellParts {
    std::size_t first = 0;
    std::vector<std::uint8_t> parts;

    explicit CellParts(const std::vector<std::uint8_t>& all = {});
};

/// A box of the subdivision. Its children halve it.
struct BoxNode {
    PoseBox box;
    BoxId parent = 0, child = 0;      // the first child, then the second; 0: not split
    double most = 0;                  // bounds the area that any single pose of the box sees
    std::uint64_t low = 0, high = 0;  // half-open range of its poses in the order of the tree
    bool has_views = false, is_bare = false;  // bare: from a state, without the views
    bool is_large = false;                    // has views in large cells alone
    CellParts parts, large_parts;             // of the fat view
    CellParts core, large_core;               // that all poses of the box see
    CellParts centre;                         // large: of the view from the middle of the box

    /// True if no pose of the box sees any floor.
    [[nodiscard]] bool isBlind() const { return most == 0; }
    [[nodiscard]] bool hasLarge() const { return (is_large || has_views) && !is_bare; }
    void prefetchLarge() const {
        constexpr std::size_t kLine = 64;
        for (const CellParts* view : {&large_parts, &large_core})
            for (std::size_t i = 0; i < view->parts.size(); i += kLine)
                __builtin_prefetch(&view->parts[i]);
    }
    [[nodiscard]] const CellParts& fatIn(Grain grain) const {
        return grain == Grain::Large ? large_parts : parts;
    }
    [[nodiscard]] const CellParts& coreIn(Grain grain) const {
        return grain == Grain::Large ? large_core : core;
    }
};

/// The tree of boxes. Box 0 holds all poses.
class PoseBoxes {
  public:
    /// Stores the references.
    PoseBoxes(const PoseFloor& floor, const Sector& sector);

    const BoxNode& operator[](BoxId id) const { return boxes_[id]; }
    [[nodiscard]] std::size_t size() const { return boxes_.size(); }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    /// Returns the tree as in a certificate.
    [[nodiscard]] std::string text() const;
    /// Writes the tree and its bounds, without views.
    void pack(Packer& to) const;
    /// Replaces the tree by a written one. Views of its boxes are missing, but for those of halves
    /// that splitWithViews() makes. \throws FormatError if it is no tree
    void unpack(Unpacker& from);
    /// Computes missing views.
    void addMissingViews(std::vector<BoxId> ids);

    /// Halves those boxes that are whole, in parallel, and lowers the bounds of single views in
    /// them and the boxes around them.
    void split(std::vector<BoxId> ids);
    /// Halves boxes, and computes the views of the halves and closer bounds of their single views.
    void splitWithViews(const std::vector<BoxId>& ids);

    /// Halves those boxes that are whole, and computes views in large cells of all halves that have
    /// none.
    void splitWithLarge(std::vector<BoxId> ids);
    /// Computes views in large cells of halves that have none.
    void addLargeViews(std::vector<BoxId> ids);

    /// Returns the index of the box whose fat view may shrink most by a split; the number of boxes
    /// if all are too small.
    [[nodiscard]] std::size_t widestOf(std::span<const BoxId> boxes) const;
    /// Returns true if a half may replace one of these boxes: it holds floor, and some poses of the
    /// boxes are in the order of the tree. Equal sensors may be assumed in that order.
    [[nodiscard]] bool isInOrder(std::span<const BoxId> boxes, std::size_t which, BoxId half) const;

    /// Returns the area of the union of the views from centres.
    [[nodiscard]] double unionOfCentres(std::span<const BoxId> boxes) const;

    /// Bounds the area that the poses of boxes see together: the largest single views of `known`,
    /// and in each cell the lesser of the fat views of the others and the floor less all cores of
    /// the known ones. Outside of the cell these add no more than their areas less their cores in
    /// it. So a core that lies in another one lowers the sum.
    [[nodiscard]] double unionOf(std::span<const BoxId> known, std::span<const BoxId> others,
                                 Grain grain = Grain::Fine) const;
    /// Bounds it for poses of `boxes` in large cells, and in fine ones if these may lower it to
    /// `enough`.
    [[nodiscard]] double unionFor(double enough, std::span<const BoxId> boxes,
                                  std::span<const BoxId> known,
                                  std::span<const BoxId> others) const;
    /// Returns true if a bound in large cells exceeds one that suffices by so little that the
    /// bound in fine cells may not, or if the boxes are no larger than these.
    [[nodiscard]] bool isWorthFine(double large, double enough, std::span<const BoxId> boxes) const;
    /// Returns true if views of each box grow by no more than 1.3 times its sector: subdivisions
    /// may then bound each by itself.
    [[nodiscard]] bool areSmall(std::span<const BoxId> boxes) const;
    /// Returns true if views of the boxes grow by no more than if moved by a cell.
    [[nodiscard]] bool areWithinCells(Grain grain, std::span<const BoxId> boxes) const;

  private:
    /// Returns halves without bounds.
    [[nodiscard]] std::array<BoxNode, 2> bareHalvesOf(BoxId id) const;
    [[nodiscard]] std::array<BoxNode, 2> halvesOf(BoxId id) const;
    void lowerMost(BoxId id);
    /// Returns the whole box in a box whose single views are bounded worst.
    [[nodiscard]] BoxId largestIn(BoxId id) const;
    void addViews(BoxNode& node) const;
    void addLarge(BoxNode& node) const;
    void write(BoxId id, std::string& text) const;
    /// Growth of a fat view with the size of its box, m2.
    [[nodiscard]] double slackOf(const PoseBox& box) const;
    /// Growth of a fat view for each metre, m.
    [[nodiscard]] double rim() const;
    [[nodiscard]] double turnOf(const PoseBox& box) const;

    const PoseFloor& floor_;
    const Sector& sector_;
    std::vector<BoxNode> boxes_;
    std::size_t bytes_ = 0;
};

}  // namespace ispace::proofs::poses
