// SPDX-License-Identifier: GPL-3.0-or-later
// The start is a homography: a point of the level plane of the heads and its ray satisfy ray x (x
// m1 + y m2 + m3) = 0, of which four points make a system of rank 8 (Hartley and Zisserman,
// Multiple View Geometry, 2004, 4.1); the nearest rotation to (m1, m2, m1 x m2) comes by singular
// values. RANSAC of 400 draws takes the pose with which most rays agree within 1.8 degrees, half of
// them at least. Looking down, where people are not upright, the plane is that of the middle of the
// body, 0.6 of the height.
//
// Then twelve rounds at most of pairing, Cauchy weights and Levenberg and Marquardt over turn,
// shift and height, the latter with its prior. Residuals are column, top and bottom of an outline
// by their spreads, which grow with its size, as limbs swing. From the fourth round on pictures
// with several people count, each body with the person that the pose puts nearest.
#include "extensions/calibration/camera_fit.h"

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
#include "extensions/calibration/least_squares.h"
#include "geom/rotation.h"
#include "scene/bodies.h"

namespace ispace::calibration {

namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr std::size_t kFewestPictures = 12;

[[noreturn]] void refuseCamera(std::string message) {
    throw FormatError(Diagnostic{"", 0, 0, std::move(message)});
}

/// A camera's pose: the columns of `turn` are its axes in the room.
struct CameraPose {
    Vector3d place = Vector3d::Zero();
    Matrix3d turn = Matrix3d::Identity();

    [[nodiscard]] std::optional<PixelPoint> project(const Camera& camera,
                                                    const Vector3d& point) const {
        return camera.project(vecOf(turn.transpose() * (point - place)));
    }
};

/// Points of a body at the origin, 1 m high, whose heading is not known: level circles about the
/// axis, and the ball of the head.
struct BodyOutline {
    struct Circle {
        double radius = 0, height = 0;
    };
    std::vector<Circle> circles;
    double head = 0, head_radius = 0;  ///< height of its middle
};

const BodyOutline& bodyOutline() {
    static const BodyOutline outline = [] {
        BodyOutline made;
        for (const BodyPart& part : humanParts(1)) {
            if (part.is_ball) {
                made.head = (part.bottom + part.top) / 2;
                made.head_radius = part.radius;
            } else if (part.radius > 0 && part.bottom == 0) {
                // Both legs, turned about the axis: between side by side and one behind the other.
                made.circles.push_back({part.radius + std::abs(part.center.y) / 2, 0});
            } else if (part.radius == 0) {
                const double mean = (part.half_length + part.half_width) / 2;
                made.circles.push_back({mean, part.bottom});
                made.circles.push_back({mean, part.top});
            }
        }
        return made;
    }();
    return outline;
}

/// What is measured of an outline: a column, and the upper and lower row.
struct OutlineFeatures {
    double column = 0, top = 0, bottom = 0;
};

/// Returns the features of a body that stands at a point; nullopt for one beside the lens.
std::optional<OutlineFeatures> predicted(const Camera& camera, const CameraPose& pose, Point2 place,
                                         double height, bool is_upright) {
    constexpr int kAround = 16;
    constexpr double kFar = 1e9;
    double left = kFar, right = -kFar, top = kFar, bottom = -kFar;
    const auto add = [&](const Vector3d& point) {
        const auto pixel = pose.project(camera, point);
        if (!pixel) return false;
        left = std::min(left, pixel->column);
        right = std::max(right, pixel->column);
        top = std::min(top, pixel->row);
        bottom = std::max(bottom, pixel->row);
        return true;
    };
    const BodyOutline& body = bodyOutline();
    const Vector3d head(place.x, place.y, body.head * height);
    // The outline of a ball is a circle across the line of sight.
    const Vector3d sight = (head - pose.place).normalized();
    const Vector3d side = sight.unitOrthogonal(), up = sight.cross(side);
    for (int i = 0; i < kAround; ++i) {
        const double a = 2 * std::numbers::pi * i / kAround;
        const double c = std::cos(a), s = std::sin(a);
        if (!add(head + body.head_radius * height * (c * side + s * up))) return std::nullopt;
        for (const BodyOutline::Circle& circle : body.circles) {
            const double r = circle.radius * height;
            if (!add({place.x + r * c, place.y + r * s, circle.height * height}))
                return std::nullopt;
        }
    }
    double column = 0.5 * (left + right);
    if (is_upright) {
        const auto middle = pose.project(camera, head);
        if (!middle) return std::nullopt;
        column = middle->column;
    }
    return OutlineFeatures{column, top, bottom};
}

OutlineFeatures measured(const PictureBody& body) {
    // Pixels are half a pixel wider than their centres.
    return {body.isUpright() ? body.head : 0.5 * (body.left + body.right), body.top - 0.5,
            body.bottom + 0.5};
}

/// A person that a picture and lasers show.
struct OutlinePair {
    Point2 place;
    PictureBody body;
    double weight = 1;  ///< robust
};

/// Standard deviations of the features, in pixels: what swinging limbs and turned bodies cost.
OutlineFeatures spreadsOf(const PictureBody& body) {
    const double size = std::hypot(body.right - body.left, body.bottom - body.top);
    return {1 + 0.02 * size, 1 + 0.01 * size, 1 + 0.025 * size};
}

/// The likelihood of a pose near another: turn about the room's axes, shift, difference of height.
struct OutlineFunctor {
    using Scalar = double;
    enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };
    using InputType = VectorXd;
    using ValueType = VectorXd;
    using JacobianType = MatrixXd;

