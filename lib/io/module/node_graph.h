// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ispace {

/// Nodes and what hangs on them, each time it does.
class NodeGraph {
  public:
    using Node = std::uint32_t;

    /// \return its number, from 0
    Node add();
    void hang(Node child, Node parent) { children_[parent].push_back(child); }
    [[nodiscard]] std::size_t size() const { return children_.size(); }

    /// \throws std::runtime_error: a circle, more than kMaxMeshNodeDepth below each other, or
    ///         more than kMaxMeshNodes below one, with all repetitions
    void check() const;

  private:
    std::vector<std::vector<Node>> children_;
};

}  // namespace ispace
