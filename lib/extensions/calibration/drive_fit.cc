// SPDX-License-Identifier: GPL-3.0-or-later
// After Censi et al. (IEEE Transactions on Robotics 29, 2013): the turn of a step is linear in
// radius over axle of both wheels (least squares of two unknowns); with it, the translation is
// linear in the axle, the laser's place and the unit vector of its heading. The first three are put
// in by their minimum, which leaves a quadratic form of the unit vector: its minimum is the
// eigenvector of the lesser eigenvalue. Of its two signs the one with an axle above 0 holds.
//
// The steps are arcs: speeds are taken as constant in a step. Covariances are the inverse of the
// information at the scatter of the residuals, by central differences of 1e-6.
#include "extensions/calibration/drive_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace::calibration {

namespace {

using Eigen::Matrix;
using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix6d = Matrix<double, 6, 6>;
using Jacobian = Matrix<double, 3, 6>;

[[noreturn]] void failDrive(const std::string& name, std::string message) {
    throw FormatError(Diagnostic{displayName(name), 0, 0, std::move(message)});
}

/// sin(x) / x and (1 - cos(x)) / x.
double sinc(double x) { return std::abs(x) < 1e-6 ? 1 - x * x / 6 : std::sin(x) / x; }
double cosc(double x) { return std::abs(x) < 1e-6 ? x / 2 : (1 - std::cos(x)) / x; }

DriveParameters parametersFrom(const std::array<double, 6>& values) {
    return {values[0], values[1], values[2], {{values[3], values[4]}, Angle::radians(values[5])}};
}
std::array<double, 6> valuesOf(const DriveParameters& p) {
    return {p.left_radius,      p.right_radius,     p.axle,
            p.laser.position.x, p.laser.position.y, p.laser.heading.radians()};
}

Vector3d vectorOf(const Pose2& motion) {
    return {motion.position.x, motion.position.y, motion.heading.radians()};
}

Vector3d residualOf(const DriveParameters& parameters, const DriveStep& step) {
    Vector3d off = vectorOf(step.motion) - vectorOf(predictedMotion(parameters, step));
    off[2] = std::remainder(off[2], 2 * std::numbers::pi);
    return off;
}

/// Minimises over all parameters in closed form: first the turns, which are linear in the ratios of
/// radius and axle, then all others, which are linear but for a unit vector.
DriveParameters solved(std::span<const DriveStep> steps, const std::string& name) {
    Matrix2d turns = Matrix2d::Zero();
    Vector2d right_side = Vector2d::Zero();
    for (const DriveStep& step : steps) {
        const Vector2d row = step.duration * Vector2d(step.left, step.right);
        turns += row * row.transpose();
        right_side += row * step.motion.heading.radians();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix2d> excited(turns);
    if (!(excited.eigenvalues()[0] > 1e-6 * excited.eigenvalues()[1]))
        failDrive(
            name,
            "the speeds of both wheels have one ratio in all steps: wanted turns and straight "
            "ways, to tell the radii apart");
    const Vector2d ratios = turns.ldlt().solve(right_side);  // -left radius / axle, right / axle
    Matrix<double, 5, 5> moment = Matrix<double, 5, 5>::Zero();
    for (const DriveStep& step : steps) {
        const double turn = step.duration * (ratios[0] * step.left + ratios[1] * step.right);
        const double way = 0.5 * step.duration * (ratios[1] * step.right - ratios[0] * step.left);
        const double x = step.motion.position.x, y = step.motion.position.y;
        Matrix<double, 2, 5> rows;
        rows << -way * sinc(turn), 1 - std::cos(turn), std::sin(turn), x, -y, -way * cosc(turn),
            -std::sin(turn), 1 - std::cos(turn), y, x;
        moment += rows.transpose() * rows;
    }
    const Matrix3d free = moment.topLeftCorner<3, 3>();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> known(free);
    if (!(known.eigenvalues()[0] > 1e-9 * known.eigenvalues()[2]))
        failDrive(name, known.eigenvectors().col(0).cwiseAbs()[0] > 0.9
                            ? "the robot only turns: its axle and wheels have no scale"
                            : "the robot does not turn: where its laser stands is not determined");
    // With the minimum over axle and position inserted, a quadratic form of the unit vector.
    const MatrixXd mixed = moment.topRightCorner<3, 2>();
    const MatrixXd inserted = -free.ldlt().solve(mixed);
    const Matrix2d form = moment.bottomRightCorner<2, 2>() + mixed.transpose() * inserted;
    const Eigen::SelfAdjointEigenSolver<Matrix2d> least(0.5 * (form + form.transpose()));
    Vector2d unit = least.eigenvectors().col(0);
    Vector3d rest = inserted * unit;
    if (rest[0] < 0) {  // the other of the two directions
        unit = -unit;
        rest = -rest;
    }
    return {-ratios[0] * rest[0],
            ratios[1] * rest[0],
            rest[0],
            {{rest[1], rest[2]}, Angle::radians(std::atan2(unit[1], unit[0]))}};
}

/// Returns the standard deviations of the residuals.
std::array<double, 3> noiseOf(const DriveParameters& parameters, std::span<const DriveStep> steps) {
    Vector3d sum = Vector3d::Zero();
    for (const DriveStep& step : steps) sum += residualOf(parameters, step).cwiseAbs2();
    const double free = static_cast<double>(3 * steps.size() - 6) / 3;
    const Vector3d noise = (sum / free).cwiseSqrt();
    return {noise[0], noise[1], noise[2]};
}

Jacobian slopesOf(const DriveParameters& parameters, const DriveStep& step) {
    Jacobian slopes;
    const std::array<double, 6> at = valuesOf(parameters);
    for (std::size_t i = 0; i < 6; ++i) {
        constexpr double kStep = 1e-6;
        std::array<double, 6> up = at, down = at;
        up[i] += kStep;
        down[i] -= kStep;
        slopes.col(static_cast<Eigen::Index>(i)) =
            (residualOf(parametersFrom(down), step) - residualOf(parametersFrom(up), step)) /
            (2 * kStep);
    }
    return slopes;
}

/// Leaves out the share of the steps with the largest residuals, each by its standard deviation.
std::vector<DriveStep> withoutWorst(const DriveParameters& parameters,
                                    std::span<const DriveStep> steps, double share) {
    const std::array<double, 3> noise = noiseOf(parameters, steps);
    std::vector<std::pair<double, std::size_t>> sizes;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Vector3d off = residualOf(parameters, steps[i]);
        double size = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double sigma = std::max(noise[static_cast<std::size_t>(axis)], 1e-12);
            size += off[axis] * off[axis] / (sigma * sigma);
        }
        sizes.emplace_back(size, i);
    }
    std::sort(sizes.begin(), sizes.end());
    const auto kept =
        static_cast<std::size_t>(std::ceil((1 - share) * static_cast<double>(steps.size())));
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < kept; ++i) order.push_back(sizes[i].second);
    std::sort(order.begin(), order.end());
    std::vector<DriveStep> left;
    left.reserve(order.size());
    for (const std::size_t i : order) left.push_back(steps[i]);
    return left;
}

