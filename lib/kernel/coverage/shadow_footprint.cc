// SPDX-License-Identifier: GPL-3.0-or-later
// A field of view cut by a level plane: half planes through the sides of a pyramid, a disc for the
// range, and conics for cones, whose points follow from the angle about the axis in closed form.
// Curves that leave the disc about the foot are closed beyond it. The region seen is the overlay of
// these with the shadows; for a plane through the sensor, where shadows are unbounded, a visibility
// polygon stands for them.
#include "coverage/shadow_footprint.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "coverage/dense_floor.h"
#include "coverage/shadow_bodies.h"
#include "geom/overlay/overlay.h"
#include "geom/tolerance.h"
#include "geom/visibility/visibility.h"
#include "scene/sensor/sensor.h"
#include "sense/scan.h"

namespace ispace {

namespace {

Polygon square(double half) { return {{-half, -half}, {half, -half}, {half, half}, {-half, half}}; }

/// Returns the part of a level plane, `drop` above the foot, on the positive side of a plane
/// through the sensor with this normal.
Polygon halfOf(const Polygon& polygon, Vec3 normal, double drop) {
    return ispace::halfOf(polygon, Vec2{normal.x, normal.y}, normal.z * drop);
}

/// A cone with its apex at the sensor, cut by a level plane: a conic that opens along `axis`.
struct Conic {
    Vec2 along{1, 0}, across{0, 1};  ///< of unit length
    double run = 0, rise = 0;        ///< components of the axis: along the plane and towards it
    double cosine = 1, sine = 0;     ///< of the half angle
    double drop = 0;                 ///< distance of the plane, not 0

