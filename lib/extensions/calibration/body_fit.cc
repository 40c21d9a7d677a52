// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of fitToBodies():
//
// 1. Foreground: the densest half of a beam's ranges, the shortest interval that holds half of them
//    (Rousseeuw and Leroy, Robust Regression, 1987), is the room; shorter beams by six standard
//    deviations, 50 mm at least, are on a body.
// 2. Discs: runs of neighbouring beams, four at least, are fitted by Gauss and Newton; errors are
//    along the beams, so that a grazing beam weighs more, at most 16 times. A disc counts if its
//    mean squared residual is below four variances.
// 3. Moments: scans of several lasers within half a scan's time, 50 ms at most.
// 4. Start: rigid motions of pairs of places (Procrustes in the plane) by RANSAC (Fischler and
//    Bolles, 1981), 400 draws, 0.25 m; lasers join the first one in the order of agreement.
// 5. Fit: ten rounds at most of grouping (within 0.15 m, then 0.08 m), Cauchy weights and Levenberg
//    and Marquardt. The place of each leg is linear given the poses, and is put in by its minimum;
//    so the search has three parameters for each laser but the first one, and one for the radius.
//
// The fit is refused where the least eigenvalue of the information allows 0.5 m or rad.
#include "extensions/calibration/body_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <unsupported/Eigen/NonLinearOptimization>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "extensions/calibration/least_squares.h"
#include "scene/bodies.h"
#include "sense/scan.h"

