// SPDX-License-Identifier: GPL-3.0-or-later
// The assignment of tracks to truths that all metrics of this folder share.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace ispace::judge {

/// A matrix of doubles, row by row.
struct Matrix {
    std::size_t rows = 0, columns = 0;
    std::vector<double> values = std::vector<double>(rows * columns);

    [[nodiscard]] double& at(std::size_t row, std::size_t column) {
        return values[row * columns + column];
    }
    [[nodiscard]] double at(std::size_t row, std::size_t column) const {
        return values[row * columns + column];
    }
};

/// Matches rows with columns, each at most once and as many as there can be, so that the sum of
/// their gains is largest. Returns pairs (row, column) by row.
///
/// Shortest augmenting paths (Crouse, On implementing 2D rectangular assignment algorithms, 2016),
/// O(r^2 c) for r rows and c >= r columns. Among equal sums it chooses as SciPy's
/// linear_sum_assignment does, so that figures of metrics that depend on the choice agree with
/// programs that use it. \pre gains are finite
std::vector<std::pair<std::size_t, std::size_t>> bestAssignment(const Matrix& gains);

}  // namespace ispace::judge