    Conic(Vec3 axis, Angle half, double height)
        : run(std::hypot(axis.x, axis.y)),
          rise(height < 0 ? -axis.z : axis.z),
          cosine(cos(half)),
          sine(sin(half)),
          drop(std::fabs(height)) {
        if (run > 0) along = {axis.x / run, axis.y / run};
        across = perpendicular(along);
    }
    /// Slope of the cone at an angle around its axis: 0 where it is nearest to the plane.
    [[nodiscard]] double steepness(double around) const {
        return cosine * rise + sine * run * std::cos(around);
    }
    [[nodiscard]] Point2 at(double around) const {
        const double far = drop / steepness(around);
        const double u = cosine * run - sine * rise * std::cos(around);
        return Point2{} + far * u * along + far * sine * std::sin(around) * across;
    }
};

/// Intersection of a cone with the disc about the foot: the disc, the empty set, or a curve's area.
struct ConeCut {
    bool holds_all = false;
    std::optional<Curve> curve;
};

/// \pre 0 < half < 90 degrees
ConeCut wedgeOf(Vec3 axis, Angle half, double reach) {
    const double run = std::hypot(axis.x, axis.y), cosine = cos(half);
    if (run <= cosine) return {};
    const Vec2 along{axis.x / run, axis.y / run}, across = perpendicular(along);
    const double c = cosine / run, s = std::sqrt(1 - c * c);
    Polygon wedge = square(2 * reach);
    wedge = ispace::halfOf(wedge, s * along + c * across, 0);
    wedge = ispace::halfOf(wedge, s * along - c * across, 0);
    return {false, curveOf(wedge)};
}

/// Closes the conic well outside the disc. \pre 0 < half < 90 degrees
ConeCut coneOnPlane(Vec3 axis, Angle half, double drop, double reach) {
    if (drop == 0) return wedgeOf(axis, half, reach);
    const Conic conic(axis, half, drop);
    const double beyond = 2 * std::hypot(reach, drop);
    // cos(around) at which the conic enters that distance.
    const double least = conic.drop / beyond - conic.cosine * conic.rise;
    const double swing = conic.sine * conic.run;
    if (swing <= least) return {conic.rise >= conic.cosine, std::nullopt};
    Curve curve;
    if (-swing >= least) {
        follow([&conic](double around) { return conic.at(around); }, std::numbers::pi,
               -std::numbers::pi, curve);
        curve.back().to = curve.front().from;
        return {false, std::move(curve)};
    }
    const double end = std::acos(std::clamp(least / swing, -1.0, 1.0));
    const double radius = std::sqrt(beyond * beyond - drop * drop);
    const Point2 left = conic.at(end), right = conic.at(-end);
    const double turn =
        std::atan2(dot(left - Point2{}, conic.across), dot(left - Point2{}, conic.along));
    const auto outside = [&conic, radius](double angle) {
        return Point2{} + radius * std::cos(angle) * conic.along +
               radius * std::sin(angle) * conic.across;
    };
    curve.push_back({right, outside(-turn)});  // zero length up to rounding
    follow(outside, -turn, turn, curve);
    curve.back().to = left;
    follow([&conic](double around) { return conic.at(around); }, end, -end, curve);
    curve.back().to = right;
    std::erase_if(curve, [](const CurveEdge& edge) { return edge.from == edge.to; });
    return {false, std::move(curve)};
}

}  // namespace

CurveEdge arcThrough(Point2 a, Point2 middle, Point2 b) {
    const Vec2 m = middle - a, c = b - a;
    const double turn = cross(m, c);
    if (!(std::fabs(turn) > kContactTolerance * length(c))) return {a, b};
    const double mm = dot(m, m), cc = dot(c, c);
    const Vec2 center{(c.y * mm - m.y * cc) / (2 * turn), (m.x * cc - c.x * mm) / (2 * turn)};
    const double radius = length(center);
    return {a, b, turn > 0 ? radius : -radius, a + center};
}

double distanceFrom(const CurveEdge& edge, Point2 middle, Point2 place) {
    if (!edge.isArc()) {
        const Vec2 way = edge.to - edge.from;
        const double size = length(way);
        return size > 0 ? std::fabs(cross(way, place - edge.from)) / size
                        : distance(edge.from, place);
    }
    if (dot(middle - edge.from, edge.to - middle) < 0)
        return std::numeric_limits<double>::infinity();
    return std::fabs(distance(edge.center, place) - std::fabs(edge.radius));
}

Curve circleOf(double radius) {
    const Point2 corners[] = {{radius, 0}, {0, radius}, {-radius, 0}, {0, -radius}};
    Curve curve;
    for (std::size_t i = 0; i < 4; ++i)
        curve.push_back({corners[i], corners[(i + 1) % 4], radius, {0, 0}});
    return curve;
}

Polygon halfOf(const Polygon& polygon, Vec2 normal, double offset) {
    const auto over = [normal, offset](Point2 p) {
        return normal.x * p.x + normal.y * p.y + offset;
    };
    Polygon half;
    half.reserve(polygon.size() + 2);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point2 p = polygon[i], q = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        const double fp = over(p), fq = over(q);
        if (fp >= 0) half.push_back(p);
        if ((fp > 0 && fq < 0) || (fp < 0 && fq > 0)) half.push_back(p + fp / (fp - fq) * (q - p));
    }
    if (half.size() < 3) half.clear();
    return half;
}

void Footprint::mark(std::vector<Curve> curves) {
    const std::uint64_t bit = marks + 1;
    marks |= bit;
    box = common(box, boundsOfAll(curves));
    layers.push_back({std::move(curves), false, 0, bit});
}

void Footprint::addCone(Vec3 axis, Angle half, double drop, bool is_in_view) {
    ConeCut cut;
    if (half > Angle()) cut = coneOnPlane(axis, half, drop, reach);
    if (cut.curve && is_in_view) return mark({*std::move(cut.curve)});
    if (cut.curve) {
        layers.push_back({{*std::move(cut.curve)}, true, 0, 0});
        return;
    }
    if (cut.holds_all != is_in_view) box = {};
}

