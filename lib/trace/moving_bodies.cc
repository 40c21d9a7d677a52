// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/moving_bodies.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace ispace {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Degrees added to each side of a body as a sensor sees it. The arc sine of a body that is almost
/// touched is worth half the digits of a double, about 1e-6 degrees.
constexpr double kAngularSlack = 1e-5;

/// Slack, relative to max_range, for bodies that begin where the rays end.
constexpr double kFarSlack = 1e-6;

/// The stretch of a ray within a closed set.
struct Stretch {
    double from = -kInfinity, to = kInfinity;

    void cut(double a, double b) {
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    void clear() { *this = {kInfinity, -kInfinity}; }
    /// A ray parallel to two planes lies between them, or it does not.
    void cutSlab(double origin, double direction, double low, double high) {
        if (direction != 0)
            cut((low - origin) / direction, (high - origin) / direction);
        else if (origin < low || origin > high)
            clear();
    }
    void cutDisc(Vec2 origin, Vec2 direction, double radius) {
        const double a = dot(direction, direction), b = dot(origin, direction);
        const double side = cross(origin, direction);
        const double root = a * radius * radius - side * side;
        if (a == 0 ? dot(origin, origin) > radius * radius : root < 0) {
            clear();
        } else if (a != 0) {
            const double half = std::sqrt(root);
            cut((-b - half) / a, (-b + half) / a);
        }
    }
    /// Where the ray first meets the surface: from inside where it leaves.
    [[nodiscard]] double meeting() const {
        if (from > to || to < 0) return kInfinity;
        return from >= 0 ? from : to;
    }
};

/// A body as rays from one place meet it: what they share is computed once.
class BodyFrom {
  public:
    BodyFrom(const MovingBody& body, CosSin axes, Point3 origin)
        : body_(body), axes_(axes), height_(origin.z) {
        offset_ = turned(origin.onFloor() - body.pose.position);
    }

    [[nodiscard]] double meet(Vec3 direction) const {
        const Vec2 flat = turned({direction.x, direction.y});
        Stretch stretch;
        stretch.cutSlab(height_, direction.z, body_.bottom, body_.top);
        if (body_.radius > 0) {
            stretch.cutDisc(offset_, flat, body_.radius);
        } else {
            stretch.cutSlab(offset_.x, flat.x, -body_.half_length, body_.half_length);
            stretch.cutSlab(offset_.y, flat.y, -body_.half_width, body_.half_width);
        }
        return stretch.meeting();
    }

  private:
    /// From the world into the body's frame.
    [[nodiscard]] Vec2 turned(Vec2 v) const {
        return {axes_.cos * v.x + axes_.sin * v.y, axes_.cos * v.y - axes_.sin * v.x};
    }

    const MovingBody& body_;
    CosSin axes_;
    Vec2 offset_;  // of the rays' origin, in the body's frame
    double height_;
};

/// A fan of rays and the ranges that bodies shorten.
class Fan {
  public:
    Fan(const Pose3& sensor, Angle first, Angle step, std::span<const Vec3> directions,
        double max_range, std::span<float> ranges)
        : sensor_(sensor),
          first_((sensor.heading + first).degrees()),
          step_(step.degrees()),
          directions_(directions),
          far_(max_range),
          ranges_(ranges) {
        const double span = step_ * (static_cast<double>(ranges.size()) - 1);
        if (span <= 180) ahead_ = unitVector(Angle::degrees(first_ + span / 2));
    }

    /// All that may be met lies on this part of the floor.
    [[nodiscard]] Box2 box() const {
        const Point2 middle = sensor_.position.onFloor();
        const Vec2 corner{far_ * (1 + kFarSlack), far_ * (1 + kFarSlack)};
        return {middle - corner, middle + corner};
    }

    /// Level rays: a body is met at its height only, and by the beams that point at it only.
    void meetLevel(const MovingBody& body, const BodyExtent& extent) {
        const double height = sensor_.position.z;
        if (height < body.bottom || height > body.top || !approach(body, extent)) return;
        // Behind all beams: half of what is near, and cheaper to tell than where it is.
        if (dot(way_, ahead_) < -reach_ * (1 + kFarSlack)) return;
        const BodyFrom from(body, extent.axes, sensor_.position);
        if (distance_ <= reach_ * (1 + kFarSlack)) {
            meetBeams(from, 0, ranges_.size());
        } else {
            const double half = Angle::radians(std::asin(reach_ / distance_)).degrees();
            meetBetween(from, directionOf(way_.x, way_.y).degrees(), half + kAngularSlack);
        }
    }

    void meetTilted(const MovingBody& body, const BodyExtent& extent) {
        if (approach(body, extent))
            meetBeams(BodyFrom(body, extent.axes, sensor_.position), 0, ranges_.size());
    }

  private:
    /// Takes the body's place on the floor. \return false if it is too far away
    bool approach(const MovingBody& body, const BodyExtent& extent) {
        way_ = body.pose.position - sensor_.position.onFloor();
        distance_ = std::sqrt(dot(way_, way_));
        reach_ = extent.reach;
        return distance_ - reach_ <= far_ * (1 + kFarSlack);
    }

