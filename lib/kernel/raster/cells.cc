// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cells.h"

#include <algorithm>
#include <numeric>

namespace ispace {

std::size_t MapCells::count() const {
    return static_cast<std::size_t>(std::count(cells_.begin(), cells_.end(), 1));
}

MapCells difference(const MapCells& cells, const MapCells& others) {
    MapCells rest = cells;
    others.forEach([&rest](int x, int y) { rest.erase(x, y); });
    return rest;
}

MapCells complement(const MapCells& cells) {
    MapCells others(cells.width(), cells.height());
    for (int y = 0; y < cells.height(); ++y) {
        int next = 0;
        forEachRunOf(cells.row(y), [&](int first, int last) {
            if (next < first) others.insertRun(y, next, first - 1);
            next = last + 1;
        });
        if (next < cells.width()) others.insertRun(y, next, cells.width() - 1);
    }
    return others;
}

namespace {

template <typename Index>
Index rootOf(std::vector<Index>& root, Index i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
}

/// Returns the number of runs in all rows.
std::size_t countRuns(const MapCells& cells) {
    std::size_t runs = 0;
    for (int y = 0; y < cells.height(); ++y) {
        const std::span<const std::uint8_t> row = cells.row(y);
        if (row.empty()) continue;
        std::size_t begins = row[0];
        for (std::size_t x = 1; x < row.size(); ++x)
            begins += static_cast<std::size_t>(row[x] & ~row[x - 1]);
        runs += begins;
    }
    return runs;
}

}  // namespace

CellPieces::CellPieces(const MapCells& cells, Joined joined)
    : width_(cells.width()), height_(cells.height()) {
    findRuns(cells);
    std::vector<Index> root(runs_.size());
    std::iota(root.begin(), root.end(), Index{0});
    joinRows(joined, root);
    addUp(root);
}

void CellPieces::findRuns(const MapCells& cells) {
    runs_.reserve(countRuns(cells));
    row_begin_.reserve(static_cast<std::size_t>(height_) + 1);
    for (int y = 0; y < height_; ++y) {
        row_begin_.push_back(runs_.size());
        forEachRunOf(cells.row(y), [&](int first, int last) { runs_.push_back({y, first, last}); });
    }
    row_begin_.push_back(runs_.size());
}

/// Merges runs of neighbouring rows that touch; of two roots the earlier one stays.
void CellPieces::joinRows(Joined joined, std::vector<Index>& root) const {
    const int reach = joined == Joined::ByCorners ? 1 : 0;
    for (std::size_t y = 1; y + 1 < row_begin_.size(); ++y) {
        std::size_t below = row_begin_[y - 1];
        std::size_t above = row_begin_[y];
        while (below < row_begin_[y] && above < row_begin_[y + 1]) {
            const RowRun& low = runs_[below];
            const RowRun& high = runs_[above];
            if (low.first <= high.last + reach && high.first <= low.last + reach) {
                const Index a = rootOf(root, static_cast<Index>(below));
                const Index b = rootOf(root, static_cast<Index>(above));
                root[std::max(a, b)] = std::min(a, b);
            }
            (low.last < high.last ? below : above) += 1;
        }
    }
}

void CellPieces::addUp(std::vector<Index>& root) {
    piece_of_.resize(runs_.size());
    for (std::size_t i = 0; i < runs_.size(); ++i) {
        const RowRun& run = runs_[i];
        const Index r = rootOf(root, static_cast<Index>(i));
        if (r == i) {
            piece_of_[i] = static_cast<Index>(pieces_.size());
            CellPiece& fresh = pieces_.emplace_back();
            fresh.first = fresh.lowest = fresh.highest = {run.first, run.row};
        } else {
            piece_of_[i] = piece_of_[r];
        }
        CellPiece& piece = pieces_[piece_of_[i]];
        const int length = run.last - run.first + 1;
        piece.cells += static_cast<std::size_t>(length);
        piece.lowest.x = std::min(piece.lowest.x, run.first);
        piece.highest.x = std::max(piece.highest.x, run.last);
        piece.highest.y = run.row;
        const bool at_edge = run.row == 0 || run.row == height_ - 1;
        const int ends = static_cast<int>(run.first == 0) +
                         static_cast<int>(run.last == width_ - 1 && width_ > 1);
        piece.border += static_cast<std::size_t>(at_edge ? length : ends);
    }
}

std::optional<std::size_t> CellPieces::at(CellIndex place) const {
    if (place.x < 0 || place.y < 0 || place.x >= width_ || place.y >= height_) return std::nullopt;
    const std::size_t run = firstRun(place);
    if (run == row_begin_[static_cast<std::size_t>(place.y) + 1] || runs_[run].first > place.x)
        return std::nullopt;
    return piece_of_[run];
}

std::size_t CellPieces::firstRun(CellIndex place) const {
    const auto y = static_cast<std::size_t>(place.y);
    const auto begin = runs_.begin() + static_cast<std::ptrdiff_t>(row_begin_[y]);
    const auto end = runs_.begin() + static_cast<std::ptrdiff_t>(row_begin_[y + 1]);
    const auto run = std::partition_point(
        begin, end, [&place](const RowRun& run) { return run.last < place.x; });
    return static_cast<std::size_t>(run - runs_.begin());
}

double CellPieces::borderShare(std::size_t piece) const {
    const int around = width_ == 1 || height_ == 1 ? width_ * height_ : 2 * (width_ + height_) - 4;
    return static_cast<double>(pieces_[piece].border) / around;
}

MapCells CellPieces::cellsOf(std::size_t piece) const {
    MapCells cells(width_, height_);
    forEachRunOfPiece(piece,
                      [&](const RowRun& run) { cells.insertRun(run.row, run.first, run.last); });
    return cells;
}

}  // namespace ispace
