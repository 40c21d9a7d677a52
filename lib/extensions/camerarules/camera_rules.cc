// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/camerarules/camera_rules.h"

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
#include "env/door_floor.h"
#include "env/zone.h"
#include "extensions/camerarules/facing_meter.h"
#include "geom/curve_clip.h"
#include "record/schema.h"
#include "scene/sensor/camera.h"
#include "scene/sensor/density_classes.h"

namespace ispace::camerarules {

namespace {

constexpr std::string_view kZonePrefix = "zone:";

std::string_view withoutPrefix(std::string_view text) {
    return text.starts_with(kZonePrefix) ? text.substr(kZonePrefix.size()) : text;
}

Angle angleOf(std::string_view text) {
    KeySpec key;
    key.unit = Unit::Angle;
    key.lower = -kMaxDistance;  // as headings of records
    key.upper = kMaxDistance;
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
    const Glob glob(withoutAllRooms(pattern));
    std::erase_if(zones, [&glob](const Zone& zone) { return !glob.matches(zone.id); });
    if (zones.empty()) throw UsageError(unknownZoneText(pattern, environment));
    return zones;
}

constexpr std::uint64_t kZoneMark = 2, kViewMark = 4, kWedgeMark = 8;

/// The indoor part of a zone, and the part of it in some views.
struct AreaInZone {
    double zone = 0, seen = 0;
};

/// \param views cut to the box of the outline: the step of an overlay's lattice grows with the
/// extent of its layers
AreaInZone areasOf(const Environment& environment, Polygon outline,
                   std::vector<std::vector<Curve>> views) {
    if (signedArea(outline) < 0) std::reverse(outline.begin(), outline.end());
    std::vector<Layer> layers = {markLayer(curvesWithArcs(environment.indoor()), kIndoorMark),
                                 markLayer({curveOf(outline)}, kZoneMark)};
    for (std::vector<Curve>& view : views) layers.push_back({.curves = std::move(view)});
    AreaInZone areas;
    forEachArea(layers, [&](const LayerLabel& label, double area) {
        if (label.marks != (kIndoorMark | kZoneMark)) return;
        areas.zone += area;
        if (label.count > 0) areas.seen += area;
    });
    return {std::max(0.0, areas.zone), std::max(0.0, areas.seen)};
}

AreaInZone areasIn(const Environment& environment, const Polygon& outline,
                   const std::vector<std::vector<Curve>>& views) {
    std::vector<std::vector<Curve>> inside;
    inside.reserve(views.size());
    for (const std::vector<Curve>& view : views)
        inside.push_back(cutAlong(view, bounds(outline)).inside);
    return areasOf(environment, outline, std::move(inside));
}

/// Returns the points within `reach` of the camera from which the direction to it is within an
/// angle of the heading, counter-clockwise.
Polygon wedgeOf(Point2 camera, Angle heading, Angle within, double reach) {
    constexpr double kStep = 45;  // degrees: chords stay beyond 0.9 of the radius
    const double half = within.degrees();
    const int steps = static_cast<int>(std::ceil(2 * half / kStep));
    Polygon wedge;
    if (half < 180) wedge.push_back(camera);
    for (int i = half < 180 ? 0 : 1; i <= steps; ++i) {
        const Angle angle = heading + Angle::degrees(180 - half + 2 * half * i / steps);
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

namespace {

/// Unless given.
constexpr double kFaceDegrees = 45;

std::optional<double> metresOf(std::string_view text) {
    const KeySpec key{.name = "distance",
                      .type = KeyType::Number,
                      .unit = Unit::Length,
                      .help = "",
                      .lower = 0.001,
                      .upper = 100};
    try {
        return std::get<double>(parseValue(key, text));
    } catch (const FormatError&) {
        return std::nullopt;
    }
}

/// Parses the pieces behind the glob of `door:GLOB[,M][,DEG[,HEADING]]`. \param wanted a message
void parseDoorPieces(std::span<const std::string_view> pieces, const std::string& text,
                     FacingRule& rule) {
    const auto fail = [&text](const std::string& why) {
        throw UsageError(
            '`' + text + "`: " + why +
            "; doors take door:GLOB[,M][,DEG[,HEADING]], as in door:Front*,1.5m,45deg");
    };
    double metres = kFromDoor;
    if (!pieces.empty())
        if (const auto distance = metresOf(pieces.front())) {
            if (pieces.size() == 1 && isAngle(pieces.front()))
                fail('`' + std::string(pieces.front()) +
                     "` may be metres or degrees, write its unit");
            metres = *distance;
            pieces = pieces.subspan(1);
        }
    if (pieces.size() > 2) fail("there is too much behind the doors");
    for (const std::string_view piece : pieces)
        if (!isAngle(piece))
            fail('`' + std::string(piece) + "` is no angle" +
                 (findClass(piece)
                      ? " (pixels a metre are asked for by --density " + std::string(piece) + ')'
                      : ""));
    rule.zone += ',' + formatDouble(metres);
    rule.within = pieces.empty() ? Angle::degrees(kFaceDegrees) : angleOf(pieces.front());
    rule.is_by_doors = pieces.size() < 2;
    if (!rule.is_by_doors) rule.heading = angleOf(pieces.back());
}

}  // namespace

FacingRule parseFacing(std::string_view text) {
    const std::string wanted =
        '`' + std::string(text) +
        "` is not ZONE[,DEG[,HEADING]][=SHARE], as in entrance,45deg,180=90%";
    FacingRule rule;
    std::string_view rest = withoutPrefix(text);
    if (const auto equals = rest.rfind('='); equals != std::string_view::npos) {
        rule.required = parseShare(rest.substr(equals + 1));
        if (!rule.required) throw UsageError(wanted);
        rest = rest.substr(0, equals);
    }
    const auto check_angle = [&] {
        if (!(rule.within.degrees() > 0 && rule.within.degrees() <= 180))
            throw UsageError('`' + std::string(text) +
                             "`: the angle is not above 0, up to 180 degrees");
    };
    std::string storey;  // `ground/` in `ground/door:...`
    if (const auto slash = rest.find('/');
        slash < rest.find(',') && rest.substr(slash + 1).starts_with(kDoorPrefix)) {
        storey = rest.substr(0, slash + 1);
        rest.remove_prefix(slash + 1);
    }
    if (rest.starts_with(kDoorPrefix)) {
        std::vector<std::string_view> pieces;
        for (auto comma = rest.find(','); comma != std::string_view::npos;
             comma = rest.find(',', comma + 1))
            pieces.push_back(rest.substr(comma + 1, rest.find(',', comma + 1) - comma - 1));
        rule.zone = rest.substr(0, rest.find(','));
        parseDoorPieces(pieces, std::string(text), rule);
        rule.zone.insert(0, storey);
        check_angle();
        return rule;
    }
    const auto last = rest.rfind(',');
    if (rest.empty() || rest.front() == ',') throw UsageError(wanted);
    if (last == std::string_view::npos) {
        rule.zone = rest;
        rule.within = Angle::degrees(kFaceDegrees);
        rule.is_by_doors = true;
        return rule;
    }
    const auto first = rest.rfind(',', last - 1);
    // `a,45deg` ends with an angle after a name, `a,45deg,180` with two angles.
    rule.is_by_doors =
        first == std::string_view::npos || !isAngle(rest.substr(first + 1, last - first - 1));
    const auto end = rule.is_by_doors ? last : first;
    rule.zone = rest.substr(0, end);
    const std::string_view within =
        rest.substr(end + 1, rule.is_by_doors ? std::string_view::npos : last - first - 1);
    if (!isAngle(within) || !isAngle(rest.substr(last + 1))) throw UsageError(wanted);
    rule.within = angleOf(within);
    if (!rule.is_by_doors) rule.heading = angleOf(rest.substr(last + 1));
    check_angle();
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

/// A side of a door that is indoors.
struct DoorSide {
    Point2 inside;  ///< a point there, kAtDoor from the opening
    Vec2 out;       ///< unit vector away from the door
    [[nodiscard]] Angle heading() const {
        return wrapped(Angle::degrees(std::atan2(out.y, out.x) * 180 / std::numbers::pi));
    }
};

std::vector<DoorSide> indoorSides(const Environment& environment, const Doorway& door) {
    const Point2 middle = door.line.a + 0.5 * (door.line.b - door.line.a);
    const Vec2 way = door.line.b - door.line.a;
    const Vec2 across = (1 / length(way)) * Vec2{-way.y, way.x};
    std::vector<DoorSide> sides;
    for (const double side : {1.0, -1.0}) {
        const Vec2 out = side * across;
        const Point2 inside = middle + (kAtDoor + door.thickness / 2) * out;
        if (environment.indoorIndex().locate(inside) == Side::Inside)
            sides.push_back({inside, out});
    }
    return sides;
}

/// Returns the heading in which people walk through a door into the zone; empty if it is not on the
/// border.
std::optional<Angle> headingInto(const Environment& environment, const Zone& zone,
                                 const Doorway& door) {
    std::vector<DoorSide> sides = indoorSides(environment, door);
    std::erase_if(sides, [&zone](const DoorSide& side) {
        return locate(zone.outline, side.inside) != Side::Inside;
    });
    return sides.size() == 1 ? std::optional(sides.front().heading()) : std::nullopt;
}

/// Returns the part of a convex outline beyond a line, where dot(p - from, out) > 0.
Polygon partBeyond(const Polygon& outline, Point2 from, Vec2 out) {
    Polygon part;
    forEachEdge(outline, [&](const Segment2& edge) {
        const double a = dot(edge.a - from, out), b = dot(edge.b - from, out);
        if (a > 0) part.push_back(edge.a);
        if ((a > 0 && b < 0) || (a < 0 && b > 0))
            part.push_back(edge.a + a / (a - b) * (edge.b - edge.a));
        else if (a == 0)
            part.push_back(edge.a);
    });
    return part;
}

/// Adds a rule for each door of a zone of doors, with a part for each side that is indoors.
void addDoorRules(const Environment& environment, const FacingRule& rule,
                  std::vector<FacingRule>& all) {
    const std::string_view words = std::string_view(rule.zone).substr(kDoorPrefix.size());
    const std::size_t comma = words.rfind(',');
    const double metres = metresOf(words.substr(comma + 1)).value();
    const DoorFloor floors(environment);
    for (const Doorway& door :
         doorsNamed(std::string(words.substr(0, comma)), rule.zone, environment)) {
        FacingRule own = rule;
        own.zone = std::string(kDoorPrefix) + door.id + ',' + formatDouble(metres);
        own.door = door.id;
        own.is_by_doors = false;
        const Polygon floor = floors.around(door, metres);
        for (const DoorSide& side : indoorSides(environment, door))
            own.parts.push_back({partBeyond(floor, door.line.a, side.out),
                                 rule.is_by_doors ? side.heading() : rule.heading});
        if (own.parts.empty())
            throw UsageError("no floor of the room is at the door " + printable(door.id));
        if (rule.is_by_doors) own.heading = own.parts.front().heading;
        all.push_back(std::move(own));
    }
}

}  // namespace

std::vector<FacingRule> facingIn(const Environment& environment,
                                 std::span<const FacingRule> rules) {
    std::vector<FacingRule> all;
    for (const FacingRule& rule : rules) {
        if (!rule.parts.empty()) {
            all.push_back(rule);
            continue;
        }
        if (withoutAllRooms(rule.zone).starts_with(kDoorPrefix)) {
            FacingRule own = rule;
            own.zone = withoutAllRooms(rule.zone);
            addDoorRules(environment, own, all);
            continue;
        }
        for (const Zone& zone : matchingZones(rule.zone, environment)) {
            FacingRule own = rule;
            own.zone = zone.id;
            own.parts = {{zone.outline, rule.heading}};
            if (signedArea(zone.outline) < 0) {
                Polygon& outline = own.parts.front().outline;
                std::reverse(outline.begin(), outline.end());
            }
            if (!rule.is_by_doors) {
                all.push_back(own);
                continue;
            }
            own.is_by_doors = false;
            const std::size_t before = all.size();
            for (const Doorway& door : doorwaysOf(environment))
                if (const auto heading = headingInto(environment, zone, door)) {
                    own.heading = own.parts.front().heading = *heading;
                    own.door = door.id;
                    all.push_back(own);
                }
            if (all.size() == before)
                throw UsageError("no door is on the border of zone " + printable(zone.id) +
                                 ": give the heading of people, as in " + zone.id + ",45deg,180");
        }
    }
    return all;
}

bool isFaced(Angle heading, Angle within, Point2 place, Point2 camera) {
    constexpr double kRounding = 1e-9;  // degrees
    const Vec2 to = camera - place;
    const double direction = std::atan2(to.y, to.x) * 180 / std::numbers::pi;
    const Angle off = wrapped(Angle::degrees(direction) - heading);
    return std::abs(off.degrees()) <= within.degrees() + kRounding;
}

FacingMeter::FacingMeter(const Environment& environment, std::span<const FacingRule> rules)
    : environment_(environment), rules_(facingIn(environment, rules)) {
    for (const FacingRule& rule : rules_) {
        std::vector<Part>& parts = parts_.emplace_back();
        for (const FacingPart& part : rule.parts) parts.push_back({bounds(part.outline)});
    }
}

void FacingMeter::measure(const FacingRule& rule, const FacingPart& part, Part& known,
                          std::span<const SensorView* const> cameras) const {
    const Box2& limits = environment_.limits();
    bool is_same = known.is_measured && known.cameras.size() == cameras.size();
    known.cameras.resize(cameras.size());
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        Faced& faced = known.cameras[i];
        const SharedCurves& view = *cameras[i]->region;
        const Point2 camera = cameras[i]->pose.position.onFloor();
        if (faced.is_known && faced.camera == camera && faced.view == view) continue;
        double reach = 0;
        for (const Point2 corner : {limits.low, limits.high, Point2{limits.low.x, limits.high.y},
                                    Point2{limits.high.x, limits.low.y}})
            reach = std::max(reach, distance(camera, corner));
        constexpr double kBeyond = 1.2;
        std::vector<Curve> floor;
        if (boundsOfAll(view).meets(known.box))
            floor = cutAlong(facedPart(view,
                                       wedgeOf(camera, part.heading, rule.within, kBeyond * reach)),
                             known.box)
                        .inside;
        is_same = is_same && floor == faced.floor;
        faced = {camera, view, std::move(floor), true};
    }
    if (is_same) return;
    std::vector<std::vector<Curve>> floors;
    floors.reserve(known.cameras.size());
    for (const Faced& faced : known.cameras) floors.push_back(faced.floor);
    const AreaInZone areas = areasOf(environment_, part.outline, std::move(floors));
    known.area = areas.zone;
    known.seen = areas.seen;
    known.is_measured = true;
}

std::vector<FacingResult> FacingMeter::measure(std::span<const SensorView> views) {
    std::vector<const SensorView*> cameras;
    bool is_known = true;
    for (const SensorView& view : views) {
        if (view.kind != &Camera::kKind) continue;
        if (view.region)
            cameras.push_back(&view);
        else
            is_known = false;
    }
    std::vector<FacingResult> results;
    for (std::size_t i = 0; i < rules_.size(); ++i) {
        FacingResult result{rules_[i]};
        double seen = 0;
        for (std::size_t k = 0; k < parts_[i].size(); ++k) {
            Part& part = parts_[i][k];
            measure(rules_[i], rules_[i].parts[k], part, cameras);
            result.area += part.area;
            seen += part.seen;
        }
        if (is_known) result.share = shareOf(seen, result.area);
        results.push_back(std::move(result));
    }
    return results;
}

std::vector<FacingResult> measureFacing(const Scene& scene, const Coverage& coverage,
                                        std::span<const FacingRule> rules) {
    return FacingMeter(scene.environment, rules).measure(coverage.sensors);
}

namespace {

/// The view of a camera; without a region if that is unknown.
struct CameraView {
    std::string id;
    std::optional<std::vector<Curve>> region;
};

/// Adds the results of a rule for the views at its density.
void addPrivacy(const Environment& environment, const PrivacyRule& rule,
                std::span<const CameraView> views, std::vector<PrivacyResult>& results) {
    for (const Zone& zone : matchingZones(rule.zones, environment)) {
        PrivacyResult result{zone.id, rule.density};
        std::vector<std::vector<Curve>> all;
        bool is_known = true;
        for (const auto& [id, region] : views) {
            is_known &= region.has_value();
            if (!region) continue;
            if (areasIn(environment, zone.outline, {*region}).seen > kMinPiece)
                result.cameras.push_back(id);
            all.push_back(*region);
        }
        const AreaInZone areas = areasIn(environment, zone.outline, all);
        result.area = areas.zone;
        if (is_known) result.seen = areas.seen;
        results.push_back(std::move(result));
    }
}

}  // namespace

std::vector<PrivacyResult> measurePrivacy(const Scene& scene, double plane,
                                          std::span<const PrivacyRule> rules) {
    const VisibleArea sight(scene.environment, plane);
    std::vector<PrivacyResult> results;
    for (const PrivacyRule& rule : rules) {
        std::vector<CameraView> views;
        for (Sensor sensor : scene.sensors) {
            auto* const camera = std::get_if<Camera>(&sensor.model);
            if (camera == nullptr) continue;
            *camera = withDensity(*camera, rule.density);
            views.push_back({sensor.id, sight.regionOf(sensor)});
        }
        addPrivacy(scene.environment, rule, views, results);
    }
    return results;
}

std::vector<PrivacyResult> measurePrivacy(const Scene& scene, const Coverage& coverage,
                                          const PrivacyRule& rule) {
    std::vector<CameraView> views;
    for (const SensorView& view : coverage.sensors) {
        if (view.kind != &Camera::kKind) continue;
        CameraView& camera = views.emplace_back(CameraView{view.id, std::nullopt});
        if (view.region) camera.region.emplace(*view.region);
    }
    std::vector<PrivacyResult> results;
    addPrivacy(scene.environment, rule, views, results);
    return results;
}

bool isMet(const FacingResult& result) {
    return !result.rule.required ||
           (result.share && *result.share >= *result.rule.required - kExactError);
}

bool isMet(const PrivacyResult& result) { return result.seen && *result.seen <= kMinPiece; }

}  // namespace ispace::camerarules
