// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of set covers by linear programs with cuts.
//
// The dual simplex of GLPK solves the program; each basic variable that is not whole yields a row
// of the basis' inverse, whose fractions are multipliers of a Chvatal-Gomory cut (R. E. Gomory,
// Outline of an algorithm for integer solutions to linear programs, 1958). Multipliers and prices
// are rounded down to multiples of 2^-20, and cuts and bounds are computed anew from these: errors
// of the simplex method make a bound weaker, never wrong.
#include <glpk.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "arrange/search/cover_core.h"

namespace ispace {

namespace {

constexpr double kPriceUnit = 0x1p-20;  // sums of prices times coefficients are exact

/// A row of whole numbers that each cover of the core satisfies.
struct CoverCut {
    std::vector<std::uint32_t> columns;  // ascending
    std::vector<double> coefficients;    // of these, positive
    double least = 1;                    // of the sum
};

/// The covering rows and cuts of a core as a linear program.
class CutProgram {
  public:
    explicit CutProgram(const CoverCore& core);

    /// Solves the program. \return false if the simplex method failed, or progress says stop
    [[nodiscard]] bool solve(const Progress& progress);
    /// Computes the bound of the prices, with columns that no cover below the limit takes.
    [[nodiscard]] CoverBound bound(double limit) const;
    /// Adds cuts that the solution violates. \return their number
    std::size_t addCuts();

  private:
    void add(CoverCut cut);
    /// Returns the cut of row multipliers, which are at least 0: coefficients and the least sum are
    /// rounded up to whole numbers (Chvatal 1973).
    [[nodiscard]] CoverCut combined(const std::vector<std::pair<std::size_t, double>>& rows) const;