namespace ispace::calibration {

namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Height of the people before the fit.
constexpr double kUsualHeight = 1.75;

[[noreturn]] void refuseBodies(std::string message) {
    throw FormatError(Diagnostic{"", 0, 0, std::move(message)});
}

/// The leg of humanParts() at a height of 1 m.
struct LegShape {
    double radius = 0, hip = 0;
};
LegShape legShape() {
    for (const BodyPart& part : humanParts(1))
        if (part.bottom == 0 && part.radius > 0) return {part.radius, part.top};
    return {};
}

/// A leg, or the middle of both, in a scan: a normal likelihood of its centre, in the laser's
/// frame.
struct LegView {
    std::size_t laser = 0;
    double time = 0;
    Vector2d centre = Vector2d::Zero();
    Vector2d away = Vector2d::Zero();  ///< unit vector from the laser
    Matrix2d covariance = Matrix2d::Zero();
    Vector2d velocity = Vector2d::Zero();
};

/// The legs in one scan.
struct LegScan {
    std::size_t laser = 0;
    double time = 0;
    std::vector<LegView> legs;
};

/// Ranges below which a beam is on a person.
std::vector<double> foregroundOf(const WatchingLaser& laser) {
    const auto& model = laser.sensor.as<Laser>();
    std::vector<double> limits(static_cast<std::size_t>(model.beams));
    std::vector<double> values;
    for (std::size_t k = 0; k < limits.size(); ++k) {
        values.clear();
        for (const std::vector<float>& scan : laser.scans)
            values.push_back(std::isfinite(scan[k]) ? static_cast<double>(scan[k]) : 1e6);
        std::sort(values.begin(), values.end());
        const std::size_t half = values.size() / 2;
        std::size_t best = 0;
        for (std::size_t i = 0; i + half < values.size(); ++i)
            if (values[i + half] - values[i] < values[best + half] - values[best]) best = i;
        const double scatter = (values[best + half] - values[best]) / 1.349;
        constexpr double kLeast = 0.05;
        limits[k] = values[best] - std::max(6 * scatter, kLeast);
    }
    return limits;
}

/// Fits the centre of a disc of known radius to points on its outline, each with the error `sigma`
/// along its beam. Empty if it is no disc.
std::optional<LegView> fittedDisc(std::span<const Vector2d> points, double radius, double sigma) {
    Vector2d middle = Vector2d::Zero();
    for (const Vector2d& point : points) middle += point;
    middle /= static_cast<double>(points.size());
    Vector2d centre = middle + 0.8 * radius * middle.normalized();
    Matrix2d information = Matrix2d::Identity();
    double squares = 0;
    for (int round = 0; round < 8; ++round) {
        information.setZero();
        Vector2d gradient = Vector2d::Zero();
        squares = 0;
        for (const Vector2d& point : points) {
            const Vector2d off = point - centre;
            const double length = off.norm();
            if (length < 1e-6) return std::nullopt;
            const Vector2d normal = off / length;
            constexpr double kGrazing = 0.25;
            const double cosine = std::max(std::abs(normal.dot(point.normalized())), kGrazing);
            const double weight = 1 / (sigma * sigma * cosine * cosine);
            const double residual = length - radius;
            information += weight * normal * normal.transpose();
            gradient += weight * residual * normal;
            squares += weight * residual * residual;
        }
        const Vector2d step = information.ldlt().solve(gradient);
        if (!step.allFinite() || step.norm() > 1) return std::nullopt;
        centre += step;
        if (step.norm() < 1e-6) break;
    }
    // The disc lies behind the points.
    if (centre.norm() < middle.norm() || (centre - middle).norm() > radius) return std::nullopt;
    constexpr double kWorst = 4;
    if (squares > kWorst * static_cast<double>(points.size())) return std::nullopt;
    LegView leg;
    leg.centre = centre;
    leg.away = centre.normalized();
    // Millimetres that no model of a body gets right.
    constexpr double kModel = 0.002;
    leg.covariance = information.inverse() + kModel * kModel * Matrix2d::Identity();
    return leg;
}

/// Takes the velocity of each leg, or of the middle of two, from its nearest neighbours in the
/// scans before and after. \param speed the highest that is expected, m/s
void addVelocities(std::vector<LegScan>& scans, double speed) {
    const auto nearest = [speed](const LegScan& scan, const LegView& leg) -> const LegView* {
        const LegView* found = nullptr;
        constexpr double kLeast = 0.05;
        double least = std::max(kLeast, speed * std::abs(scan.time - leg.time));
        for (const LegView& other : scan.legs)
            if (const double off = (other.centre - leg.centre).norm(); off < least) {
                least = off;
                found = &other;
            }
        return found;
    };
    for (std::size_t i = 0; i < scans.size(); ++i)
        for (LegView& leg : scans[i].legs) {
            const LegView* before = i > 0 ? nearest(scans[i - 1], leg) : nullptr;
            const LegView* after = i + 1 < scans.size() ? nearest(scans[i + 1], leg) : nullptr;
            if (before == nullptr) before = &leg;
            if (after == nullptr) after = &leg;
            if (after->time > before->time)
                leg.velocity = (after->centre - before->centre) / (after->time - before->time);
        }
}

/// Finds the legs in the scans of a laser.
class LegFinder {
  public:
    LegFinder(const WatchingLaser& laser, std::size_t index, double radius)
        : laser_(laser), index_(index), limits_(foregroundOf(laser)), radius_(radius) {
        const auto& model = laser.sensor.as<Laser>();
        for (int k = 0; k < model.beams; ++k) {
            const Vec2 way = unitVector(model.bearing(k));
            ways_.emplace_back(way.x, way.y);
        }
    }

    [[nodiscard]] std::vector<LegScan> all() const {
        std::vector<LegScan> scans;
        for (std::size_t i = 0; i < laser_.scans.size(); ++i)
            scans.push_back({index_, laser_.times[i], legsOf(i)});
        constexpr double kFoot = 3;
        addVelocities(scans, kFoot);
        return scans;
    }

  private:
    [[nodiscard]] std::vector<LegView> legsOf(std::size_t scan) const {
        const std::vector<float>& ranges = laser_.scans[scan];
        std::vector<LegView> legs;
        for (std::size_t begin = 0; begin < ranges.size();) {
            if (!isOnPerson(ranges, begin)) {
                ++begin;
                continue;
            }
            std::size_t end = begin + 1;
            constexpr double kJump = 0.08;  // from one leg to the other
            while (end < ranges.size() && isOnPerson(ranges, end) &&
                   std::abs(ranges[end] - ranges[end - 1]) < kJump)
                ++end;
            addLeg(scan, begin, end, legs);
            begin = end;
        }
        return legs;
    }
    [[nodiscard]] bool isOnPerson(const std::vector<float>& ranges, std::size_t k) const {
        return ranges[k] > 0 && ranges[k] < limits_[k];
    }

