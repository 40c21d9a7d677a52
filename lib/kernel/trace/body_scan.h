// SPDX-License-Identifier: GPL-3.0-or-later
// Intersects single rays, level scans and pictures with moving bodies. Private to MovingBodies.
//
// All by one exact test (BodyFrame), behind bounds that only skip: cones, boxes of pixels and
// angles of beams are wider than rounding (kAngularSlack is three times the error of angleOf(), a
// pixel's slack 1e-3), so that a bound never changes a range. Each keeps the nearer of the range so
// far and the body; the order of bodies does not matter.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "trace/moving_bodies.h"
#include "trace/rays.h"
#include "trace/round_body.h"

namespace ispace {

/// A body as seen from one origin; stores the values that its rays share.
class BodyFrame {
  public:
    BodyFrame(const MovingBody& body, CosSin axes, Point3 origin)
        : body_(body), axes_(axes), height_(origin.z) {
        offset_ = turned(origin.onFloor() - body.pose.position);
        offset_.x -= body.lean * (height_ - body.middle());
    }

    [[nodiscard]] RayInterval within(Vec3 direction) const {
        const Vec2 flat = turned({direction.x, direction.y});
        RayInterval inside;
        if (body_.is_ball) {
            inside.cutBall({offset_.x, offset_.y, height_ - body_.middle()},
                           {flat.x, flat.y, direction.z}, body_.radius);
            return inside;
        }
        inside.cutSlab(height_, direction.z, body_.bottom, body_.top);
        if (body_.radius > 0) {
            inside.cutDisc(offset_, {flat.x - body_.lean * direction.z, flat.y}, body_.radius,
                           body_.lean);
        } else {
            inside.cutSlab(offset_.x, flat.x, -body_.half_length, body_.half_length);
            inside.cutSlab(offset_.y, flat.y, -body_.half_width, body_.half_width);
        }
        return inside;
    }
    /// Finds the first intersection at a multiple of at least `least`; from inside, the exit.
    [[nodiscard]] RayHit meet(Vec3 direction, double least = 0) const {
        const RayInterval inside = within(direction);
        if (inside.enter > inside.exit || inside.exit < least) return {};
        if (inside.enter >= least) return {inside.enter, inside.enter_slope};
        return {inside.exit, inside.exit_slope};
    }

    [[nodiscard]] const MovingBody& body() const { return body_; }
    [[nodiscard]] CosSin axes() const { return axes_; }
    /// Origin of the rays in the body's frame, relative to the centre of the level cut there.
    [[nodiscard]] Vec2 offset() const { return offset_; }

  private:
    /// Converts from the world to the body's frame.
    [[nodiscard]] Vec2 turned(Vec2 v) const {
        return {axes_.cos * v.x + axes_.sin * v.y, axes_.cos * v.y - axes_.sin * v.x};
    }

    const MovingBody& body_;
    CosSin axes_;
    Vec2 offset_;  // of the rays' origin, in the body's frame
    double height_;
};

/// Ranges shortened by bodies, and their cosines.
class ShortenedRanges {
  public:
    ShortenedRanges(double most, std::span<float> ranges, std::span<float> cosines)
        : far_(static_cast<float>(most)), ranges_(ranges), cosines_(cosines) {}

    [[nodiscard]] float operator[](std::size_t i) const { return ranges_[i]; }
    /// \param size length of the direction
    void shorten(std::size_t i, const RayHit& met, double size) {
        // Compare as float32, so that a body exactly at the limit is met.
        const auto range = static_cast<float>(met.multiple);
        if (!(range <= far_ && range < ranges_[i])) return;
        ranges_[i] = range;
        if (!cosines_.empty()) cosines_[i] = std::min(1.0F, static_cast<float>(met.slope / size));
    }

  private:
    float far_;
    std::span<float> ranges_, cosines_;
};

/// Neighbouring rays of a scan, shortened by bodies, with a common origin or one origin
/// each.
class BodyScan {
  public:
    static constexpr std::size_t kBlock =
        32;  ///< rays per bounding box in which bodies are searched

    /// Holds rays `begin` to before `end`. \pre origins.size() is 1 or directions.size(); begin <
    /// end
    BodyScan(std::span<const Point3> origins, const Directions& directions, std::size_t begin,
             std::size_t end, double max_range, const ShortenedRanges& ranges);