/// Clips by the planes through the sensor that bound the field of view, and by a range along its
/// axis.
void Footprint::addPolygon(const FieldOfView& view, double drop) {
    const Frame3& frame = view.frame;
    const Angle right_angle = Angle::degrees(90);
    Polygon polygon = square(reach);
    const auto keep = [&](Vec3 local) { polygon = halfOf(polygon, frame * local, drop); };
    if (view.shape == FieldOfView::Shape::Pyramid) {
        const Tangents& sides = view.sides;
        keep({sides.right, 1, 0});
        keep({sides.down, 0, 1});
        keep({sides.left, -1, 0});
        keep({sides.up, 0, -1});
    } else if (view.shape == FieldOfView::Shape::Window && view.half_x <= right_angle) {
        const auto [c, s] = cosSin(view.half_x);
        for (const double side : {1.0, -1.0}) keep({s, side * c, 0});
    } else if (view.shape == FieldOfView::Shape::Cone && view.half_x == right_angle) {
        keep({1, 0, 0});
    }
    if (view.is_by_depth) {
        const Vec3 f = frame.forward;
        polygon = ispace::halfOf(polygon, Vec2{-f.x, -f.y}, view.max_range - f.z * drop);
    }
    if (polygon.empty()) {
        box = {};
        return;
    }
    mark({curveOf(polygon)});
}

void Footprint::addPicture(const FieldOfView& view, double drop) {
    auto curves = pictureOnPlane(view, drop, reach);
    if (!curves) return;
    if (curves->empty())
        box = {};
    else
        mark(*std::move(curves));
}

/// Removes the wedge behind the sensor that bearings of more than a half turn leave out.
void Footprint::addWedgeBehind(const FieldOfView& view, double drop) {
    const auto [c, s] = cosSin(Angle::degrees(180) - view.half_x);
    Polygon wedge = square(2 * reach);
    for (const double side : {1.0, -1.0})
        wedge = halfOf(wedge, view.frame * Vec3{-s, side * c, 0}, drop);
    if (!wedge.empty()) layers.push_back({{curveOf(wedge)}, true, 0, 0});
}

Footprint::Footprint(const FieldOfView& view, double drop, bool disc_is_left_out) {
    const double far = view.farthest();
    if (!withinRange(std::fabs(drop), far) || std::fabs(drop) >= far) return;
    reach = std::sqrt(far * far - drop * drop);
    const Angle right_angle = Angle::degrees(90), half_turn = Angle::degrees(180);
    box.add({-reach, -reach});
    box.add({reach, reach});
    addPolygon(view, drop);
    if (!view.is_by_depth && !disc_is_left_out) mark({circleOf(reach)});
    const Frame3& frame = view.frame;
    if (view.shape == FieldOfView::Shape::Picture) addPicture(view, drop);
    if (view.least_density > 0) {
        std::vector<Curve> dense =
            DenseFloor::alone(*view.resolution, frame, drop, box, view.least_density);
        if (dense.empty())
            box = {};
        else
            mark(std::move(dense));
    }
    if (view.shape == FieldOfView::Shape::Cone) {
        if (view.half_x < right_angle)
            addCone(frame.forward, view.half_x, drop, true);
        else if (view.half_x > right_angle && view.half_x < half_turn)
            addCone(-1 * frame.forward, half_turn - view.half_x, drop, false);
    }
    if (view.shape == FieldOfView::Shape::Window) {
        if (view.half_x > right_angle && view.half_x < half_turn) addWedgeBehind(view, drop);
        if (view.half_y < right_angle)
            for (const double side : {1.0, -1.0})
                addCone(side * frame.up, right_angle - view.half_y, drop, false);
    }
}

struct ShadowCaster::Data {
    explicit Data(const Environment& environment) : bodies(environment) {}

    ShadowBodies bodies;

    [[nodiscard]] std::vector<Curve> regionInView(const FieldOfView& view, double height,
                                                  Surfaces surfaces) const;
    [[nodiscard]] std::optional<std::vector<Curve>> regionScanned(const Sensor& sensor) const;
};

