// SPDX-License-Identifier: GPL-3.0-or-later
// Fits noise to residuals. Terms are added only if the Bayesian information criterion justifies
// them (G. Schwarz, Estimating the dimension of a model, 1978). Odometry: variances of turn and way
// as linear functions of both (Probabilistic Robotics, section 5.4), by iterated weighted least
// squares, without motions beyond five deviations, which are wrong matches of scans.
#include "extensions/reality/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "base/number.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "sense/ultrasound_burst.h"

namespace ispace::reality {

namespace {

/// Counts of returns and losses for each whole degree of incidence.
struct IncidenceCounts {
    static constexpr std::size_t kDegrees = 90;
    std::array<double, kDegrees> lost{}, all{};
};

double logOf(double p) {
    constexpr double kLeast = 1e-12;
    return std::log(std::max(p, kLeast));
}

/// Returns the log-likelihood of losses with d everywhere and a ramp, and the best d for it.
std::pair<double, double> bestDropout(const IncidenceCounts& counts, double from, double to) {
    const auto ramp = [&](std::size_t degree) {
        const double angle = static_cast<double>(degree) + 0.5;
        if (angle <= from) return 0.0;
        return angle >= to ? 1.0 : (angle - from) / (to - from);
    };
    // EM of d: a loss is one of d with the share d / (d + (1 - d) g).
    double d = 0.05;
    constexpr int kRounds = 60;
    for (int round = 0; round < kRounds; ++round) {
        double by_d = 0, chances = 0;
        for (std::size_t i = 0; i < IncidenceCounts::kDegrees; ++i) {
            const double g = ramp(i), p = d + (1 - d) * g;
            if (p > 0) by_d += counts.lost[i] * d / p;
            chances += counts.all[i];
        }
        if (chances <= 0) break;
        const double next = by_d / chances;
        if (std::abs(next - d) < 1e-10) break;
        d = next;
    }
    double likelihood = 0;
    for (std::size_t i = 0; i < IncidenceCounts::kDegrees; ++i) {
        const double p = d + (1 - d) * ramp(i);
        if (counts.lost[i] > 0) likelihood += counts.lost[i] * logOf(p);
        if (counts.all[i] > counts.lost[i])
            likelihood += (counts.all[i] - counts.lost[i]) * logOf(1 - p);
    }
    return {likelihood, d};
}

/// Returns the resolution of which all ranges are whole multiples; 0 if they differ.
double resolutionOf(const LoggedRun& run, std::size_t sensor) {
    for (const double step : {0.01, 0.005, 0.001}) {
        bool holds = true, any = false;
        for (const MeasuredScan& scan : run.scans) {
            if (scan.sensor != sensor || !holds) continue;
            for (const float range : scan.ranges()) {
                if (!(range < kNoReturn)) continue;
                any = true;
                const double n = double{range} / step;
                constexpr double kRounding = 2e-3;
                if (std::abs(n - std::round(n)) > kRounding + 1e-7 * n) {
                    holds = false;
                    break;
                }
            }
        }
        if (holds && any) return step;
    }
    return 0;
}

/// The beam model of a sensor's own noise: hits and lost returns alone.
std::optional<BeamModel> knownModel(const Sensor& sensor) {
    const RangeNoise* noise = nullptr;
    if (const Laser* laser = sensor.tryAs<Laser>()) noise = &laser->noise;
    if (const Ranger* ranger = sensor.tryAs<Ranger>()) noise = &ranger->noise;
    if (noise == nullptr || noise->sigma[0] <= 0) return std::nullopt;
    BeamModel model;
    model.max = noise->dropout;
    model.hit = 1 - noise->dropout;
    model.bias = noise->bias;
    model.sigma = noise->sigma;
    return model;
}

/// Variance of errors as a linear function of what causes them, by maximum likelihood: iterated
/// weighted least squares of the squares, whose variance is twice that of their mean.
struct VarianceFit {
    Eigen::VectorXd values, errors;
};

/// Returns the causes that occur.
std::vector<Eigen::Index> activeOf(const Eigen::MatrixXd& causes) {
    std::vector<Eigen::Index> active;
    for (Eigen::Index k = 0; k < causes.cols(); ++k)
        if (causes.col(k).squaredNorm() > 0) active.push_back(k);
    return active;
}

/// Sets the estimates of some causes and their standard errors.
void setActive(const std::vector<Eigen::Index>& active, const Eigen::VectorXd& found,
               const Eigen::MatrixXd& covariance, VarianceFit& fit) {
    for (std::size_t i = 0; i < active.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        fit.values(active[i]) = found(k);
        fit.errors(active[i]) = std::sqrt(std::max(covariance(k, k), 0.0));
    }
}

VarianceFit fitVariance(const Eigen::MatrixXd& causes, const Eigen::VectorXd& squares) {
    const Eigen::Index count = causes.cols();
    VarianceFit fit{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
    std::vector<Eigen::Index> active = activeOf(causes);
    while (!active.empty()) {
        const auto size = static_cast<Eigen::Index>(active.size());
        Eigen::MatrixXd x(causes.rows(), size);
        for (Eigen::Index k = 0; k < size; ++k)
            x.col(k) = causes.col(active[static_cast<std::size_t>(k)]);
        Eigen::VectorXd variance =
            Eigen::VectorXd::Constant(causes.rows(), std::max(squares.mean(), 1e-18));
        Eigen::VectorXd found = Eigen::VectorXd::Zero(size);
        Eigen::MatrixXd information;
        constexpr int kRounds = 60;
        for (int round = 0; round < kRounds; ++round) {
            const Eigen::VectorXd weights = (2 * variance.array().square()).inverse();
            information = x.transpose() * weights.asDiagonal() * x;
            found = information.ldlt().solve(x.transpose() * weights.cwiseProduct(squares));
            const double least = 1e-4 * std::max(squares.mean(), 1e-18);
            variance = (x * found).cwiseMax(least);
        }
        // A variance below 0 counts as 0.
        Eigen::Index lowest = 0;
        if (found.minCoeff(&lowest) < 0) {
            active.erase(active.begin() + lowest);
            continue;
        }
        setActive(active, found, information.inverse(), fit);
        break;
    }
    return fit;
}

/// Standard deviation of errors as a linear function of what causes them, beside that of the
/// corrected poses, by maximum likelihood: Fisher scoring. Causes that would lower it count as 0.
VarianceFit fitDeviation(const Eigen::MatrixXd& causes, const Eigen::VectorXd& squares) {
    const Eigen::Index count = causes.cols();
    VarianceFit fit{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
    std::vector<Eigen::Index> active = activeOf(causes);
    const double mean = std::max(squares.mean(), 1e-18);
    bool has_rest = true;  // the variance of the corrected poses
    while (!active.empty()) {
        const auto size = static_cast<Eigen::Index>(active.size());
        const Eigen::Index all = size + (has_rest ? 1 : 0);
        Eigen::MatrixXd x(causes.rows(), size);
        for (Eigen::Index k = 0; k < size; ++k)
            x.col(k) = causes.col(active[static_cast<std::size_t>(k)]);
        Eigen::VectorXd found = Eigen::VectorXd::Constant(
            all, std::sqrt(mean) / std::max(x.rowwise().sum().mean(), 1e-12));
        if (has_rest) found(size) = 0.1 * mean;
        Eigen::MatrixXd information;
        constexpr int kRounds = 200;
        for (int round = 0; round < kRounds; ++round) {
            const Eigen::VectorXd linear = x * found.head(size);
            const double rest = has_rest ? found(size) : 0;
            const Eigen::VectorXd variance = (linear.array().square() + rest).max(1e-4 * mean);
            Eigen::MatrixXd slopes(causes.rows(), all);  // of the variance, by itself
            for (Eigen::Index k = 0; k < size; ++k)
                slopes.col(k) = 2 * linear.array() * x.col(k).array() / variance.array();
            if (has_rest) slopes.col(size) = variance.cwiseInverse();
            information = 0.5 * slopes.transpose() * slopes;
            const Eigen::VectorXd excess = squares.array() / variance.array() - 1;
            const Eigen::VectorXd step =
                information.ldlt().solve(0.5 * slopes.transpose() * excess);
            if (!step.allFinite()) break;
            // Half steps: a deviation may not pass through 0.
            found += 0.5 * step;
            if (step.norm() < 1e-9 * found.norm()) break;
        }
        if (has_rest && found(size) < 0) {
            has_rest = false;
            continue;
        }
        Eigen::Index lowest = 0;
        if (found.head(size).minCoeff(&lowest) < 0) {
            active.erase(active.begin() + lowest);
            continue;
        }
        setActive(active, found, information.inverse(), fit);
        break;
    }
    return fit;
}

Pose2 relative(const Pose2& frame, const Pose2& pose) {
    const Vec2 way = pose.position - frame.position;
    const auto [c, s] = cosSin(frame.heading);
    return {{c * way.x + s * way.y, c * way.y - s * way.x}, wrapped(pose.heading - frame.heading)};
}

Pose2 floorPose(const Pose3& pose) { return {pose.position.onFloor(), pose.heading}; }

/// A motion of the robot by odometry and by corrected poses.
struct OdometryMotion {
    Pose2 odometry, truth;
    double turns = 0, ways = 0;  ///< sums of |turn| in radians and |way| in metres
};

double forward(const Pose2& motion) {
    const auto [c, s] = cosSin(0.5 * motion.heading);
    return motion.position.x * c + motion.position.y * s;
}

void addStep(OdometryMotion& motion, const Pose2& from, const Pose2& to) {
    const Pose2 step = relative(from, to);
    motion.turns += std::abs(step.heading.radians());
    motion.ways += std::hypot(step.position.x, step.position.y);
}

/// Poses as those of the sensor, by the offset that the log has.
Pose2 sensorPose(const LogPoses& poses) {
    const Pose3 mount = poses.mount.value_or(Pose3());
    return {*poses.odometry * mount.position.onFloor(), poses.odometry->heading + mount.heading};
}

/// Returns the motion between two scans by odometry that begins anew at the first; nullopt without.
std::optional<OdometryMotion> begunMotion(const Log& log, std::size_t from, std::size_t to,
                                          std::size_t& at) {
    while (at < log.odometry.size() && log.odometry[at].scans_before <= from) ++at;
    std::optional<Pose2> first, last;
    OdometryMotion motion;
    for (std::size_t k = at; k < log.odometry.size() && log.odometry[k].scans_before <= to; ++k) {
        const LogOdometry& each = log.odometry[k];
        if (each.begins)
            first = last = each.pose;
        else if (last)
            addStep(motion, *last, each.pose);
        if (last) last = each.pose;
    }
    if (!first || !last) return std::nullopt;
    motion.odometry = relative(*first, *last);
    return motion;
}

/// Returns the motions of each sensor with corrected poses: from scan to scan, and with odometry
/// that goes on over several scans until it has moved by 10 cm or 0.1 radians.
std::vector<OdometryMotion> motionsOf(const Log& log) {
    std::vector<OdometryMotion> motions;
    const bool begins = std::any_of(log.odometry.begin(), log.odometry.end(),
                                    [](const LogOdometry& each) { return each.begins; });
    struct Path {
        std::size_t from = 0, last = 0;
        OdometryMotion motion;
    };
    std::map<std::string, Path> ways;
    std::size_t at = 0;
    for (std::size_t i = 0; i < log.scans.size(); ++i) {
        const LogScan& scan = log.scans[i];
        if (!scan.poses.corrected || (!begins && !scan.poses.odometry)) continue;
        const auto [known, is_first] = ways.try_emplace(scan.sensor, Path{i, i, {}});
        if (is_first) continue;
        Path& way = known->second;
        const LogPoses &from = log.scans[way.from].poses, &last = log.scans[way.last].poses;
        way.last = i;
        const Pose2 truth = relative(floorPose(*from.corrected), floorPose(*scan.poses.corrected));
        if (begins) {
            if (auto motion = begunMotion(log, way.from, i, at)) {
                motion->truth = truth;
                motions.push_back(*motion);
            }
        } else {
            addStep(way.motion, *last.odometry, *scan.poses.odometry);
            constexpr double kMetres = 0.1, kRadians = 0.1;
            if (way.motion.ways < kMetres && way.motion.turns < kRadians) continue;
            way.motion.truth = truth;
            way.motion.odometry = relative(sensorPose(from), sensorPose(scan.poses));
            motions.push_back(way.motion);
        }
        way = {i, i, {}};
    }
    return motions;
}

/// Errors beyond five robust deviations are those of wrong matches of scans.
void limitOutliers(Eigen::VectorXd& errors) {
    std::vector<double> values(errors.data(), errors.data() + errors.size());
    const RobustSpread spread = robustSpread(values);
    const double most = 5 * std::max(spread.sigma, 1e-9);
    for (double& error : errors)
        error = std::clamp(error, spread.median - most, spread.median + most);
}

/// Returns the squares of errors without outliers: those beyond five deviations of a motion of this
/// size.
Eigen::VectorXd squaresOf(const Eigen::VectorXd& errors, const Eigen::MatrixXd& causes) {
    Eigen::VectorXd limited = errors;
    limitOutliers(limited);
    constexpr int kRounds = 5;
    constexpr double kMost = 5;
    for (int round = 0; round < kRounds; ++round) {
        const VarianceFit fit = fitVariance(causes, limited.array().square());
        const Eigen::VectorXd most = kMost * (causes * fit.values).cwiseMax(1e-18).cwiseSqrt();
        limited = errors.cwiseMax(-most).cwiseMin(most);
    }
    return limited.array().square();
}

double significant(double value) {
    constexpr int kDigits = 4;
    return roundSignificant(value, kDigits);
}

std::string withError(double value, double error) {
    return formatDouble(significant(value)) + " +- " + formatDouble(roundSignificant(error, 2));
}

std::string commentOf(const BeamFit& fit) {
    const BeamModel& m = fit.model;
    const BeamFit::Errors& e = fit.errors;
    std::string text = "#   bias " + withError(m.bias, e.bias) + " m; sigma " +
                       withError(m.sigma[0], e.sigma[0]) + " m";
    if (fit.terms != SpreadTerms::Constant)
        text += ", " + withError(m.sigma[1], e.sigma[1]) + " m/m";
    if (fit.terms == SpreadTerms::Square)
        text += ", " + withError(m.sigma[2], e.sigma[2]) + " m/m2";
    text += "\n#   hit " + withError(m.hit, e.hit) + ", short " + withError(m.nearer, e.nearer) +
            " (lambda " + withError(m.lambda, e.lambda) + " per metre), max " +
            withError(m.max, e.max) + ", random " + withError(m.random, e.random) +
            ", mixed at edges " + withError(m.mixed, e.mixed) + "\n";
    return text;
}

void setNoise(Record& record, const BeamFit& fit, const DropoutFit& dropout, double resolution) {
    const BeamModel& model = fit.model;
    record.set("bias", significant(model.bias));
    Tuple sigma{significant(model.sigma[0])};
    const auto terms = static_cast<std::size_t>(fit.terms);
    for (std::size_t k = 1; k < terms; ++k) sigma.push_back(significant(model.sigma[k]));
    record.set("sigma", sigma);
    record.set("dropout", significant(dropout.dropout));
    if (dropout.graze)
        record.set("incidence",
                   Tuple{dropout.graze->first.degrees(), dropout.graze->second.degrees()});
    if (resolution > 0) record.set("resolution", resolution);
}

/// Returns the record of a placed or pending sensor of the scene; nullopt without one.
std::optional<Record> recordOf(const Scene& scene, const std::string& id) {
    for (std::size_t i = 0; i < scene.ids.size(); ++i)
        if (scene.ids[i] == id) return scene.records[i];
    return std::nullopt;
}

std::string wordOf(const std::string& sensor) {
    std::string word;
    for (const char c : sensor)
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_') word += c;
    return word.empty() ? "fitted" : word;
}

/// Writes the beams of a log's laser to its record.
void setBeams(Record& record, const LoggedRun& run, std::size_t sensor) {
    for (const MeasuredScan& scan : run.scans) {
        if (scan.sensor != sensor || scan.scan == nullptr) continue;
        // Ranges of logs are float32.
        constexpr int kDigits = 6;
        record.set("range", Tuple{roundSignificant(run.sensors[sensor].min_range, kDigits),
                                  roundSignificant(run.sensors[sensor].max_range, kDigits)});
        record.set("first", nineDecimals(scan.scan->first.degrees()));
        record.set("step", nineDecimals(scan.scan->step.degrees()));
        record.set("beams", static_cast<double>(scan.ranges().size()));
        return;
    }
}

Record sensorRecord(const SensorFit& fit, const LoggedRun& run, const Scene& scene) {
    std::size_t index = 0;
    while (run.sensors[index].id != fit.sensor) ++index;
    const MeasuredSensor& sensor = run.sensors[index];
    std::optional<Record> record;
    if (fit.known != nullptr) record = recordOf(scene, fit.known->id);
    if (record && !sensor.stands)
        for (const char* key : {"at", "on", "heading", "tilt", "roll"})
            if (record->has(key)) record->erase(key);
    if (!record) {
        const bool is_ranger = fit.known != nullptr && fit.known->is<Ranger>();
        record.emplace(*sceneSchemas().find(is_ranger ? "ranger" : "laser"));
        record->set("id", wordOf(fit.sensor));
        if (fit.known != nullptr && !deviceName(fit.known->model).empty())
            record->set("model", deviceName(fit.known->model));
        else if (!is_ranger)
            setBeams(*record, run, index);
    }
    setNoise(*record, fit.fit, fit.dropout, fit.resolution);
    return *record;
}

}  // namespace

/// Most likely ramp between two angles of incidence, by whole degrees: all pairs of even ones, then
/// the neighbours of the best. It must beat a flat share by log(samples), as BIC counts two
/// parameters. The error is binomial and holds for a given ramp.
DropoutFit fitDropout(std::span<const BeamSample> samples) {
    IncidenceCounts counts;
    double lost = 0;
    for (const BeamSample& sample : samples) {
        const double degrees =
            Angle::radians(std::acos(std::clamp(sample.cosine, 0.0, 1.0))).degrees();
        const auto degree =
            std::min(IncidenceCounts::kDegrees - 1, static_cast<std::size_t>(degrees));
        counts.all[degree] += 1;
        if (!sample.isReturn()) {
            counts.lost[degree] += 1;
            lost += 1;
        }
    }
    const double all = static_cast<double>(samples.size());
    DropoutFit fit;
    if (samples.empty()) return fit;
    const auto [flat, share] = bestDropout(counts, 90, 90);
    fit.dropout = share;
    fit.error = std::sqrt(share * (1 - share) / all);
    constexpr double kLeastLost = 20;
    if (lost < kLeastLost) return fit;
    double best = flat + std::log(all);  // two parameters more
    constexpr int kStep = 2, kMost = 90;
    const auto try_ramp = [&](int from, int to) {
        const auto [likelihood, d] = bestDropout(counts, from, to);
        if (likelihood <= best) return;
        best = likelihood;
        fit.dropout = d;
        fit.error = std::sqrt(d * (1 - d) / all);
        fit.graze = {Angle::degrees(from), Angle::degrees(to)};
    };
    for (int from = 0; from < kMost; from += kStep)
        for (int to = from + kStep; to <= kMost; to += kStep) try_ramp(from, to);
    if (fit.graze) {
        const int from = static_cast<int>(fit.graze->first.degrees());
        const int to = static_cast<int>(fit.graze->second.degrees());
        for (int f = std::max(0, from - 1); f <= from + 1; ++f)
            for (int t = std::max(f, to - 1); t <= std::min(kMost, to + 1); ++t) try_ramp(f, t);
    }
    return fit;
}

/// The held-out likelihood is of odd scans under a fit to the even ones, but with the terms that
/// the fit to all scans has chosen.
std::vector<SensorFit> fitSensors(const LoggedRun& run) {
    std::vector<SensorFit> fits;
    for (std::size_t sensor = 0; sensor < run.sensors.size(); ++sensor) {
        std::vector<std::size_t> all, even, odd;
        for (std::size_t i = 0; i < run.scans.size(); ++i) {
            if (run.scans[i].sensor != sensor) continue;
            (all.size() % 2 == 0 ? even : odd).push_back(i);
            all.push_back(i);
        }
        // Measured ranges beyond a limit become the limit.
        constexpr double kMargin = 0.05;
        const std::vector<BeamSample> samples = evenShare(samplesOf(run, all, kMargin));
        if (samples.empty()) continue;
        SensorFit fit;
        fit.sensor = run.sensors[sensor].id;
        if (run.sensors[sensor].known) fit.known = &*run.sensors[sensor].known;
        fit.fit = fitBeams(samples);
        fit.dropout = fitDropout(samples);
        fit.resolution = resolutionOf(run, sensor);
        const std::vector<BeamSample> held = evenShare(samplesOf(run, odd, kMargin));
        if (!held.empty()) {
            const BeamFit of_even =
                fitBeams(evenShare(samplesOf(run, even, kMargin)), fit.fit.terms);
            fit.held_out = of_even.model.meanLogLikelihood(held);
            fit.held_out_beams = held.size();
            if (fit.known != nullptr)
                if (const auto known = knownModel(*fit.known))
                    fit.held_out_known = known->meanLogLikelihood(held);
        }
        fits.push_back(std::move(fit));
    }
    return fits;
}

/// Squared errors of turn and way are regressed on their causes and a constant, which is the
/// variance of the corrected poses themselves.
std::optional<OdometryFit> fitOdometry(const Log& log) {
    const std::vector<OdometryMotion> motions = motionsOf(log);
    constexpr std::size_t kLeast = 20;
    if (motions.size() < kLeast) return std::nullopt;
    const auto count = static_cast<Eigen::Index>(motions.size());
    Eigen::VectorXd turn(count), way(count);
    Eigen::MatrixXd causes(count, 3), squares(count, 3);
    double turn_sum = 0, way_sum = 0, turn_errors = 0, way_errors = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
        const OdometryMotion& motion = motions[static_cast<std::size_t>(i)];
        turn(i) = wrapped(motion.truth.heading - motion.odometry.heading).radians();
        way(i) = forward(motion.truth) - forward(motion.odometry);
        causes.row(i) << motion.turns, motion.ways, 1;
        const double net_turn = motion.odometry.heading.radians();
        const double net_way = std::hypot(motion.odometry.position.x, motion.odometry.position.y);
        squares.row(i) << net_turn * net_turn, net_way * net_way, 1;
        turn_sum += net_turn * net_turn;
        turn_errors += turn(i) * net_turn;
        way_sum += net_way * net_way;
        way_errors += way(i) * net_way;
    }
    OdometryFit fit;
    fit.motions = motions.size();
    fit.scale_turn = turn_sum > 0 ? turn_errors / turn_sum : 0;
    fit.scale_way = way_sum > 0 ? way_errors / way_sum : 0;
    const Eigen::VectorXd turn2 = squaresOf(turn, causes), way2 = squaresOf(way, causes);
    const auto take = [&](const Eigen::MatrixXd& of, std::array<double, 4>& alphas,
                          std::array<double, 4>& errors) {
        const VarianceFit turns = fitVariance(of, turn2), ways = fitVariance(of, way2);
        // Alpha 3 is of the way by the way, alpha 4 of the way by turns.
        alphas = {turns.values(0), turns.values(1), ways.values(1), ways.values(0)};
        errors = {turns.errors(0), turns.errors(1), ways.errors(1), ways.errors(0)};
        return std::pair(std::sqrt(turns.values(2)), std::sqrt(ways.values(2)));
    };
    std::tie(fit.turn_error, fit.way_error) = take(causes, fit.alphas, fit.errors);
    static_cast<void>(take(squares, fit.thrun, fit.thrun_errors));
    const Eigen::MatrixXd sizes = squares.leftCols(2).cwiseSqrt();
    const VarianceFit turns = fitDeviation(sizes, turn2);
    const VarianceFit ways = fitDeviation(sizes, way2);
    fit.carmen = {turns.values(0), turns.values(1), ways.values(1), ways.values(0)};
    fit.carmen_errors = {turns.errors(0), turns.errors(1), ways.errors(1), ways.errors(0)};
    return fit;
}

/// Pairs each burst with the receivers that should hear it in the scene without people, 5 cm short
/// of their limit; such a receiver that is not in the log has missed it.
std::vector<UltrasoundFit> fitUltrasound(const Log& log, const Scene& scene, RayScenes& worlds) {
    std::vector<Sensor> receivers = sensorsOf<Receiver>(scene);
    const std::vector<Sensor> tags = sensorsOf<Tag>(scene);
    std::map<std::string, std::vector<BeamSample>> samples;
    if (log.bursts.empty() || receivers.empty()) return {};
    const Surfaces surfaces = Tag::kKind.stopped_by;
    worlds.prepareMesh(surfaces);
    const MovingBodies bodies;
    for (const LogBurst& burst : log.bursts) {
        const auto tag = std::find_if(tags.begin(), tags.end(),
                                      [&](const Sensor& each) { return each.id == burst.sensor; });
        if (tag == tags.end()) continue;
        Sensor placed = *tag;
        if (burst.corrected) placed.pose = *burst.corrected;
        const Burst expected =
            castBurst(worlds.mesh(surfaces), bodies, placed, receivers, 0, burst.time, {});
        for (const TimeOfFlight& flight : expected.heard) {
            const Sensor& receiver = receivers[flight.receiver];
            BeamSample sample{.measured = std::numeric_limits<double>::infinity(),
                              .expected = flight.distance,
                              .cosine = 1,
                              .limit = receiver.as<Receiver>().max_range,
                              .edge_near = 0,
                              .edge_far = 0};
            for (const auto& [id, distance] : burst.heard)
                if (id == receiver.id) sample.measured = distance;
            constexpr double kMargin = 0.05;
            if (sample.expected < sample.limit - kMargin) samples[receiver.id].push_back(sample);
        }
    }
    std::vector<UltrasoundFit> fits;
    for (const Sensor& receiver : receivers) {
        constexpr std::size_t kLeast = 20;
        const std::vector<BeamSample>& of = samples[receiver.id];
        if (of.size() < kLeast) continue;
        UltrasoundFit fit;
        fit.receiver = receiver.id;
        for (const Sensor& each : scene.sensors)
            if (each.id == receiver.id) fit.known = &each;
        fit.fit = fitBeams(of);
        fits.push_back(std::move(fit));
    }
    return fits;
}

std::string fittedLayout(const std::vector<SensorFit>& sensors,
                         const std::vector<UltrasoundFit>& ultrasound,
                         const std::optional<OdometryFit>& odometry, const LoggedRun& run,
                         const Scene& scene, const std::string& history_line) {
    Document document{.kind = DocumentKind::Layout, .history = {history_line}, .records = {}};
    std::string comments = "# standard errors, and what a record does not hold:\n";
    for (const SensorFit& fit : sensors) {
        const Record record = sensorRecord(fit, run, scene);
        comments += "# " + record.writtenId() + ": " + std::to_string(fit.fit.samples) +
                    " beams, mean log-likelihood " +
                    formatDouble(significant(fit.fit.log_likelihood)) + "\n" + commentOf(fit.fit);
        comments += "#   dropout " + withError(fit.dropout.dropout, fit.dropout.error) + "\n";
        if (fit.held_out_beams > 0) {
            comments += "#   held-out log-likelihood " + formatDouble(significant(fit.held_out)) +
                        " (odd scans, " + std::to_string(fit.held_out_beams) + " beams)";
            if (fit.held_out_known != 0)
                comments +=
                    ", of the noise before " + formatDouble(significant(fit.held_out_known));
            comments += "\n";
        }
        document.records.push_back(record);
    }
    for (const UltrasoundFit& fit : ultrasound) {
        std::optional<Record> record = recordOf(scene, fit.receiver);
        if (!record) continue;
        DropoutFit dropout;
        dropout.dropout = fit.fit.model.max;
        setNoise(*record, fit.fit, dropout, 0);
        comments += "# " + fit.receiver + ": " + std::to_string(fit.fit.samples) + " bursts\n" +
                    commentOf(fit.fit);
        document.records.push_back(std::move(*record));
    }
    if (odometry) {
        const OdometryFit& fit = *odometry;
        Record robot(*sceneSchemas().find("robot"));
        robot.set("id", std::string("robot"));
        Tuple alphas;
        for (const double alpha : fit.alphas) alphas.push_back(significant(alpha));
        robot.set("odometry_noise", alphas);
        comments += "# robot: " + std::to_string(fit.motions) + " motions; alphas";
        for (std::size_t k = 0; k < fit.alphas.size(); ++k)
            comments += (k == 0 ? " " : ", ") + withError(fit.alphas[k], fit.errors[k]);
        comments += "\n#   for variances alpha d^2 of single motions";
        for (std::size_t k = 0; k < fit.thrun.size(); ++k)
            comments += (k == 0 ? " " : ", ") + withError(fit.thrun[k], fit.thrun_errors[k]);
        comments += "\n#   for CARMEN's deviations alpha |d| of single motions";
        for (std::size_t k = 0; k < fit.carmen.size(); ++k)
            comments += (k == 0 ? " " : ", ") + withError(fit.carmen[k], fit.carmen_errors[k]);
        comments += "\n#   systematic: " + formatDouble(significant(fit.scale_turn)) +
                    " a radian, " + formatDouble(significant(fit.scale_way)) +
                    " a metre; corrected poses " + formatDouble(significant(fit.turn_error)) +
                    " rad, " + formatDouble(significant(fit.way_error)) + " m\n";
        document.records.push_back(std::move(robot));
    }
    return writeRecordText(document) + comments;
}

}  // namespace ispace::reality
