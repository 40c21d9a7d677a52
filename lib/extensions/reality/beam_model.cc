// SPDX-License-Identifier: GPL-3.0-or-later
// Expectation maximisation of the beam model. The mean of a truncated exponential is that of the
// interval, which table 6.2 of the book leaves out. Spread and bias have no closed form: each round
// takes steps of Fisher scoring. Ends when the mean log-likelihood grows by less than 1e-8, after
// 300 rounds at most.
#include "extensions/reality/beam_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ispace::reality {

namespace {

constexpr double kLeastSigma = 1e-4;  // metres
constexpr double kLeastDensity = 1e-12;

double normalDensity(double x, double mean, double sigma) {
    const double u = (x - mean) / sigma;
    return std::exp(-0.5 * u * u) / (sigma * std::sqrt(2 * std::numbers::pi));
}

/// The components of the density of a return, weighted.
struct Components {
    double hit = 0, nearer = 0, random = 0, mixed = 0;
    [[nodiscard]] double sum() const { return hit + nearer + random + mixed; }
};

Components componentsOf(const BeamModel& model, const BeamSample& sample) {
    Components parts;
    const double z = sample.measured, expected = sample.expected;
    const double sigma = std::max(model.sigmaAt(expected), kLeastSigma);
    parts.hit = model.hit * normalDensity(z, expected + model.bias, sigma);
    if (z < expected && model.nearer > 0) {
        const double whole = -std::expm1(-model.lambda * expected);
        parts.nearer = model.nearer * model.lambda * std::exp(-model.lambda * z) /
                       std::max(whole, kLeastDensity);
    }
    if (sample.limit > 0 && z <= sample.limit) parts.random = model.random / sample.limit;
    if (sample.isAtEdge() && model.mixed > 0) {
        const double rest = 1 - model.mixed;
        parts.hit *= rest;
        parts.nearer *= rest;
        parts.random *= rest;
        if (z >= sample.edge_near && z <= sample.edge_far)
            parts.mixed = model.mixed / (sample.edge_far - sample.edge_near);
    }
    return parts;
}

/// Weighted residuals of hits, for the spread.
struct HitSums {
    std::vector<double> weight, residual, range;
};

/// Maximises the weighted likelihood of hits over bias and spread by Fisher scoring: each step
/// solves the weighted normal equations of both.
void fitSpread(const HitSums& hits, int terms, BeamModel& model) {
    constexpr int kSteps = 3;
    for (int step = 0; step < kSteps; ++step) {
        double weights = 0, sum = 0;
        Eigen::MatrixXd information = Eigen::MatrixXd::Zero(terms, terms);
        Eigen::VectorXd score = Eigen::VectorXd::Zero(terms);
        for (std::size_t i = 0; i < hits.weight.size(); ++i) {
            const double sigma = std::max(model.sigmaAt(hits.range[i]), kLeastSigma);
            const double w = hits.weight[i] / (sigma * sigma);
            weights += w;
            sum += w * hits.residual[i];
        }
        if (weights <= 0) return;
        model.bias = sum / weights;
        for (std::size_t i = 0; i < hits.weight.size(); ++i) {
            const double r = hits.range[i];
            const double sigma = std::max(model.sigmaAt(r), kLeastSigma);
            const double u = (hits.residual[i] - model.bias) / sigma;
            const std::array<double, 3> powers{1, r, r * r};
            for (int a = 0; a < terms; ++a) {
                const double wa = hits.weight[i] * powers[static_cast<std::size_t>(a)];
                score(a) += wa * (u * u - 1) / sigma;
                for (int b = 0; b <= a; ++b)
                    information(a, b) +=
                        2 * wa * powers[static_cast<std::size_t>(b)] / (sigma * sigma);
            }
        }
        information = information.selfadjointView<Eigen::Lower>();
        const Eigen::VectorXd change = information.ldlt().solve(score);
        if (!change.allFinite()) return;
        // A step may not take the least spread of the data below half of what it was.
        double scale = 1;
        constexpr double kLeastScale = 1e-3;
        const auto [near, far] = std::minmax_element(hits.range.begin(), hits.range.end());
        const auto changed = [&](double r) {
            double sigma = 0, power = 1;
            for (int a = 0; a < terms; ++a, power *= r)
                sigma += (model.sigma[static_cast<std::size_t>(a)] + scale * change(a)) * power;
            return sigma;
        };
        const auto holds = [&](double r) { return changed(r) >= 0.5 * model.sigmaAt(r); };
        while (scale > kLeastScale && !(holds(*near) && holds(*far) && holds(0.5 * (*near + *far))))
            scale *= 0.5;
        for (int a = 0; a < terms; ++a)
            model.sigma[static_cast<std::size_t>(a)] += scale * change(a);
    }
}

/// One round of expectation and maximisation. Returns the mean log-likelihood before it.
double improve(std::span<const BeamSample> samples, int terms, HitSums& hits, BeamModel& model) {
    double log_sum = 0, hit = 0, short_sum = 0, max = 0, random = 0, mixed = 0, edges = 0;
    double weighted_range = 0, truncated = 0;
    hits.weight.clear();
    hits.residual.clear();
    hits.range.clear();
    for (const BeamSample& sample : samples) {
        if (sample.isAtEdge()) edges += 1;
        if (!sample.isReturn()) {
            log_sum += std::log(std::max(model.density(sample), kLeastDensity));
            max += 1;
            continue;
        }
        const Components parts = componentsOf(model, sample);
        const double whole = parts.sum();
        log_sum += std::log(std::max(whole, kLeastDensity));
        if (whole <= 0) {
            random += 1;
            continue;
        }
        const double h = parts.hit / whole, s = parts.nearer / whole;
        hit += h;
        short_sum += s;
        random += parts.random / whole;
        mixed += parts.mixed / whole;
        constexpr double kNegligible = 1e-9;
        if (h > kNegligible) {
            hits.weight.push_back(h);
            hits.residual.push_back(sample.measured - sample.expected);
            hits.range.push_back(sample.expected);
        }
        if (s > 0) {
            weighted_range += s * sample.measured;
            // Mean of z under the truncated exponential, for the next λ.
            const double x = model.lambda * sample.expected;
            truncated += s * (sample.expected / std::max(std::expm1(x), kLeastDensity));
        }
    }
    // Mixed pixels at edges are apart from the four shares.
    const double all = static_cast<double>(samples.size()) - mixed;
    model.mixed = edges > 0 ? mixed / edges : 0;
    if (all <= 0) return log_sum / static_cast<double>(samples.size());
    model.hit = hit / all;
    model.nearer = short_sum / all;
    model.max = max / all;
    model.random = random / all;
    // E[z] = 1/λ - z*/(e^(λz*) - 1): table 6.2 leaves out the second term.
    if (short_sum > 0 && weighted_range + truncated > 0)
        model.lambda = std::clamp(short_sum / (weighted_range + truncated), 1e-3, 1e3);
    if (!hits.weight.empty()) fitSpread(hits, terms, model);
    return log_sum / static_cast<double>(samples.size());
}

BeamModel startOf(std::span<const BeamSample> samples) {
    std::vector<double> residuals;
    std::size_t none = 0;
    for (const BeamSample& sample : samples) {
        if (sample.isReturn())
            residuals.push_back(sample.measured - sample.expected);
        else
            ++none;
    }
    const RobustSpread spread = robustSpread(residuals);
    BeamModel model;
    model.bias = spread.median;
    model.sigma[0] = std::max(spread.sigma, 10 * kLeastSigma);
    model.max = static_cast<double>(none) / static_cast<double>(samples.size());
    constexpr double kShort = 0.05, kRandom = 0.05, kMixed = 0.1;
    model.nearer = kShort * (1 - model.max);
    model.random = kRandom * (1 - model.max);
    model.hit = 1 - model.max - model.nearer - model.random;
    model.mixed = kMixed;
    return model;
}

/// The parameters as a vector: shares short, max, random (hit is the rest), lambda, bias, mixed,
/// sigma.
constexpr std::size_t kFirstSigma = 6;
using BeamParameters = std::array<double, kFirstSigma + 3>;

BeamParameters parametersOf(const BeamModel& model) {
    return {model.nearer, model.max,      model.random,   model.lambda,  model.bias,
            model.mixed,  model.sigma[0], model.sigma[1], model.sigma[2]};
}

BeamModel modelOf(const BeamParameters& p) {
    BeamModel model;
    model.nearer = p[0];
    model.max = p[1];
    model.random = p[2];
    model.hit = 1 - p[0] - p[1] - p[2];
    model.lambda = p[3];
    model.bias = p[4];
    model.mixed = p[5];
    model.sigma = {p[kFirstSigma], p[kFirstSigma + 1], p[kFirstSigma + 2]};
    return model;
}

/// Inverts the information of the parameters that are not at an end of their range.
BeamFit::Errors errorsOf(std::span<const BeamSample> samples, const BeamModel& model, int terms) {
    const BeamParameters best = parametersOf(model);
    constexpr double kLeastShare = 1e-7;
    std::vector<std::size_t> active;
    for (const std::size_t share : {0U, 1U, 2U})
        if (best[share] > kLeastShare) active.push_back(share);
    if (best[0] > kLeastShare) active.push_back(3);
    active.push_back(4);
    if (best[5] > kLeastShare) active.push_back(5);
    for (int a = 0; a < terms; ++a) active.push_back(kFirstSigma + static_cast<std::size_t>(a));
    const auto count = static_cast<Eigen::Index>(active.size());
    std::vector<std::pair<BeamModel, BeamModel>> beside;
    std::vector<double> width;
    for (const std::size_t i : active) {
        BeamParameters less = best, more = best;
        const double scale = i >= kFirstSigma ? std::abs(best[i]) + 1e-3 * model.sigma[0]
                             : i == 4         ? model.sigma[0]
                                              : best[i];
        const double h = 1e-4 * scale;
        less[i] -= h;
        more[i] += h;
        width.push_back(2 * h);
        beside.emplace_back(modelOf(less), modelOf(more));
    }
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd gradient(count);
    for (const BeamSample& sample : samples) {
        const double density = std::max(model.density(sample), kLeastDensity);
        for (Eigen::Index k = 0; k < count; ++k) {
            const auto i = static_cast<std::size_t>(k);
            gradient(k) = (beside[i].second.density(sample) - beside[i].first.density(sample)) /
                          (width[i] * density);
        }
        information.selfadjointView<Eigen::Lower>().rankUpdate(gradient);
    }
    information = information.selfadjointView<Eigen::Lower>();
    const Eigen::MatrixXd covariance =
        information.completeOrthogonalDecomposition().pseudoInverse();
    BeamParameters errors{};
    double hit_variance = 0;
    for (Eigen::Index k = 0; k < count; ++k) {
        const std::size_t i = active[static_cast<std::size_t>(k)];
        errors[i] = std::sqrt(std::max(covariance(k, k), 0.0));
        for (Eigen::Index l = 0; l < count; ++l)
            if (i < 3 && active[static_cast<std::size_t>(l)] < 3) hit_variance += covariance(k, l);
    }
    return {.hit = std::sqrt(std::max(hit_variance, 0.0)),
            .nearer = errors[0],
            .max = errors[1],
            .random = errors[2],
            .lambda = errors[3],
            .bias = errors[4],
            .mixed = errors[5],
            .sigma = {errors[kFirstSigma], errors[kFirstSigma + 1], errors[kFirstSigma + 2]}};
}

}  // namespace