ShadowCaster::ShadowCaster(const Environment& environment)
    : data_(std::make_shared<const Data>(environment)) {}

namespace {

Curve movedBy(Vec2 way, Curve curve) {
    for (CurveEdge& edge : curve) {
        edge.from = edge.from + way;
        edge.to = edge.to + way;
        if (edge.isArc()) edge.center = edge.center + way;
    }
    return curve;
}

/// Returns the area with all marks outside all shadows, of layers relative to `foot`.
std::vector<Curve> laid(std::span<const Layer> layers, std::uint64_t marks, Point2 foot) {
    std::vector<Curve> curves = Overlay(layers).curves(
        [marks](const LayerLabel& label) { return label.marks == marks && label.count == 0; });
    for (Curve& curve : curves) curve = movedBy(foot - Point2{}, std::move(curve));
    return curves;
}

/// A plane this near to the sensor counts as one through it.
bool passesThrough(double drop) { return std::fabs(drop) <= kRayEpsilon; }

/// The space between two heights over a box relative to a sensor's foot, and over the foot itself,
/// enlarged by more than the distance of contact.
ShadowBodies::Space spaceAbout(Point2 foot, Box2 box, double bottom, double top) {
    constexpr double kMargin = 2 * kRayEpsilon;
    box.add({0, 0});
    const Vec2 out = foot - Point2{kMargin, kMargin}, in = foot - Point2{-kMargin, -kMargin};
    return {{box.low + out, box.high + in}, bottom - kMargin, top + kMargin};
}

Box2 boxAbout(double reach) { return {{-reach, -reach}, {reach, reach}}; }

}  // namespace

std::vector<Curve> ShadowCaster::Data::regionInView(const FieldOfView& view, double height,
                                                    Surfaces surfaces) const {
    const Point3 sensor = view.frame.origin;
    const bool is_level = passesThrough(height - sensor.z);
    const double drop = is_level ? 0 : height - sensor.z;
    Footprint footprint(view, drop, is_level);
    const Box2 box = footprint.box;
    if (!(box.low.x < box.high.x && box.low.y < box.high.y)) return {};
    const ShadowBodies::Space space =
        spaceAbout(sensor.onFloor(), is_level ? boxAbout(footprint.reach) : box,
                   std::min(sensor.z, height), std::max(sensor.z, height));
    std::vector<const ShadowBody*> near = bodies.near(space, surfaces);
    if (space.bottom <= 0 && space.top >= 0) near.push_back(&bodies.floor());
    if (is_level) {
        Frame3 plane;
        plane.origin = sensor;
        const VisibilityMap map(cutsOf(near, plane, footprint.reach));
        const Curve seen = outlineOf(map.query({0, 0}, footprint.reach));
        if (seen.empty()) return {};
        footprint.mark({seen});
    } else {
        const Shadows shadows(near, sensor, height, box);
        for (const ShadowBody* const body : near)
            for (Layer& layer : shadows.of(*body)) footprint.layers.push_back(std::move(layer));
    }
    return laid(footprint.layers, footprint.marks, sensor.onFloor());
}