    void addLeg(std::size_t scan, std::size_t begin, std::size_t end,
                std::vector<LegView>& legs) const {
        constexpr std::size_t kFewest = 4;
        if (end - begin < kFewest) return;
        const auto& model = laser_.sensor.as<Laser>();
        std::vector<Vector2d> points;
        for (std::size_t k = begin; k < end; ++k)
            points.emplace_back((laser_.scans[scan][k] - model.noise.bias) * ways_[k]);
        const double radius = radius_;
        if ((points.front() - points.back()).norm() > 2.4 * radius) return;
        const double range = points[points.size() / 2].norm();
        const auto& [s0, s1, s2] = model.noise.sigma;
        constexpr double kLeastSigma = 0.002;
        const double sigma = std::max(kLeastSigma, s0 + range * (s1 + range * s2));
        auto leg = fittedDisc(points, radius, sigma);
        if (!leg) return;
        leg->laser = index_;
        leg->time = laser_.times[scan];
        if (model.spin != 0) leg->time += model.timeOf(static_cast<int>((begin + end) / 2));
        legs.push_back(*leg);
    }

    const WatchingLaser& laser_;
    std::size_t index_;
    std::vector<double> limits_;
    double radius_;
    std::vector<Vector2d> ways_;
};

/// Feet of a person are not farther apart.
constexpr double kStride = 0.6;

LegView middleOf(const LegView& one, const LegView& other) {
    LegView both = one;
    both.time = 0.5 * (one.time + other.time);
    both.centre = 0.5 * (one.centre + other.centre);
    both.away = 0.5 * (one.away + other.away);
    both.covariance = 0.25 * (one.covariance + other.covariance);
    both.velocity = 0.5 * (one.velocity + other.velocity);
    return both;
}

/// Replaces two legs of a scan by their middle; scans with another number of legs are emptied.
void joinLegs(std::vector<LegScan>& scans) {
    for (LegScan& scan : scans) {
        if (scan.legs.size() != 2 || (scan.legs[0].centre - scan.legs[1].centre).norm() > kStride) {
            scan.legs.clear();
            continue;
        }
        scan.legs[0] = middleOf(scan.legs[0], scan.legs[1]);
        scan.legs.pop_back();
    }
}

/// Scans of several lasers at about one time, each laser at most once.
using LegMoment = std::vector<const LegScan*>;

std::vector<LegMoment> momentsOf(const std::vector<std::vector<LegScan>>& scans) {
    std::vector<const LegScan*> all;
    std::vector<double> steps;
    for (const std::vector<LegScan>& one : scans)
        for (std::size_t i = 0; i < one.size(); ++i) {
            if (i > 0) steps.push_back(one[i].time - one[i - 1].time);
            if (!one[i].legs.empty()) all.push_back(&one[i]);
        }
    if (steps.empty()) return {};
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                     steps.end());
    constexpr double kLongest = 0.05;  // a foot moves by 0.15 m
    const double within = std::min(0.5 * steps[steps.size() / 2], kLongest);
    std::stable_sort(all.begin(), all.end(),
                     [](const LegScan* a, const LegScan* b) { return a->time < b->time; });
    std::vector<LegMoment> moments;
    LegMoment moment;
    const auto finish = [&] {
        if (moment.size() > 1) moments.push_back(moment);
        moment.clear();
    };
    for (const LegScan* scan : all) {
        const bool is_later = !moment.empty() && scan->time - moment.front()->time > within;
        const bool is_again = std::any_of(moment.begin(), moment.end(), [&](const LegScan* one) {
            return one->laser == scan->laser;
        });
        if (is_later || is_again) finish();
        moment.push_back(scan);
    }
    finish();
    return moments;
}

/// A rigid motion of the plane: x, y, angle.
using Motion = Vector3d;

Vector2d moved(const Motion& motion, const Vector2d& point) {
    return Eigen::Rotation2Dd(motion[2]) * point + motion.head<2>();
}

