// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef TRACKER_ASSIGNMENT_H
#define TRACKER_ASSIGNMENT_H

#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace tracker {

/// Assigns each row a different column so that the sum of the costs is least: the Hungarian method,
/// as the shortest augmenting paths of Jonker and Volgenant (Computing 38, 1987), in O(rows²
/// columns).
/// \param cost with at least as many columns as rows
/// \return the column of each row
inline std::vector<int> assign(const Eigen::MatrixXd& cost) {
    const auto rows = static_cast<int>(cost.rows()), columns = static_cast<int>(cost.cols());
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    // Rows and columns from 1 on; 0 is where a path begins.
    Eigen::VectorXd row_price = Eigen::VectorXd::Zero(rows + 1);
    Eigen::VectorXd column_price = Eigen::VectorXd::Zero(columns + 1);
    Eigen::VectorXi row_of = Eigen::VectorXi::Zero(columns + 1);
    Eigen::VectorXi before = Eigen::VectorXi::Zero(columns + 1);
    for (int row = 1; row <= rows; ++row) {
        row_of[0] = row;
        Eigen::VectorXd least = Eigen::VectorXd::Constant(columns + 1, kInfinity);
        std::vector<bool> done(static_cast<std::size_t>(columns) + 1, false);
        int at = 0;
        do {
            done[static_cast<std::size_t>(at)] = true;
            const int from = row_of[at];
            double delta = kInfinity;
            int next = 0;
            for (int column = 1; column <= columns; ++column) {
                if (done[static_cast<std::size_t>(column)]) continue;
                const double reduced =
                    cost(from - 1, column - 1) - row_price[from] - column_price[column];
                if (reduced < least[column]) least[column] = reduced, before[column] = at;
                if (least[column] < delta) delta = least[column], next = column;
            }
            for (int column = 0; column <= columns; ++column) {
                if (done[static_cast<std::size_t>(column)]) {
                    row_price[row_of[column]] += delta;
                    column_price[column] -= delta;
                } else {
                    least[column] -= delta;
                }
            }
            at = next;
        } while (row_of[at] != 0);
        for (; at != 0; at = before[at]) row_of[at] = row_of[before[at]];
    }
    std::vector<int> column_of(static_cast<std::size_t>(rows), -1);
    for (int column = 1; column <= columns; ++column)
        if (row_of[column] != 0)
            column_of[static_cast<std::size_t>(row_of[column] - 1)] = column - 1;
    return column_of;
}

}  // namespace tracker

#endif  // TRACKER_ASSIGNMENT_H
