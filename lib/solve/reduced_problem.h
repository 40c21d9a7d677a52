// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "solve/relaxation.h"

namespace ispace {

/// A problem cut down to the candidates that still matter: cells that the same of them see are one,
/// cells that none of them sees are gone. Weights are in fine units, see RelaxedCells.
struct ReducedProblem {
    struct OfKind {
        std::shared_ptr<const CandidateSet> candidates;
        std::vector<std::uint32_t> original;  ///< candidates in the problem's set, ascending
        std::uint16_t multiplicity = 1;
    };
    std::uint64_t settled = 0;  ///< weight of cells that are covered in any case
    std::vector<std::uint32_t> weights;
    std::vector<std::uint16_t> needs;
    std::vector<OfKind> kinds;

    [[nodiscard]] std::size_t cells() const { return weights.size(); }
    [[nodiscard]] std::size_t candidates() const;
    [[nodiscard]] std::size_t bytes() const;
};

/// The whole of a problem; original is left empty.
ReducedProblem wholeProblem(const Problem& problem, const RelaxedCells& cells);

/// Cuts a problem down. O(cells + runs of the sites of those kept), by hashes of who sees a cell.
/// \param kept per kind, the candidates to keep (of the sets of `from`), ascending
/// \param multipliers of the cells; replaced by those of the joined cells, which are their sums
ReducedProblem reduce(const ReducedProblem& from,
                      const std::vector<std::vector<std::uint32_t>>& kept,
                      std::vector<std::uint32_t>& multipliers);

}  // namespace ispace