/// Returns the rigid motion that maps the first points nearest to the second ones (Procrustes).
Motion rigidMotion(std::span<const std::pair<Vector2d, Vector2d>> pairs) {
    Vector2d from = Vector2d::Zero(), to = Vector2d::Zero();
    for (const auto& [a, b] : pairs) {
        from += a;
        to += b;
    }
    from /= static_cast<double>(pairs.size());
    to /= static_cast<double>(pairs.size());
    double cosine = 0, sine = 0;
    for (const auto& [a, b] : pairs) {
        const Vector2d p = a - from, q = b - to;
        cosine += p.dot(q);
        sine += p[0] * q[1] - p[1] * q[0];
    }
    const double angle = std::atan2(sine, cosine);
    const Vector2d shift = to - Eigen::Rotation2Dd(angle) * from;
    return {shift[0], shift[1], angle};
}

/// Pairs of positions of one person in the frames of two lasers.
using PlacePairs = std::vector<std::pair<Vector2d, Vector2d>>;

/// Returns the motion on which most of the pairs agree, and their number.
std::pair<Motion, std::size_t> agreedMotion(const PlacePairs& pairs) {
    constexpr double kNear = 0.25, kApart = 0.7;
    constexpr int kTries = 400;
    std::mt19937 random(1);
    Motion best = Motion::Zero();
    std::size_t most = 0;
    const auto near = [&](const Motion& motion) {
        PlacePairs found;
        for (const auto& pair : pairs)
            if ((moved(motion, pair.first) - pair.second).norm() < kNear) found.push_back(pair);
        return found;
    };
    for (int i = 0; i < kTries && pairs.size() > 1; ++i) {
        const auto& a = pairs[random() % pairs.size()];
        const auto& b = pairs[random() % pairs.size()];
        if ((a.first - b.first).norm() < kApart) continue;
        const std::array<std::pair<Vector2d, Vector2d>, 2> two{a, b};
        const Motion motion = rigidMotion(two);
        const std::size_t count = near(motion).size();
        if (count > most) {
            most = count;
            best = motion;
        }
    }
    for (int i = 0; i < 3 && most > 1; ++i) best = rigidMotion(near(best));
    return {best, most};
}

/// Returns the middle of the legs of a scan that sees one person alone.
std::optional<Vector2d> onePlace(const LegScan& scan) {
    Vector2d middle = Vector2d::Zero();
    for (const LegView& leg : scan.legs) middle += leg.centre;
    middle /= static_cast<double>(scan.legs.size());
    constexpr double kHalfStride = 0.35;
    for (const LegView& leg : scan.legs)
        if ((leg.centre - middle).norm() > kHalfStride) return std::nullopt;
    return middle;
}

/// Legs of different lasers that are one.
struct LegGroup {
    std::vector<const LegView*> views;
    double time = 0;
    double weight = 1;  ///< robust
};

/// The likelihood of poses, as Eigen's Levenberg and Marquardt takes it. Parameters: x, y, angle of
/// each laser but the first one, and the difference of the leg's radius to the usual one.
struct BodyFunctor {
    using Scalar = double;
    enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };
    using InputType = VectorXd;
    using ValueType = VectorXd;
    using JacobianType = MatrixXd;

    std::span<const LegGroup> groups;
    int lasers = 0, rows = 0;

    [[nodiscard]] int inputs() const { return 3 * (lasers - 1) + 1; }
    [[nodiscard]] int values() const { return rows; }
    static Motion motionOf(const VectorXd& x, std::size_t laser) {
        return laser == 0 ? Motion::Zero().eval()
                          : Motion(x.segment<3>(3 * (static_cast<Eigen::Index>(laser) - 1)));
    }
    /// Residuals of a group, by their standard deviations, about its most likely position.
    void residualsOf(const LegGroup& group, const VectorXd& x, double* values) const {
        constexpr std::size_t kMost = 64;
        std::array<Vector2d, kMost> places;
        std::array<Matrix2d, kMost> weights;
        Matrix2d sum = Matrix2d::Zero();
        Vector2d weighted = Vector2d::Zero();
        const std::size_t count = std::min(group.views.size(), kMost);
        const double wider = x[x.size() - 1];
        for (std::size_t i = 0; i < count; ++i) {
            const LegView& view = *group.views[i];
            const Motion motion = motionOf(x, view.laser);
            const Matrix2d turn = Eigen::Rotation2Dd(motion[2]).toRotationMatrix();
            places[i] = turn * (view.centre + wider * view.away +
                                (group.time - view.time) * view.velocity) +
                        motion.head<2>();
            weights[i] = (turn * view.covariance * turn.transpose()).inverse();
            sum += weights[i];
            weighted += weights[i] * places[i];
        }
        const Vector2d place = sum.ldlt().solve(weighted);
        const double root = std::sqrt(group.weight);
        for (std::size_t i = 0; i < count; ++i) {
            const Vector2d off = Eigen::LLT<Matrix2d>(weights[i]).matrixU() * (places[i] - place);
            values[2 * i] = root * off[0];
            values[2 * i + 1] = root * off[1];
        }
    }
    int operator()(const VectorXd& x, VectorXd& values) const {
        Eigen::Index row = 0;
        for (const LegGroup& group : groups) {
            residualsOf(group, x, &values[row]);
            row += 2 * static_cast<Eigen::Index>(group.views.size());
        }
        return 0;
    }
    int df(const VectorXd& x, MatrixXd& slopes) const {
        centralSlopes(*this, x, slopes);
        return 0;
    }
};

