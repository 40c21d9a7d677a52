// SPDX-License-Identifier: GPL-3.0-or-later
// Fields of view and shadows on a level plane, and the region that is in view and in no shadow.
//
//     const ShadowCaster caster(environment);
//     if (const auto region = caster.regionSeen(camera, 0.0))  // disjoint curves
//         area = signedArea(*region);
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

/// Maximum distance of the arcs that approximate a conic from it, metres.
constexpr double kConicError = kChordError / 100;

/// Appends arcs along a smooth curve from place(begin) to place(end); they begin where the edges of
/// `curve` end. A piece is halved until the curve's points at its quarters lie within kConicError
/// of the arc through its ends and middle; 16 times at most. O(1 / error^(1/3)): an arc through
/// three points errs by the cube of its length.
template <typename Place>
void follow(Place place, double begin, double end, Curve& curve);

/// Returns the circle about (0, 0), counter-clockwise.
Curve circleOf(double radius);

/// Returns the part of a convex polygon where dot(normal, p) + offset >= 0.
Polygon halfOf(const Polygon& polygon, Vec2 normal, double offset);

/// Computes the part of a level plane in a camera's picture, `drop` above the foot, within `reach`
/// of the foot; beyond that, closing edges are arbitrary. The distorted border is traced within
/// kConicError. No value: the whole plane is in view; no curves: the plane is out of view.
/// (picture_footprint.cc)
std::optional<std::vector<Curve>> pictureOnPlane(const FieldOfView& view, double drop,
                                                 double reach);

/// The part of a level plane in an unobstructed field of view, as layers: a point is in view if it
/// has all `marks` and lies in no counted layer. Coordinates are relative to the foot of the
/// sensor, the point right above or below it.
struct Footprint {
    std::vector<Layer> layers;
    std::uint64_t marks = 0;
    Box2 box;  ///< bounds of the part in view; empty if the plane is out of view
    /// Maximum distance of a point in view from the foot. The disc is one of the layers unless
    /// `disc_is_left_out`.
    double reach = 0;

    /// `drop` is the height of the plane above the sensor: negative if the sensor looks down, 0 if
    /// the plane passes through it.
    Footprint(const FieldOfView& view, double drop, bool disc_is_left_out);
    /// Intersects the view with the area of these curves; without curves the view is empty.
    void mark(std::vector<Curve> curves);

  private:
    void addCone(Vec3 axis, Angle half, double drop, bool is_in_view);
    void addPolygon(const FieldOfView& view, double drop);
    void addPicture(const FieldOfView& view, double drop);
    void addWedgeBehind(const FieldOfView& view, double drop);
};

// Steps of follow().

/// Returns the arc from a to b through `middle`, straight if it is so within rounding.
CurveEdge arcThrough(Point2 a, Point2 middle, Point2 b);
/// Returns the maximum distance of a point on the arc from an edge; +infinity for arcs of more than
/// a half turn.
double distanceFrom(const CurveEdge& edge, Point2 middle, Point2 place);

template <typename Place>
void follow(Place place, double begin, double end, Curve& curve) {
    constexpr int kPieces = 8, kMaxDepth = 16;
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
        piece(piece, t, from, u, to, kMaxDepth);
        from = to;
    }
}

/// Computes the part of a level plane that a sensor sees, unless it scans in a level slice: in its
/// field of view and range, outside all shadows. The blind zone is not cut out. A point of the
/// plane inside a body is seen if a line of sight reaches it. Light passes clear glass, sound does
/// not; a receiver hears an omnidirectional tag there.
///
/// A laser that scans in one tilted plane covers the floor below or above the visible part of that
/// plane, above the floor (`height` does not count). The closed form is unknown for swept lasers,
/// and for cameras if tangential distortion ends their field of view within the picture.
///
/// The environment is required only during construction; copies share their data. Thread-safe.
class ShadowCaster {
  public:
    explicit ShadowCaster(const Environment& environment);

    /// Computes the exact region: disjoint curves with the seen floor on their left. Conics are
    /// approximated within kChordError (less closely for receivers and spherical rangers if
    /// their range exceeds some hundred times their height above the plane). Empty curves: no floor
    /// is seen; no value: unknown. O(n log n) in the triangles near the field of view and the
    /// crossings of their shadows. \throws FormatError for shadows with tens of millions of
    /// crossings
    [[nodiscard]] std::optional<std::vector<Curve>> regionSeen(const Sensor& sensor,
                                                               double height) const;

  private:
    struct Data;
    std::shared_ptr<const Data> data_;
};

}  // namespace ispace