namespace {

/// Adds the floor, an unbounded plane, at which lines of sight in a scan plane end.
void addFloor(const Frame3& plane, double max_range, std::vector<Segment2>& lines) {
    const Vec2 uphill{plane.forward.z, plane.left.z};
    const double slope = length(uphill);
    if (!(slope * max_range > plane.origin.z)) return;
    const Vec2 way = 1 / slope * uphill;
    const Point2 nearest = Point2{} - (plane.origin.z / slope) * way;
    const Vec2 aside = (2 * max_range) * perpendicular(way);
    lines.push_back({nearest - aside, nearest + aside});
}

/// Maps a curve of a scan plane to the plan, relative to the foot.
Curve onPlan(const Curve& curve, const ScanPlane& plane) {
    const Vec3 &f = plane.frame().forward, &l = plane.frame().left;
    const auto place_of = [&](Point2 p) {
        return Point2{p.x * f.x + p.y * l.x, p.x * f.y + p.y * l.y};
    };
    Curve out;
    out.reserve(curve.size());
    for (const CurveEdge& edge : curve) {
        const Point2 from = out.empty() ? place_of(edge.from) : out.back().to;
        const Point2 to = place_of(edge.to);
        if (!edge.isArc()) {
            if (from != to) out.push_back({from, to});
            continue;
        }
        const double radius = std::fabs(edge.radius);
        const Vec2 begin = edge.from - edge.center, end = edge.to - edge.center;
        const double first = std::atan2(begin.y, begin.x);
        const double span = std::atan2(cross(begin, end), dot(begin, end));
        if (out.empty()) out.push_back({from, from});
        follow(
            [&](double angle) {
                return place_of(edge.center + radius * Vec2{std::cos(angle), std::sin(angle)});
            },
            first, first + span, out);
    }
    if (out.empty()) return out;
    out.back().to = out.front().from;
    std::erase_if(out, [](const CurveEdge& edge) { return edge.from == edge.to; });
    if (plane.up() > 0) return out;
    std::reverse(out.begin(), out.end());
    for (CurveEdge& edge : out) {
        std::swap(edge.from, edge.to);
        edge.radius = -edge.radius;
    }
    return out;
}

}  // namespace

std::optional<std::vector<Curve>> ShadowCaster::Data::regionScanned(const Sensor& sensor) const {
    const Laser& laser = sensor.as<Laser>();
    if (laser.sweep != SweepAxis::None) return std::nullopt;
    const ScanPlane plane(sensor.pose);
    if (plane.up() == 0) return std::vector<Curve>{};
    const bool is_over_floor = sensor.pose.position.z > kRayEpsilon;
    const Point2 foot = sensor.pose.position.onFloor();
    constexpr double kAnyHeight = std::numeric_limits<double>::infinity();
    std::vector<const ShadowBody*> near = bodies.near(
        spaceAbout(foot, boxAbout(laser.max_range), -kAnyHeight, kAnyHeight), Surfaces::Opaque);
    if (!is_over_floor) near.push_back(&bodies.floor());
    std::vector<Segment2> lines = cutsOf(near, plane.frame(), laser.max_range);
    if (is_over_floor) addFloor(plane.frame(), laser.max_range, lines);
    const VisibilityMap map(lines);
    const VisibleRegion seen = map.query({0, 0}, laser.max_range);
    const Curve curve = onPlan(outlineOf(sectorOf(seen, laser.first, laser.span())), plane);
    if (curve.empty()) return std::vector<Curve>{};
    if (is_over_floor) return std::vector<Curve>{movedBy(foot - Point2{}, curve)};
    // From below the floor: the part of the scan plane above it.
    const double far = laser.max_range;
    const double z = plane.heightAt(foot);
    const Vec2 uphill{plane.heightAt(foot + Vec2{1, 0}) - z, plane.heightAt(foot + Vec2{0, 1}) - z};
    const Polygon over = halfOf({{-far, -far}, {far, -far}, {far, far}, {-far, far}}, uphill, z);
    if (over.empty()) return std::vector<Curve>{};
    const Layer layers[] = {{{curve}, false, 0, 1}, {{curveOf(over)}, false, 0, 2}};
    return laid(layers, 3, foot);
}

std::optional<std::vector<Curve>> ShadowCaster::regionSeen(const Sensor& sensor,
                                                           double height) const {
    const auto view = fieldOfView(sensor);
    if (!view) return data_->regionScanned(sensor);
    // Such a lens ends within the picture, but not on a circle.
    if (const Camera* camera = std::get_if<Camera>(&sensor.model);
        camera != nullptr && camera->isLopsided() && !camera->fillsPicture())
        return std::nullopt;
    return data_->regionInView(*view, height, kindOf(sensor.model).stopped_by);
}

}  // namespace ispace
