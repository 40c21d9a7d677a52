// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/morphology.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace ispace {

// OpenCV has these functions, too, but linking it costs a third of each start of a program.

namespace {

/// Returns the cells with all of a square of `side` cells to the right and above in the set.
MapCells eroded(const MapCells& cells, int side) {
    MapCells result(cells.width(), cells.height());
    const auto width = static_cast<std::size_t>(cells.width());
    std::vector<std::uint8_t> across(width);
    std::vector<int> up(width);  // number of consecutive rows in `across`
    for (int y = cells.height() - 1; y >= 0; --y) {
        const std::span<const std::uint8_t> in = cells.row(y);
        int run = 0;
        for (std::size_t x = width; x-- > 0;) {
            run = in[x] != 0 ? run + 1 : 0;
            across[x] = run >= side ? 1 : 0;
        }
        std::uint8_t* const out = result.row(y).data();
        for (std::size_t x = 0; x < width; ++x) {
            up[x] = across[x] != 0 ? up[x] + 1 : 0;
            out[x] = up[x] >= side ? 1 : 0;
        }
    }
    return result;
}

/// Returns the cells with any of the set in the square of `side` cells with its upper right cell
/// `shift` columns and rows further on.
MapCells dilated(const MapCells& cells, int side, int shift) {
    MapCells result(cells.width(), cells.height());
    const int width = cells.width(), height = cells.height();
    std::vector<std::uint8_t> across(static_cast<std::size_t>(width));
    std::vector<int> left(
        across.size());  // number of further rows for which a cell of `across` counts
    for (int y = 0; y < height + shift; ++y) {
        if (y < height) {
            const std::uint8_t* const in = cells.row(y).data();
            int more = 0;
            for (int x = 0; x < width + shift; ++x) {
                more = x < width && in[x] != 0 ? side : std::max(more - 1, 0);
                if (x >= shift) across[static_cast<std::size_t>(x - shift)] = more > 0 ? 1 : 0;
            }
        } else {
            std::fill(across.begin(), across.end(), std::uint8_t{0});
        }
        for (std::size_t x = 0; x < across.size(); ++x)
            left[x] = across[x] != 0 ? side : std::max(left[x] - 1, 0);
        if (y < shift) continue;
        std::uint8_t* const out = result.row(y - shift).data();
        for (std::size_t x = 0; x < across.size(); ++x) out[x] = left[x] > 0 ? 1 : 0;
    }
    return result;
}

}  // namespace

MapCells opened(const MapCells& cells, int side) { return dilated(eroded(cells, side), side, 0); }

MapCells grown(const MapCells& cells, int reach) { return dilated(cells, 2 * reach + 1, reach); }

std::vector<CellIndex> deepestPlaces(const MapCells& cells, const CellPieces& pieces) {
    const int width = cells.width(), height = cells.height();
    // Steps to the outside, with a column on each side, and a row below and above, of zeros.
    const std::size_t n = static_cast<std::size_t>(width) + 2;
    std::vector<int> steps(n * (static_cast<std::size_t>(height) + 2));
    const auto row_of = [&](int y) { return &steps[n * (static_cast<std::size_t>(y) + 1) + 1]; };
    for (int y = 0; y < height; ++y) {
        const std::uint8_t* const is_in = cells.row(y).data();
        int* const row = row_of(y);
        const int* const below = row - n;
        for (int x = 0; x < width; ++x)
            if (is_in[x] != 0) row[x] = 1 + std::min(row[x - 1], below[x]);
    }
    for (int y = height - 1; y >= 0; --y) {
        int* const row = row_of(y);
        const int* const above = row + n;
        for (int x = width - 1; x >= 0; --x)
            row[x] = std::min(row[x], 1 + std::min(row[x + 1], above[x]));
    }
    std::vector<CellIndex> places(pieces.size());
    std::vector<int> deepest(pieces.size());
    pieces.forEachRun([&](const RowRun& run, std::size_t piece) {
        const int* const row = row_of(run.row);
        const int* const best = std::max_element(row + run.first, row + run.last + 1);
        if (*best <= deepest[piece]) return;
        deepest[piece] = *best;
        places[piece] = {static_cast<int>(best - row), run.row};
    });
    return places;
}

namespace {

/// Further than any distance in a grid, and its square still an int.
constexpr int kFar = 40'000;

/// Computes distances within columns, kFar if the column lies in the set.
std::vector<int> columnDistances(const MapCells& cells, BorderRule beyond) {
    const int width = cells.width();
    const int height = cells.height();
    const int edge = beyond == BorderRule::Out ? 0 : kFar;
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
            // Computes the first column that is nearer to x than to the site before.
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

std::vector<int> squaredDistances(const MapCells& cells, BorderRule beyond) {
    std::vector<int> result = columnDistances(cells, beyond);
    RowEnvelope envelope(cells.width());
    std::vector<std::int64_t> away(static_cast<std::size_t>(cells.width()) + 2);
    away.front() = away.back() = beyond == BorderRule::Out ? 0 : kFar;
    for (int y = 0; y < cells.height(); ++y) {
        int* row = &result[cells.index(0, y)];
        std::copy(row, row + cells.width(), away.begin() + 1);
        envelope.run(away, row);
    }
    for (int& squared : result)
        if (squared >= kFar * kFar) squared = kNoDistance;
    return result;
}

CellIndex widestPlace(const MapCells& cells) {
    const int width = cells.width(), height = cells.height();
    // Rows with a column on each side, and a row below and above: rings grow from beyond the grid.
    // They are at most half as many as the shorter side, which 16 bits hold for any picture.
    const std::size_t n = static_cast<std::size_t>(width) + 2;
    std::vector<std::uint16_t> rings(n * (static_cast<std::size_t>(height) + 2));
    const auto row_of = [&](int y) { return &rings[n * (static_cast<std::size_t>(y) + 1) + 1]; };
    // Distance transform in two passes: from below and the left, then from above and the right.
    const auto grown = [](std::uint16_t ring) { return static_cast<std::uint16_t>(ring + 1); };
    for (int y = 0; y < height; ++y) {
        const std::uint8_t* const is_in = cells.row(y).data();
        std::uint16_t* const row = row_of(y);
        const std::uint16_t* const below = row - n;
        for (int x = 0; x < width; ++x)
            if (is_in[x] != 0)
                row[x] = grown(std::min({row[x - 1], below[x - 1], below[x], below[x + 1]}));
    }
    CellIndex best;
    std::uint16_t widest = 0;
    for (int y = height - 1; y >= 0; --y) {
        std::uint16_t* const row = row_of(y);
        const std::uint16_t* const above = row + n;
        for (int x = width - 1; x >= 0; --x) {
            if (row[x] == 0) continue;
            row[x] = std::min(row[x],
                              grown(std::min({row[x + 1], above[x + 1], above[x], above[x - 1]})));
            if (row[x] < widest) continue;
            widest = row[x];
            best = {x, y};
        }
    }
    return best;
}

}  // namespace ispace
