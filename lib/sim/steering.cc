// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/steering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/simd.h"

namespace ispace {

namespace {

/// Metres to keep between circles and obstacles if there is room.
constexpr double kGap = 0.05;
/// Usual numbers, of little memory.
constexpr std::size_t kUsualNeighbours = 16, kUsualLines = 24;
constexpr double kHair = 1e-6;
/// Share of the horizon in which obstacles matter where a mover turns aside, and the least that is
/// tested.
constexpr double kAside = 0.25, kLeastShare = 1.0 / 8;
/// Metres: nearer lines are not tested by lanes.
constexpr double kLeastReach = 1e-3;

double square(double x) { return x * x; }

/// Sets the lanes up to a multiple of kLanes.
void pad(LineLanes& lanes) {
    for (std::size_t i = lanes.count; i % LineLanes::kLanes != 0; ++i)
        for (LineLanes::Lane* const lane :
             {&lanes.ax, &lanes.ay, &lanes.dx, &lanes.dy, &lanes.per_square, &lanes.reach_square})
            (*lane)[i] = 0;
}

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

/// Computes for each line the least squared distance of the way to it, less that at which it comes
/// near; -1 if they cross. Rounds otherwise than comesNear().
ISPACE_SIMD_CLONES void findRoom(const LineLanes& lanes, double x, double y, double* room) {
    const double per_square = 1 / (x * x + y * y);
    const std::size_t end =
        (lanes.count + LineLanes::kLanes - 1) / LineLanes::kLanes * LineLanes::kLanes;
    for (std::size_t i = 0; i < end; ++i) {
        const double ax = lanes.ax[i], ay = lanes.ay[i], dx = lanes.dx[i], dy = lanes.dy[i];
        const double bx = ax + dx, by = ay + dy;
        const auto share = [](double along) {
            const double least = simd::choose(along > 0, along, 0.0);
            return simd::choose(least < 1, least, 1.0);
        };
        // The end of the way to the line, then the line's ends to the way.
        const double t = share(((x - ax) * dx + (y - ay) * dy) * lanes.per_square[i]);
        const double ex = x - ax - t * dx, ey = y - ay - t * dy;
        const double s = share((ax * x + ay * y) * per_square);
        const double fx = ax - s * x, fy = ay - s * y;
        const double u = share((bx * x + by * y) * per_square);
        const double gx = bx - u * x, gy = by - u * y;
        const double e = ex * ex + ey * ey, f = fx * fx + fy * fy, g = gx * gx + gy * gy;
        const double fg = simd::choose(f < g, f, g);
        const double least = simd::choose(e < fg, e, fg) - lanes.reach_square[i];
        const double sides = (x * ay - y * ax) * (x * by - y * bx);
        const double ends = (dy * ax - dx * ay) * (dx * (y - ay) - dy * (x - ax));
        room[i] = simd::choose(sides < 0, simd::choose(ends < 0, -1.0, least), least);
    }
}

}  // namespace

Steering::Steering(const SteeringState& helm, double speed, double horizon)
    : place_(helm.around->motions[helm.mover].pose.position),
      radius_(helm.around->movers[helm.mover].model.radius),
      speed_(speed),
      horizon_(horizon),
      helm_(&helm) {
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
        if (neighbours_.empty()) neighbours_.reserve(kUsualNeighbours);
        neighbours_.push_back({offset, velocityOf(motion), reach});
    });
}

