// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef AVOID_GLOBAL_PLAN_H
#define AVOID_GLOBAL_PLAN_H

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "grid_map.h"

namespace avoid {

/// Computes the remaining way to a goal from each cell of a room, by Dijkstra's algorithm from the
/// goal. Ways near obstacles count as longer than they are, so that the shortest way keeps clear of
/// them if it can.
class GlobalPlan {
  public:
    /// \param radius of the robot, m: where its middle is nearer to things no way leads
    GlobalPlan(const GridMap& map, const Eigen::Vector2d& goal, double radius)
        : origin_(map.least()), goal_(goal) {
        const Eigen::Vector2d size = map.greatest() - map.least();
        columns_ = static_cast<int>(size.x() / kCell) + 1;
        rows_ = static_cast<int>(size.y() / kCell) + 1;
        const auto cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
        left_.assign(cells, std::numeric_limits<double>::infinity());
        std::vector<double> price(cells);
        for (int row = 0; row < rows_; ++row)
            for (int column = 0; column < columns_; ++column)
                price[index(column, row)] = priceOf(map.clearance(place(column, row)) - radius);
        spread(price);
    }

    /// Remaining way from here; infinite if no way leads to the goal.
    double left(const Eigen::Vector2d& from) const {
        double least = std::numeric_limits<double>::infinity();
        const Eigen::Vector2d cells = (from - origin_) / kCell;
        const int column = static_cast<int>(std::floor(cells.x()));
        const int row = static_cast<int>(std::floor(cells.y()));
        for (int r = row; r <= row + 1; ++r)
            for (int c = column; c <= column + 1; ++c)
                if (isInside(c, r))
                    least = std::min(least, left_[index(c, r)] + (place(c, r) - from).norm());
        return least;
    }

    /// Returns the way from here to the goal; empty without one.
    std::vector<Eigen::Vector2d> way(const Eigen::Vector2d& from) const {
        std::vector<Eigen::Vector2d> places;
        std::pair<int, int> at = nearestOpen(from);
        if (at.first < 0) return places;
        for (;;) {
            places.push_back(place(at.first, at.second));
            std::pair<int, int> best = at;
            for (int r = at.second - 1; r <= at.second + 1; ++r)
                for (int c = at.first - 1; c <= at.first + 1; ++c)
                    if (isInside(c, r) &&
                        left_[index(c, r)] < left_[index(best.first, best.second)])
                        best = {c, r};
            if (best == at) break;
            at = best;
        }
        places.push_back(goal_);
        return places;
    }

  private:
    static constexpr double kCell = 0.05;     // m
    static constexpr double kComfort = 0.25;  // m beyond the robot's radius without cost
    static constexpr double kCost = 4;        // times as long, without clearance

    static double priceOf(double room) {
        if (room <= 0) return std::numeric_limits<double>::infinity();
        return 1 + kCost * std::max(0.0, 1 - room / kComfort);
    }

    void spread(const std::vector<double>& price) {
        using Entry = std::pair<double, std::size_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        const Eigen::Vector2d cells = (goal_ - origin_) / kCell;
        const int column = static_cast<int>(std::lround(cells.x()));
        const int row = static_cast<int>(std::lround(cells.y()));
        if (!isInside(column, row)) return;
        left_[index(column, row)] = 0;
        queue.push({0, index(column, row)});
        while (!queue.empty()) {
            const Entry entry = queue.top();
            queue.pop();
            if (entry.first > left_[entry.second]) continue;
            const int c = static_cast<int>(entry.second) % columns_;
            const int r = static_cast<int>(entry.second) / columns_;
            for (int to_r = r - 1; to_r <= r + 1; ++to_r)
                for (int to_c = c - 1; to_c <= c + 1; ++to_c) {
                    if (!isInside(to_c, to_r)) continue;
                    const std::size_t to = index(to_c, to_r);
                    const double cost =
                        entry.first + kCell * std::hypot(to_c - c, to_r - r) * price[to];
                    if (!(cost < left_[to])) continue;
                    left_[to] = cost;
                    queue.push({cost, to});
                }
        }
    }

    /// The cell to begin at: a robot may stand a little nearer to things than it would go.
    std::pair<int, int> nearestOpen(const Eigen::Vector2d& from) const {
        constexpr int kReach = 6;
        const Eigen::Vector2d cells = (from - origin_) / kCell;
        const int column = static_cast<int>(std::lround(cells.x()));
        const int row = static_cast<int>(std::lround(cells.y()));
        std::pair<int, int> best{-1, -1};
        double nearest = std::numeric_limits<double>::infinity();
        for (int r = row - kReach; r <= row + kReach; ++r)
            for (int c = column - kReach; c <= column + kReach; ++c) {
                if (!isInside(c, r) || !std::isfinite(left_[index(c, r)])) continue;
                const double away = (place(c, r) - from).norm();
                if (away < nearest) nearest = away, best = {c, r};
            }
        return best;
    }

    bool isInside(int column, int row) const {
        return column >= 0 && row >= 0 && column < columns_ && row < rows_;
    }
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    }
    Eigen::Vector2d place(int column, int row) const {
        return origin_ + kCell * Eigen::Vector2d(column, row);
    }

    Eigen::Vector2d origin_, goal_;
    int columns_ = 0, rows_ = 0;
    std::vector<double> left_;
};

}  // namespace avoid

#endif  // AVOID_GLOBAL_PLAN_H
