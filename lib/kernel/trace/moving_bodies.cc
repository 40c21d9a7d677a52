// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies are found by FloorGrid: cells are at least as wide as two bodies' reaches, and at most 2 n
// + 1, however far apart bodies are; lists lie in one array, filled by counting. Candidates come by
// cell, then by number; each keeps the nearer range, so that their order does not matter.
#include "trace/moving_bodies.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "geom/tolerance.h"
#include "trace/body_scan.h"
#include "trace/rays.h"

namespace ispace {

double MovingBody::reach() const {
    return radius > 0 ? radius : std::sqrt(half_length * half_length + half_width * half_width);
}

double MovingBody::sway() const { return std::fabs(lean) * (top - bottom) / 2; }

MovingBody MovingBody::cutAt(double z) const {
    MovingBody cut = *this;
    const double up = z - middle();
    cut.pose.position = pose.position + lean * up * unitVector(pose.heading);
    if (is_ball) cut.radius = std::sqrt(std::max(0.0, radius * radius - up * up));
    cut.lean = 0;
    cut.is_ball = false;
    return cut;
}

Vec3 MovingBody::normalAt(Point3 place) const {
    const BodyFrame from(*this, cosSin(pose.heading), place);
    const Vec2 at = from.offset();
    const Vec2 along = unitVector(pose.heading), across = perpendicular(along);
    const auto in_world = [&](Vec3 n) {
        const Vec2 flat = n.x * along + n.y * across;
        return 1 / length(n) * Vec3{flat.x, flat.y, n.z};
    };
    if (is_ball) return in_world({at.x, at.y, place.z - middle()});
    // Normal of the face that lies farthest out.
    struct Face {
        double height;
        Vec3 normal;
    };
    const double x = std::copysign(1.0, at.x), y = std::copysign(1.0, at.y);
    const bool is_round = radius > 0;
    const Face faces[] = {
        {place.z - top, {0, 0, 1}},
        {bottom - place.z, {0, 0, -1}},
        is_round ? Face{length(at) - radius, {at.x, at.y, -lean * at.x}}
                 : Face{std::fabs(at.x) - half_length, {x, 0, 0}},
        is_round ? Face{-radius, {}} : Face{std::fabs(at.y) - half_width, {0, y, 0}}};
    return in_world(
        std::max_element(std::begin(faces), std::end(faces), [](const Face& a, const Face& b) {
            return a.height < b.height;
        })->normal);
}

MovingBody movingBody(const BodyPart& part, const Pose2& pose, CosSin axes, std::uint32_t owner) {
    const auto& [x, y] = part.center;
    const Vec2 way{axes.cos * x - axes.sin * y, axes.sin * x + axes.cos * y};
    return {.pose = {pose.position + way, pose.heading},
            .half_length = part.half_length,
            .half_width = part.half_width,
            .radius = part.radius,
            .bottom = part.bottom,
            .top = part.top,
            .owner = owner,
            .lean = part.lean,
            .is_ball = part.is_ball,
            .faces_down = part.faces_down};
}

double MovingBody::meet(Point3 origin, Vec3 direction) const {
    return BodyFrame(*this, cosSin(pose.heading), origin).meet(direction).multiple;
}

void FloorGrid::rebuild(std::span<const Point2> places, double reach) {
    // Small margin, so that rounding cannot lose a touching body.
    reach_ = reach * (1 + kContactTolerance) + kContactTolerance;
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

FloorGrid::Cells FloorGrid::cellsAbout(const Box2& box) const {
    if (box.empty()) return {};
    const auto [low, high] = box.expanded(reach_);
    return {cellOf(low.x - box_.low.x, columns_), cellOf(high.x - box_.low.x, columns_),
            cellOf(low.y - box_.low.y, rows_), cellOf(high.y - box_.low.y, rows_)};
}

Box2 FloorGrid::partInRow(Point2 a, Point2 b, std::size_t row) const {
    // Rounding is far less than this.
    const double around = reach_ + kContactTolerance * (1 + size_);
    const double low = box_.low.y + static_cast<double>(row) * size_ - around;
    const double high = low + size_ + 2 * around;
    double from = 0, to = 1;
    if (const double climb = b.y - a.y; climb != 0) {
        const double at_low = (low - a.y) / climb, at_high = (high - a.y) / climb;
        from = std::max(from, std::min(at_low, at_high));
        to = std::min(to, std::max(at_low, at_high));
    }
    Box2 part;
    if (from > to) return part;
    part.add(a + from * (b - a));
    part.add(a + to * (b - a));
    return part;
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
    bottom_ = std::numeric_limits<double>::infinity();
    top_ = -bottom_;
    for (const MovingBody& body : bodies_) {
        bottom_ = std::min(bottom_, body.bottom - kContactTolerance);
        top_ = std::max(top_, body.top + kContactTolerance);
        places_.push_back(body.pose.position);
        // The parts of a person have the same heading.
        const bool is_alike =
            !extents_.empty() && body.pose.heading == bodies_[extents_.size() - 1].pose.heading;
        const bool is_same = !extents_.empty() && body.owner == bodies_[extents_.size() - 1].owner;
        const std::uint32_t mover =
            extents_.empty() ? 0 : extents_.back().mover + (is_same ? 0 : 1);
        const double own = body.reach();
        extents_.push_back({is_alike ? extents_.back().axes : cosSin(body.pose.heading), own,
                            own + body.sway(), mover});
        reach = std::max(reach, extents_.back().whole);
    }
    grid_.rebuild(places_, reach);
}

void MovingBodies::shorten(Point3 origin, const Directions& directions, double max_range,
                           std::uint32_t own, std::span<float> ranges,
                           std::span<float> cosines) const {
    assert(directions.size() == ranges.size());
    if (directions.arc && directions.arc->step > Angle() && !ranges.empty() && !grid_.empty()) {
        BodyArc arc(origin, directions, max_range, bodies_, extents_, {max_range, ranges, cosines});
        return arc.meetFrom(grid_, own);
    }
    shortenInBlocks({&origin, 1}, directions, 0, ranges.size(), max_range, own, ranges, cosines);
}

void MovingBodies::shorten(std::span<const Point3> origins, const Directions& directions,
                           std::size_t begin, std::size_t end, double max_range, std::uint32_t own,
                           std::span<float> ranges, std::span<float> cosines) const {
    assert(directions.size() == ranges.size() && origins.size() == ranges.size());
    assert(begin <= end && end <= ranges.size());
    shortenInBlocks(origins, directions, begin, end, max_range, own, ranges, cosines);
}

void MovingBodies::shortenInBlocks(std::span<const Point3> origins, const Directions& directions,
                                   std::size_t begin, std::size_t end, double max_range,
                                   std::uint32_t own, std::span<float> ranges,
                                   std::span<float> cosines) const {
    if (grid_.empty()) return;
    const ShortenedRanges shortened(max_range, ranges, cosines);
    for (; begin < end; begin += BodyScan::kBlock) {
        BodyScan scan(origins, directions, begin, std::min(begin + BodyScan::kBlock, end),
                      max_range, shortened);
        grid_.forEachNear(scan.box(), [&](std::size_t i) {
            if (bodies_[i].owner != own) scan.meet(bodies_[i], extents_[i]);
        });
    }
}

void MovingBodies::shorten(Point3 origin, const RayGrid& grid, double most, std::uint32_t own,
                           std::span<float> multiples, std::span<float> cosines) const {
    assert(grid.size() == multiples.size());
    if (multiples.empty() || grid_.empty()) return;
    BodyPicture picture(origin, grid, most, {most, multiples, cosines});
    grid_.forEachNear(picture.box(), [&](std::size_t i) {
        if (bodies_[i].owner != own) picture.meet(bodies_[i], extents_[i]);
    });
}

bool MovingBodies::clipToHeights(Point3& a, Point3& b) const {
    double from = 0, to = 1;
    if (const double climb = b.z - a.z; climb != 0) {
        const double at_bottom = (bottom_ - a.z) / climb, at_top = (top_ - a.z) / climb;
        from = std::max(from, std::min(at_bottom, at_top));
        to = std::min(to, std::max(at_bottom, at_top));
    } else if (a.z < bottom_ || a.z > top_) {
        return false;
    }
    if (!(from <= to)) return false;
    const Vec3 way = b - a;
    b = a + to * way;
    a = a + from * way;
    return true;
}

bool MovingBodies::between(Point3 a, Point3 b, std::uint32_t own) const {
    return anyAlong(a, b, [&](std::size_t i) {
        if (bodies_[i].owner == own) return false;
        const RayInterval inside = BodyFrame(bodies_[i], extents_[i].axes, a).within(b - a);
        return inside.enter <= inside.exit && inside.enter <= 1 && inside.exit >= 0;
    });
}

std::vector<std::uint32_t> MovingBodies::bodiesNear(Point2 place, double reach) const {
    std::vector<std::uint32_t> near;
    const Vec2 around{reach, reach};
    grid_.forEachRun({place - around, place + around}, {}, [&](std::size_t begin, std::size_t end) {
        const std::span<const std::uint32_t> run = grid_.order().subspan(begin, end - begin);
        near.insert(near.end(), run.begin(), run.end());
    });
    std::sort(near.begin(), near.end());
    return near;
}

double MovingBodies::meet(std::size_t i, Point3 origin, Vec3 direction) const {
    return BodyFrame(bodies_[i], extents_[i].axes, origin).meet(direction).multiple;
}

}  // namespace ispace
