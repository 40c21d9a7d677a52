// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the fits to people: slopes, and weights that outliers lose.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace ispace::calibration {

/// Computes the slopes of a functor's values at `x` by central differences.
template <typename Functor>
void centralSlopes(const Functor& functor, const Eigen::VectorXd& x, Eigen::MatrixXd& slopes) {
    constexpr double kStep = 1e-5;
    Eigen::VectorXd up(functor.values()), down(functor.values());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        Eigen::VectorXd at = x;
        at[i] = x[i] + kStep;
        functor(at, up);
        at[i] = x[i] - kStep;
        functor(at, down);
        slopes.col(i) = (up - down) / (2 * kStep);
    }
}

/// Returns the weights of Cauchy by mean squared residuals, scaled by their median. \param usual
/// the median of such means for normal residuals of variance 1
inline std::vector<double> cauchyWeights(std::span<const double> squares, double usual) {
    if (squares.empty()) return {};
    std::vector<double> sorted(squares.begin(), squares.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double scale = std::max(*middle / usual, 1e-6);
    constexpr double kCauchy = 2.385;
    std::vector<double> weights;
    weights.reserve(squares.size());
    for (const double square : squares)
        weights.push_back(1 / (1 + square / (scale * kCauchy * kCauchy)));
    return weights;
}

}  // namespace ispace::calibration
