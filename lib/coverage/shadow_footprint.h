// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "env/environment.h"
#include "geom/curve.h"
#include "geom/overlay/overlay.h"
#include "geom/point.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// How finely conics are laid out: as arcs none farther from them than this, in metres.
constexpr double kConicError = kChordError / 100;

/// Appends arcs along a smooth curve from place(begin) to place(end), which begin where the edges
/// of `curve` end. O(1 / error^(1/3))
template <typename Place>
void follow(Place place, double begin, double end, Curve& curve);

/// The circle about (0, 0), counter-clockwise.
Curve circleOf(double radius);

/// The part of a convex polygon where dot(normal, p) + offset >= 0.
Polygon halfOf(const Polygon& polygon, Vec2 normal, double offset);

/// What a camera's picture shows of a level plane, `drop` over the foot, within `reach` of the
/// foot; farther away the curves close somehow. Its border is traced as it is bent, within
/// kConicError. No value: all of the plane is in view; no curves: nothing. (picture_footprint.cc)
std::optional<std::vector<Curve>> pictureOnPlane(const FieldOfView& view, double drop,
                                                 double reach);

/// What of a level plane is in view if nothing stands between, as layers: a place is in view if
/// it has all `marks` and no counted layer holds it. Places count from the foot, where the sensor
/// is right above or below.
struct Footprint {
    std::vector<Layer> layers;
    std::uint64_t marks = 0;
    Box2 box;  ///< holds all that is in view; empty if nothing is
    /// No place in view is farther from the foot. The disc is one of the layers unless
    /// `disc_is_left_out`.
    double reach = 0;

    /// `drop` is the height of the plane over the sensor: below 0 if it looks down. With 0 the
    /// plane passes through the sensor.
    Footprint(const FieldOfView& view, double drop, bool disc_is_left_out);
    /// Adds what must hold a place; nothing is in view any more without curves.
    void mark(std::vector<Curve> curves);

  private:
    void addCone(Vec3 axis, Angle half, double drop, bool is_in_view);
    void addPolygon(const FieldOfView& view, double drop);
    void addPicture(const FieldOfView& view, double drop);
    void addWedgeBehind(const FieldOfView& view, double drop);
};

// What follow() is made of.

/// The arc from a to b through `middle`, straight if it is so within rounding.
CurveEdge arcThrough(Point2 a, Point2 middle, Point2 b);
/// How far a place on it may lie from an edge; +infinity for arcs of more than a half turn.
double distanceFrom(const CurveEdge& edge, Point2 middle, Point2 place);

template <typename Place>
void follow(Place place, double begin, double end, Curve& curve) {
    constexpr int kPieces = 8, kDeepest = 16;
    const auto piece = [&](auto& self, double t, Point2 from, double u, Point2 to,
                           int depth) -> void {
        const double half = t + (u - t) / 2;
        const Point2 middle = place(half);
        const CurveEdge edge = arcThrough(from, middle, to);
        const double off = std::max(distanceFrom(edge, middle, place(t + (u - t) / 4)),
                                    distanceFrom(edge, middle, place(t + (u - t) * 3 / 4)));
        if (off <= kConicError || depth == 0) {
            curve.push_back(edge);
            return;
        }
        self(self, t, from, half, middle, depth - 1);
        self(self, half, middle, u, to, depth - 1);
    };
    Point2 from = curve.empty() ? place(begin) : curve.back().to;
    for (int i = 1; i <= kPieces; ++i) {
        const double t = begin + (end - begin) * (i - 1) / kPieces;
        const double u = begin + (end - begin) * i / kPieces;
        const Point2 to = place(u);
        piece(piece, t, from, u, to, kDeepest);
        from = to;
    }
}

/// What sensors that do not scan in a level slice see of a level plane: what is in their field of
/// view and range, and in no shadow that a body throws. The blind zone is not cut out. A place on
/// the plane that a body covers is seen if sight reaches it. Light passes clear glass, sound does
/// not; a receiver hears there a tag that emits all around.
///
/// A laser that scans in one tilted plane covers the floor over or under which that plane passes in
/// sight, above the floor (`height` does not count). Of swept lasers no closed form is known, nor
/// of cameras whose tangential distortion ends their field of view within the picture.
///
/// Needs the environment no longer once it is made; copies share what they hold. Thread-safe.
class ShadowCaster {
  public:
    explicit ShadowCaster(const Environment& environment);

    /// The exact region: disjoint curves with what is seen on their left. Conics are laid out
    /// within kChordError (of receivers and spherical rangers that see farther than some hundred
    /// times their height over the plane somewhat worse). Empty curves: nothing is seen; nothing:
    /// not known. O(n log n) in the triangles near the field of view and the crossings of their
    /// shadows. \throws FormatError for shadows that cross by the ten million
    [[nodiscard]] std::optional<std::vector<Curve>> regionSeen(const Sensor& sensor,
                                                               double height) const;

  private:
    struct Data;
    std::shared_ptr<const Data> data_;
};

}  // namespace ispace
