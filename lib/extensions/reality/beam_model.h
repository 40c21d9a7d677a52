// SPDX-License-Identifier: GPL-3.0-or-later
// The beam model of Thrun, Burgard and Fox, Probabilistic Robotics, 2005, section 6.3, fitted by
// expectation maximisation (table 6.2), with a spread that grows with the range, a bias, and mixed
// pixels at edges.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "extensions/reality/compare.h"

namespace ispace::reality {

/// One measured range z beside the simulated one z*.
struct BeamSample {
    double measured = 0;  ///< metres; +infinity is no return
    double expected = 0;  ///< metres, finite
    double cosine = 1;    ///< of incidence
    double limit = 0;     ///< maximum range
    /// Ranges between which a pixel that sees two surfaces measures; equal away from edges.
    double edge_near = 0, edge_far = 0;
    [[nodiscard]] bool isReturn() const;
    [[nodiscard]] bool isAtEdge() const { return edge_far > edge_near; }
};

/// The density of z:
///
///     hit N(z; z* + bias, s0 + s1 z* + s2 z*^2) + short λ e^(-λz) η [z < z*] + random / limit
///
/// for a return, where η normalises to [0, z*], and `max` for a lost one. At edges a share `mixed`
/// of this is uniform between the two surfaces instead. hit + short + max + random = 1.
struct BeamModel {
    double hit = 0, nearer = 0, max = 0, random = 0;  ///< nearer: short
    double lambda = 1;                                ///< per metre
    double bias = 0;                                  ///< metres
    std::array<double, 3> sigma{};
    double mixed = 0;

    [[nodiscard]] double sigmaAt(double range) const {
        return sigma[0] + range * (sigma[1] + range * sigma[2]);
    }
    [[nodiscard]] double density(const BeamSample& sample) const;
    /// Mean of the logarithm of the density. Densities are per metre; no return is a probability.
    [[nodiscard]] double meanLogLikelihood(std::span<const BeamSample> samples) const;
};

/// Terms of the spread that are fitted: s0 alone, s0 and s1, all three.
enum class SpreadTerms { Constant = 1, Linear = 2, Square = 3 };

struct BeamFit {
    BeamModel model;
    SpreadTerms terms = SpreadTerms::Constant;
    std::size_t samples = 0;
    double log_likelihood = 0;  ///< mean
    int rounds = 0;
    /// Standard errors, by the outer product of the gradients (Berndt, Hall, Hall and Hausman,
    /// 1974); 0 for a share at 0 or 1, which has no interval.
    struct Errors {
        double hit = 0, nearer = 0, max = 0, random = 0, lambda = 0, bias = 0, mixed = 0;
        std::array<double, 3> sigma{};
    } errors;
};

/// Fits the model. Deterministic. O(rounds * samples). \pre not empty
BeamFit fitBeams(std::span<const BeamSample> samples, SpreadTerms terms);
/// Fits it with the terms that the Bayesian information criterion justifies.
BeamFit fitBeams(std::span<const BeamSample> samples);

/// Returns the samples of some scans: those with a simulated range inside the limits of the sensor
/// by `margin`. \param scans indices in LoggedRun::scans
std::vector<BeamSample> samplesOf(const LoggedRun& run, std::span<const std::size_t> scans,
                                  double margin = 0);

/// Returns the samples, or every second, third ... if there are more than 400 000.
std::vector<BeamSample> evenShare(std::vector<BeamSample> samples);

/// Median and robust standard deviation, 1.4826 times the median distance from it.
struct RobustSpread {
    std::size_t count = 0;
    double median = 0, sigma = 0;
};
/// Overwrites the values. All 0 for an empty list.
RobustSpread robustSpread(std::vector<double>& values);

}  // namespace ispace::reality