    /// Beams that point within `half` degrees of `middle`, in any turn.
    void meetBetween(const BodyFrom& body, double middle, double half) {
        const auto last = static_cast<double>(ranges_.size()) - 1;
        if (step_ <= 0) return meetBeams(body, 0, ranges_.size());
        double begin = std::fmod(middle - half - first_, 360.0);
        if (begin > 0) begin -= 360;
        // Begins in the turn before the first beam and may go on in each turn of the fan.
        for (; begin <= last * step_; begin += 360) {
            const double from = std::ceil(begin / step_);
            const double to = std::floor((begin + 2 * half) / step_);
            if (to < 0) continue;
            meetBeams(body, static_cast<std::size_t>(std::clamp(from, 0.0, last + 1)),
                      static_cast<std::size_t>(std::min(to, last)) + 1);
        }
    }

    void meetBeams(const BodyFrom& body, std::size_t begin, std::size_t end) {
        const auto far = static_cast<float>(far_);
        const double nearest = distance_ - reach_;
        for (std::size_t k = begin; k < end; ++k) {
            if (ranges_[k] <= nearest) continue;
            // As float32: what begins exactly at max_range is met.
            const auto range = static_cast<float>(body.meet(directions_[k]));
            if (range <= far && range < ranges_[k]) ranges_[k] = range;
        }
    }

    const Pose3& sensor_;
    double first_, step_;  // degrees, in the world
    std::span<const Vec3> directions_;
    double far_;
    std::span<float> ranges_;
    Vec2 ahead_;  // no beam points away from it; null if there is no such direction
    // Of the body at hand, on the floor.
    Vec2 way_;
    double distance_ = 0, reach_ = 0;
};

}  // namespace

double MovingBody::reach() const {
    return radius > 0 ? radius : std::hypot(half_length, half_width);
}

double MovingBody::meet(Point3 origin, Vec3 direction) const {
    return BodyFrom(*this, cosSin(pose.heading), origin).meet(direction);
}

void FloorGrid::rebuild(std::span<const Point2> places, double reach) {
    // A hair more, so that rounding loses nothing that just touches.
    constexpr double kSlack = 1e-9;
    reach_ = reach * (1 + kSlack) + kSlack;
    box_ = {};
    for (const Point2& place : places) box_.add(place);
    if (places.empty()) box_ = {{0, 0}, {0, 0}};
    // At most 2 n + 1 cells, however far apart the things are: n over the area, and n / 2 along
    // each side.
    const auto count = static_cast<double>(std::max<std::size_t>(1, places.size()));
    const double longer = std::max(box_.width(), box_.depth());
    size_ = std::max({2 * reach_, 2 * longer / count,
                      std::sqrt(box_.width() / count) * std::sqrt(box_.depth())});
    columns_ = static_cast<std::size_t>(box_.width() / size_) + 1;
    rows_ = static_cast<std::size_t>(box_.depth() / size_) + 1;

    // Count, then fill: the lists of all cells lie in one array.
    const auto cell = [&](Point2 place) {
        return cellOf(place.y - box_.low.y, rows_) * columns_ +
               cellOf(place.x - box_.low.x, columns_);
    };
    first_.assign(columns_ * rows_ + 1, 0);
    for (const Point2& place : places) ++first_[cell(place)];
    std::uint32_t end = 0;
    for (std::uint32_t& entry : first_) entry = end += entry;
    indices_.resize(places.size());
    // Backwards from the ends, which thereby become the beginnings.
    for (std::size_t i = places.size(); i-- > 0;)
        indices_[--first_[cell(places[i])]] = static_cast<std::uint32_t>(i);
}

std::size_t FloorGrid::cellOf(double offset, std::size_t count) const {
    const double cell = offset / size_;
    if (!(cell > 0)) return 0;
    return cell < static_cast<double>(count) ? static_cast<std::size_t>(cell) : count - 1;
}

MovingBodies::MovingBodies(std::vector<MovingBody> bodies) : bodies_(std::move(bodies)) { index(); }

void MovingBodies::rebuild(std::span<const MovingBody> bodies) {
    bodies_.assign(bodies.begin(), bodies.end());
    index();
}

void MovingBodies::index() {
    places_.clear();
    places_.reserve(bodies_.size());
    extents_.clear();
    extents_.reserve(bodies_.size());
    double reach = 0;
    for (const MovingBody& body : bodies_) {
        places_.push_back(body.pose.position);
        extents_.push_back({cosSin(body.pose.heading), body.reach()});
        reach = std::max(reach, extents_.back().reach);
    }
    grid_.rebuild(places_, reach);
}

void MovingBodies::shorten(const Pose3& sensor, Angle first, Angle step,
                           std::span<const Vec3> directions, double max_range, std::uint32_t own,
                           std::span<float> ranges) const {
    assert(directions.size() == ranges.size());
    if (ranges.empty()) return;
    Fan fan(sensor, first, step, directions, max_range, ranges);
    const bool level = sensor.isLevel();
    grid_.forEachNear(fan.box(), [&](std::size_t i) {
        const MovingBody& body = bodies_[i];
        if (body.owner == own) return;
        if (level)
            fan.meetLevel(body, extents_[i]);
        else
            fan.meetTilted(body, extents_[i]);
    });
}

}  // namespace ispace
