// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/engine/arrange/search: set cover problems by rows and by columns, and their bounds.
//
// Costs and prices are multiples of 2^-20 below 2^31, so doubles hold all their sums exactly: a
// bound needs no tolerance. Reductions keep at least one optimal cover, not all of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arrange/search/set_cover.h"

namespace ispace {

/// The rows that are still open and the columns that may still be taken.
class CoverCore {
  public:
    CoverCore() = default;
    explicit CoverCore(const SetCover& problem);

    [[nodiscard]] std::size_t rows() const { return row_first_.size() - 1; }
    [[nodiscard]] std::size_t columns() const { return cost.size(); }
    [[nodiscard]] std::span<const std::uint32_t> rowsOf(std::size_t column) const {
        return std::span(rows_).subspan(first_[column], first_[column + 1] - first_[column]);
    }
    [[nodiscard]] std::span<const std::uint32_t> columnsOf(std::size_t row) const {
        return std::span(columns_).subspan(row_first_[row], row_first_[row + 1] - row_first_[row]);
    }
    /// Takes these columns, which closes their rows, and excludes others.
    /// \param out 1 for columns to exclude \param closed 1 for rows to drop
    [[nodiscard]] CoverCore without(const std::vector<char>& out, std::vector<char> closed,
                                    std::span<const std::uint32_t> taken) const;
    /// Takes columns that are the last of a row, and removes rows and columns that others dominate,
    /// until none is left. Rows without columns remain.
    void reduce();
    /// Divides the open rows into cores that share no column, with prices and without taken
    /// columns.
    [[nodiscard]] std::vector<CoverCore> components() const;

    std::vector<double> cost;          ///< of columns, whole numbers
    std::vector<std::uint32_t> id;     ///< of columns, in the first problem
    std::vector<double> price;         ///< of rows: multipliers, multiples of 2^-20
    std::vector<std::uint32_t> taken;  ///< ids
    double taken_cost = 0;

  private:
    void transpose(std::size_t rows);
    [[nodiscard]] bool takeForced();
    [[nodiscard]] std::vector<char> dominatedRows() const;
    [[nodiscard]] std::vector<char> dominatedColumns() const;

    std::vector<std::uint32_t> first_ = {0}, rows_;         // by column
    std::vector<std::uint32_t> row_first_ = {0}, columns_;  // by row
};

/// A Lagrangian bound of a core, with the columns that it excludes.
struct CoverBound {
    double value = 0;              ///< of the core's rows alone
    std::vector<double> fraction;  ///< of columns: how often rounds took them, 0 to 1
    std::vector<char> excluded;    ///< columns that no cover below the limit takes
};
/// How to raise prices: deflected subgradients come closer to the best prices of large cores, plain
/// ones of small cores.
struct PriceRounds {
    int rounds;
    int patience;   ///< rounds without gain before steps become smaller
    double newest;  ///< share of the newest subgradient in the direction; 1: plain
};
/// Raises core.price by subgradients; ends once no cover below `limit` (of the core's rows) exists.
CoverBound raisePrices(CoverCore& core, double limit, const PriceRounds& how);

/// Bounds a core by its linear program with Chvatal-Gomory cuts (V. Chvatal, Edmonds polytopes and
/// a hierarchy of combinatorial problems, 1973): rows of whole numbers that follow from sums of
/// rows. Prices and multipliers are multiples of 2^-20, so the bound holds in spite of rounding.
/// For cores of which raisePrices() leaves a gap: slower, and far stronger. Ends early once a
/// quarter of the columns are excluded. \return the bound; value 0 if the core is too large. If
/// progress says stop, that so far
CoverBound raiseByCuts(const CoverCore& core, double limit, const Progress& progress);

/// Finds columns that symmetries of the core map to each other: for each a column of its orbit, the
/// same for all of them. Misses symmetries that colours of neighbours do not lead to; reports none
/// that does not exist.
std::vector<std::uint32_t> columnOrbits(const CoverCore& core);

/// Covers all rows, cheaply: greedily, then by local search with weights of rows.
/// \pre each row has a column
/// \return columns of the core
std::vector<std::uint32_t> coverByWeights(const CoverCore& core, std::uint64_t steps,
                                          std::uint64_t seed, double enough,
                                          const Progress& progress);

}  // namespace ispace