    /// Bounding box of the rays on the floor: bodies outside it are not met.
    [[nodiscard]] const Box2& box() const { return box_; }
    void meet(const MovingBody& body, const BodyExtent& extent);

  private:
    [[nodiscard]] Point3 origin(std::size_t k) const { return origins_[is_one_ ? 0 : k]; }

    std::span<const Point3> origins_;
    bool is_one_;
    const Directions& directions_;
    std::size_t begin_, end_;
    ShortenedRanges ranges_;
    Box2 box_;
    // A cone on the floor that holds all rays; if below half a turn, its sides as unit vectors.
    Vec2 right_, left_;
    Point2 middle_;  // centre of the origins
    double spread_ = 0,
           reach_ = 0;   // radius about it that holds the origins, and maximum length of rays
    double low_, high_;  // range of the rays' heights
};

/// The pixels [left, right) x [top, bottom) of a picture.
struct PixelBox {
    int left = 0, top = 0, right = 0, bottom = 0;
};

/// A picture with ranges shortened by bodies.
class BodyPicture {
  public:
    BodyPicture(Point3 origin, const RayGrid& grid, double most, const ShortenedRanges& ranges);

    /// Bounding box of the rays on the floor: bodies outside it are not met.
    [[nodiscard]] Box2 box() const;
    void meet(const MovingBody& body, const BodyExtent& extent);

    /// Returns the pixels with rays that may meet the body; all if the body holds the origin.
    [[nodiscard]] PixelBox pixelsOf(const MovingBody& body, const BodyExtent& extent) const;

  private:
    /// Converts a vector to multiples of right, down and corner.
    [[nodiscard]] Vec3 projected(Vec3 way) const {
        return {dot(to_right_, way), dot(to_down_, way), dot(to_corner_, way)};
    }

    Point3 origin_;
    const RayGrid& grid_;
    double far_;  // metres
    ShortenedRanges ranges_;
    bool is_plane_ = false;  // false: the rays lie in a plane through the origin
    Vec3 to_right_, to_down_, to_corner_;
};

/// A level scan of equal steps, shortened by bodies. Bodies are collected in growing squares
/// around the scanner and intersected from the nearest on. Skips bodies if all their beams end
/// nearer, at walls or other bodies: in rooms and crowds nearly all.
class BodyArc {
  public:
    /// \pre directions.arc, with a step above 0
    BodyArc(Point3 origin, const Directions& directions, double max_range,
            std::span<const MovingBody> bodies, std::span<const BodyExtent> extents,
            const ShortenedRanges& ranges);

    /// Intersects all bodies except those of `own`, visiting near grid cells before farther ones.
    void meetFrom(const FloorGrid& grid, std::uint32_t own);

  private:
    static constexpr std::size_t kBlock = 8, kMaxWaiting = 256;

    /// A body, the lower bound of its distance, and the beams that may meet it: from first to last,
    /// and from other_first to other_last if the body spans both ends of the scan.
    struct Waiting {
        double nearest;
        std::uint32_t body;
        std::int32_t first, last, other_first, other_last;
    };
    /// Returns the part of the floor where bodies may still shorten a beam.
    [[nodiscard]] Box2 view() const;
    /// Collects those of the given bodies that may shorten a beam.
    void look(std::span<const std::uint32_t> bodies, std::uint32_t own);
    void meetCollected();
    [[nodiscard]] bool isSeen(const Waiting& waiting) const;
    [[nodiscard]] bool isSeen(std::int32_t first, std::int32_t last, double nearest) const;
    void meetBeams(const BodyFrame& body, std::int32_t first, std::int32_t last, double nearest);
    void findFarthest(std::size_t block);

    Point3 origin_;
    const Directions& directions_;
    std::span<const MovingBody> bodies_;
    std::span<const BodyExtent> extents_;
    double far_;
    float most_;  // that plus a margin
    ShortenedRanges ranges_;
    CosSin middle_;                 // of the arc
    double rate_ = 0;               // beams per radian
    double count_ = 0;              // number of beams
    std::vector<float>& farthest_;  // the maximum range of each block of beams
    std::array<Waiting, kMaxWaiting> waiting_;
    std::size_t size_ = 0;
};

}  // namespace ispace
