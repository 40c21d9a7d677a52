// SPDX-License-Identifier: GPL-3.0-or-later
// Rows are added one by one; each addition is a search for the shortest augmenting path with
// reduced costs (Dijkstra over columns), and prices keep matched pairs tight: reduced costs of rows
// that are in stay at or above 0, whatever the sign of the costs. Costs are the gains with a minus;
// a tall matrix is transposed. The scan order of the columns and the preference for free ones
// decide among equal sums, exactly as in SciPy.
#include "extensions/judge/assignment.h"

#include <algorithm>
#include <limits>

namespace ispace::judge {

namespace {

constexpr auto kNone = std::numeric_limits<std::size_t>::max();

/// The matching of the first rows, grown by a row at a time. There are at least as many columns as
/// rows.
class Matching {
  public:
    explicit Matching(const Matrix& costs)
        : costs_(costs),
          row_price_(costs.rows),
          column_price_(costs.columns),
          column_of_(costs.rows, kNone),
          row_of_(costs.columns, kNone),
          path_(costs.columns, kNone),
          shortest_(costs.columns) {}

    void add(std::size_t row) {
        const std::size_t sink = findPath(row);
        for (std::size_t column = sink;;) {
            const std::size_t from = path_[column];
            row_of_[column] = from;
            std::swap(column_of_[from], column);
            if (from == row) return;
        }
    }
    [[nodiscard]] const std::vector<std::size_t>& columnOf() const { return column_of_; }

  private:
    /// Finds the cheapest alternating path from a free row to a free column, and moves the prices
    /// so that matched pairs stay tight. \return the column
    std::size_t findPath(std::size_t start) {
        std::vector<bool> row_seen(costs_.rows), column_seen(costs_.columns);
        std::vector<std::size_t> open(costs_.columns);
        // From the last: equal costs then match row i with column i.
        for (std::size_t i = 0; i < open.size(); ++i) open[i] = open.size() - i - 1;
        std::fill(shortest_.begin(), shortest_.end(), std::numeric_limits<double>::infinity());
        double length = 0;
        std::size_t row = start, sink = kNone;
        while (sink == kNone) {
            row_seen[row] = true;
            std::size_t best = kNone;
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < open.size(); ++i) {
                const std::size_t column = open[i];
                const double way =
                    length + costs_.at(row, column) - row_price_[row] - column_price_[column];
                if (way < shortest_[column]) {
                    path_[column] = row;
                    shortest_[column] = way;
                }
                if (shortest_[column] < least ||
                    (shortest_[column] == least && row_of_[column] == kNone)) {
                    least = shortest_[column];
                    best = i;
                }
            }
            length = least;
            const std::size_t column = open[best];
            if (row_of_[column] == kNone)
                sink = column;
            else
                row = row_of_[column];
            column_seen[column] = true;
            open[best] = open.back();
            open.pop_back();
        }
        row_price_[start] += length;
        for (std::size_t i = 0; i < costs_.rows; ++i)
            if (row_seen[i] && i != start) row_price_[i] += length - shortest_[column_of_[i]];
        for (std::size_t j = 0; j < costs_.columns; ++j)
            if (column_seen[j]) column_price_[j] -= length - shortest_[j];
        return sink;
    }

    const Matrix& costs_;
    std::vector<double> row_price_, column_price_;
    std::vector<std::size_t> column_of_, row_of_, path_;
    std::vector<double> shortest_;
};

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> bestAssignment(const Matrix& gains) {
    if (gains.rows == 0 || gains.columns == 0) return {};
    const bool is_tall = gains.columns < gains.rows;
    Matrix costs{std::min(gains.rows, gains.columns), std::max(gains.rows, gains.columns)};
    for (std::size_t row = 0; row < gains.rows; ++row)
        for (std::size_t column = 0; column < gains.columns; ++column)
            (is_tall ? costs.at(column, row) : costs.at(row, column)) = -gains.at(row, column);
    Matching matching(costs);
    for (std::size_t row = 0; row < costs.rows; ++row) matching.add(row);
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t row = 0; row < costs.rows; ++row) {
        const std::size_t column = matching.columnOf()[row];
        pairs.emplace_back(is_tall ? column : row, is_tall ? row : column);
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace ispace::judge