/// Fits the poses of lasers to each other.
class BodyFitter {
  public:
    BodyFitter(std::span<const WatchingLaser> lasers, const BodyTarget& target)
        : lasers_(lasers),
          target_(target),
          radius_(target.isPerson() ? legShape().radius * kUsualHeight : target.radius) {
        for (std::size_t i = 0; i < lasers.size(); ++i)
            scans_.push_back(LegFinder(lasers[i], i, radius_).all());
        const auto height = [&](std::size_t i) { return lasers[i].sensor.pose.position.z; };
        constexpr double kLevel = 0.01;
        for (std::size_t i = 0; i < lasers.size(); ++i) {
            // Legs of other heights, or at other times: they swing faster than their owner walks.
            if (std::abs(height(i) - height(0)) > kLevel) joins_ = true;
            if (lasers[i].sensor.as<Laser>().spin != 0) joins_ = true;
        }
        if (joins_ && target.isPerson())
            for (std::vector<LegScan>& one : scans_) {
                joinLegs(one);
                constexpr double kWalk = 2;
                addVelocities(one, kWalk);
            }
        moments_ = momentsOf(scans_);
    }

    BodyFit fit() {
        VectorXd x = start();
        std::vector<LegGroup> groups;
        constexpr int kRounds = 10;
        for (int round = 0; round < kRounds; ++round) {
            groups = grouped(x, round < 3 ? 0.15 : 0.08);
            weigh(groups, x);
            BodyFunctor functor = functorOf(groups);
            if (functor.values() < functor.inputs()) refuseBodies(undetermined(1));
            Eigen::LevenbergMarquardt<BodyFunctor> search(functor);
            search.parameters.maxfev = 20;
            const VectorXd before = x;
            search.minimize(x);
            if (round > 4 && (x - before).norm() < 1e-6) break;
        }
        return described(x, groups);
    }

  private:
    [[nodiscard]] BodyFunctor functorOf(std::span<const LegGroup> groups) const {
        std::size_t rows = 0;
        for (const LegGroup& group : groups) rows += 2 * group.views.size();
        return {groups, static_cast<int>(lasers_.size()), static_cast<int>(rows)};
    }

    [[nodiscard]] std::string bodies() const { return target_.isPerson() ? "people" : "robots"; }

    [[nodiscard]] std::string undetermined(std::size_t laser) const {
        return "the ways of the " + bodies() + " do not determine how " + lasers_[laser].sensor.id +
               " stands to " + lasers_[0].sensor.id;
    }