    const Camera& camera;
    CameraPose about;
    double height = 0;
    PeopleHeight known;
    std::span<const OutlinePair> pairs;

    static constexpr int kInputs = 7;
    [[nodiscard]] int inputs() const { return kInputs; }
    [[nodiscard]] int values() const { return 3 * static_cast<int>(pairs.size()) + 1; }

    [[nodiscard]] CameraPose poseAt(const VectorXd& x) const {
        CameraPose pose = about;
        pose.place += x.segment<3>(0);
        const Vector3d turn = x.segment<3>(3);
        if (turn.norm() > 0)
            pose.turn = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * about.turn;
        return pose;
    }
    int operator()(const VectorXd& x, VectorXd& values) const {
        const CameraPose pose = poseAt(x);
        const double tall = height + x[6];
        Eigen::Index row = 0;
        for (const OutlinePair& pair : pairs) {
            const auto model = predicted(camera, pose, pair.place, tall, pair.body.isUpright());
            constexpr double kBeside = 50;
            Vector3d off = Vector3d::Constant(kBeside);
            if (model) {
                const OutlineFeatures seen = measured(pair.body), spread = spreadsOf(pair.body);
                off = {(seen.column - model->column) / spread.column,
                       (seen.top - model->top) / spread.top,
                       (seen.bottom - model->bottom) / spread.bottom};
            }
            values.segment<3>(row) = std::sqrt(pair.weight) * off;
            row += 3;
        }
        values[row] = (tall - known.mean) / known.sigma;
        return 0;
    }
    int df(const VectorXd& x, MatrixXd& slopes) const {
        centralSlopes(*this, x, slopes);
        return 0;
    }
};

class PictureFitter {
  public:
    PictureFitter(const Sensor& sensor, std::span<const PictureMoment> moments,
                  const PeopleHeight& known)
        : camera_(sensor.as<Camera>()), id_(sensor.id), moments_(moments), known_(known) {}

    CameraFit fit() {
        pairs_ = singles();
        if (pairs_.size() < kFewestPictures)
            refuseCamera("the pictures of " + id_ + " show one whole person at " +
                         std::to_string(pairs_.size()) +
                         " moments at which lasers see one: wanted " +
                         std::to_string(kFewestPictures));
        CameraPose pose = start();
        double height = known_.mean;
        constexpr int kRounds = 12;
        for (int round = 0; round < kRounds; ++round) {
            if (round > 2) pairs_ = paired(pose, height);
            if (pairs_.size() < kFewestPictures) refuseStrange();
            OutlineFunctor functor{camera_, pose, height, known_, pairs_};
            weigh(functor);
            VectorXd x = VectorXd::Zero(OutlineFunctor::kInputs);
            Eigen::LevenbergMarquardt<OutlineFunctor> search(functor);
            search.parameters.maxfev = 30;
            search.minimize(x);
            pose = functor.poseAt(x);
            height += x[6];
            if (round > 4 && x.norm() < 1e-7) break;
        }
        return described(pose, height);
    }

  private:
    [[noreturn]] void refuseStrange() const {
        refuseCamera("no pose of " + id_ +
                     " explains its pictures: do clocks, lens and lasers fit together?");
    }

    /// Returns the people of pictures with one person that lasers see alone, too.
    [[nodiscard]] std::vector<OutlinePair> singles() const {
        std::vector<OutlinePair> pairs;
        for (const PictureMoment& moment : moments_)
            if (moment.people.size() == 1 && moment.bodies.size() == 1 &&
                !moment.bodies.front().meets_edge)
                pairs.push_back({moment.people.front(), moment.bodies.front()});
        return pairs;
    }

