// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cell_distance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "raster/cell_pieces.h"

namespace ispace {

namespace {

/// Further than any distance in a grid, and its square still an int.
constexpr int kFar = 40'000;

/// Distances within columns, kFar where there is none.
std::vector<int> columnDistances(const MapCells& cells, Beyond beyond) {
    const int width = cells.width();
    const int height = cells.height();
    const int edge = beyond == Beyond::Out ? 0 : kFar;
    std::vector<int> away(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    std::vector<int> last(static_cast<std::size_t>(width), edge);
    const auto pass = [&](int y) {
        const std::span<const std::uint8_t> row = cells.row(y);
        int* out = &away[cells.index(0, y)];
        for (std::size_t x = 0; x < row.size(); ++x) {
            last[x] = row[x] == 0 ? 0 : std::min(last[x] + 1, kFar);
            out[x] = std::min(out[x], last[x]);
        }
    };
    std::fill(away.begin(), away.end(), kFar);
    for (int y = 0; y < height; ++y) pass(y);
    std::fill(last.begin(), last.end(), edge);
    for (int y = height - 1; y >= 0; --y) pass(y);
    return away;
}

/// One row: the lower envelope of a parabola over each column.
class RowEnvelope {
  public:
    explicit RowEnvelope(int width)
        : site_(static_cast<std::size_t>(width) + 2), begin_(site_.size()) {}

    /// \param away distances within the columns -1 … width, those beyond the grid included
    void run(const std::vector<std::int64_t>& away, int* out) {
        const auto n = static_cast<std::int64_t>(away.size());
        const auto value = [&](std::int64_t x, std::int64_t site) {
            const std::int64_t up = away[static_cast<std::size_t>(site)];
            return (x - site) * (x - site) + up * up;
        };
        std::size_t top = 0;
        site_[0] = begin_[0] = 0;
        for (std::int64_t x = 1; x < n; ++x) {
            bool empty = false;
            while (value(begin_[top], site_[top]) > value(begin_[top], x)) {
                if (top == 0) {
                    empty = true;
                    break;
                }
                --top;
            }
            if (empty) {
                site_[0] = x;
                continue;
            }
            // The first column that is nearer to x than to the site before.
            const std::int64_t s = site_[top];
            const std::int64_t a = away[static_cast<std::size_t>(s)];
            const std::int64_t b = away[static_cast<std::size_t>(x)];
            const std::int64_t from = 1 + (x * x - s * s + b * b - a * a) / (2 * (x - s));
            if (from >= n) continue;
            ++top;
            site_[top] = x;
            begin_[top] = from;
        }
        for (std::int64_t x = n - 2; x >= 1; --x) {
            while (top > 0 && begin_[top] > x) --top;
            out[x - 1] =
                static_cast<int>(std::min<std::int64_t>(value(x, site_[top]), kNoDistance));
        }
    }

  private:
    std::vector<std::int64_t> site_, begin_;
};

}  // namespace

std::vector<int> squaredDistances(const MapCells& cells, Beyond beyond) {
    std::vector<int> result = columnDistances(cells, beyond);
    RowEnvelope envelope(cells.width());
    std::vector<std::int64_t> away(static_cast<std::size_t>(cells.width()) + 2);
    away.front() = away.back() = beyond == Beyond::Out ? 0 : kFar;
    for (int y = 0; y < cells.height(); ++y) {
        int* row = &result[cells.index(0, y)];
        std::copy(row, row + cells.width(), away.begin() + 1);
        envelope.run(away, row);
    }
    for (int& squared : result)
        if (squared >= kFar * kFar) squared = kNoDistance;
    return result;
}

namespace {

template <typename Test>
MapCells cellsWhere(const MapCells& like, const std::vector<int>& values, Test test) {
    MapCells cells(like.width(), like.height());
    std::size_t i = 0;
    for (int y = 0; y < like.height(); ++y)
        for (int x = 0; x < like.width(); ++x, ++i)
            if (test(values[i])) cells.insert(x, y);
    return cells;
}

}  // namespace

MapCells reachedByDisc(const MapCells& cells, double radius, const std::vector<CellPlace>& from) {
    // Half a cell: the edge of the cells outside lies that much before their middles.
    const double reach = (radius + 0.5) * (radius + 0.5);
    const MapCells middles = cellsWhere(cells, squaredDistances(cells, Beyond::Out),
                                        [reach](int squared) { return squared >= reach; });
    const CellPieces pieces(middles, CellPieces::Joined::BySides);
    MapCells chosen(cells.width(), cells.height());
    const auto choose = [&](std::size_t piece) {
        pieces.forEachRun([&](const CellRun& run, std::size_t of) {
            if (of != piece) return;
            for (int x = run.first; x <= run.last; ++x) chosen.insert(x, run.row);
        });
    };
    if (from.empty() && pieces.size() > 0) {
        const auto& list = pieces.list();
        choose(static_cast<std::size_t>(
            std::max_element(list.begin(), list.end(),
                             [](const auto& a, const auto& b) { return a.cells < b.cells; }) -
            list.begin()));
    }
    const int steps = static_cast<int>(std::ceil(radius));
    for (const CellPlace place : from) {
        // The nearest middle whose disc covers the place.
        std::optional<std::size_t> nearest;
        double least = reach;
        for (int v = -steps; v <= steps; ++v)
            for (int u = -steps; u <= steps; ++u) {
                const double squared = static_cast<double>(u) * u + static_cast<double>(v) * v;
                if (squared >= least || !middles.contains(place.x + u, place.y + v)) continue;
                least = squared;
                nearest = pieces.at({place.x + u, place.y + v});
            }
        if (nearest) choose(*nearest);
    }
    return cellsWhere(cells, squaredDistances(complement(chosen), Beyond::In),
                      [reach](int squared) { return squared < reach; });
}

}  // namespace ispace
