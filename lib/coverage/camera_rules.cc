// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/camera_rules.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>
#include <utility>
#include <variant>

#include "base/error.h"
#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"
#include "coverage/metrics.h"
#include "coverage/visible_area.h"
#include "env/zone.h"
#include "geom/curve_clip.h"
#include "record/schema.h"
#include "scene/sensor/camera.h"

namespace ispace {

namespace {

constexpr std::string_view kZonePrefix = "zone:";

std::string_view withoutPrefix(std::string_view text) {
    return text.starts_with(kZonePrefix) ? text.substr(kZonePrefix.size()) : text;
}

Angle angleOf(std::string_view text) {
    KeySpec key;
    key.unit = Unit::Angle;
    return Angle::degrees(std::get<double>(parseValue(key, text)));
}

bool isAngle(std::string_view text) {
    try {
        static_cast<void>(angleOf(text));
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

/// Returns the zones that match. \throws UsageError if none does
std::vector<Zone> matchingZones(const std::string& pattern, const Environment& environment) {
    std::vector<Zone> zones = zonesOf(environment);
    std::vector<std::string> known;
    known.reserve(zones.size());
    for (const Zone& zone : zones) known.push_back(zone.id);
    const Glob glob(pattern);
    std::erase_if(zones, [&glob](const Zone& zone) { return !glob.matches(zone.id); });
    if (zones.empty())
        throw UsageError("the room has no zone `" + printable(pattern) + '`' +
                         didYouMean(pattern, known));
    return zones;
}

constexpr std::uint64_t kZoneMark = 2, kViewMark = 4, kWedgeMark = 8;

/// The indoor part of a zone, and the part of it in some views.
struct AreaInZone {
    double zone = 0, seen = 0;
};

AreaInZone areasIn(const Environment& environment, const Zone& zone,
                   const std::vector<std::vector<Curve>>& views) {
    Polygon outline = zone.outline;
    if (signedArea(outline) < 0) std::reverse(outline.begin(), outline.end());
    std::vector<Layer> layers = {markLayer(curvesWithArcs(environment.indoor()), kIndoorMark),
                                 markLayer({curveOf(outline)}, kZoneMark)};
    // The step of an overlay's lattice grows with the extent of its layers.
    for (const std::vector<Curve>& view : views)
        layers.push_back({.curves = cutAlong(view, bounds(outline)).inside});
    AreaInZone areas;
    forEachArea(layers, [&](const LayerLabel& label, double area) {
        if (label.marks != (kIndoorMark | kZoneMark)) return;
        areas.zone += area;
        if (label.count > 0) areas.seen += area;
    });
    return {std::max(0.0, areas.zone), std::max(0.0, areas.seen)};
}

/// Returns the points within `reach` of the camera from which the direction to it is within an
/// angle of the heading, counter-clockwise.
Polygon wedgeOf(Point2 camera, const FacingRule& rule, double reach) {
    constexpr double kStep = 45;  // degrees: chords stay beyond 0.9 of the radius
    const double half = rule.within.degrees();
    const int steps = static_cast<int>(std::ceil(2 * half / kStep));
    Polygon wedge;
    if (half < 180) wedge.push_back(camera);
    for (int i = half < 180 ? 0 : 1; i <= steps; ++i) {
        const Angle angle = rule.heading + Angle::degrees(180 - half + 2 * half * i / steps);
        wedge.push_back(camera + reach * Vec2{cos(angle), sin(angle)});
    }
    return wedge;
}

/// Returns the part of a view that is in the wedge.
std::vector<Curve> facedPart(const std::vector<Curve>& view, const Polygon& wedge) {
    const std::vector<Layer> layers = {markLayer(view, kViewMark),
                                       markLayer({curveOf(wedge)}, kWedgeMark)};
    return Overlay(layers).curves(
        [](const LayerLabel& label) { return label.marks == (kViewMark | kWedgeMark); });
}

}  // namespace

FacingRule parseFacing(std::string_view text) {
    const std::string wanted = '`' + std::string(text) +
                               "` is not ZONE,DEG[,HEADING][=SHARE], as in entrance,45deg,180=90%";
    FacingRule rule;
    std::string_view rest = withoutPrefix(text);
    if (const auto equals = rest.rfind('='); equals != std::string_view::npos) {
        rule.required = parseShare(rest.substr(equals + 1));
        if (!rule.required) throw UsageError(wanted);
        rest = rest.substr(0, equals);
    }
    const auto last = rest.rfind(',');
    if (last == std::string_view::npos || rest.front() == ',') throw UsageError(wanted);
    const auto first = rest.rfind(',', last - 1);
    // `a,45deg` ends with an angle after a name, `a,45deg,180` with two angles.
    rule.is_by_doors =
        first == std::string_view::npos || !isAngle(rest.substr(first + 1, last - first - 1));
    const auto end = rule.is_by_doors ? last : first;
    rule.zone = rest.substr(0, end);
    const std::string_view within =
        rest.substr(end + 1, rule.is_by_doors ? std::string_view::npos : last - first - 1);
    rule.within = angleOf(within);
    if (!rule.is_by_doors) rule.heading = angleOf(rest.substr(last + 1));
    if (!(rule.within.degrees() > 0 && rule.within.degrees() <= 180))
        throw UsageError('`' + std::string(text) +
                         "`: the angle is not above 0, up to 180 degrees");
    return rule;
}

PrivacyRule parsePrivacy(std::string_view text) {
    const std::string_view rest = withoutPrefix(text);
    const auto comma = rest.rfind(',');
    PrivacyRule rule{std::string(rest.substr(0, comma))};
    if (rule.zones.empty()) throw UsageError('`' + std::string(text) + "` names no zone");
    if (comma == std::string_view::npos) return rule;
    const auto density = pixelDensityOf(rest.substr(comma + 1));
    if (!density)
        throw UsageError('`' + std::string(rest.substr(comma + 1)) +
                         "` is no number of pixels a metre, and no class such as recognise");
    rule.density = *density;
    return rule;
}

std::vector<std::string> privateZones(const PrivacyRule& rule, const Environment& environment) {
    std::vector<std::string> ids;
    for (const Zone& zone : matchingZones(rule.zones, environment)) ids.push_back(zone.id);
    return ids;
}

namespace {

/// Returns the heading in which people walk through a door into the zone; empty if it is not on the
/// border.
std::optional<Angle> headingInto(const Environment& environment, const Zone& zone,
                                 const Doorway& door) {
    const Point2 middle = door.line.a + 0.5 * (door.line.b - door.line.a);
    const Vec2 way = door.line.b - door.line.a;
    const Vec2 across = (1 / length(way)) * Vec2{-way.y, way.x};
    std::optional<Angle> heading;
    for (const double side : {1.0, -1.0}) {
        const Point2 inside = middle + side * (kAtDoor + door.thickness / 2) * across;
        if (locate(zone.outline, inside) != Side::Inside ||
            environment.indoorIndex().locate(inside) != Side::Inside)
            continue;
        if (heading) return std::nullopt;  // on both sides
        heading = wrapped(
            Angle::degrees(std::atan2(side * across.y, side * across.x) * 180 / std::numbers::pi));
    }
    return heading;
}

}  // namespace

std::vector<FacingRule> facingIn(const Environment& environment,
                                 std::span<const FacingRule> rules) {
    std::vector<FacingRule> all;
    for (const FacingRule& rule : rules)
        for (const Zone& zone : matchingZones(rule.zone, environment)) {
            FacingRule own = rule;
            own.zone = zone.id;
            if (!rule.is_by_doors) {
                all.push_back(own);
                continue;
            }
            own.is_by_doors = false;
            const std::size_t before = all.size();
            for (const Doorway& door : doorwaysOf(environment))
                if (const auto heading = headingInto(environment, zone, door)) {
                    own.heading = *heading;
                    all.push_back(own);
                }
            if (all.size() == before)
                throw UsageError("no door is on the border of zone " + printable(zone.id) +
                                 ": give the heading of people, as in " + zone.id + ",45deg,180");
        }
    return all;
}

bool isFaced(const FacingRule& rule, Point2 place, Point2 camera) {
    constexpr double kRounding = 1e-9;  // degrees
    const Vec2 to = camera - place;
    const double heading = std::atan2(to.y, to.x) * 180 / std::numbers::pi;
    const Angle off = wrapped(Angle::degrees(heading) - rule.heading);
    return std::abs(off.degrees()) <= rule.within.degrees() + kRounding;
}

std::vector<FacingResult> measureFacing(const Scene& scene, const Coverage& coverage,
                                        std::span<const FacingRule> rules) {
    std::vector<FacingResult> results;
    const Box2& limits = scene.environment.limits();
    for (const FacingRule& rule : facingIn(scene.environment, rules)) {
        for (const Zone& zone : matchingZones(rule.zone, scene.environment)) {
            FacingResult result{rule};
            std::vector<std::vector<Curve>> faced;
            bool is_known = true;
            for (const SensorView& view : coverage.sensors) {
                if (!scene.sensors[view.index].is<Camera>()) continue;
                if (!view.region) {
                    is_known = false;
                    continue;
                }
                const Point2 camera = view.pose.position.onFloor();
                double reach = 0;
                for (const Point2 corner :
                     {limits.low, limits.high, Point2{limits.low.x, limits.high.y},
                      Point2{limits.high.x, limits.low.y}})
                    reach = std::max(reach, distance(camera, corner));
                constexpr double kBeyond = 1.2;
                faced.push_back(facedPart(*view.region, wedgeOf(camera, rule, kBeyond * reach)));
            }
            const AreaInZone areas = areasIn(scene.environment, zone, faced);
            result.area = areas.zone;
            if (is_known) result.share = shareOf(areas.seen, areas.zone);
            results.push_back(std::move(result));
        }
    }
    return results;
}

std::vector<PrivacyResult> measurePrivacy(const Scene& scene, double plane,
                                          std::span<const PrivacyRule> rules) {
    const VisibleArea sight(scene.environment, plane);
    std::vector<PrivacyResult> results;
    for (const PrivacyRule& rule : rules) {
        std::vector<std::pair<std::string, std::optional<std::vector<Curve>>>> views;
        for (Sensor sensor : scene.sensors) {
            auto* const camera = std::get_if<Camera>(&sensor.model);
            if (camera == nullptr) continue;
            *camera = withDensity(*camera, rule.density);
            views.emplace_back(sensor.id, sight.regionOf(sensor));
        }
        for (const Zone& zone : matchingZones(rule.zones, scene.environment)) {
            PrivacyResult result{zone.id, rule.density};
            std::vector<std::vector<Curve>> all;
            bool is_known = true;
            for (const auto& [id, region] : views) {
                is_known &= region.has_value();
                if (!region) continue;
                if (areasIn(scene.environment, zone, {*region}).seen > kMinPiece)
                    result.cameras.push_back(id);
                all.push_back(*region);
            }
            const AreaInZone areas = areasIn(scene.environment, zone, all);
            result.area = areas.zone;
            if (is_known) result.seen = areas.seen;
            results.push_back(std::move(result));
        }
    }
    return results;
}

bool isMet(const FacingResult& result) {
    return !result.rule.required ||
           (result.share && *result.share >= *result.rule.required - kExactError);
}

bool isMet(const PrivacyResult& result) { return result.seen && *result.seen <= kMinPiece; }

}  // namespace ispace