    /// Joins laser after laser to the first one, each by the pair with the most agreeing positions.
    [[nodiscard]] VectorXd start() const {
        const std::size_t count = lasers_.size();
        std::vector<std::vector<PlacePairs>> pairs(count, std::vector<PlacePairs>(count));
        for (const LegMoment& moment : moments_)
            for (const LegScan* a : moment)
                for (const LegScan* b : moment) {
                    if (a == b) continue;
                    const auto from = onePlace(*a), to = onePlace(*b);
                    if (from && to) pairs[a->laser][b->laser].emplace_back(*from, *to);
                }
        std::vector<std::optional<Motion>> known(count);
        known[0] = Motion::Zero();
        for (std::size_t joined = 1; joined < count; ++joined) {
            std::size_t most = 0, next = 0;
            Motion best = Motion::Zero();
            for (std::size_t a = 0; a < count; ++a)
                for (std::size_t b = 0; b < count; ++b) {
                    if (known[a] || !known[b]) continue;
                    const auto [motion, agree] = agreedMotion(pairs[a][b]);
                    if (agree <= most) continue;
                    most = agree;
                    next = a;
                    const Vector2d place = moved(*known[b], motion.head<2>());
                    best = {place[0], place[1], (*known[b])[2] + motion[2]};
                }
            constexpr std::size_t kFewest = 10;
            if (most < kFewest) refuseBodies(apart(known));
            known[next] = best;
        }
        VectorXd x = VectorXd::Zero(3 * static_cast<Eigen::Index>(count - 1) + 1);
        for (std::size_t i = 1; i < count; ++i)
            x.segment<3>(3 * static_cast<Eigen::Index>(i - 1)) = *known[i];
        return x;
    }

    [[nodiscard]] std::string apart(const std::vector<std::optional<Motion>>& known) const {
        for (std::size_t i = 0; i < known.size(); ++i)
            if (!known[i])
                return bodies() + (target_.isPerson() ? " walk" : " drive") +
                       " too little in sight of " + lasers_[i].sensor.id +
                       " and another laser at one time";
        return "";
    }

    /// Joins legs of different lasers within `gate` metres.
    [[nodiscard]] std::vector<LegGroup> grouped(const VectorXd& x, double gate) const {
        std::vector<LegGroup> groups;
        std::vector<std::pair<LegGroup, Vector2d>> open;
        for (const LegMoment& moment : moments_) {
            open.clear();
            for (const LegScan* scan : moment)
                for (const LegView& leg : scan->legs) {
                    const Vector2d place = moved(BodyFunctor::motionOf(x, leg.laser), leg.centre);
                    std::pair<LegGroup, Vector2d>* nearest = nullptr;
                    double least = gate;
                    for (auto& group : open) {
                        const bool has = std::any_of(
                            group.first.views.begin(), group.first.views.end(),
                            [&](const LegView* view) { return view->laser == leg.laser; });
                        const double off = (group.second - place).norm();
                        if (has || off >= least) continue;
                        least = off;
                        nearest = &group;
                    }
                    if (nearest == nullptr) {
                        open.push_back({{{&leg}, 0, 1}, place});
                    } else {
                        nearest->first.views.push_back(&leg);
                    }
                }
            for (auto& [group, place] : open) {
                if (group.views.size() < 2) continue;
                for (const LegView* view : group.views) group.time += view->time;
                group.time /= static_cast<double>(group.views.size());
                groups.push_back(std::move(group));
            }
        }
        return groups;
    }

    /// Sets robust weights (Cauchy) by the residuals.
    void weigh(std::span<LegGroup> groups, const VectorXd& x) const {
        const BodyFunctor functor = functorOf(groups);
        std::vector<double> sizes;
        VectorXd values(functor.values());
        functor(x, values);
        Eigen::Index row = 0;
        for (const LegGroup& group : groups) {
            const auto count = 2 * static_cast<Eigen::Index>(group.views.size());
            sizes.push_back(values.segment(row, count).squaredNorm() /
                            static_cast<double>(count - 2));
            row += count;
        }
        // Half of a squared normal variable, of two degrees, lies below 0.69.
        const std::vector<double> weights = cauchyWeights(sizes, 0.69);
        for (std::size_t i = 0; i < groups.size(); ++i) groups[i].weight = weights[i];
    }

