// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "base/number.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// Finds the first i in [begin, end) that is not `before`, else end; `guess` is mostly right.
template <typename Before>
int firstNot(int begin, int end, double guess, Before before) {
    if (guess >= begin && guess <= end) {
        const auto i = static_cast<int>(guess);
        if ((i == begin || before(i - 1)) && (i == end || !before(i))) return i;
    }
    while (begin < end) {
        const int middle = begin + (end - begin) / 2;
        if (before(middle))
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
}

/// Computes in bit i the parity of the bits from i on.
std::uint64_t parityFrom(std::uint64_t bits) {
    for (const int shift : {1, 2, 4, 8, 16, 32}) bits ^= bits >> shift;
    return bits;
}

/// Clamps to [low, high]; returns low for NaN.
double held(double value, double low, double high) { return std::max(low, std::min(value, high)); }

/// Converts to a whole number within [low, high], also from far beyond.
int clampedInt(double value, int low, int high) {
    return static_cast<int>(std::clamp(value, 1.0 * low, 1.0 * high));
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

double Grid::columnCenter(int column) const {
    return limits.low.x + limits.width() * ((column + 0.5) / columns);
}

double Grid::rowCenter(int row) const {
    return limits.low.y + limits.depth() * ((row + 0.5) / rows);
}

Point2 Grid::center(std::size_t cell) const {
    const auto across = static_cast<std::size_t>(columns);
    return {columnCenter(static_cast<int>(cell % across)),
            rowCenter(static_cast<int>(cell / across))};
}

Point2 Grid::toCells(Point2 p) const {
    return {GridAxis::columnsOf(*this).position(p.x), GridAxis::rowsOf(*this).position(p.y)};
}

double Grid::cellArea() const {
    return limits.width() * limits.depth() / static_cast<double>(size());
}

Grid gridOf(Point2 low, double size, int columns, int rows) {
    return {{low, low + size * Vec2{static_cast<double>(columns), static_cast<double>(rows)}},
            columns,
            rows};
}

std::string cellsText(const Grid& grid) {
    constexpr int kDigits = 3;
    const std::string x =
        formatDouble(roundSignificant(grid.limits.width() / grid.columns, kDigits));
    const std::string y = formatDouble(roundSignificant(grid.limits.depth() / grid.rows, kDigits));
    return std::to_string(grid.columns) + " x " + std::to_string(grid.rows) + " cells of " + x +
           " m" + (x == y ? "" : " x " + y + " m");
}

double GridAxis::slack(double size) const {
    // Some roundings of the coordinates, and some of the result.
    constexpr double kRoundings = 32 * std::numeric_limits<double>::epsilon();
    const double coordinates = size + std::abs(low) + std::abs(low + extent);
    return kRoundings * (coordinates * perMetre() + count);
}

int GridAxis::firstNotBelow(double value, int begin) const {
    const double guess = held(std::ceil(position(value)), begin, count);
    return firstNot(begin, count, guess, [&](int i) { return center(i) < value; });
}

int GridAxis::firstAbove(double value, int begin) const {
    const double guess = held(std::floor(position(value)) + 1, begin, count);
    return firstNot(begin, count, guess, [&](int i) { return center(i) <= value; });
}

void Scanline::reset(const Grid& grid, const Box2& box) {
    grid_ = grid;
    x_axis_ = GridAxis::columnsOf(grid);
    y_axis_ = GridAxis::rowsOf(grid);
    columns_per_metre_ = x_axis_.perMetre();
    slack_ = x_axis_.slack(0);
    first_column_ = last_column_ = first_row_ = last_row_ = 0;
    if (!box.empty()) {
        first_column_ = x_axis_.firstNotBelow(box.low.x);
        last_column_ = x_axis_.firstAbove(box.high.x, first_column_);
        first_row_ = y_axis_.firstNotBelow(box.low.y);
        last_row_ = y_axis_.firstAbove(box.high.y, first_row_);
    }
    y_.resize(static_cast<std::size_t>(rows()));
    for (int row = 0; row < rows(); ++row)
        y_[static_cast<std::size_t>(row)] = y_axis_.center(first_row_ + row);
    const std::size_t words = static_cast<std::size_t>(rows()) * wordsPerRow();
    flips_.assign(words, 0);
    edges_.assign(words, 0);
}

/// Relative to the first row of the window, as all rows and columns from here on.
int Scanline::firstRowFrom(double y) const {
    const double guess = held(std::ceil(y_axis_.position(y)) - first_row_, 0, rows());
    return firstNot(0, rows(), guess,
                    [&](int row) { return y_[static_cast<std::size_t>(row)] < y; });
}

void Scanline::add(const Segment2& edge) {
    if (flips_.empty()) return;
    const bool upward = edge.a.y <= edge.b.y;
    const Point2 low = upward ? edge.a : edge.b, high = upward ? edge.b : edge.a;
    if (!(low.y <= y_.back()) || !(high.y >= y_.front())) return;
    const int row = firstRowFrom(low.y);
    if (!(y_[static_cast<std::size_t>(row)] <= high.y)) return;
    if (low.y == high.y)
        addLevel(edge, row);
    else
        addSloped(low, high, row);
}

/// \param column relative to the first of the window
void Scanline::mark(std::vector<std::uint64_t>& rows, int column, int row, bool toggle) {
    std::uint64_t& word =
        rows[static_cast<std::size_t>(row) * wordsPerRow() + static_cast<std::size_t>(column) / 64];
    const std::uint64_t bit = std::uint64_t{1} << (static_cast<unsigned>(column) % 64);
    word = toggle ? word ^ bit : word | bit;
}

void Scanline::addLevel(const Segment2& edge, int row) {
    const double left = std::min(edge.a.x, edge.b.x), right = std::max(edge.a.x, edge.b.x);
    const double y = y_[static_cast<std::size_t>(row)];
    int column = std::min(x_axis_.firstNotBelow(left, first_column_), last_column_);
    const int end = std::min(x_axis_.firstAbove(right, column), last_column_);
    // Several rows may have the same middle if coordinates are too large for the cells.
    for (; row < rows() && y_[static_cast<std::size_t>(row)] == y; ++row)
        for (int i = column; i < end; ++i) mark(edges_, i - first_column_, row, false);
}

/// Adds a rising edge, from the first row with a middle not below it.
void Scanline::addSloped(Point2 low, Point2 high, int row) {
    const double slope = columns_per_metre_ * ((high.x - low.x) / (high.y - low.y));
    const double foot = x_axis_.position(low.x) - first_column_;
    double slack = slack_ + 32 * std::numeric_limits<double>::epsilon() * columns_per_metre_ *
                                (std::abs(low.x) + std::abs(high.x));
    if (!std::isfinite(slope)) slack = 1;  // every column is uncertain
    const int count = rows(), columns = last_column_ - first_column_;
    const std::size_t words = wordsPerRow();
    for (; row < count && y_[static_cast<std::size_t>(row)] <= high.y; ++row) {
        const double y = y_[static_cast<std::size_t>(row)];
        // Computes the first column that is not to the left of the upward edge, and its distance
        // beyond.
        const double next = held(foot + slope * (y - low.y), -0.5, columns - 0.5) + 1;
        auto column = static_cast<int>(next);
        const double rest = next - column;
        if (!(rest > slack && rest < 1 - slack)) column = settle(low, high, row, column);
        // An edge owns its lower end only, so that a vertex between two edges flips once or twice.
        if (column == 0 || !(y < high.y)) continue;
        const auto last = static_cast<std::size_t>(column - 1);
        flips_[static_cast<std::size_t>(row) * words + last / 64] ^= std::uint64_t{1}
                                                                     << (last % 64);
    }
}

/// Finds the first column that is not to the left of the upward edge; marks those on it.
int Scanline::settle(Point2 low, Point2 high, int row, int guess) {
    const double y = y_[static_cast<std::size_t>(row)];
    const int columns = last_column_ - first_column_;
    const auto turn = [&](int column) {
        return orientation(low, high, {x_axis_.center(first_column_ + column), y});
    };
    int column = std::clamp(guess, 0, columns);
    while (column > 0 && turn(column - 1) != Turn::Left) --column;
    while (column < columns && turn(column) == Turn::Left) ++column;
    for (int i = column; i < columns && turn(i) == Turn::Straight; ++i) mark(edges_, i, row, false);
    return column;
}

/// Calls visit(row, word of the row, its bits).
template <typename Visit>
void Scanline::forEachWord(bool closed, Visit visit) const {
    const std::size_t words = wordsPerRow();
    for (int row = 0; row < rows(); ++row) {
        const std::size_t begin = static_cast<std::size_t>(row) * words;
        std::uint64_t beyond = 0;  // all ones if the words to the right have odd parity
        for (std::size_t i = words; i-- > 0;) {
            const std::uint64_t parity = parityFrom(flips_[begin + i]);
            std::uint64_t inside = parity ^ beyond;
            if ((parity & 1U) != 0) beyond = ~beyond;
            inside = closed ? inside | edges_[begin + i] : inside & ~edges_[begin + i];
            // Bits beyond the window have no flips to their right: only `beyond` could set them,
            // and in the last word it is 0.
            visit(row, i, inside);
        }
    }
}

void Scanline::finish(CellSet& cells, bool closed) const {
    forEachWord(closed, [&](int row, std::size_t i, std::uint64_t inside) {
        cells.addBits(grid_.cell(first_column_, first_row_ + row) + 64 * i, inside);
    });
}

void Scanline::takeInside(std::vector<std::uint64_t>& words) const {
    words.resize(flips_.size());
    forEachWord(false, [&](int row, std::size_t i, std::uint64_t inside) {
        words[static_cast<std::size_t>(row) * wordsPerRow() + i] = inside;
    });
}

void Scanline::removeClosed(std::vector<std::uint64_t>& words) const {
    forEachWord(true, [&](int row, std::size_t i, std::uint64_t inside) {
        words[static_cast<std::size_t>(row) * wordsPerRow() + i] &= ~inside;
    });
}

namespace {

Scanline scanOf(const Grid& grid, std::span<const Polygon> curves) {
    Scanline scan(grid, bounds(curves));
    for (const Polygon& curve : curves)
        forEachEdge(curve, [&scan](const Segment2& edge) { scan.add(edge); });
    return scan;
}

}  // namespace

CellSet cellsIn(const Grid& grid, const Regions& regions) {
    CellSet inside(grid.size());
    for (const Region& part : regions.parts) {
        Scanline scan(grid, bounds(part.outline));
        part.forEachEdge([&scan](const Segment2& edge) { scan.add(edge); });
        scan.addInside(inside);
    }
    return inside;
}

CellSet cellsWithin(const Grid& grid, std::span<const Polygon> curves) {
    CellSet inside(grid.size());
    scanOf(grid, curves).addInside(inside);
    return inside;
}

std::vector<RowRun> runsWithin(const Grid& grid, std::span<const Polygon> curves) {
    const Scanline scan = scanOf(grid, curves);
    std::vector<std::uint64_t> words;
    scan.takeInside(words);
    std::vector<RowRun> runs;
    for (int row = 0; row < scan.rows(); ++row) {
        const auto bits = std::span(words).subspan(
            static_cast<std::size_t>(row) * scan.wordsPerRow(), scan.wordsPerRow());
        // Finds the first column at or after one with a bit other than `flip`.
        const auto next = [&](int column, std::uint64_t flip) {
            while (column < scan.columns()) {
                const auto i = static_cast<std::size_t>(column);
                if (const std::uint64_t rest = (bits[i / 64] ^ flip) >> (i % 64); rest != 0)
                    return std::min(column + std::countr_zero(rest), scan.columns());
                column = (column / 64 + 1) * 64;
            }
            return scan.columns();
        };
        for (int first = next(0, 0); first < scan.columns();) {
            const int end = next(first, ~std::uint64_t{0});
            runs.push_back(
                {scan.firstRow() + row, scan.firstColumn() + first, scan.firstColumn() + end - 1});
            first = next(end, 0);
        }
    }
    return runs;
}

CellSet cellsBlocked(const Grid& grid, std::span<const Polygon> solids) {
    CellSet blocked(grid.size());
    for (const Polygon& solid : solids) {
        Scanline scan(grid, bounds(solid));
        forEachEdge(solid, [&scan](const Segment2& edge) { scan.add(edge); });
        scan.addClosed(blocked);
    }
    return blocked;
}

void appendCrossings(const Segment2& segment, const Grid& grid, std::vector<CellPair>& pairs) {
    const Point2 a = grid.toCells(segment.a), b = grid.toCells(segment.b);
    // Finds where the segment crosses the lines through middles: the cells below and above it
    // there.
    const auto split = [](double value) {
        const double below = std::floor(value);
        const auto low = static_cast<std::int64_t>(below);
        if (value == below) return std::pair{low, low};
        return value - below <= 0.5 ? std::pair{low, low + 1} : std::pair{low + 1, low};
    };
    if (a.x != b.x) {
        const Whole columns = wholeBetween(a.x, b.x, grid.columns);
        for (int column = columns.first; column <= columns.last; ++column) {
            const auto [near, far] = split(a.y + (column - a.x) * ((b.y - a.y) / (b.x - a.x)));
            pairs.push_back({column, near, column, far});
        }
    }
    if (a.y != b.y) {
        const Whole rows = wholeBetween(a.y, b.y, grid.rows);
        for (int row = rows.first; row <= rows.last; ++row) {
            const auto [near, far] = split(a.x + (row - a.y) * ((b.x - a.x) / (b.y - a.y)));
            pairs.push_back({near, row, far, row});
        }
    }
}

}  // namespace ispace
