// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/steering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace ispace {

namespace {

/// Metres to keep between circles and obstacles if there is room.
constexpr double kGap = 0.05;
/// Usual number of neighbours.
constexpr std::size_t kUsual = 32;
constexpr double kHair = 1e-6;

Vec2 velocityOf(const Motion& motion) {
    if (motion.drive.speed == 0 && motion.side.speed == 0) return {};
    const Vec2 ahead = motion.forward();
    return motion.drive.speed * ahead + motion.side.speed * perpendicular(ahead);
}

/// Returns true if the way comes nearer to the line than `reach`.
bool comesNear(const Segment2& way, const Segment2& line, double reach) {
    const auto apart = [reach](double a, double b, double c, double d) {
        return std::max(a, b) + reach < std::min(c, d) || std::max(c, d) + reach < std::min(a, b);
    };
    if (apart(way.a.x, way.b.x, line.a.x, line.b.x) || apart(way.a.y, way.b.y, line.a.y, line.b.y))
        return false;
    const double least =
        std::min(std::min(squaredDistance(way.a, line), squaredDistance(way.b, line)),
                 std::min(squaredDistance(line.a, way), squaredDistance(line.b, way)));
    return least < reach * reach || intersects(way, line);
}

}  // namespace

Steering::Steering(const SteeringState& helm, double speed, double horizon)
    : place_(helm.around->motions[helm.mover].pose.position),
      radius_(helm.around->movers[helm.mover].model.radius),
      speed_(speed),
      horizon_(horizon),
      helm_(&helm) {
    neighbours_.reserve(kUsual);
    findNeighbours(*helm.around, helm.mover);
}

void Steering::findNeighbours(const Surroundings& around, std::size_t mover) {
    const double sight = radius_ + std::min(kMoverSight, 2 * speed_ * horizon_);
    around.traffic->forEachNear(place_, sight, [&](std::size_t other) {
        if (other == mover) return;
        const Motion& motion = around.motions[other];
        const Vec2 offset = motion.pose.position - place_;
        const double reach = radius_ + around.movers[other].model.radius + kGap;
        // Most are too far away to meet within the horizon.
        const double fastest = speed_ + std::abs(motion.drive.speed) + std::abs(motion.side.speed);
        const double farthest = (reach + fastest * horizon_) * (1 + kHair);
        if (dot(offset, offset) > farthest * farthest) return;
        neighbours_.push_back({offset, velocityOf(motion), reach});
    });
}

void Steering::findLines() const {
    if (std::exchange(has_lines_, true)) return;
    const double ahead = speed_ * horizon_ + kGap;
    if (helm_->clearance > ahead) return;
    lines_.reserve(kUsual);
    helm_->vicinity->forEachWithin(
        *helm_->obstacles, place_, radius_ + ahead, [&](const Segment2& line, double apart) {
            // A hair less, so that the way along it is free.
            lines_.push_back({line, std::min(radius_ + kGap, apart - kHair)});
        });
}

double Steering::untilNeighbour(Vec2 velocity) const {
    double least = kForever;
    for (const auto& [offset, others, reach] : neighbours_) {
        const Vec2 closing = velocity - others;
        const double b = dot(offset, closing);
        if (b <= 0) continue;  // they part
        const double c = dot(offset, offset) - reach * reach;
        if (c <= 0) return 0;
        const double a = dot(closing, closing);
        const double root = b * b - a * c;
        if (root > 0) least = std::min(least, (b - std::sqrt(root)) / a);
    }
    return least;
}

/// Tests the first `most` of the horizon.
double Steering::untilLine(Vec2 velocity, double most) const {
    constexpr double kMinValue = 1.0 / 8;
    const bool has_index = helm_->index != nullptr && !has_lines_;
    if (!has_index) findLines();
    if (!has_index && lines_.empty()) return kForever;
    for (double share = most; share >= kMinValue; share /= 2) {
        const Segment2 way{place_, place_ + share * horizon_ * velocity};
        const bool is_free =
            has_index ? isFreeByIndex(way)
                      : std::none_of(lines_.begin(), lines_.end(), [&](const Line& line) {
                            return comesNear(way, line.line, line.reach);
                        });
        if (is_free) return share == most ? kForever : share * horizon_;
    }
    return 0;
}

/// Tests a way against the lines that findLines() would find, of which it reads those near the way.
bool Steering::isFreeByIndex(const Segment2& way) const {
    const double ahead = speed_ * horizon_ + kGap;
    if (helm_->clearance > ahead) return true;
    const ObstacleIndex::Way look = helm_->index->look(way, radius_ + kGap);
    if (look != ObstacleIndex::Way::Unknown) return look == ObstacleIndex::Way::Clear;
    helm_->index->findIn(bounds(way).expanded(radius_ + kGap), nearby_);
    const double farthest = radius_ + ahead;
    return std::none_of(nearby_.begin(), nearby_.end(), [&](const Segment2& line) {
        const double square = squaredDistance(place_, line);
        return square < farthest * farthest &&
               comesNear(way, line, std::min(radius_ + kGap, std::sqrt(square) - kHair));
    });
}

double Steering::freeTime(Angle direction, double share) const {
    const Vec2 velocity = speed_ * unitVector(direction);
    const double time = std::min(horizon_, untilNeighbour(velocity));
    return time == 0 ? 0 : std::min(time, untilLine(velocity, share));
}

bool Steering::isFree(Vec2 way) const {
    const Segment2 path{place_, place_ + way};
    findLines();
    const bool is_clear = std::all_of(lines_.begin(), lines_.end(), [&](const Line& line) {
        const double at_end = std::sqrt(squaredDistance(path.b, line.line));
        const double reach = std::min(line.reach, std::max(radius_, at_end) - kHair);
        return !comesNear(path, line.line, reach);
    });
    return is_clear &&
           std::all_of(neighbours_.begin(), neighbours_.end(), [&](const Neighbour& other) {
               const double apart = std::min(other.reach, length(other.offset) - kHair);
               return squaredDistance(place_ + other.offset, path) >= apart * apart;
           });
}

FreeHeading Steering::choose(Angle desired, double needed) const {
    constexpr std::array<double, 11> kTurns = {0, -15, 15, -30, 30, -50, 50, -75, 75, -100, 100};
    // Degrees of turning that a second of free way is worth.
    constexpr double kWorth = 120, kAside = 0.25;
    FreeHeading best{desired, 0};
    double best_worth = -kForever;
    for (const double turn : kTurns) {
        const Angle direction = desired + Angle::degrees(turn);
        const double time = freeTime(direction, turn == 0 ? 1 : kAside);
        if (time >= needed) return {direction, time};
        const double worth = time - std::abs(turn) / kWorth;
        if (worth > best_worth && (time > 0 || turn == 0)) {
            best = {direction, time};
            best_worth = worth;
        }
    }
    return best;
}

}  // namespace ispace