std::string withSigma(double value, double sigma, int decimals, const char* unit) {
    return formatFixed(value, decimals) + " +- " + formatFixed(sigma, decimals) + ' ' + unit;
}

/// Standard deviations of the parameters, in the order of the covariance.
std::array<double, 6> sigmasOf(const DriveFit& fit) {
    std::array<double, 6> sigmas{};
    for (std::size_t i = 0; i < 6; ++i) sigmas[i] = std::sqrt(fit.covariance[i][i]);
    return sigmas;
}

}  // namespace

bool isDrive(std::string_view bytes) {
    const std::string_view line = bytes.substr(0, std::min(bytes.find('\n'), std::size_t{1000}));
    return line.starts_with('{') && line.find("\"phi_l\"") != std::string_view::npos;
}

std::vector<DriveStep> readDrive(std::string_view bytes, const std::string& name) {
    std::vector<DriveStep> steps;
    int line = 1;
    for (std::size_t begin = 0;;) {
        for (; begin < bytes.size() &&
               std::string_view(" \t\r\n").find(bytes[begin]) != std::string_view::npos;
             ++begin)
            if (bytes[begin] == '\n') ++line;
        if (begin == bytes.size()) return steps;
        const auto refuse = [&](const char* wanted) {
            throw FormatError(Diagnostic{displayName(name), line, 0, wanted});
        };
        const std::size_t end = std::min(bytes.find('}', begin), bytes.size() - 1) + 1;
        const std::string_view text = bytes.substr(begin, end - begin);
        const auto json = nlohmann::json::parse(text, nullptr, false);
        if (!json.is_object()) refuse("wanted a JSON object");
        line += static_cast<int>(std::count(text.begin(), text.end(), '\n'));
        begin = end;
        const auto number = [&](const nlohmann::json& value) {
            if (!value.is_number() || !std::isfinite(value.get<double>()))
                refuse("wanted numbers `T`, `phi_l`, `phi_r` and `sm`: [x, y, heading]");
            return value.get<double>();
        };
        const auto field = [&](const char* key) {
            return number(json.contains(key) ? json[key] : nlohmann::json());
        };
        DriveStep step{field("T"), field("phi_l"), field("phi_r"), {}};
        const auto motion = json.contains("sm") ? json["sm"] : nlohmann::json();
        if (!motion.is_array() || motion.size() != 3) refuse("wanted `sm`: [x, y, heading]");
        step.motion = {{number(motion[0]), number(motion[1])}, Angle::radians(number(motion[2]))};
        if (!(step.duration > 0)) refuse("wanted `T` above 0");
        steps.push_back(step);
    }
}