    [[nodiscard]] BodyFit described(const VectorXd& x, std::span<const LegGroup> groups) const {
        const BodyFunctor functor = functorOf(groups);
        MatrixXd slopes(functor.values(), functor.inputs());
        VectorXd values(functor.values());
        functor(x, values);
        functor.df(x, slopes);
        double used = 0;
        for (const LegGroup& group : groups)
            used += group.weight * static_cast<double>(2 * group.views.size() - 2);
        const double free = std::max(1.0, used - static_cast<double>(functor.inputs()));
        const double variance = values.squaredNorm() / free;
        const MatrixXd information = slopes.transpose() * slopes / std::max(variance, 1e-6);
        const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(information);
        constexpr double kUnknown = 0.5;  // metres or radians: half the room
        if (!(solver.eigenvalues()[0] * kUnknown * kUnknown > 1)) {
            Eigen::Index worst = 0;
            solver.eigenvectors().col(0).cwiseAbs().maxCoeff(&worst);
            refuseBodies(undetermined(std::min<std::size_t>(static_cast<std::size_t>(worst) / 3 + 1,
                                                            lasers_.size() - 1)));
        }
        const MatrixXd covariance = information.inverse();
        BodyFit fit;
        fit.scatter = std::sqrt(variance);
        fit.moments = moments_.size();
        fit.legs.assign(lasers_.size(), 0);
        for (const LegGroup& group : groups)
            for (const LegView* view : group.views) ++fit.legs[view->laser];
        fit.radius = radius_ + x[x.size() - 1];
        fit.radius_sigma = std::sqrt(covariance(covariance.rows() - 1, covariance.cols() - 1));
        if (target_.isPerson()) {
            const double radius = legShape().radius;
            fit.height = fit.radius / radius;
            fit.height_sigma = fit.radius_sigma / radius;
        }
        addPoses(x, covariance, fit);
        return fit;
    }

    /// Puts the motions before the pose of the first laser.
    void addPoses(const VectorXd& x, const MatrixXd& covariance, BodyFit& fit) const {
        const Pose3& first = lasers_[0].sensor.pose;
        const Pose2 frame{first.position.onFloor(), first.heading};
        const double turn = first.heading.radians();
        Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
        axes.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(turn).toRotationMatrix();
        for (std::size_t i = 0; i < lasers_.size(); ++i) {
            const Motion motion = BodyFunctor::motionOf(x, i);
            Pose3 pose = lasers_[i].sensor.pose;
            const Point2 place = frame * Point2{motion[0], motion[1]};
            pose.position.x = place.x;
            pose.position.y = place.y;
            pose.heading = wrapped(first.heading + Angle::radians(motion[2]));
            fit.poses.push_back(i == 0 ? first : pose);
            PlanCovariance plain = {};
            if (i > 0) {
                const auto at = 3 * static_cast<Eigen::Index>(i - 1);
                const Eigen::Matrix3d own =
                    axes * covariance.block<3, 3>(at, at) * axes.transpose();
                for (int r = 0; r < 3; ++r)
                    for (int c = 0; c < 3; ++c)
                        plain[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] = own(r, c);
            }
            fit.covariances.push_back(plain);
        }
    }

    std::span<const WatchingLaser> lasers_;
    BodyTarget target_;
    double radius_;
    std::vector<std::vector<LegScan>> scans_;
    std::vector<LegMoment> moments_;
    bool joins_ = false;
};

/// \throws FormatError for a laser that cannot see the bodies
void mustSee(std::span<const WatchingLaser> lasers, const BodyTarget& target) {
    const double hips = legShape().hip * kUsualHeight;
    for (const WatchingLaser& laser : lasers) {
        if (!scansSlice(laser.sensor)) refuseBodies(laser.sensor.id + " is not level");
        // Hands hang there, too.
        constexpr double kBelow = 0.8;
        if (target.isPerson() && laser.sensor.pose.position.z > kBelow * hips)
            refuseBodies(laser.sensor.id + " scans at " +
                         formatFixed(laser.sensor.pose.position.z, 2) + " m: wanted legs, below " +
                         formatFixed(kBelow * hips, 2) + " m");
        for (const std::vector<float>& scan : laser.scans)
            if (scan.size() != static_cast<std::size_t>(laser.sensor.as<Laser>().beams))
                refuseBodies("scans of " + laser.sensor.id + " have different beams");
    }
}

