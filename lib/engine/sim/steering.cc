// SPDX-License-Identifier: GPL-3.0-or-later
// Velocity obstacles of circles, and distances of ways to lines.
//
// The time until two circles meet is the first root of a quadratic equation in their relative
// velocity. Obstacles are tested for shares of the horizon: all of it for the desired heading, a
// quarter for those aside, halved until a share is free. With an index of obstacles most tests end
// early: by a strip that is known to be free, by circles without obstacles about points of the way,
// or by the wall that blocked the last way; then by vectors of lines. Each of these decides only if
// it clears the limit by more than kDoubt, which exceeds its rounding, so all of them agree with
// the plain test.
#include "sim/steering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/simd.h"

namespace ispace {

namespace {

/// Metres to keep between circles and obstacles if there is room.
constexpr double kGap = FreeStrip::kGap;
/// Usual number, of little memory.
constexpr std::size_t kUsualLines = 24;
constexpr double kHair = 1e-6;
/// Share of the horizon in which obstacles matter where a mover turns aside, and the least that is
/// tested.
constexpr double kAside = 0.25, kLeastShare = 1.0 / 8;
/// Metres: nearer lines are not tested by lanes.
constexpr double kLeastReach = 1e-3;
/// Square metres: exceeds all rounding of coordinates of a town.
constexpr double kDoubt = 1e-7;
/// Metres: farther than all coordinates of a town.
constexpr double kFarAway = 1e6;
/// Metres to either side of a strip's middle line, for a mover that bends while it turns, and where
/// that is too much.
constexpr double kWide = 0.08, kNarrow = 1e-3;
/// Metres by which a strip keeps farther from obstacles than its half width: exceeds all rounding.
constexpr double kStripGap = 1e-4;
/// Metres beyond the horizon that the strip of a way may have.
constexpr double kMore = 2;
/// Degrees from the desired heading.
constexpr std::array<double, 11> kTurns = {0, -15, 15, -30, 30, -50, 50, -75, 75, -100, 100};

double square(double x) { return x * x; }

/// Returns the share of a line at which it is nearest to a point, from its product with the line.
ISPACE_INLINE double shareAt(double along) {
    const double least = simd::choose(along > 0, along, 0.0);
    return simd::choose(least < 1, least, 1.0);
}

/// Returns the least of `count` numbers, a multiple of kLanes; infinite without any.
ISPACE_INLINE double leastOf(const double* numbers, std::size_t count) {
    constexpr std::size_t kLanes = LineLanes::kLanes;
    std::array<double, kLanes> least;
    least.fill(kForever);
    for (std::size_t i = 0; i < count; i += kLanes)
        for (std::size_t k = 0; k < kLanes; ++k)
            least[k] = numbers[i + k] < least[k] ? numbers[i + k] : least[k];
    double result = least[0];
    for (std::size_t k = 1; k < kLanes; ++k) result = least[k] < result ? least[k] : result;
    return result;
}

/// Sets lanes to lines relative to a place, but for their reaches, and `squares` to their squared
/// distances. Returns the least of these.
ISPACE_SIMD_CLONES double fill(const ObstacleIndex::Line* __restrict all,
                               const std::uint32_t* __restrict which, std::size_t count,
                               double place_x, double place_y, LineLanes* __restrict lanes,
                               double* __restrict squares) {
    constexpr std::size_t kLanes = LineLanes::kLanes;
    for (std::size_t i = 0; i < count; ++i) {
        const ObstacleIndex::Line& line = all[which[i]];
        lanes->ax[i] = line.begin.x - place_x;
        lanes->ay[i] = line.begin.y - place_y;
        lanes->dx[i] = line.along.x;
        lanes->dy[i] = line.along.y;
        lanes->per_square[i] = line.per_square;
    }
    const std::size_t end = (count + kLanes - 1) / kLanes * kLanes;
    for (std::size_t i = count; i < end; ++i) {
        lanes->ax[i] = lanes->ay[i] = kFarAway;
        lanes->dx[i] = lanes->dy[i] = lanes->per_square[i] = 0;
    }
    lanes->count = end;
    for (std::size_t i = 0; i < end; ++i) {
        const double ax = lanes->ax[i], ay = lanes->ay[i], dx = lanes->dx[i], dy = lanes->dy[i];
        const double t = shareAt(-(ax * dx + ay * dy) * lanes->per_square[i]);
        const double x = ax + t * dx, y = ay + t * dy;
        squares[i] = x * x + y * y;
    }
    return leastOf(squares, end);
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

/// Returns the least squared distance of the way (x, y) to a line, less that at which it comes
/// near; -1 if they cross. Rounds otherwise than comesNear(). \param per_way inverse of its squared
/// length
ISPACE_INLINE double roomBeside(double ax, double ay, double dx, double dy, double per_square,
                                double reach_square, double x, double y, double per_way) {
    const double bx = ax + dx, by = ay + dy;
    // The end of the way to the line, then the line's ends to the way.
    const double t = shareAt(((x - ax) * dx + (y - ay) * dy) * per_square);
    const double ex = x - ax - t * dx, ey = y - ay - t * dy;
    const double s = shareAt((ax * x + ay * y) * per_way);
    const double fx = ax - s * x, fy = ay - s * y;
    const double u = shareAt((bx * x + by * y) * per_way);
    const double gx = bx - u * x, gy = by - u * y;
    const double e = ex * ex + ey * ey, f = fx * fx + fy * fy, g = gx * gx + gy * gy;
    const double fg = simd::choose(f < g, f, g);
    const double least = simd::choose(e < fg, e, fg) - reach_square;
    const double sides = (x * ay - y * ax) * (x * by - y * bx);
    const double ends = (dy * ax - dx * ay) * (dx * (y - ay) - dy * (x - ax));
    return simd::choose(sides < 0, simd::choose(ends < 0, -1.0, least), least);
}

/// Computes roomBeside() of each line. Returns the least.
ISPACE_SIMD_CLONES double findRoom(const LineLanes* __restrict lanes, double x, double y,
                                   double* __restrict room) {
    const double per_way = 1 / (x * x + y * y);
    const std::size_t count = lanes->count;
    for (std::size_t i = 0; i < count; ++i)
        room[i] = roomBeside(lanes->ax[i], lanes->ay[i], lanes->dx[i], lanes->dy[i],
                             lanes->per_square[i], lanes->reach_square[i], x, y, per_way);
    return leastOf(room, count);
}

/// Counts the points within a distance, of a multiple of kLanes.
ISPACE_SIMD_CLONES std::int64_t countNear(const double* __restrict x, const double* __restrict y,
                                          std::size_t count, double place_x, double place_y,
                                          double square) {
    std::int64_t near = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double dx = x[i] - place_x, dy = y[i] - place_y;
        near += dx * dx + dy * dy <= square ? 1 : 0;
    }
    return near;
}

/// Returns the length of a strip along a unit vector that the lines leave free, at most `most`.
/// \param reach distance that its middle line keeps from them
double freeLength(const LineLanes& lanes, Vec2 along, double most, double reach) {
    LineLanes::Lane room;
    findRoom(&lanes, most * along.x, most * along.y, room.data());
    double length = most;
    for (std::size_t i = 0; i < lanes.count; ++i) {
        if (room[i] + lanes.reach_square[i] - reach * reach > kDoubt) continue;
        const Vec2 begin{lanes.ax[i], lanes.ay[i]}, line{lanes.dx[i], lanes.dy[i]};
        // Before its nearer end, and before the way comes so near to the line without ends.
        const double first = dot(begin, along) + std::min(0.0, dot(line, along)) - reach;
        const double off = cross(line, begin), gain = cross(line, along);
        const double margin = std::abs(off) - reach / std::sqrt(lanes.per_square[i]);
        const double meets = margin > 0 && off * gain > 0 ? margin / std::abs(gain) : 0;
        length = std::min(length, std::max(first, meets));
    }
    return length;
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

void FewMovers::set(Traffic& traffic, std::span<const Mover> movers,
                    std::span<const Motion> motions) {
    traffic_ = &traffic;
    motions_ = motions;
    is_built_ = false;
    const std::size_t end =
        (motions.size() + LineLanes::kLanes - 1) / LineLanes::kLanes * LineLanes::kLanes;
    x_.assign(end, kFarAway);
    y_.assign(end, kFarAway);
    fastest_ = widest_ = 0;
    for (std::size_t i = 0; i < motions.size(); ++i) {
        const Motion& motion = motions[i];
        x_[i] = motion.pose.position.x;
        y_[i] = motion.pose.position.y;
        fastest_ = std::max(fastest_, std::abs(motion.drive.speed) + std::abs(motion.side.speed));
        widest_ = std::max(widest_, movers[i].model.radius);
    }
}

const Traffic* FewMovers::about(Point2 p, double reach) {
    if (countNear(x_.data(), y_.data(), x_.size(), p.x, p.y, square(reach)) < 2) return nullptr;
    if (!std::exchange(is_built_, true)) traffic_->rebuild(motions_);
    return traffic_;
}

void Steering::findNeighbours(const Surroundings& around, std::size_t mover) {
    const Traffic* traffic = around.traffic;
    if (around.few != nullptr) {
        const double fastest = speed_ + around.few->fastest();
        traffic = around.few->about(
            place_, (radius_ + around.few->widest() + kGap + fastest * horizon_) * (1 + 2 * kHair));
        if (traffic == nullptr) return;
    }
    const double sight = radius_ + std::min(kMoverSight, 2 * speed_ * horizon_);
    traffic->forEachNear(place_, sight, [&](std::size_t other) {
        if (other == mover) return;
        const Motion& motion = around.motions[other];
        const Vec2 offset = motion.pose.position - place_;
        const double reach = radius_ + around.movers[other].model.radius + kGap;
        // Most are too far away to meet within the horizon.
        const double fastest = speed_ + std::abs(motion.drive.speed) + std::abs(motion.side.speed);
        const double farthest = (reach + fastest * horizon_) * (1 + kHair);
        if (dot(offset, offset) > farthest * farthest) return;
        const Vec2 velocity = velocityOf(motion);
        const Neighbour found{offset.x, offset.y, velocity.x, velocity.y, reach};
        if (count_ < kUsualNeighbours) {
            few_[count_++] = found;
            return;
        }
        if (many_.empty()) many_.assign(few_.begin(), few_.end());
        many_.push_back(found);
    });
}

Steering::Course Steering::courseTo(Angle direction) const {
    return {direction, speed_ * unitVector(direction)};
}

/// Returns a course that deviates from the desired one by one of kTurns.
Steering::Course Steering::courseTo(Angle desired, Vec2 forward, std::size_t turn) const {
    const Angle direction = desired + Angle::degrees(kTurns[turn]);
    if (turn == 0) return {direction, speed_ * forward};
    // Without a neighbour the velocity decides on obstacles alone, in doubt by the exact one.
    if (helm_->index == nullptr || has_lines_ || count_ > 0) return courseTo(direction);
    static const std::array<Vec2, kTurns.size()> vectors = [] {
        std::array<Vec2, kTurns.size()> made;
        for (std::size_t i = 0; i < made.size(); ++i)
            made[i] = unitVector(Angle::degrees(kTurns[i]));
        return made;
    }();
    const Vec2 by = vectors[turn];
    return {direction,
            {speed_ * (by.x * forward.x - by.y * forward.y),
             speed_ * (by.y * forward.x + by.x * forward.y)},
            false};
}

/// Returns the unit vector along the desired heading, which is mostly that of the last choice.
Vec2 Steering::forwardOf(Angle desired) const {
    SteeringMemory* const memory = helm_->memory;
    if (memory == nullptr) return unitVector(desired);
    if (memory->heading != desired) {
        memory->heading = desired;
        memory->forward = unitVector(desired);
    }
    return memory->forward;
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
    for (const auto& [x, y, x_velocity, y_velocity, reach] : neighbours()) {
        const Vec2 offset{x, y}, closing = velocity - Vec2{x_velocity, y_velocity};
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

/// Returns the distance at which obstacles are passed if there is room.
double Steering::usualReach() const { return radius_ + kGap; }

/// Returns true only if all obstacles are at least that far away.
bool Steering::isApart() const { return nearest_ >= usualReach() + 2 * kHair; }

/// Fills lanes with the lines of the index about p. Returns the mover's distance to the nearest of
/// them; empty if the index does not know them, they are too many, or one is too near to the mover
/// to decide by lanes.
std::optional<double> Steering::fillAt(Point2 p, LineLanes& lanes) const {
    const auto near = helm_->index->near(p);
    if (!near || near->which.size() > LineLanes::kMost) return std::nullopt;
    LineLanes::Lane squares;
    const double least = fill(near->all.data(), near->which.data(), near->which.size(), place_.x,
                              place_.y, &lanes, squares.data());
    if (!(least > square(kLeastReach))) return std::nullopt;
    const double usual = usualReach(), apart = square(usual + 2 * kHair);
    std::fill_n(lanes.reach_square.begin(), lanes.count, square(usual));
    // A hair less than their distance, so that the way along them is free.
    for (std::size_t i = 0; i < lanes.count && least < apart; ++i)
        if (squares[i] < apart)
            lanes.reach_square[i] = square(std::min(usual, std::sqrt(squares[i]) - kHair));
    return std::sqrt(least);
}

/// Fills the lanes with the lines about the mover, unless all are beyond short ways. \returns false
/// as fillAt()
bool Steering::fillHere() const {
    const double usual = usualReach();
    const double farthest =
        usual + std::max(kAside * speed_ * horizon_ + 2 * kHair, kNarrow + kStripGap + kLeastReach);
    lanes_.count = 0;
    if (nearest_ > farthest) {
        known_ = nearest_;
        return true;
    }
    known_ = ObstacleIndex::kNear;
    const std::optional<double> nearest = fillAt(place_, lanes_);
    if (!nearest) return false;
    nearest_ = std::max(nearest_, std::min(ObstacleIndex::kNear, *nearest) - kDoubt);
    if (helm_->memory != nullptr) helm_->memory->nearest = nearest_;
    return true;
}

/// Tests a share of the horizon by the last choices; empty if they do not tell.
std::optional<bool> Steering::isFreeByMemory(Vec2 way, double share) const {
    const SteeringMemory* const memory = helm_->memory;
    if (memory == nullptr) return std::nullopt;
    if (memory->strip.contains({place_, place_ + way})) return true;
    if (share <= kAside || !memory->has_wall) return std::nullopt;
    const ObstacleIndex::Line& wall = memory->wall;
    const Vec2 begin = wall.begin - place_;
    const Vec2 foot = begin + shareAt(-dot(begin, wall.along) * wall.per_square) * wall.along;
    const double apart = std::sqrt(dot(foot, foot)) - kHair;
    if (apart < kLeastReach) return std::nullopt;
    const double room =
        roomBeside(begin.x, begin.y, wall.along.x, wall.along.y, wall.per_square,
                   square(std::min(usualReach(), apart)), way.x, way.y, 1 / dot(way, way));
    return room < -kDoubt ? std::optional(false) : std::nullopt;
}

/// Returns the length of a strip along a unit vector that circles without obstacles cover, at most
/// `most` and the last of their radii.
double Steering::freeAhead(Vec2 along, double most) const {
    constexpr double kLeastStep = 0.08;
    const double reach = usualReach() + kWide + kStripGap;
    double gone = 0, room = nearest_ - reach;
    while (room >= kLeastStep && gone < most) {
        gone += room;
        room = helm_->index->least(place_ + gone * along) - reach;
    }
    return gone;
}

/// Tests a share of the horizon by lines of the index; empty in doubt.
std::optional<bool> Steering::isFreeByLanes(Vec2 way, double share) const {
    const double usual = usualReach(), end = std::sqrt(dot(way, way));
    const bool is_long = share > kAside;
    SteeringMemory* const memory = is_long ? helm_->memory : nullptr;
    if (nearest_ < 0)
        nearest_ = std::max({0.0, helm_->clearance > 0 ? helm_->clearance + radius_ : 0,
                             helm_->index->least(place_)});
    bool is_looked_at = false;
    const auto is_blocked = [&] {
        if (!is_long || is_looked_at || !isApart()) return false;
        is_looked_at = true;
        for (const double part : {1.0, 0.75, 0.5})
            if (helm_->index->most(place_ + part * way) < usual - kDoubt) return true;
        return false;
    };
    // Circles without obstacles about points of the way.
    if (!is_long) {
        const auto is_clear = [&](double part, double half) {
            return helm_->index->least(place_ + part * way) > usual + half * end + kHair;
        };
        if (is_clear(1.0 / 2, 1.0 / 2) ||
            (is_clear(1.0 / 4, 1.0 / 4) && is_clear(3.0 / 4, 1.0 / 4)))
            return true;
    } else if (is_blocked()) {
        return false;
    } else if (memory != nullptr) {
        const double free = freeAhead(1 / end * way, end + kMore);
        if (free > end) {
            memory->strip = {place_, 1 / end * way, free, kWide};
            return true;
        }
    }
    if (!std::exchange(has_lanes_, true)) are_in_lanes_ = fillHere();
    if (!are_in_lanes_) return std::nullopt;
    LineLanes::Lane room;
    const auto test = [&](const LineLanes& lanes) -> std::optional<bool> {
        const double least = findRoom(&lanes, way.x, way.y, room.data());
        if (least > kDoubt) return true;
        if (least >= -kDoubt) return std::nullopt;
        if (memory != nullptr) {
            const auto i = static_cast<std::size_t>(
                std::min_element(room.begin(), room.begin() + lanes.count) - room.begin());
            memory->wall = {place_ + Vec2{lanes.ax[i], lanes.ay[i]},
                            {lanes.dx[i], lanes.dy[i]},
                            lanes.per_square[i]};
            memory->has_wall = true;
        }
        return false;
    };
    if (const auto is_free = test(lanes_); is_free != std::optional(true)) return is_free;
    // The point of a line that is nearest to the way lies beside it or about its end: lines about
    // points of the way tell of it as far as `each`, and of its end as far as `ahead`.
    const double apart = usual + kNarrow + kStripGap, reach = apart + kHair;
    const auto beside = [reach](double radius) {
        return std::sqrt(std::max(0.0, square(radius) - square(reach)));
    };
    const double ahead = ObstacleIndex::kNear - reach, each = beside(ObstacleIndex::kNear);
    if (!(ahead > kLeastReach && each > kLeastReach)) return std::nullopt;
    if (end <= known_ - usual - kHair) return true;
    if (is_blocked()) return false;
    constexpr std::size_t kMost = 3;
    std::array<LineLanes, kMost> lanes;
    std::size_t count = 0;
    const Vec2 along = 1 / end * way;
    double middle = beside(known_) + each;
    for (;; middle += 2 * each) {
        LineLanes& here = lanes[std::min(count++, kMost - 1)];
        if (!fillAt(place_ + middle * along, here)) return std::nullopt;
        if (const auto is_free = test(here); is_free != std::optional(true)) return is_free;
        if (middle + ahead >= end) break;
    }
    if (memory == nullptr || count > kMost || nearest_ < apart) return true;
    // The strip may be longer: then the next ways lie in it.
    if (count < kMost && fillAt(place_ + (middle + 2 * each) * along, lanes[count])) {
        middle += 2 * each;
        ++count;
    }
    double free = freeLength(lanes_, along, middle + ahead, apart);
    for (std::size_t i = 0; i < count && free > end; ++i)
        free = std::min(free, freeLength(lanes[i], along, middle + ahead, apart));
    if (free > end) memory->strip = {place_, along, free, kNarrow};
    return true;
}

/// Tests a share of the horizon.
bool Steering::isFreeOfLines(const Course& course, double share) const {
    const bool is_indexed = helm_->index != nullptr && !has_lines_;
    if (is_indexed) {
        const Vec2 way = share * horizon_ * course.velocity;
        if (const auto is_free = isFreeByMemory(way, share)) return *is_free;
        if (const auto is_free = isFreeByLanes(way, share)) return *is_free;
    }
    const Vec2 velocity = course.is_exact ? course.velocity : courseTo(course.direction).velocity;
    const Segment2 way{place_, place_ + share * horizon_ * velocity};
    if (is_indexed) return isFreeByIndex(way);
    findLines();
    return std::none_of(lines_.begin(), lines_.end(),
                        [&](const Line& line) { return comesNear(way, line.line, line.reach); });
}

/// Tests the first `most` of the horizon. A result below `needed` may be too small.
double Steering::untilLine(const Course& course, double most, double needed) const {
    if (isFreeOfLines(course, most)) return kForever;
    for (double share = most / 2; share >= kLeastShare && share * horizon_ >= needed; share /= 2)
        if (isFreeOfLines(course, share)) return share * horizon_;
    return 0;
}

/// Tests a way against the lines that findLines() would find, of which it reads those near the way.
bool Steering::isFreeByIndex(const Segment2& way) const {
    const double ahead = speed_ * horizon_ + kGap;
    if (helm_->clearance > ahead) return true;
    const ObstacleIndex::Outlook look = helm_->index->look(way, radius_ + kGap);
    if (look != ObstacleIndex::Outlook::Unknown) return look == ObstacleIndex::Outlook::Clear;
    helm_->index->findIn(bounds(way).expanded(radius_ + kGap), nearby_);
    const double farthest = radius_ + ahead;
    return std::none_of(nearby_.begin(), nearby_.end(), [&](const Segment2& line) {
        const double square = squaredDistance(place_, line);
        return square < farthest * farthest &&
               comesNear(way, line, std::min(radius_ + kGap, std::sqrt(square) - kHair));
    });
}

double Steering::freeTime(Angle direction) const {
    const Course course = courseTo(direction);
    const double time = std::min(horizon_, untilNeighbour(course.velocity));
    return time == 0 ? 0 : std::min(time, untilLine(course, 1, 0));
}

bool Steering::isFree(Vec2 way) const {
    const Segment2 path{place_, place_ + way};
    findLines();
    const bool is_clear = std::all_of(lines_.begin(), lines_.end(), [&](const Line& line) {
        const double at_end = std::sqrt(squaredDistance(path.b, line.line));
        const double reach = std::min(line.reach, std::max(radius_, at_end) - kHair);
        return !comesNear(path, line.line, reach);
    });
    const std::span<const Neighbour> others = neighbours();
    return is_clear && std::all_of(others.begin(), others.end(), [&](const Neighbour& other) {
               const Vec2 offset{other.x, other.y};
               const double apart = std::min(other.reach, length(offset) - kHair);
               return squaredDistance(place_ + offset, path) >= apart * apart;
           });
}

FreeHeading Steering::choose(Angle desired, double needed) const {
    // Degrees of turning that a second of free way is worth.
    constexpr double kWorth = 120;
    // Most often one of them is free. Without any, all times are compared.
    std::array<double, kTurns.size()> most;  // upper bounds of these times
    const auto share_of = [](double turn) { return turn == 0 ? 1 : kAside; };
    const Vec2 forward = forwardOf(desired);
    for (std::size_t i = 0; i < kTurns.size(); ++i) {
        const Course course = courseTo(desired, forward, i);
        most[i] = std::min(horizon_, untilNeighbour(course.velocity));
        if (most[i] < needed) continue;
        if (most[i] == 0) return {course.direction, 0};  // as long as needed: no time at all
        const double share = share_of(kTurns[i]);
        const double time = std::min(most[i], untilLine(course, share, needed));
        if (time >= needed) return {course.direction, time};
        most[i] = std::min(most[i], share / 2 * horizon_);
    }
    FreeHeading best{desired, 0};
    double best_worth = -kForever;
    for (std::size_t i = 0; i < kTurns.size(); ++i) {
        const double turn = kTurns[i], price = std::abs(turn) / kWorth;
        if (most[i] - price <= best_worth) continue;
        const Course course = courseTo(desired, forward, i);
        const double time =
            most[i] == 0 ? 0 : std::min(most[i], untilLine(course, share_of(turn), 0));
        const double worth = time - price;
        if (worth > best_worth && (time > 0 || turn == 0)) {
            best = {course.direction, time};
            best_worth = worth;
        }
    }
    return best;
}

}  // namespace ispace