bool BeamSample::isReturn() const { return measured < std::numeric_limits<double>::infinity(); }

double BeamModel::density(const BeamSample& sample) const {
    if (!sample.isReturn()) return sample.isAtEdge() ? max * (1 - mixed) : max;
    return componentsOf(*this, sample).sum();
}

double BeamModel::meanLogLikelihood(std::span<const BeamSample> samples) const {
    double sum = 0;
    for (const BeamSample& sample : samples)
        sum += std::log(std::max(density(sample), kLeastDensity));
    return samples.empty() ? 0 : sum / static_cast<double>(samples.size());
}

namespace {

BeamFit fitFrom(const BeamModel& start, std::span<const BeamSample> samples, SpreadTerms terms) {
    constexpr int kMostRounds = 300;
    constexpr double kEnough = 1e-8;
    BeamFit fit;
    fit.model = start;
    fit.terms = terms;
    fit.samples = samples.size();
    HitSums hits;
    double before = -std::numeric_limits<double>::infinity();
    for (fit.rounds = 1; fit.rounds <= kMostRounds; ++fit.rounds) {
        const double likelihood = improve(samples, static_cast<int>(terms), hits, fit.model);
        if (std::abs(likelihood - before) < kEnough * (1 + std::abs(likelihood))) break;
        before = likelihood;
    }
    // Ranges without noise: the last step may pass 0.
    if (terms == SpreadTerms::Constant) fit.model.sigma[0] = std::max(fit.model.sigma[0], 0.0);
    fit.log_likelihood = fit.model.meanLogLikelihood(samples);
    return fit;
}

}  // namespace