Pose2 predictedMotion(const DriveParameters& p, const DriveStep& step) {
    const double left = step.duration * step.left * p.left_radius;
    const double right = step.duration * step.right * p.right_radius;
    const double turn = (right - left) / p.axle, way = 0.5 * (left + right);
    const Pose2 after{{way * sinc(turn), way * cosc(turn)}, Angle::radians(turn)};
    const Point2 moved = after * p.laser.position;
    const CosSin axes = cosSin(p.laser.heading);
    const Vec2 off = moved - p.laser.position;
    return {{axes.cos * off.x + axes.sin * off.y, axes.cos * off.y - axes.sin * off.x},
            Angle::radians(turn)};
}

DriveFit fitDrive(std::span<const DriveStep> steps, const std::string& name) {
    constexpr std::size_t kFewest = 10;
    if (steps.size() < kFewest)
        failDrive(name, "a drive of " + std::to_string(steps.size()) + " steps: wanted at least " +
                            std::to_string(kFewest));
    constexpr int kRounds = 4;
    constexpr double kWorst = 0.01;
    std::vector<DriveStep> kept(steps.begin(), steps.end());
    DriveFit fit;
    fit.steps = steps.size();
    for (int round = 0; round <= kRounds; ++round) {
        if (round > 0) kept = withoutWorst(fit.parameters, kept, kWorst);
        fit.parameters = solved(kept, name);
    }
    fit.inliers = kept.size();
    fit.noise = noiseOf(fit.parameters, kept);
    Vector3d weight;
    for (int i = 0; i < 3; ++i)
        weight[i] = 1 / std::pow(std::max(fit.noise[static_cast<std::size_t>(i)], 1e-12), 2);
    Matrix6d information = Matrix6d::Zero();
    for (const DriveStep& step : kept) {
        const Jacobian slopes = slopesOf(fit.parameters, step);
        information += slopes.transpose() * weight.asDiagonal() * slopes;
    }
    const Matrix6d covariance = information.inverse();
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j)
            fit.covariance[i][j] =
                covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    return fit;
}

std::string driveText(const DriveFit& fit) {
    const DriveParameters& p = fit.parameters;
    const std::array<double, 6> s = sigmasOf(fit);
    constexpr double kDegrees = 180 / std::numbers::pi;
    return "steps:          " + std::to_string(fit.inliers) + " of " + std::to_string(fit.steps) +
           "\nleft diameter:  " + withSigma(2e3 * p.left_radius, 2e3 * s[0], 3, "mm") +
           "\nright diameter: " + withSigma(2e3 * p.right_radius, 2e3 * s[1], 3, "mm") +
           "\naxle:           " + withSigma(1e3 * p.axle, 1e3 * s[2], 3, "mm") +
           "\nlaser x:        " + withSigma(1e3 * p.laser.position.x, 1e3 * s[3], 3, "mm") +
           "\nlaser y:        " + withSigma(1e3 * p.laser.position.y, 1e3 * s[4], 3, "mm") +
           "\nlaser heading:  " + withSigma(p.laser.heading.degrees(), kDegrees * s[5], 3, "deg") +
           "\nscan matching:  " + formatFixed(1e3 * fit.noise[0], 3) + " mm, " +
           formatFixed(1e3 * fit.noise[1], 3) + " mm, " + formatFixed(kDegrees * fit.noise[2], 4) +
           " deg\n";
}

std::string driveJson(const DriveFit& fit) {
    const DriveParameters& p = fit.parameters;
    const std::array<double, 6> s = sigmasOf(fit);
    JsonWriter json;
    beginReport(json, "ispace-drive/1", "envc");
    json.key("steps").value(fit.steps).key("inliers").value(fit.inliers);
    const auto parameter = [&](const char* key, double value, double sigma) {
        json.key(key).beginObject().key("value").value(value).key("sigma").value(sigma).endObject();
    };
    parameter("left_diameter", 2 * p.left_radius, 2 * s[0]);
    parameter("right_diameter", 2 * p.right_radius, 2 * s[1]);
    parameter("axle", p.axle, s[2]);
    parameter("laser_x", p.laser.position.x, s[3]);
    parameter("laser_y", p.laser.position.y, s[4]);
    parameter("laser_heading", p.laser.heading.degrees(), s[5] * 180 / std::numbers::pi);
    json.key("scan_matching").beginObject();
    json.key("sigma_x").value(fit.noise[0]).key("sigma_y").value(fit.noise[1]);
    json.key("sigma_heading").value(fit.noise[2] * 180 / std::numbers::pi).endObject();
    json.key("covariance").beginArray();
    for (const auto& row : fit.covariance) {
        json.beginArray();
        for (const double one : row) json.value(one);
        json.endArray();
    }
    return json.endArray().endObject().take() + '\n';
}

}  // namespace ispace::calibration
