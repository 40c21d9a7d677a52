// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/worst_case.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "arrange/search/case_values.h"

namespace ispace {

std::uint64_t WorstCaseProblem::totalOf(std::size_t block) const {
    if (ways != nullptr) return shortest;
    const auto begin = problem->weights.begin();
    return std::accumulate(begin + static_cast<std::ptrdiff_t>(blocks[block].first),
                           begin + static_cast<std::ptrdiff_t>(blocks[block].end),
                           std::uint64_t{0});
}

FailureProblem failureProblem(const Problem& plain, const std::vector<std::uint16_t>& seen,
                              std::size_t sensors, std::size_t failures) {
    constexpr double kMaxWeight = 4e9;
    std::vector<double> factors;  // C(n - m, K - m + 1)
    for (std::size_t m = 1; m <= failures + 1; ++m) {
        double factor = 1;
        for (std::size_t i = 0; i < failures + 1 - m; ++i)
            factor = factor * static_cast<double>(sensors - m - i) / static_cast<double>(i + 1);
        factors.push_back(std::round(factor));
    }
    const double all = std::accumulate(factors.begin(), factors.end(), 0.0);  // C(n, K)
    const auto total = static_cast<double>(plain.totalWeight());
    // Rounding adds up to one to each factor.
    const double most = kMaxWeight / std::max(total, 1.0) - static_cast<double>(factors.size());
    const double scale = std::max(1.0, all / most);
    FailureProblem made{plain, static_cast<std::uint64_t>(total * all / scale)};
    Problem& problem = made.problem;
    problem.required = static_cast<int>(failures) + 1;
    problem.weights.clear();
    problem.achieved.clear();
    for (std::size_t m = 1; m <= failures + 1; ++m) {
        const auto factor = static_cast<std::uint32_t>(std::ceil(factors[m - 1] / scale));
        for (std::size_t i = 0; i < plain.cells(); ++i) {
            problem.weights.push_back(factor * plain.weights[i]);
            problem.achieved.push_back(static_cast<std::uint16_t>(
                std::min<std::size_t>(failures + 1 - m + seen[i], 0xffff)));
        }
    }
    return made;
}

CaseValue worstCase(const WorstCaseProblem& of, const std::vector<Choice>& chosen) {
    return CaseValues(of, chosen).worst();
}

}  // namespace ispace