    /// Pairs people and bodies by the pose, each with the nearest.
    [[nodiscard]] std::vector<OutlinePair> paired(const CameraPose& pose, double height) const {
        std::vector<OutlinePair> pairs;
        for (const PictureMoment& moment : moments_)
            for (const PictureBody& body : moment.bodies) {
                if (body.meets_edge) continue;
                const double size = body.bottom - body.top;
                double least = 0.5 * size;
                const Point2* nearest = nullptr;
                for (const Point2& place : moment.people) {
                    const auto model = predicted(camera_, pose, place, height, body.isUpright());
                    if (!model) continue;
                    const OutlineFeatures seen = measured(body);
                    const double off =
                        std::hypot(seen.column - model->column, seen.top - model->top);
                    if (off >= least) continue;
                    least = off;
                    nearest = &place;
                }
                if (nearest != nullptr) pairs.push_back({*nearest, body});
            }
        return pairs;
    }

    /// The plane of the points that the start pairs with pixels, as a share of the height.
    [[nodiscard]] static double shareOf(bool is_upright) {
        constexpr double kMiddle = 0.6;
        return is_upright ? 1 : kMiddle;
    }

    [[nodiscard]] CameraPose start() const {
        const auto upright = static_cast<std::size_t>(
            std::count_if(pairs_.begin(), pairs_.end(),
                          [](const OutlinePair& pair) { return pair.body.isUpright(); }));
        const bool is_upright = 2 * upright >= pairs_.size();
        std::vector<std::pair<Point2, Vector3d>> rays;
        for (const OutlinePair& pair : pairs_) {
            if (pair.body.isUpright() != is_upright) continue;
            const OutlineFeatures seen = measured(pair.body);
            const double row = is_upright ? seen.top : 0.5 * (seen.top + seen.bottom);
            if (const auto ray = camera_.ray({seen.column, row}))
                rays.emplace_back(pair.place, vectorOf(*ray));
        }
        constexpr std::size_t kFewestRays = 4;
        if (rays.size() < kFewestRays) refuseStrange();
        const double plane = shareOf(is_upright) * known_.mean;
        std::mt19937 random(1);
        std::optional<CameraPose> best;
        std::size_t most = 0;
        constexpr int kTries = 400;
        constexpr double kAgrees = 0.9995;  // cosine of 1.8 degrees
        for (int k = 0; k < kTries; ++k) {
            std::array<std::size_t, 4> drawn{};
            for (std::size_t& one : drawn) one = random() % rays.size();
            std::vector<std::pair<Point2, Vector3d>> few;
            few.reserve(drawn.size());
            for (const std::size_t one : drawn) few.push_back(rays[one]);
            const auto pose = solved(few, plane);
            if (!pose) continue;
            const std::size_t agree = agreeing(*pose, rays, plane, kAgrees).size();
            if (agree > most) {
                most = agree;
                best = pose;
            }
        }
        if (!best || 2 * most < rays.size()) refuseStrange();
        const auto all = solved(agreeing(*best, rays, plane, kAgrees), plane);
        return all ? *all : *best;
    }

    [[nodiscard]] static std::vector<std::pair<Point2, Vector3d>> agreeing(
        const CameraPose& pose, std::span<const std::pair<Point2, Vector3d>> rays, double plane,
        double cosine) {
        std::vector<std::pair<Point2, Vector3d>> agree;
        for (const auto& [place, ray] : rays) {
            const Vector3d way =
                pose.turn.transpose() * (Vector3d(place.x, place.y, plane) - pose.place);
            if (way.normalized().dot(ray) > cosine) agree.emplace_back(place, ray);
        }
        return agree;
    }

