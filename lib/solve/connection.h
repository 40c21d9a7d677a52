// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstddef>
#include <vector>

#include "solve/problem.h"

namespace ispace {

/// How the views of sensors hang together, see Problem::is_connected.
class Connection {
  public:
    /// O(cells + cells that the chosen see)
    Connection(const Problem& problem, const std::vector<Choice>& chosen);

    /// Sets of views that see no common cell of weight above 0.
    [[nodiscard]] std::size_t parts() const { return parts_; }
    /// True if with this one all hangs together. O(parts * runs); the first call: O(parts * cells)
    [[nodiscard]] bool isJoinedBy(const Choice& choice) const;

  private:
    const Problem* problem_;
    std::size_t parts_ = 0;
    std::vector<std::size_t> part_of_cell_;          // kNobody: of none
    mutable std::vector<CellPrices> cells_of_part_;  // 1 for its cells; made when first asked for
};

}  // namespace ispace
