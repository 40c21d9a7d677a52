// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/shadow_caster.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "cover/shadow_bodies.h"
#include "cover/shadow_footprint.h"
#include "geom/overlay.h"
#include "geom/visibility.h"
#include "sense/scan_plane.h"
#include "sensor/kind.h"

namespace ispace {

struct ShadowCaster::Data {
    std::vector<ShadowBody> bodies;  ///< clear glass first, the floor last
    std::size_t clear = 0;           ///< so many are of clear glass

    explicit Data(const Environment& environment) : bodies(clearBodiesOf(environment)) {
        clear = bodies.size();
        std::vector<ShadowBody> opaque = opaqueBodiesOf(environment);
        std::move(opaque.begin(), opaque.end(), std::back_inserter(bodies));
    }
    /// What throws shadows of sound and of light.
    [[nodiscard]] std::span<const ShadowBody> solid() const { return bodies; }
    [[nodiscard]] std::span<const ShadowBody> opaque() const { return solid().subspan(clear); }
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

/// What has all marks and is in no shadow, of layers that count from `foot`.
std::vector<Curve> laid(std::span<const Layer> layers, std::uint64_t marks, Point2 foot) {
    std::vector<Curve> curves = Overlay(layers).curves(
        [marks](const LayerLabel& label) { return label.marks == marks && label.count == 0; });
    for (Curve& curve : curves) curve = movedBy(foot - Point2{}, std::move(curve));
    return curves;
}

/// A plane this near to the sensor is taken for one that passes through it.
bool passesThrough(double drop) { return std::fabs(drop) <= kRayEpsilon; }

std::vector<Curve> regionInView(std::span<const ShadowBody> bodies, const FieldOfView& view,
                                double height) {
    const Point3 sensor = view.frame.origin;
    const bool is_level = passesThrough(height - sensor.z);
    const double drop = is_level ? 0 : height - sensor.z;
    Footprint footprint(view, drop, is_level);
    const Box2 box = footprint.box;
    if (!(box.low.x < box.high.x && box.low.y < box.high.y)) return {};
    if (is_level) {
        Frame3 plane;
        plane.origin = sensor;
        const VisibilityMap map(cutsOf(bodies, plane, footprint.reach));
        const Curve seen = outlineOf(map.query({0, 0}, footprint.reach));
        if (seen.empty()) return {};
        footprint.mark({seen});
    } else {
        const Shadows shadows(bodies, sensor, height, box);
        for (const ShadowBody& body : bodies)
            for (Layer& layer : shadows.of(body)) footprint.layers.push_back(std::move(layer));
    }
    return laid(footprint.layers, footprint.marks, sensor.onFloor());
}

/// A line of sight in a scan plane ends at the floor, which has no end.
void addFloor(const Frame3& plane, double max_range, std::vector<Segment2>& lines) {
    const Vec2 uphill{plane.forward.z, plane.left.z};
    const double slope = length(uphill);
    if (!(slope * max_range > plane.origin.z)) return;
    const Vec2 way = 1 / slope * uphill;
    const Point2 nearest = Point2{} - (plane.origin.z / slope) * way;
    const Vec2 aside = (2 * max_range) * perpendicular(way);
    lines.push_back({nearest - aside, nearest + aside});
}

/// A curve of a scan plane on the plan, counted from the foot.
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
    const std::span<const ShadowBody> all = opaque();
    std::vector<Segment2> lines =
        cutsOf(is_over_floor ? all.first(all.size() - 1) : all, plane.frame(), laser.max_range);
    if (is_over_floor) addFloor(plane.frame(), laser.max_range, lines);
    const VisibilityMap map(lines);
    const VisibleRegion seen = map.query({0, 0}, laser.max_range);
    const Curve curve = onPlan(outlineOf(sectorOf(seen, laser.first, laser.span())), plane);
    if (curve.empty()) return std::vector<Curve>{};
    const Point2 foot = sensor.pose.position.onFloor();
    if (is_over_floor) return std::vector<Curve>{movedBy(foot - Point2{}, curve)};
    // From below the floor: what of it is above.
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
    // Such a lens ends somewhere in the picture, and on no circle.
    if (const Camera* camera = std::get_if<Camera>(&sensor.model);
        camera != nullptr && camera->isLopsided() && !camera->fillsPicture())
        return std::nullopt;
    const bool is_light = kindOf(sensor.model).stopped_by == Surfaces::Opaque;
    return regionInView(is_light ? data_->opaque() : data_->solid(), *view, height);
}

}  // namespace ispace
