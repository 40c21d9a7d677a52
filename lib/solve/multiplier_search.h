// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ispace {

/// The first factor of a MultiplierSearch whose start is nearly as good as can be: a longer step
/// only leads away.
constexpr double kWarmFactor = 0.5;

/// Looks for the Lagrange multipliers with the least bound, one trial after another: the volume
/// algorithm (Barahona & Anbil 2000), a subgradient method that steps from the best multipliers so
/// far along an average of the subgradients, so that it neither swings between sensors that are
/// nearly alike nor needs many steps.
class MultiplierSearch {
  public:
    /// \param weights of the cells: the multipliers are from 0 to these
    /// \param start the first trial
    /// \param target a value that the bound will not pass, or about
    /// \param factor of the first step: 1 leads to the target if the bound were a plane
    MultiplierSearch(std::span<const std::uint32_t> weights, std::vector<std::uint32_t> start,
                     double target, double factor = 1);

    [[nodiscard]] const std::vector<std::uint32_t>& trial() const { return trial_; }
    [[nodiscard]] const std::vector<std::uint32_t>& best() const { return best_; }
    /// What the trial gave, and the next trial.
    /// \param cover how far the sensors that are best at these prices meet each cell: 1 is just met
    void report(double bound, std::span<const float> cover);
    /// The best multipliers have another bound, and are to be gone on from: there are more sensors
    /// to choose from than the last trials knew.
    void restart(double bound, std::span<const float> cover);
    /// The part that the last trial has in the average.
    [[nodiscard]] double part() const { return part_; }

  private:
    void step();

    std::span<const std::uint32_t> weights_;
    double target_;
    double bound_ = 0;
    bool is_first_ = true;
    double factor_, mixing_ = 0.2, part_ = 1;
    int failures_ = 0;
    std::vector<std::uint32_t> trial_, best_;
    std::vector<float> average_;  // of cover
};

}  // namespace ispace
