// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/body_fan.h"

#include "trace/ray_limits.h"

namespace ispace {

namespace {

/// Degrees added to each side of a body as a sensor sees it. The arc sine of a body that is almost
/// touched is worth half the digits of a double, about 1e-6 degrees.
constexpr double kAngularSlack = 1e-5;

}  // namespace

BodyFan::BodyFan(Point3 origin, const Directions& directions, double max_range,
                 const ShortenedRanges& ranges)
    : origin_(origin), directions_(directions), far_(max_range), ranges_(ranges) {
    if (!directions.arc) return;
    first_ = directions.arc->first.degrees();
    step_ = directions.arc->step.degrees();
    const double span = step_ * (static_cast<double>(directions.size()) - 1);
    if (span >= 0 && span <= 180) ahead_ = unitVector(Angle::degrees(first_ + span / 2));
}

Box2 BodyFan::box() const {
    const Point2 middle = origin_.onFloor();
    const Vec2 corner{far_ * (1 + kFarSlack), far_ * (1 + kFarSlack)};
    return {middle - corner, middle + corner};
}

void BodyFan::meet(const MovingBody& body, const BodyExtent& extent) {
    if (directions_.arc)
        meetArc(body, extent);
    else if (approach(body, extent))
        meetAll(BodyFrom(body, extent.axes, origin_));
}

/// Level rays: a body is met at its height only, and by the beams that point at it only.
void BodyFan::meetArc(const MovingBody& body, const BodyExtent& extent) {
    const double height = origin_.z;
    if (height < body.bottom || height > body.top || !approach(body, extent)) return;
    // Behind all beams: half of what is near, and cheaper to tell than where it is.
    if (dot(way_, ahead_) < -reach_ * (1 + kFarSlack)) return;
    const BodyFrom from(body, extent.axes, origin_);
    if (distance_ <= reach_ * (1 + kFarSlack)) {
        meetBeams(from, 0, directions_.size());
    } else {
        const double half = Angle::radians(std::asin(reach_ / distance_)).degrees();
        meetBetween(from, directionOf(way_.x, way_.y).degrees(), half + kAngularSlack);
    }
}

/// Rays of all directions: those that pass its middle on the floor near enough.
void BodyFan::meetAll(const BodyFrom& body) {
    const double wide = reach_ * (1 + kFarSlack) * reach_ * (1 + kFarSlack);
    for (std::size_t k = 0; k < directions_.size(); ++k) {
        const double x = directions_.x[k], y = directions_.y[k];
        const double aside = way_.x * y - way_.y * x;
        if (aside * aside <= wide * (x * x + y * y) + 1e-12) meetBeams(body, k, k + 1);
    }
}

/// Takes the body's place on the floor. \return false if it is too far away
bool BodyFan::approach(const MovingBody& body, const BodyExtent& extent) {
    way_ = body.pose.position - origin_.onFloor();
    distance_ = std::sqrt(dot(way_, way_));
    reach_ = extent.reach;
    return distance_ - reach_ <= far_ * (1 + kFarSlack);
}

/// Beams that point within `half` degrees of `middle`, in any turn.
void BodyFan::meetBetween(const BodyFrom& body, double middle, double half) {
    const auto last = static_cast<double>(directions_.size()) - 1;
    if (step_ <= 0) return meetBeams(body, 0, directions_.size());
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

void BodyFan::meetBeams(const BodyFrom& body, std::size_t begin, std::size_t end) {
    const double nearest = distance_ - reach_;
    for (std::size_t k = begin; k < end; ++k)
        if (static_cast<double>(ranges_[k]) > nearest)
            ranges_.shorten(k, body.meet(directions_[k]), 1);
}

}  // namespace ispace
