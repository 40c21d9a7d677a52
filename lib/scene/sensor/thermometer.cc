// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/thermometer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/body.h"
#include "env/walls.h"
#include "geom/predicates.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

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

Thermometer thermometerOf(const Record& record, const Record* device) {
    return parametersOf<Thermometer>(record, device);
}

namespace {

void addFigures(std::vector<KeySpec>& keys) {
    constexpr double kWidest = 1000;
    keys.push_back({.name = "limits",
                    .type = KeyType::Tuple,
                    .help = "least and greatest temperature that it tells, degrees Celsius",
                    .min_count = 2,
                    .max_count = 2,
                    .lower = -kWidest,
                    .upper = kWidest});
    keys.push_back({.name = "resolution",
                    .type = KeyType::Number,
                    .help = "least difference that it tells, kelvin, with --noise",
                    .lower = 0,
                    .upper = kWidest});
    keys.push_back({.name = "error",
                    .type = KeyType::Number,
                    .help = "standard deviation of its constant error, kelvin, with --noise",
                    .lower = 0,
                    .upper = kWidest});
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

bool isNear(const Polygon& outline, Point2 p, double within) {
    bool is_near = locate(outline, p) != Side::Outside;
    forEachEdge(outline,
                [&](const Segment2& edge) { is_near = is_near || distance(p, edge) <= within; });
    return is_near;
}

/// Returns the index of the zone: the named one, else the first in which the thermometer stands.
std::size_t zoneOf(const Record& thermometer, const RoomRecords& room) {
    const bool is_named = thermometer.has("zone");
    std::vector<std::string> zones;
    for (std::size_t i = 0; i < room.records.size(); ++i) {
        if (room.records[i].keyword() != "zone") continue;
        zones.push_back(room.ids[i]);
        if (is_named ? zones.back() == thermometer.text("zone")
                     : !thermometer.has("on") &&
                           locate(zoneOutline(room.records[i]),
                                  poseOf(thermometer).position.onFloor()) != Side::Outside)
            return i;
    }
    if (!is_named)
        throw FormatError(
            thermometer.finding("zone",
                                "`zone`: it stands in no zone, whose temperature it would "
                                "report; name one"));
    throw FormatError(thermometer.finding("zone", "`zone`: no zone has the id `" +
                                                      thermometer.text("zone") + '`' +
                                                      didYouMean(thermometer.text("zone"), zones)));
}

/// Computes the heat of a zone with the windows on its outline.
void lookUpZone(SensorModel& model, const Record& record, const RoomRecords& room) {
    constexpr double kJoules = 1000;         // in a kilojoule
    constexpr double kOpenLoss = 90;         // W/K through a square metre of an open window
    constexpr double kSolarFactor = 0.6;     // share of the sun that heats the zone, double panes
    constexpr double kWindowDistance = 0.3;  // openings are as far from their walls at most
    Thermometer& thermometer = std::get<Thermometer>(model);
    ZoneHeat& heat = thermometer.heat;
    const std::size_t index = zoneOf(record, room);
    const Record& zone = room.records[index];
    thermometer.zone = room.ids[index];
    heat.outline = zoneOutline(zone);
    double sun = 0;
    for (const Record& weather : room.records) {
        if (weather.keyword() != "weather") continue;
        heat.outside = weather.number("celsius");
        sun = weather.number("sun");
    }
    const double area = std::abs(signedArea(heat.outline));
    heat.start = zone.number("celsius");
    heat.storage = zone.number("storage") * kJoules * area;
    heat.loss = zone.number("loss") * area;
    for (const HeatWindow& one : room.shared<HeatWindow>([&room] { return windowsOf(room); })) {
        if (!isNear(heat.outline, one.at, kWindowDistance)) continue;
        if (one.is_open) heat.loss += kOpenLoss * one.area;
        if (one.lets_sun_in) heat.power += kSolarFactor * sun * one.area;
    }
    for (const HeatSource& one : room.shared<HeatSource>([&room] { return sourcesOf(room); }))
        if (locate(heat.outline, one.at) != Side::Outside) heat.power += one.watts;
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
    .read = [](const Record& record, const Record* device) -> SensorModel {
        return thermometerOf(record, device);
    },
    .look_up = lookUpZone,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        return {"-", "-", "-", formatDouble(std::get<Thermometer>(model).rate)};
    },
    .bearings = [](const SensorModel& /*model*/) { return BearingSpan{}; },
    .perceives = false,
    .is_read = true};

}  // namespace ispace
