// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cell_raster.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace ispace {

namespace {

/// An edge that goes upwards, in cells, with the rows whose middles it passes; its upper end is not
/// part of it, so that a corner counts once.
struct Edge {
    int first_row, last_row;
    double x, y;   // a point of it
    double slope;  // columns a row

    [[nodiscard]] double at(int row) const { return x + (row - y) * slope; }
};

/// To a whole number within [low, high], also from far beyond.
int clampedInt(double value, int low, int high) {
    return static_cast<int>(std::clamp(value, 1.0 * low, 1.0 * high));
}

std::vector<Edge> upwardEdges(std::span<const Polygon> curves, const CellFrame& frame) {
    std::vector<Edge> edges;
    for (const Polygon& curve : curves) {
        forEachEdge(curve, [&](const Segment2& edge) {
            Point2 a = frame.toCells(edge.a), b = frame.toCells(edge.b);
            if (a.y > b.y) std::swap(a, b);
            const int first = clampedInt(std::ceil(a.y), 0, frame.rows);
            const int last = clampedInt(std::ceil(b.y) - 1, -1, frame.rows - 1);
            if (first <= last) edges.push_back({first, last, a.x, a.y, (b.x - a.x) / (b.y - a.y)});
        });
    }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return a.first_row < b.first_row; });
    return edges;
}

/// Whole numbers from `a` to `b`, ends included, within [0, count): the first and the last.
struct Whole {
    int first, last;
};
Whole wholeBetween(double a, double b, int count) {
    return {clampedInt(std::ceil(std::min(a, b)), 0, count),
            clampedInt(std::floor(std::max(a, b)), -1, count - 1)};
}

}  // namespace

std::vector<CellRun> insideRuns(std::span<const Polygon> curves, const CellFrame& frame) {
    const std::vector<Edge> edges = upwardEdges(curves, frame);
    std::vector<CellRun> runs;
    std::vector<Edge> active;
    std::vector<double> crossings;
    auto next = edges.begin();
    for (int row = edges.empty() ? frame.rows : edges.front().first_row; row < frame.rows; ++row) {
        while (next != edges.end() && next->first_row == row) active.push_back(*next++);
        std::erase_if(active, [row](const Edge& edge) { return edge.last_row < row; });
        if (active.empty() && next == edges.end()) break;
        crossings.clear();
        for (const Edge& edge : active) crossings.push_back(edge.at(row));
        std::sort(crossings.begin(), crossings.end());
        for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
            const Whole cells = wholeBetween(crossings[i], crossings[i + 1], frame.columns);
            if (cells.first <= cells.last) runs.push_back({row, cells.first, cells.last});
        }
    }
    return runs;
}

void appendCrossings(const Segment2& segment, const CellFrame& frame,
                     std::vector<CellPair>& pairs) {
    const Point2 a = frame.toCells(segment.a), b = frame.toCells(segment.b);
    // Where the segment passes the lines through middles: the cells below and above it there.
    const auto split = [](double value) {
        const double below = std::floor(value);
        const auto low = static_cast<std::int64_t>(below);
        if (value == below) return std::pair{low, low};
        return value - below <= 0.5 ? std::pair{low, low + 1} : std::pair{low + 1, low};
    };
    if (a.x != b.x) {
        const Whole columns = wholeBetween(a.x, b.x, frame.columns);
        for (int column = columns.first; column <= columns.last; ++column) {
            const auto [near, far] = split(a.y + (column - a.x) * ((b.y - a.y) / (b.x - a.x)));
            pairs.push_back({column, near, column, far});
        }
    }
    if (a.y != b.y) {
        const Whole rows = wholeBetween(a.y, b.y, frame.rows);
        for (int row = rows.first; row <= rows.last; ++row) {
            const auto [near, far] = split(a.x + (row - a.y) * ((b.x - a.x) / (b.y - a.y)));
            pairs.push_back({near, row, far, row});
        }
    }
}

}  // namespace ispace