/// Appends the middles of the pairs of legs of a scan, the nearest first.
void addPairs(LegScan scan, const WatchingLaser& laser, double wider,
              std::vector<SeenPerson>& seen) {
    const Pose2 frame{laser.sensor.pose.position.onFloor(), laser.sensor.pose.heading};
    while (scan.legs.size() > 1) {
        std::size_t a = 0, b = 0;
        double least = kStride;
        for (std::size_t i = 0; i < scan.legs.size(); ++i)
            for (std::size_t j = i + 1; j < scan.legs.size(); ++j)
                if (const double off = (scan.legs[i].centre - scan.legs[j].centre).norm();
                    off < least) {
                    least = off;
                    a = i;
                    b = j;
                }
        if (b == 0) return;
        const LegView both = middleOf(scan.legs[a], scan.legs[b]);
        const Vector2d place = both.centre + wider * both.away;
        seen.push_back({both.time, frame * Point2{place[0], place[1]}});
        scan.legs.erase(scan.legs.begin() + static_cast<std::ptrdiff_t>(b));
        scan.legs.erase(scan.legs.begin() + static_cast<std::ptrdiff_t>(a));
    }
}

}  // namespace

std::vector<SeenPerson> peopleSeen(std::span<const WatchingLaser> lasers, double height) {
    mustSee(lasers, {});
    const double radius = legShape().radius;
    std::vector<SeenPerson> seen;
    for (std::size_t i = 0; i < lasers.size(); ++i)
        for (LegScan& scan : LegFinder(lasers[i], i, radius * kUsualHeight).all())
            addPairs(std::move(scan), lasers[i], radius * (height - kUsualHeight), seen);
    std::stable_sort(seen.begin(), seen.end(),
                     [](const SeenPerson& a, const SeenPerson& b) { return a.time < b.time; });
    return seen;
}

std::vector<Point2> peopleAt(std::span<const SeenPerson> seen, double time) {
    constexpr double kAround = 0.2, kApart = 0.5;  // seconds, metres
    struct Person {
        std::vector<const SeenPerson*> points;
        Vector2d sum = Vector2d::Zero();
    };
    std::vector<Person> people;
    auto at =
        std::lower_bound(seen.begin(), seen.end(), time - kAround,
                         [](const SeenPerson& one, double before) { return one.time < before; });
    for (; at != seen.end() && at->time <= time + kAround; ++at) {
        const Vector2d place(at->place.x, at->place.y);
        const auto known = std::find_if(people.begin(), people.end(), [&](const Person& person) {
            return (person.sum / static_cast<double>(person.points.size()) - place).norm() < kApart;
        });
        Person& person = known == people.end() ? people.emplace_back() : *known;
        person.points.push_back(&*at);
        person.sum += place;
    }
    std::vector<Point2> places;
    for (const Person& person : people) {
        // A line through the points, or the only one if it is of this time.
        const auto count = static_cast<double>(person.points.size());
        const Vector2d mean = person.sum / count;
        double mean_time = 0, squares = 0;
        for (const SeenPerson* one : person.points) mean_time += (one->time - time) / count;
        Vector2d slope = Vector2d::Zero();
        for (const SeenPerson* one : person.points) {
            const double off = one->time - time - mean_time;
            squares += off * off;
            slope += off * (Vector2d(one->place.x, one->place.y) - mean);
        }
        constexpr double kSameTime = 0.02, kLeast = 1e-6;
        const bool is_between = person.points.front()->time <= time + kSameTime &&
                                person.points.back()->time >= time - kSameTime;
        if (!is_between) continue;
        const Vector2d place =
            squares > kLeast ? Vector2d(mean - mean_time * slope / squares) : mean;
        places.push_back({place[0], place[1]});
    }
    return places;
}

BodyFit fitToBodies(std::span<const WatchingLaser> lasers, BodyTarget target) {
    if (lasers.size() < 2)
        refuseBodies("wanted two lasers or more that see the same " +
                     std::string(target.isPerson() ? "people" : "robots"));
    constexpr std::size_t kMostLasers = 64;
    if (lasers.size() > kMostLasers) refuseBodies("wanted at most 64 lasers");
    mustSee(lasers, target);
    BodyFit fit = BodyFitter(lasers, target).fit();
    // Discs are found by a fixed radius: those of a robot once more, by the radius found.
    constexpr double kSame = 0.0005;
    for (int round = 0;
         round < 3 && !target.isPerson() && std::abs(fit.radius - target.radius) > kSame; ++round) {
        target.radius = fit.radius;
        fit = BodyFitter(lasers, target).fit();
    }
    return fit;
}

}  // namespace ispace::calibration
