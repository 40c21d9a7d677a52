// SPDX-License-Identifier: GPL-3.0-or-later
// A set cover by rows and columns: reductions, and bounds by prices.
//
// A row is dropped if another row's columns all cover it, a column if another covers its rows for
// no more, and forced columns are taken (J. E. Beasley, An algorithm for set covering problem,
// 1987). Signatures of 64 bits exclude most pairs before their lists are compared. Prices rise by
// subgradients with memory (P. M. Camerini, L. Fratta, F. Maffioli, On improving relaxation methods
// by modified gradient techniques, 1975). They are multiples of 2^-20, and the sum of prices less
// the excess of columns is a bound for any prices: no rounding, no tolerance.
#include "arrange/search/cover_core.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace ispace {

namespace {

/// A bit for each index, wrapped: a subset has a subset of the bits.
std::uint64_t signatureOf(std::span<const std::uint32_t> set) {
    std::uint64_t bits = 0;
    for (const std::uint32_t i : set) bits |= std::uint64_t{1} << (i * 0x9e3779b1U >> 26U);
    return bits;
}

/// Lists of indices, one of which may be a subset of another.
template <typename ListOf>
std::vector<std::uint64_t> signatures(std::size_t count, ListOf list_of) {
    std::vector<std::uint64_t> bits(count);
    for (std::size_t i = 0; i < count; ++i) bits[i] = signatureOf(list_of(i));
    return bits;
}

/// \pre both ascend
bool isSubset(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
    return a.size() <= b.size() && std::includes(b.begin(), b.end(), a.begin(), a.end());
}

}  // namespace

CoverCore::CoverCore(const SetCover& problem)
    : cost(problem.costs.begin(), problem.costs.end()), price(problem.rows) {
    assert(problem.costs.size() == problem.columns.size());
    id.resize(cost.size());
    std::iota(id.begin(), id.end(), 0U);
    for (const auto& column : problem.columns) {
        rows_.insert(rows_.end(), column.begin(), column.end());
        first_.push_back(static_cast<std::uint32_t>(rows_.size()));
    }
    transpose(problem.rows);
}

void CoverCore::transpose(std::size_t rows) {
    row_first_.assign(rows + 1, 0);
    for (const std::uint32_t row : rows_) ++row_first_[row + 1];
    std::partial_sum(row_first_.begin(), row_first_.end(), row_first_.begin());
    std::vector<std::uint32_t> next(row_first_.begin(), row_first_.end() - 1);
    columns_.resize(rows_.size());
    for (std::uint32_t column = 0; column < columns(); ++column)
        for (const std::uint32_t row : rowsOf(column)) columns_[next[row]++] = column;
}

CoverCore CoverCore::without(const std::vector<char>& out, std::vector<char> closed,
                             std::span<const std::uint32_t> taken_columns) const {
    CoverCore rest;
    rest.taken = taken;
    rest.taken_cost = taken_cost;
    for (const std::uint32_t column : taken_columns) {
        rest.taken.push_back(id[column]);
        rest.taken_cost += cost[column];
        for (const std::uint32_t row : rowsOf(column)) closed[row] = 1;
    }
    std::vector<std::uint32_t> row_of(rows());
    for (std::size_t row = 0; row < rows(); ++row) {
        row_of[row] = static_cast<std::uint32_t>(rest.price.size());
        if (closed[row] == 0) rest.price.push_back(price[row]);
    }
    rest.rows_.reserve(rows_.size());
    for (std::size_t column = 0; column < columns(); ++column) {
        if (out[column] != 0) continue;
        for (const std::uint32_t row : rowsOf(column))
            if (closed[row] == 0) rest.rows_.push_back(row_of[row]);
        if (rest.rows_.size() == rest.first_.back()) continue;
        rest.first_.push_back(static_cast<std::uint32_t>(rest.rows_.size()));
        rest.cost.push_back(cost[column]);
        rest.id.push_back(id[column]);
    }
    rest.transpose(rest.price.size());
    return rest;
}

void CoverCore::reduce() {
    for (;;) {
        if (takeForced()) continue;
        const std::vector<char> rows_out = dominatedRows();
        if (std::count(rows_out.begin(), rows_out.end(), 1) > 0)
            *this = without(std::vector<char>(columns()), rows_out, {});
        const std::vector<char> out = dominatedColumns();
        if (std::count(out.begin(), out.end(), 1) == 0) return;
        *this = without(out, std::vector<char>(rows()), {});
    }
}

std::vector<CoverCore> CoverCore::components() const {
    constexpr auto kNone = static_cast<std::uint32_t>(-1);
    std::vector<std::uint32_t> part_of(rows(), kNone), part_of_column(columns(), kNone), open;
    std::uint32_t count = 0;
    for (std::uint32_t first = 0; first < rows(); ++first) {
        if (part_of[first] != kNone) continue;
        part_of[first] = count;
        open.push_back(first);
        while (!open.empty()) {
            const std::uint32_t row = open.back();
            open.pop_back();
            for (const std::uint32_t column : columnsOf(row)) {
                if (part_of_column[column] != kNone) continue;
                part_of_column[column] = count;
                for (const std::uint32_t other : rowsOf(column)) {
                    if (part_of[other] != kNone) continue;
                    part_of[other] = count;
                    open.push_back(other);
                }
            }
        }
        ++count;
    }
    std::vector<CoverCore> parts;
    for (std::uint32_t part = 0; part < count; ++part) {
        std::vector<char> out(columns()), closed(rows());
        for (std::size_t j = 0; j < columns(); ++j) out[j] = part_of_column[j] == part ? 0 : 1;
        for (std::size_t i = 0; i < rows(); ++i) closed[i] = part_of[i] == part ? 0 : 1;
        parts.push_back(without(out, std::move(closed), {}));
        parts.back().taken.clear();
        parts.back().taken_cost = 0;
    }
    return parts;
}

