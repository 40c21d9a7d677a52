// SPDX-License-Identifier: GPL-3.0-or-later
// Orbits of columns, by colours.
//
// Columns and rows are told apart by the colours of their neighbours until colours settle (B. D.
// McKay, A. Piperno, Practical graph isomorphism II, 2014). To map one column to another, both get
// a new colour, and the first of equal colours again, without backtracking: symmetries may be
// missed, which costs time alone. A permutation counts only after costs and rows were compared, so
// that equal hashes of different colours do no harm.
#include <algorithm>
#include <numeric>

#include "arrange/search/cover_core.h"
#include "base/random.h"

namespace ispace {

namespace {

/// Colours of columns and rows: images of each other under a symmetry have equal ones.
struct CoverColors {
    std::vector<std::uint64_t> columns, rows;
    std::size_t kinds = 0;  ///< different colours of columns
};

/// Distinguishes columns and rows by the colours of their neighbours, until no more can be told
/// apart.
void refine(const CoverCore& core, CoverColors& colors) {
    std::vector<std::uint64_t> sorted;
    for (;;) {
        for (std::size_t i = 0; i < core.rows(); ++i) {
            std::uint64_t sum = 0;
            for (const std::uint32_t j : core.columnsOf(i)) sum += mixedBits(colors.columns[j]);
            colors.rows[i] = mixedBits(colors.rows[i] ^ sum);
        }
        for (std::size_t j = 0; j < core.columns(); ++j) {
            std::uint64_t sum = 0;
            for (const std::uint32_t i : core.rowsOf(j)) sum += mixedBits(colors.rows[i]);
            colors.columns[j] = mixedBits(colors.columns[j] ^ sum);
        }
        sorted = colors.columns;
        std::sort(sorted.begin(), sorted.end());
        const auto kinds =
            static_cast<std::size_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
        if (kinds == colors.kinds || kinds == core.columns()) {
            colors.kinds = kinds;
            return;
        }
        colors.kinds = kinds;
    }
}

/// Columns in the order of their colours.
std::vector<std::uint32_t> byColor(const CoverColors& colors) {
    std::vector<std::uint32_t> order(colors.columns.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return colors.columns[a] < colors.columns[b];
    });
    return order;
}

/// Orbits of columns, merged as symmetries are found.
class CoverOrbits {
  public:
    explicit CoverOrbits(const CoverCore& core) : core_(core), of_(core.columns()) {
        std::iota(of_.begin(), of_.end(), 0U);
        start_.columns.resize(core.columns());
        start_.rows.assign(core.rows(), 1);
        for (std::size_t j = 0; j < core.columns(); ++j)
            start_.columns[j] = static_cast<std::uint64_t>(core.cost[j]);
        refine(core, start_);
    }
    std::vector<std::uint32_t> run() {
        const std::vector<std::uint32_t> order = byColor(start_);
        for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
            if (start_.columns[order[i]] != start_.columns[order[first]]) first = i;
            // One column of each known orbit suffices: symmetries join the rest.
            for (std::size_t k = first; k < i && rootOf(order[i]) == order[i]; ++k)
                if (rootOf(order[k]) == order[k] && order[k] != order[i]) map(order[k], order[i]);
        }
        for (std::uint32_t j = 0; j < of_.size(); ++j) of_[j] = rootOf(j);
        return of_;
    }

  private:
    [[nodiscard]] std::uint32_t rootOf(std::uint32_t j) const {
        while (of_[j] != j) j = of_[j];
        return j;
    }
    static void mark(CoverColors& colors, std::uint32_t j) {
        colors.columns[j] = mixedBits(colors.columns[j] + 1);
    }
    /// Looks for a symmetry that maps column a to b, without backtracking.
    void map(std::uint32_t a, std::uint32_t b) {
        CoverColors from = start_, to = start_;
        for (;;) {
            mark(from, a);
            mark(to, b);
            refine(core_, from);
            refine(core_, to);
            const std::vector<std::uint32_t> left = byColor(from), right = byColor(to);
            std::size_t split = left.size();
            for (std::size_t i = 0; i < left.size(); ++i) {
                const std::uint64_t color = from.columns[left[i]];
                if (color != to.columns[right[i]]) return;
                if (split == left.size() && i + 1 < left.size() &&
                    color == from.columns[left[i + 1]])
                    split = i;
            }
            if (split == left.size()) {
                join(left, right);
                return;
            }
            a = left[split];
            b = right[split];
        }
    }
    /// Joins each column to its image, if the permutation keeps costs and rows.
    void join(const std::vector<std::uint32_t>& left, const std::vector<std::uint32_t>& right) {
        std::vector<std::uint32_t> image(left.size());
        for (std::size_t i = 0; i < left.size(); ++i) image[left[i]] = right[i];
        std::vector<std::vector<std::uint32_t>> rows, images;
        for (std::size_t i = 0; i < core_.rows(); ++i) {
            const auto row = core_.columnsOf(i);
            rows.emplace_back(row.begin(), row.end());
            auto& mapped = images.emplace_back();
            for (const std::uint32_t j : row) mapped.push_back(image[j]);
            std::sort(mapped.begin(), mapped.end());
        }
        std::sort(rows.begin(), rows.end());
        std::sort(images.begin(), images.end());
        if (rows != images) return;
        for (std::uint32_t j = 0; j < image.size(); ++j) {
            if (core_.cost[j] != core_.cost[image[j]]) return;
        }
        for (std::uint32_t j = 0; j < image.size(); ++j) {
            const std::uint32_t p = rootOf(j), q = rootOf(image[j]);
            of_[std::max(p, q)] = std::min(p, q);
        }
    }

    const CoverCore& core_;
    std::vector<std::uint32_t> of_;  // a column of the same orbit, lower or itself
    CoverColors start_;
};

}  // namespace

std::vector<std::uint32_t> columnOrbits(const CoverCore& core) { return CoverOrbits(core).run(); }

}  // namespace ispace