    /// Returns the pose from which points of a level plane are seen along rays: ray x (x m1 + y m2
    /// + m3) = 0, linear in m1 and m2, the room's axes in the camera's frame, and in m3.
    [[nodiscard]] static std::optional<CameraPose> solved(
        std::span<const std::pair<Point2, Vector3d>> rays, double plane) {
        MatrixXd equations(3 * static_cast<Eigen::Index>(rays.size()), 9);
        Eigen::Index row = 0;
        for (const auto& [place, ray] : rays) {
            Matrix3d cross;
            cross << 0, -ray[2], ray[1], ray[2], 0, -ray[0], -ray[1], ray[0], 0;
            equations.block<3, 3>(row, 0) = place.x * cross;
            equations.block<3, 3>(row, 3) = place.y * cross;
            equations.block<3, 3>(row, 6) = cross;
            row += 3;
        }
        const Eigen::JacobiSVD<MatrixXd> svd(equations, Eigen::ComputeFullV);
        constexpr double kRank = 1e-6;
        if (svd.singularValues()[7] < kRank * svd.singularValues()[0]) return std::nullopt;
        const VectorXd m = svd.matrixV().col(8);
        Vector3d m1 = m.segment<3>(0), m2 = m.segment<3>(3), m3 = m.segment<3>(6);
        double scale = 0.5 * (m1.norm() + m2.norm());
        if (!(scale > 0)) return std::nullopt;
        const auto& [first, ray] = rays.front();
        if (ray.dot(first.x * m1 + first.y * m2 + m3) < 0) scale = -scale;
        m1 /= scale;
        m2 /= scale;
        m3 /= scale;
        Matrix3d axes;
        axes << m1, m2, m1.cross(m2);
        const Eigen::JacobiSVD<Matrix3d> nearest(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
        Matrix3d turned = nearest.matrixU() * nearest.matrixV().transpose();
        if (turned.determinant() < 0) return std::nullopt;
        CameraPose pose;
        pose.turn = turned.transpose();
        pose.place = Vector3d(0, 0, plane) - pose.turn * m3;
        return pose;
    }

    /// Sets robust weights (Cauchy) by the residuals.
    void weigh(const OutlineFunctor& functor) {
        for (OutlinePair& pair : pairs_) pair.weight = 1;
        VectorXd values(functor.values());
        functor(VectorXd::Zero(OutlineFunctor::kInputs), values);
        std::vector<double> sizes;
        for (std::size_t i = 0; i < pairs_.size(); ++i)
            sizes.push_back(values.segment<3>(3 * static_cast<Eigen::Index>(i)).squaredNorm() / 3);
        // Half of a mean of three squared normal variables lies below 0.79.
        const std::vector<double> weights = cauchyWeights(sizes, 0.79);
        for (std::size_t i = 0; i < pairs_.size(); ++i) pairs_[i].weight = weights[i];
    }

    [[nodiscard]] CameraFit described(const CameraPose& pose, double height) {
        const OutlineFunctor functor{camera_, pose, height, known_, pairs_};
        weigh(functor);
        VectorXd values(functor.values());
        const VectorXd x = VectorXd::Zero(OutlineFunctor::kInputs);
        functor(x, values);
        MatrixXd slopes(functor.values(), functor.inputs());
        functor.df(x, slopes);
        double used = 1, pixels = 0, rows = 0;
        Eigen::Index row = 0;
        for (const OutlinePair& pair : pairs_) {
            used += 3 * pair.weight;
            const OutlineFeatures spread = spreadsOf(pair.body);
            pixels += std::pow(values[row] * spread.column, 2) +
                      std::pow(values[row + 1] * spread.top, 2) +
                      std::pow(values[row + 2] * spread.bottom, 2);
            rows += 3 * pair.weight;
            row += 3;
        }
        const double variance =
            values.squaredNorm() / std::max(1.0, used - OutlineFunctor::kInputs);
        const MatrixXd information = slopes.transpose() * slopes / std::max(variance, 1e-6);
        const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(information);
        constexpr double kUnknown = 0.5;  // metres or radians
        if (!(solver.eigenvalues()[0] * kUnknown * kUnknown > 1))
            refuseCamera("the ways of the people do not determine the pose of " + id_);
        const MatrixXd covariance = information.inverse();
        CameraFit fit;
        fit.pose =
            poseOf({pose.place[0], pose.place[1], pose.place[2]}, Eigen::Quaterniond(pose.turn));
        for (std::size_t r = 0; r < 6; ++r)
            for (std::size_t c = 0; c < 6; ++c)
                fit.covariance[r][c] =
                    covariance(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
        fit.pictures = pairs_.size();
        fit.pixels = std::sqrt(pixels / std::max(rows, 1.0));
        fit.height = {height, std::sqrt(covariance(6, 6))};
        return fit;
    }

    const Camera& camera_;
    std::string id_;
    std::span<const PictureMoment> moments_;
    PeopleHeight known_;
    std::vector<OutlinePair> pairs_;
};

}  // namespace

CameraFit fitToPictures(const Sensor& camera, std::span<const PictureMoment> moments,
                        const PeopleHeight& height) {
    return PictureFitter(camera, moments, height).fit();
}

}  // namespace ispace::calibration
