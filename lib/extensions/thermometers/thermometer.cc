// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/thermometers/thermometer.h"

#include <algorithm>
#include <any>
#include <cmath>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/body.h"
#include "env/walls.h"
#include "extensions/thermometers/temperature.h"
#include "extensions/thermometers/zone_temperatures.h"
#include "geom/predicates.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"
#include "scene/thing_kind.h"

namespace ispace::thermometers {

Thermometer withParameters(Thermometer base, const Record& record) {
    if (record.has("limits")) {
        const Tuple& limits = record.tuple("limits");
        if (!(limits[0] < limits[1]))
            throw FormatError(record.finding("limits", "`limits`: the first has to be less"));
        base.min = limits[0];
        base.max = limits[1];
    }
    if (record.has("resolution")) base.resolution = record.number("resolution");
    if (record.has("error")) base.error = record.number("error");
    if (record.has("rate")) base.rate = record.number("rate");
    return base;
}

namespace {

void addFigures(std::vector<KeySpec>& keys) {
    constexpr double kMaxDegrees = 1000;
    keys.push_back({.name = "limits",
                    .type = KeyType::Tuple,
                    .help = "least and greatest temperature that it tells, degrees Celsius",
                    .min_count = 2,
                    .max_count = 2,
                    .lower = -kMaxDegrees,
                    .upper = kMaxDegrees});
    keys.push_back({.name = "resolution",
                    .type = KeyType::Number,
                    .help = "least difference that it tells, kelvin, with --noise",
                    .lower = 0,
                    .upper = kMaxDegrees});
    keys.push_back({.name = "error",
                    .type = KeyType::Number,
                    .help = "standard deviation of its constant error, kelvin, with --noise",
                    .lower = 0,
                    .upper = kMaxDegrees});
    keys.push_back(positiveKey("rate", Unit::Frequency, "readings a second", kMaxRate));
}

void addThermometerKeys(std::vector<KeySpec>& keys) {
    keys.push_back(
        {.name = "zone",
         .type = KeyType::Word,
         .help = "id of the zone whose temperature it reports; left out: the first in which it "
                 "stands",
         .role = Role::Reference});
    addFigures(keys);
}

/// A window: its opening, as it is now.
struct HeatWindow {
    Point2 at;
    double area = 0;  ///< m2
    bool is_open = false, lets_sun_in = false;
};
/// A heater or a lamp that is on.
struct HeatSource {
    Point2 at;
    double watts = 0;
};

/// Returns the middle of an opening that names its wall and the offset along it.
std::optional<Point2> alongWall(const Record& opening, const RoomRecords& room) {
    const auto found = std::find(room.ids.begin(), room.ids.end(), opening.text("wall"));
    if (found == room.ids.end() || !opening.has("offset")) return std::nullopt;
    Diagnostics ignored;  // reported by the environment
    double rest = opening.number("offset");
    const Record& wall = room.records[static_cast<std::size_t>(found - room.ids.begin())];
    for (const WallLine& one : wallLinesOf(wall, ignored)) {
        const Vec2 way = one.line.b - one.line.a;
        if (const double all = length(way); rest > all)
            rest -= all;
        else
            return one.line.a + (rest / all) * way;
    }
    return std::nullopt;
}

std::optional<Point2> middleOf(const Record& opening, const RoomRecords& room) {
    const auto point = [&](std::string_view key) {
        const Tuple& at = opening.tuple(key);
        return Point2{at[0], at[1]};
    };
    if (opening.has("at")) return point("at");
    if (opening.has("from") && opening.has("to"))
        return point("from") + 0.5 * (point("to") - point("from"));
    return opening.has("wall") ? alongWall(opening, room) : std::nullopt;
}

double areaOf(const Record& window) {
    const Tuple& size = window.tuple("size");
    double width = size[0];
    if (window.has("from") && window.has("to")) {
        const Tuple &a = window.tuple("from"), &b = window.tuple("to");
        width = distance(Point2{a[0], a[1]}, Point2{b[0], b[1]});
    }
    return width * (size.size() > 2 ? size[2] : window.number("height"));
}

std::vector<HeatWindow> windowsOf(const RoomRecords& room) {
    std::vector<HeatWindow> windows;
    for (const Record& record : room.records) {
        if (record.keyword() != "window") continue;
        const auto at = middleOf(record, room);
        if (!at) continue;
        const std::string& glass = record.text("glass");
        windows.push_back({*at, areaOf(record), record.flag("open") || glass == "none",
                           glass != "opaque" && !record.flag("blind")});
    }
    return windows;
}

std::vector<HeatSource> sourcesOf(const RoomRecords& room) {
    constexpr double kLumensPerWatt = 100;  // of white light-emitting diodes
    std::vector<HeatSource> sources;
    for (const Record& record : room.records) {
        if (const auto emission = emissionOf(record); emission && emission->heat > 0)
            sources.push_back({emission->pose.position.onFloor(), emission->heat});
        const bool is_heater = record.keyword() == "heater";
        if ((!is_heater && record.keyword() != "lamp") || !record.flag("on")) continue;
        const Tuple& at = record.tuple("at");
        sources.push_back(
            {{at[0], at[1]},
             record.number("level") *
                 (is_heater ? record.number("watts") : record.number("lumens") / kLumensPerWatt)});
    }
    return sources;
}

/// A zone of the room and its heat.
struct HeatZone {
    std::size_t record = 0;  // index
    Box2 box;
    ZoneHeat heat;
    [[nodiscard]] bool has(Point2 p) const {
        return box.contains(p) && locate(heat.outline, p) != Side::Outside;
    }
};
/// The id of a zone, in a list in the order of ids.
struct HeatZoneId {
    std::string id;
    std::size_t zone = 0;  // index among the zones
};

constexpr double kWindowDistance = 0.3;  // windows are as far from the outlines at most
constexpr double kWindowReach = 0.5;     // from a window to the spots on both sides of it

/// Returns the vector from a window to a spot on one side of it, across the nearest edge of a zone;
/// empty if no zone has an edge near it.
std::optional<Vec2> acrossWindow(const std::vector<HeatZone>& zones, Point2 at) {
    std::optional<Vec2> across;
    double nearest = kWindowDistance;
    for (const HeatZone& zone : zones) {
        const Point2 near = {std::clamp(at.x, zone.box.low.x, zone.box.high.x),
                             std::clamp(at.y, zone.box.low.y, zone.box.high.y)};
        if (!(distance(at, near) <= kWindowDistance)) continue;
        forEachEdge(zone.heat.outline, [&](const Segment2& edge) {
            const double away = distance(at, edge);
            const Vec2 way = edge.b - edge.a;
            if (!(away <= nearest && length(way) > 0)) return;
            nearest = away;
            across = (kWindowReach / length(way)) * perpendicular(way);
        });
    }
    return across;
}

/// Adds a window to the heat of the zones on one side of it, if no zone is on the other.
void addWindow(std::vector<HeatZone>& zones, const HeatWindow& window, double sun) {
    constexpr double kOpenLoss = 90;      // W/K through a square metre of an open window
    constexpr double kSolarFactor = 0.6;  // share of the sun that heats the zone, double panes
    const std::optional<Vec2> across = acrossWindow(zones, window.at);
    if (!across) return;
    std::vector<HeatZone*> left, right;
    for (HeatZone& zone : zones) {
        if (zone.has(window.at + *across)) left.push_back(&zone);
        if (zone.has(window.at + -1.0 * *across)) right.push_back(&zone);
    }
    if (!left.empty() && !right.empty()) return;
    left.insert(left.end(), right.begin(), right.end());
    for (HeatZone* const zone : left) {
        if (window.is_open) zone->heat.loss += kOpenLoss * window.area;
        if (window.lets_sun_in) zone->heat.power += kSolarFactor * sun * window.area;
    }
}

/// Computes the heat of all zones with the windows on their outlines.
std::vector<HeatZone> zonesOf(const RoomRecords& room) {
    constexpr double kJoules = 1000;    // in a kilojoule
    constexpr double kMinArea = 0.001;  // m2: of a degenerate zone
    ZoneHeat bare;
    double sun = 0;
    for (const Record& weather : room.records) {
        if (weather.keyword() != "weather") continue;
        bare.outside = weather.number("celsius");
        sun = weather.number("sun");
    }
    std::vector<HeatZone> zones;
    for (std::size_t i = 0; i < room.records.size(); ++i) {
        const Record& record = room.records[i];
        if (record.keyword() != "zone") continue;
        if (!record.has("path") && !record.has("size"))
            throw FormatError(
                record.finding("zone has no extent: give `path`, or `at` and `size`"));
        ZoneHeat heat = bare;
        heat.outline = zoneOutline(record);
        const double area = std::max(std::abs(signedArea(heat.outline)), kMinArea);
        heat.start = record.number("celsius");
        heat.storage = record.number("storage") * kJoules * area;
        heat.loss = record.number("loss") * area;
        const Box2 box = bounds(heat.outline);
        zones.push_back({i, box, std::move(heat)});
    }
    for (const HeatWindow& one : windowsOf(room))
        if (one.is_open || (one.lets_sun_in && sun > 0)) addWindow(zones, one, sun);
    for (const HeatSource& one : sourcesOf(room))
        for (HeatZone& zone : zones)
            if (zone.has(one.at)) zone.heat.power += one.watts;
    return zones;
}

std::vector<HeatZoneId> zoneIds(const SharedList<HeatZone>& zones, const RoomRecords& room) {
    std::vector<HeatZoneId> ids;
    for (const HeatZone& zone : zones) ids.push_back({room.ids[zone.record], ids.size()});
    std::stable_sort(ids.begin(), ids.end(),
                     [](const HeatZoneId& a, const HeatZoneId& b) { return a.id < b.id; });
    return ids;
}

const HeatZone& zoneNamed(const Record& thermometer, const SharedList<HeatZone>& zones,
                          const RoomRecords& room) {
    const std::string& name = thermometer.text("zone");
    const auto ids = room.shared<HeatZoneId>([&] { return zoneIds(zones, room); });
    const auto* const found =
        std::lower_bound(ids.begin(), ids.end(), name,
                         [](const HeatZoneId& one, const std::string& id) { return one.id < id; });
    if (found != ids.end() && found->id == name) return zones.begin()[found->zone];
    std::vector<std::string> known;
    for (const HeatZone& zone : zones) known.push_back(room.ids[zone.record]);
    throw FormatError(thermometer.finding(
        "zone", "`zone`: no zone has the id `" + name + '`' + didYouMean(name, known)));
}

/// Copies the heat of the zone: the named one, else the first in which the thermometer stands.
void lookUpZone(SensorModel& model, const Record& record, const RoomRecords& room) {
    const auto zones = room.shared<HeatZone>([&room] { return zonesOf(room); });
    const HeatZone* zone = nullptr;
    if (record.has("zone")) {
        zone = &zoneNamed(record, zones, room);
    } else if (!record.has("at") && !record.has("on")) {
        return;  // it has no position yet
    } else {
        if (!record.has("on")) {
            const Point2 at = poseOf(record).position.onFloor();
            zone = std::find_if(zones.begin(), zones.end(),
                                [at](const HeatZone& one) { return one.has(at); });
        }
        if (zone == nullptr || zone == zones.end())
            throw FormatError(
                record.finding("zone",
                               "`zone`: it stands in no zone, whose temperature it would "
                               "report; name one"));
    }
    changeModel<Thermometer>(model, [&](Thermometer& thermometer) {
        thermometer.zone = room.ids[zone->record];
        thermometer.heat = zone->heat;
    });
}

/// Zones have one temperature for all their thermometers.
AddedReading advanceZone(const Sensor& sensor, double time, const MovingBodies& bodies,
                         std::any& memory) {
    if (!memory.has_value()) memory = ZoneTemperatures();
    ZoneTemperatures& zones = *std::any_cast<ZoneTemperatures>(&memory);
    const Thermometer& thermometer = sensor.as<Thermometer>();
    const ZoneTemperatures::State last = zones.advance(thermometer, time, bodies);
    Temperature before;
    before.truth = last.celsius;
    return {last.time, 0, sensor.pose, &Thermometer::kKind, before};
}

std::vector<Mesh> thermometerBody() {
    Mesh box{Material::Sensor, {}, {}};
    addBox(box, {-0.02, -0.03, -0.04}, {0, 0.03, 0.04});
    return {std::move(box)};
}

}  // namespace

const SensorKind Thermometer::kKind = {
    .keyword = "thermometer",
    .noun = "thermometer",
    .help =
        "thermometer of a zone, which heaters, lamps, people and the sun warm; bare: "
        "limits=-40,125 rate=0.1",
    .heading_help = "direction of its front, from +x",
    .device_help = "a thermometer one can buy",
    .sign = SensorSign::Square,
    .add_keys = addThermometerKeys,
    .body = thermometerBody,
    .read = readModel<Thermometer>,
    .look_up = lookUpZone,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        return {"-", "-", "-", formatDouble(tryModel<Thermometer>(model)->rate)};
    },
    .bearings = [](const SensorModel& /*model*/) { return BearingSpan{}; },
    .perceives = false,
    .is_read = true,
    .measure = measureBy<Thermometer>,
    .follow =
        [](const AddedReading& before, AddedReading& now) {
            goOn(before.as<Temperature>(), now.time - before.time, now.as<Temperature>());
        },
    .advance = advanceZone,
    .reading = &Temperature::kKind};

void addThermometers() { addSensorKind(Thermometer::kKind); }

}  // namespace ispace::thermometers