    struct Deleter {
        void operator()(glp_prob* program) const {
            glp_delete_prob(program);
            glp_free_env();  // of this thread
        }
    };
    const CoverCore& core_;
    std::vector<CoverCut> rows_;
    std::unique_ptr<glp_prob, Deleter> program_{glp_create_prob()};
};

CutProgram::CutProgram(const CoverCore& core) : core_(core) {
    glp_term_out(GLP_OFF);
    glp_set_obj_dir(program_.get(), GLP_MIN);
    glp_add_cols(program_.get(), static_cast<int>(core.columns()));
    for (std::size_t j = 0; j < core.columns(); ++j) {
        glp_set_col_bnds(program_.get(), static_cast<int>(j) + 1, GLP_LO, 0, 0);
        glp_set_obj_coef(program_.get(), static_cast<int>(j) + 1, core.cost[j]);
    }
    for (std::size_t row = 0; row < core.rows(); ++row) {
        const auto columns = core.columnsOf(row);
        add({{columns.begin(), columns.end()}, std::vector<double>(columns.size(), 1), 1});
    }
}

void CutProgram::add(CoverCut cut) {
    const int row = glp_add_rows(program_.get(), 1);
    glp_set_row_bnds(program_.get(), row, GLP_LO, cut.least, 0);
    std::vector<int> columns = {0};
    std::vector<double> values = {0};
    for (const std::uint32_t column : cut.columns) columns.push_back(static_cast<int>(column) + 1);
    values.insert(values.end(), cut.coefficients.begin(), cut.coefficients.end());
    glp_set_mat_row(program_.get(), row, static_cast<int>(cut.columns.size()), columns.data(),
                    values.data());
    rows_.push_back(std::move(cut));
}

/// Continues from the last basis, which stays dual feasible as rows are added.
bool CutProgram::solve(const Progress& progress) {
    glp_smcp how;
    glp_init_smcp(&how);
    how.msg_lev = GLP_MSG_OFF;
    how.meth = GLP_DUALP;
    how.it_lim = 100;  // steps between looks at the progress
    int code = GLP_EITLIM;
    while (code == GLP_EITLIM && !progress.stopped()) code = glp_simplex(program_.get(), &how);
    return code == 0 && glp_get_status(program_.get()) == GLP_OPT;
}

/// A column is taken at most once, so with any prices of at least 0 no cover costs less than their
/// sum plus all negative reduced costs. Exact: the dual values of GLPK only suggest prices.
CoverBound CutProgram::bound(double limit) const {
    const std::size_t n = core_.columns();
    CoverBound bound{0, std::vector<double>(n), std::vector<char>(n)};
    std::vector<double> reduced = core_.cost;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const double dual = glp_get_row_dual(program_.get(), static_cast<int>(i) + 1);
        const double price = std::max(0.0, std::floor(dual / kPriceUnit) * kPriceUnit);
        if (price == 0) continue;
        bound.value += price * rows_[i].least;
        for (std::size_t k = 0; k < rows_[i].columns.size(); ++k)
            reduced[rows_[i].columns[k]] -= price * rows_[i].coefficients[k];
    }
    for (std::size_t j = 0; j < n; ++j) bound.value += std::min(0.0, reduced[j]);
    for (std::size_t j = 0; j < n; ++j) {
        bound.fraction[j] = glp_get_col_prim(program_.get(), static_cast<int>(j) + 1);
        bound.excluded[j] = reduced[j] > 0 && std::ceil(bound.value + reduced[j]) >= limit ? 1 : 0;
    }
    return bound;
}

CoverCut CutProgram::combined(const std::vector<std::pair<std::size_t, double>>& rows) const {
    std::vector<double> sums(core_.columns());
    CoverCut cut;
    cut.least = 0;
    for (const auto& [row, multiplier] : rows) {
        cut.least += multiplier * rows_[row].least;
        for (std::size_t k = 0; k < rows_[row].columns.size(); ++k)
            sums[rows_[row].columns[k]] += multiplier * rows_[row].coefficients[k];
    }
    cut.least = std::ceil(cut.least);
    for (std::uint32_t j = 0; j < sums.size(); ++j) {
        if (sums[j] == 0) continue;
        cut.columns.push_back(j);
        cut.coefficients.push_back(std::min(std::ceil(sums[j]), cut.least));
    }
    return cut;
}

/// Of each fractional basic column one cut; keeps those that cut deepest, by distance from the
/// solution.
std::size_t CutProgram::addCuts() {
    constexpr double kWhole = 0.05, kViolated = 0.02;
    constexpr std::size_t kMaxCuts = 40;
    const int m = glp_get_num_rows(program_.get()), n = glp_get_num_cols(program_.get());
    if (glp_bf_exists(program_.get()) == 0 && glp_factorize(program_.get()) != 0) return 0;
    std::vector<double> inverse(static_cast<std::size_t>(m) + 1);  // a row of the basis' inverse
    std::vector<std::pair<double, CoverCut>> found;
    for (int j = 1; j <= n; ++j) {
        const double x = glp_get_col_prim(program_.get(), j);
        const int basic = glp_get_col_bind(program_.get(), j);
        if (basic == 0 || std::abs(x - std::round(x)) < kWhole) continue;
        std::fill(inverse.begin(), inverse.end(), 0);
        inverse[static_cast<std::size_t>(basic)] = 1;
        glp_btran(program_.get(), inverse.data());
        std::vector<std::pair<std::size_t, double>> rows;
        for (int row = 1; row <= m; ++row) {
            const auto at = static_cast<std::size_t>(row);
            if (inverse[at] == 0 || glp_get_row_stat(program_.get(), row) == GLP_BS) continue;
            const double share = inverse[at] - std::floor(inverse[at] + 1e-7);
            // Rounded down, so that whole coefficients stay.
            const double multiplier = std::floor(share / kPriceUnit - 2) * kPriceUnit;
            if (multiplier > 0) rows.emplace_back(at - 1, multiplier);
        }
        if (rows.empty()) continue;
        CoverCut cut = combined(rows);
        double sum = 0, norm = 0;
        for (std::size_t k = 0; k < cut.columns.size(); ++k) {
            sum += cut.coefficients[k] *
                   glp_get_col_prim(program_.get(), static_cast<int>(cut.columns[k]) + 1);
            norm += cut.coefficients[k] * cut.coefficients[k];
        }
        const double violation = cut.least - sum;
        if (violation < kViolated) continue;
        found.emplace_back(violation / std::sqrt(norm), std::move(cut));
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    found.resize(std::min(found.size(), kMaxCuts));
    for (auto& [depth, cut] : found) add(std::move(cut));
    return found.size();
}

}  // namespace

CoverBound raiseByCuts(const CoverCore& core, double limit, const Progress& progress) {
    constexpr std::size_t kMaxEntries = 300'000;  // of a program that takes seconds
    constexpr int kMaxRounds = 40, kPatience = 3;
    constexpr double kMinGain = 0.05;  // of the gap
    CoverBound best{0, std::vector<double>(core.columns()), std::vector<char>(core.columns())};
    std::size_t entries = 0;
    for (std::size_t row = 0; row < core.rows(); ++row) entries += core.columnsOf(row).size();
    if (entries == 0 || entries > kMaxEntries) return best;
    CutProgram program(core);
    int stalled = 0;
    for (int round = 0; round < kMaxRounds && program.solve(progress); ++round) {
        CoverBound bound = program.bound(limit);
        const double gain = bound.value - best.value;
        for (std::size_t j = 0; j < core.columns(); ++j)
            if (best.excluded[j] != 0) bound.excluded[j] = 1;
        bound.value = std::max(bound.value, best.value);
        best = std::move(bound);
        if (std::ceil(best.value) >= limit) break;
        const auto out = std::count(best.excluded.begin(), best.excluded.end(), 1);
        if (4 * static_cast<std::size_t>(out) > core.columns()) break;  // a smaller core is faster
        stalled = gain < kMinGain * (limit - best.value) ? stalled + 1 : 0;
        if (stalled >= kPatience || program.addCuts() == 0) break;
    }
    return best;
}

}  // namespace ispace