void Steering::findLines() const {
    if (std::exchange(has_lines_, true)) return;
    const double ahead = speed_ * horizon_ + kGap;
    if (helm_->clearance > ahead) return;
    lines_.reserve(kUsualLines);
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

/// Fills lanes with the lines of the index about p that are nearer than `farthest` to the mover.
/// \returns false if the index does not know them, they are too many, or one is too near to decide
/// by lanes
bool Steering::fillFromIndex(Point2 p, double farthest, LineLanes& lanes) const {
    const auto near = helm_->index->near(p);
    if (!near || near->which.size() > LineLanes::kMost) return false;
    const double usual = radius_ + kGap, apart = usual + 2 * kHair;
    double nearest = kForever;
    std::size_t count = 0;
    for (const std::uint32_t i : near->which) {
        const ObstacleIndex::Line& line = near->all[i];
        const Vec2 begin = line.begin - place_;
        const double share = std::clamp(-dot(begin, line.along) * line.per_square, 0.0, 1.0);
        const Vec2 foot = begin + share * line.along;
        const double square = dot(foot, foot);
        double reach = usual;
        if (square < apart * apart) reach = std::min(usual, std::sqrt(square) - kHair);
        lanes.ax[count] = begin.x;
        lanes.ay[count] = begin.y;
        lanes.dx[count] = line.along.x;
        lanes.dy[count] = line.along.y;
        lanes.per_square[count] = line.per_square;
        lanes.reach_square[count] = reach * reach;
        nearest = std::min(nearest, square);
        count += square < farthest * farthest ? 1 : 0;
    }
    lanes.count = count;
    pad(lanes);
    is_apart_ = is_apart_ && nearest >= apart * apart;
    return nearest > kLeastReach * kLeastReach;
}

/// Nearer lines to the mover are in the lanes.
double Steering::reachOfLanes() const {
    return kAside * speed_ * horizon_ + radius_ + kGap + kHair;
}

/// Fills the lanes with the lines that come near ways of kAside. \returns false as fillFromIndex()
bool Steering::fillLanes() const {
    const double farthest = reachOfLanes();
    if (helm_->clearance > farthest - radius_) return true;
    return farthest <= ObstacleIndex::kNear && fillFromIndex(place_, farthest, lanes_);
}

/// Tests a share of the horizon; empty in doubt, and without an index, for which lanes do not pay.
std::optional<bool> Steering::isFreeByLanes(Vec2 velocity, double share) const {
    if (helm_->index == nullptr || has_lines_) return std::nullopt;
    if (!std::exchange(has_lanes_, true)) are_in_lanes_ = fillLanes();
    if (!are_in_lanes_) return std::nullopt;
    // Exceeds all rounding of coordinates of a town.
    constexpr double kDoubt = 1e-7;
    const auto least_room = [](const LineLanes& lanes, Vec2 way) {
        std::array<double, LineLanes::kMost> room;
        findRoom(lanes, way.x, way.y, room.data());
        double least = 1;
        for (std::size_t i = 0; i < lanes.count; ++i) least = std::min(least, room[i]);
        return least;
    };
    const Vec2 way = share * horizon_ * velocity;
    const double room = least_room(lanes_, way);
    if (room < -kDoubt) return false;
    if (room <= kDoubt) return std::nullopt;
    if (share <= kAside) return true;
    const double usual = radius_ + kGap, end = length(way);
    for (const double part : {1.0, 0.75, 0.5})
        if (is_apart_ && helm_->index->most(place_ + part * way) < usual - kDoubt) return false;
    // The point of a line that is nearest to the way lies beside it or about its end. The index is
    // asked from the end on back to the lines in the lanes.
    const double reach = usual + kHair;
    const auto beside = [reach](double radius) {
        return std::sqrt(std::max(0.0, square(radius) - square(reach)));
    };
    const double known = beside(reachOfLanes()), each = beside(ObstacleIndex::kNear);
    double ahead = ObstacleIndex::kNear - reach;
    if (!(ahead > kLeastReach && each > kLeastReach && known > 0)) return std::nullopt;
    LineLanes lanes;
    for (double left = end; left > known; ahead = each) {
        const double middle = left - ahead;
        if (!fillFromIndex(place_ + middle / end * way, kForever, lanes)) return std::nullopt;
        const double least = least_room(lanes, way);
        if (least < -kDoubt) return false;
        if (least <= kDoubt) return std::nullopt;
        left = middle - each;
    }
    return true;
}

/// Tests a share of the horizon.
bool Steering::isFreeOfLines(Vec2 velocity, double share) const {
    if (const auto is_free = isFreeByLanes(velocity, share)) return *is_free;
    const Segment2 way{place_, place_ + share * horizon_ * velocity};
    if (helm_->index != nullptr && !has_lines_) return isFreeByIndex(way);
    findLines();
    return std::none_of(lines_.begin(), lines_.end(),
                        [&](const Line& line) { return comesNear(way, line.line, line.reach); });
}

/// Tests the first `most` of the horizon. A result below `needed` may be too small.
double Steering::untilLine(Vec2 velocity, double most, double needed) const {
    if (isFreeOfLines(velocity, most)) return kForever;
    for (double share = most / 2; share >= kLeastShare && share * horizon_ >= needed; share /= 2)
        if (isFreeOfLines(velocity, share)) return share * horizon_;
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

double Steering::freeTime(Angle direction) const {
    const Vec2 velocity = speed_ * unitVector(direction);
    const double time = std::min(horizon_, untilNeighbour(velocity));
    return time == 0 ? 0 : std::min(time, untilLine(velocity, 1, 0));
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
    constexpr double kWorth = 120;
    // Most often one of them is free. Without any, all times are compared.
    std::array<double, kTurns.size()> most;  // upper bounds of these times
    const auto share_of = [](double turn) { return turn == 0 ? 1 : kAside; };
    for (std::size_t i = 0; i < kTurns.size(); ++i) {
        const Angle direction = desired + Angle::degrees(kTurns[i]);
        const Vec2 velocity = speed_ * unitVector(direction);
        most[i] = std::min(horizon_, untilNeighbour(velocity));
        if (most[i] < needed) continue;
        if (most[i] == 0) return {direction, 0};  // as long as needed: no time at all
        const double share = share_of(kTurns[i]);
        const double time = std::min(most[i], untilLine(velocity, share, needed));
        if (time >= needed) return {direction, time};
        most[i] = std::min(most[i], share / 2 * horizon_);
    }
    FreeHeading best{desired, 0};
    double best_worth = -kForever;
    for (std::size_t i = 0; i < kTurns.size(); ++i) {
        const double turn = kTurns[i], price = std::abs(turn) / kWorth;
        if (most[i] - price <= best_worth) continue;
        const Angle direction = desired + Angle::degrees(turn);
        const double time =
            most[i] == 0
                ? 0
                : std::min(most[i], untilLine(speed_ * unitVector(direction), share_of(turn), 0));
        const double worth = time - price;
        if (worth > best_worth && (time > 0 || turn == 0)) {
            best = {direction, time};
            best_worth = worth;
        }
    }
    return best;
}

}  // namespace ispace
