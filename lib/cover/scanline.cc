// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/scanline.h"

#include <algorithm>

#include "geom/predicates.h"

namespace ispace {

namespace {

/// First i in [begin, end) for which at(i) is not below value (or is above), else end; at never
/// decreases.
template <typename At>
int lowerBound(int begin, int end, At at, double value) {
    while (begin < end) {
        const int middle = begin + (end - begin) / 2;
        if (at(middle) < value)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
}
template <typename At>
int upperBound(int begin, int end, At at, double value) {
    while (begin < end) {
        const int middle = begin + (end - begin) / 2;
        if (at(middle) <= value)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
}

/// Bit i: parity of the bits from i on.
std::uint64_t parityFrom(std::uint64_t bits) {
    for (const int shift : {1, 2, 4, 8, 16, 32}) bits ^= bits >> shift;
    return bits;
}

}  // namespace

Scanline::Scanline(const Grid& grid, const Box2& box) : grid_(grid) {
    if (box.empty()) return;
    const auto x = [&grid](int column) { return grid.columnCenter(column); };
    const auto y = [&grid](int row) { return grid.rowCenter(row); };
    first_column_ = lowerBound(0, grid.columns, x, box.low.x);
    last_column_ = upperBound(first_column_, grid.columns, x, box.high.x);
    first_row_ = lowerBound(0, grid.rows, y, box.low.y);
    last_row_ = upperBound(first_row_, grid.rows, y, box.high.y);
    x_.reserve(static_cast<std::size_t>(last_column_ - first_column_));
    for (int column = first_column_; column < last_column_; ++column) x_.push_back(x(column));
    flips_.resize(static_cast<std::size_t>(last_row_ - first_row_) * wordsPerRow());
    edges_.resize(flips_.size());
}

void Scanline::add(const Segment2& edge) {
    if (flips_.empty()) return;
    const bool upward = edge.a.y <= edge.b.y;
    const Point2 low = upward ? edge.a : edge.b, high = upward ? edge.b : edge.a;
    const auto y = [this](int row) { return grid_.rowCenter(row); };
    const int end = upperBound(first_row_, last_row_, y, high.y);
    for (int row = lowerBound(first_row_, last_row_, y, low.y); row < end; ++row) {
        if (low.y == high.y)
            addLevel(edge, row);
        else
            addToRow(low, high, row);
    }
}

/// \param column counted from the first of the window
void Scanline::mark(std::vector<std::uint64_t>& rows, int column, int row, bool toggle) {
    std::uint64_t& word = rows[static_cast<std::size_t>(row - first_row_) * wordsPerRow() +
                               static_cast<std::size_t>(column) / 64];
    const std::uint64_t bit = std::uint64_t{1} << (static_cast<unsigned>(column) % 64);
    word = toggle ? word ^ bit : word | bit;
}

void Scanline::addLevel(const Segment2& edge, int row) {
    const double left = std::min(edge.a.x, edge.b.x), right = std::max(edge.a.x, edge.b.x);
    const auto first = std::lower_bound(x_.begin(), x_.end(), left);
    const auto last = std::upper_bound(first, x_.end(), right);
    for (auto x = first; x != last; ++x) mark(edges_, static_cast<int>(x - x_.begin()), row, false);
}

void Scanline::addToRow(Point2 low, Point2 high, int row) {
    const double y = grid_.rowCenter(row);
    const auto columns = static_cast<int>(x_.size());
    const auto turn = [&](int column) {
        return orientation(low, high, {x_[static_cast<std::size_t>(column)], y});
    };
    const double guess = low.x + (high.x - low.x) * ((y - low.y) / (high.y - low.y));
    // The first column that is not to the left of the upward edge.
    auto column = static_cast<int>(std::lower_bound(x_.begin(), x_.end(), guess) - x_.begin());
    while (column > 0 && turn(column - 1) != Turn::Left) --column;
    while (column < columns && turn(column) == Turn::Left) ++column;
    // An edge owns its lower end only, so that a vertex between two edges flips once or twice.
    if (y < high.y && column > 0) mark(flips_, column - 1, row, true);
    for (; column < columns && turn(column) == Turn::Straight; ++column)
        mark(edges_, column, row, false);
}

void Scanline::finish(CellSet& cells, bool closed) const {
    const std::size_t words = wordsPerRow();
    for (int row = first_row_; row < last_row_; ++row) {
        const std::size_t begin = static_cast<std::size_t>(row - first_row_) * words;
        std::uint64_t beyond = 0;  // all ones if the words to the right have odd parity
        for (std::size_t i = words; i-- > 0;) {
            const std::uint64_t parity = parityFrom(flips_[begin + i]);
            std::uint64_t inside = parity ^ beyond;
            if ((parity & 1U) != 0) beyond = ~beyond;
            inside = closed ? inside | edges_[begin + i] : inside & ~edges_[begin + i];
            // Bits beyond the window have no flips to their right: only `beyond` could set them,
            // and the last word has none.
            cells.addBits(grid_.cell(first_column_, row) + 64 * i, inside);
        }
    }
}

}  // namespace ispace
