// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/arrange/poses: the subdivision of all poses of two sensors into pairs of boxes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "arrange/poses/pose_boxes.h"

namespace ispace::poses {

/// The tree of pairs of boxes, which bounds the area that two of several sensors see together.
class BoxPairs {
  public:
    /// Stores the reference; search() divides these boxes.
    explicit BoxPairs(PoseBoxes& boxes) : boxes_(boxes) {}

    /// Halves the pairs that may see most, until there are `most` or `is_stopped` says so;
    /// continues a search that was stopped.
    void search(std::size_t most, const std::function<bool()>& is_stopped);
    void pack(Packer& to) const;
    /// Replaces the tree by a written one. \throws FormatError if it is no tree of these boxes
    void unpack(Unpacker& from);

    /// Bounds the area that two poses see together, by the pairs; infinite without a search.
    [[nodiscard]] double mostOf(BoxId first, BoxId second) const;
    /// Bounds what two boxes see together, from their views.
    [[nodiscard]] double unionOf(BoxId first, BoxId second) const;

    [[nodiscard]] std::size_t bytes() const { return pairs_.size() * sizeof(PairNode); }
    /// Returns the tree as in a certificate; empty without a search.
    [[nodiscard]] std::string text() const;

  private:
    /// A pair of boxes, in the order of the tree, and its subdivision.
    struct PairNode {
        std::array<BoxId, 2> boxes{};
        double most = 0;  // bounds the area that two poses in them see together
        std::uint32_t parent = 0, child = 0, children = 0;  // the first child, and their number
        bool is_split = false;
    };
    [[nodiscard]] bool isHalf(const PairNode& parent, const PairNode& pair, std::size_t id) const;
    void split(const std::vector<std::uint32_t>& ids);
    void lower(std::uint32_t id);
    void write(std::uint32_t id, std::string& text) const;

    PoseBoxes& boxes_;
    std::vector<PairNode> pairs_;
};

}  // namespace ispace::poses