BeamFit fitBeams(std::span<const BeamSample> samples, SpreadTerms terms) {
    BeamFit fit = fitFrom(startOf(samples), samples, terms);
    fit.errors = errorsOf(samples, fit.model, static_cast<int>(terms));
    return fit;
}

BeamFit fitBeams(std::span<const BeamSample> samples) {
    const double count = static_cast<double>(samples.size());
    BeamFit best;
    double least = std::numeric_limits<double>::infinity();
    BeamModel start = startOf(samples);
    for (const SpreadTerms terms :
         {SpreadTerms::Constant, SpreadTerms::Linear, SpreadTerms::Square}) {
        BeamFit fit = fitFrom(start, samples, terms);
        start = fit.model;
        const double criterion =
            static_cast<int>(terms) * std::log(count) - 2 * count * fit.log_likelihood;
        if (criterion < least) {
            least = criterion;
            best = fit;
        }
    }
    best.errors = errorsOf(samples, best.model, static_cast<int>(best.terms));
    return best;
}

std::vector<BeamSample> samplesOf(const LoggedRun& run, std::span<const std::size_t> scans,
                                  double margin) {
    std::vector<BeamSample> samples;
    for (const std::size_t i : scans) {
        const MeasuredScan& scan = run.scans[i];
        const MeasuredSensor& sensor = run.sensors[scan.sensor];
        const std::span<const MeasuredBeam> beams = run.beamsOf(scan);
        const double far = sensor.max_range;
        for (std::size_t k = 0; k < beams.size(); ++k) {
            const MeasuredBeam& beam = beams[k];
            const double expected = double{beam.expected};
            if (!(expected < far - margin && expected > sensor.min_range + margin)) continue;
            BeamSample sample{.measured = double{beam.measured},
                              .expected = expected,
                              .cosine = double{beam.cosine},
                              .limit = std::min(far, 1e5),
                              .edge_near = expected,
                              .edge_far = expected};
            // Neighbours of a scan; a cloud has no order.
            constexpr double kJump = 0.3;
            for (const std::size_t other : {k - 1, k + 1}) {
                if (scan.scan == nullptr || other >= beams.size()) continue;
                const double beside = double{beams[other].expected};
                if (!(beside < far)) continue;
                sample.edge_near = std::min(sample.edge_near, beside);
                sample.edge_far = std::max(sample.edge_far, beside);
            }
            if (sample.edge_far - sample.edge_near < kJump) sample.edge_near = sample.edge_far;
            samples.push_back(sample);
        }
    }
    return samples;
}

std::vector<BeamSample> evenShare(std::vector<BeamSample> samples) {
    constexpr std::size_t kMost = 400'000;
    const std::size_t step = samples.size() / kMost + 1;
    if (step == 1) return samples;
    std::size_t count = 0;
    for (std::size_t i = 0; i < samples.size(); i += step) samples[count++] = samples[i];
    samples.resize(count);
    return samples;
}

RobustSpread robustSpread(std::vector<double>& values) {
    RobustSpread spread{.count = values.size()};
    if (values.empty()) return spread;
    const auto median = [](std::vector<double>& list) {
        const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
        std::nth_element(list.begin(), middle, list.end());
        if (list.size() % 2 == 1) return *middle;
        return 0.5 * (*middle + *std::max_element(list.begin(), middle));
    };
    spread.median = median(values);
    for (double& value : values) value = std::abs(value - spread.median);
    constexpr double kNormal = 1.4826;
    spread.sigma = kNormal * median(values);
    return spread;
}

}  // namespace ispace::reality