bool CoverCore::takeForced() {
    std::vector<std::uint32_t> forced;
    for (std::size_t row = 0; row < rows(); ++row)
        if (columnsOf(row).size() == 1) forced.push_back(columnsOf(row).front());
    if (forced.empty()) return false;
    std::sort(forced.begin(), forced.end());
    forced.erase(std::unique(forced.begin(), forced.end()), forced.end());
    *this = without(std::vector<char>(columns()), std::vector<char>(rows()), forced);
    return true;
}

/// A row is dominated by one whose columns all cover it.
std::vector<char> CoverCore::dominatedRows() const {
    std::vector<char> out(rows());
    const auto bits = signatures(rows(), [this](std::size_t row) { return columnsOf(row); });
    for (std::uint32_t row = 0; row < rows(); ++row) {
        const auto own = columnsOf(row);
        if (out[row] != 0 || own.empty()) continue;
        const std::uint32_t rarest =
            *std::min_element(own.begin(), own.end(), [this](std::uint32_t a, std::uint32_t b) {
                return rowsOf(a).size() < rowsOf(b).size();
            });
        for (const std::uint32_t other : rowsOf(rarest))
            if (other != row && out[other] == 0 && (bits[row] & ~bits[other]) == 0 &&
                isSubset(own, columnsOf(other)))
                out[other] = 1;
    }
    return out;
}

/// A column is dominated by one that covers its rows and is not dearer; one without rows by none.
std::vector<char> CoverCore::dominatedColumns() const {
    std::vector<char> out(columns());
    const auto bits = signatures(columns(), [this](std::size_t column) { return rowsOf(column); });
    for (std::uint32_t column = 0; column < columns(); ++column) {
        const auto own = rowsOf(column);
        if (own.empty()) {
            out[column] = 1;
            continue;
        }
        const std::uint32_t rarest =
            *std::min_element(own.begin(), own.end(), [this](std::uint32_t a, std::uint32_t b) {
                return columnsOf(a).size() < columnsOf(b).size();
            });
        const auto& others = columnsOf(rarest);
        const bool is_out = std::any_of(others.begin(), others.end(), [&](std::uint32_t other) {
            return other != column && out[other] == 0 && cost[other] <= cost[column] &&
                   (bits[column] & ~bits[other]) == 0 && isSubset(own, rowsOf(other));
        });
        out[column] = is_out ? 1 : 0;
    }
    return out;
}

CoverBound raisePrices(CoverCore& core, double limit, const PriceRounds& how) {
    constexpr double kUnit = 0x1p-20;
    constexpr double kMaxSum = 0x1p32;  // beyond, sums of multiples of the unit are not exact
    const std::size_t m = core.rows(), n = core.columns();
    CoverBound bound{0, std::vector<double>(n), std::vector<char>(n)};
    std::vector<double> best = core.price, price = core.price, reduced(n), direction(m);
    std::vector<int> lack(m);
    double step = 1, top = -1;
    int stalled = 0;
    double newest = 1;  // of directions from the best prices
    // Goes on from the best prices in shorter steps; returns false if these become too short.
    const auto shorten = [&] {
        step *= 0.7;
        stalled = 0;
        price = best;
        newest = 1;
        return step >= 0.005;
    };
    constexpr double kMemory = 0.1;
    for (int round = 0; round < how.rounds; ++round) {
        std::fill(lack.begin(), lack.end(), 1);
        double value = std::accumulate(price.begin(), price.end(), 0.0);
        if (value >= kMaxSum) {
            if (!shorten()) break;
            continue;
        }
        for (std::size_t j = 0; j < n; ++j) {
            double rest = core.cost[j];
            for (const std::uint32_t row : core.rowsOf(j)) rest -= price[row];
            reduced[j] = rest;
            bound.fraction[j] += kMemory * ((rest < 0 ? 1 : 0) - bound.fraction[j]);
            if (rest >= 0) continue;
            value += rest;
            for (const std::uint32_t row : core.rowsOf(j)) --lack[row];
        }
        // Columns whose price alone lifts the bound to the limit.
        for (std::size_t j = 0; j < n; ++j)
            if (reduced[j] > 0 && std::ceil(value + reduced[j]) >= limit) bound.excluded[j] = 1;
        if (value > top) {
            if (value > top + 1e-3 * std::abs(limit)) stalled = 0;
            top = value;
            best = price;
            if (std::ceil(top) >= limit) break;
        }
        if (++stalled >= how.patience) {
            if (!shorten()) break;
            continue;
        }
        double norm = 0;
        bool is_cover = true;  // of exactly this cost
        for (std::size_t i = 0; i < m; ++i) {
            direction[i] += newest * (lack[i] - direction[i]);
            if (direction[i] > 0 || price[i] > 0) norm += direction[i] * direction[i];
            is_cover = is_cover && lack[i] <= 0 && (lack[i] == 0 || price[i] == 0);
        }
        newest = how.newest;
        if (is_cover || norm == 0) break;
        const double length = step * (1.02 * limit - value) / norm;
        for (std::size_t i = 0; i < m; ++i)
            price[i] =
                std::max(0.0, std::floor((price[i] + length * direction[i]) / kUnit) * kUnit);
    }
    core.price = std::move(best);
    bound.value = std::max(top, 0.0);
    return bound;
}

}  // namespace ispace
