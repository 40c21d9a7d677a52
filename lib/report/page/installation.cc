// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/page/installation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "base/number.h"
#include "drawing/plan/plan.h"
#include "env/level.h"
#include "geom/predicates.h"
#include "raster/grid.h"

namespace ispace {

namespace {

constexpr double kEm = 2.6;  // text size of the plan, millimetres

/// The faces of walls at a height, with the index of each one's element.
struct WallFaces {
    std::vector<Segment2> lines;
    std::vector<std::size_t> owners;
};

WallFaces facesAt(const Environment& environment, double height) {
    const std::shared_ptr<const Level> level = environment.level(height);
    const Slice& slice = level->slice();
    WallFaces faces;
    const auto add = [&](const Segment2& line, std::size_t owner) {
        if (!isWall(environment.elements()[owner])) return;
        faces.lines.push_back(line);
        faces.owners.push_back(owner);
    };
    for (std::size_t i = 0; i < slice.sheets.size(); ++i)
        add(slice.sheets[i], slice.sheet_owners[i]);
    for (std::size_t i = 0; i < slice.solids.size(); ++i)
        forEachEdge(slice.solids[i],
                    [&](const Segment2& edge) { add(edge, slice.solid_owners[i]); });
    return faces;
}

/// Returns the foot of the perpendicular from p; empty if it lies beside the segment.
std::optional<Point2> footOn(const Segment2& line, Point2 p) {
    const Vec2 along = line.b - line.a;
    const double share = dot(p - line.a, along) / dot(along, along);
    if (!(share >= 0 && share <= 1)) return std::nullopt;
    return line.a + share * along;
}

bool isHidden(Point2 from, Point2 foot, const std::vector<Segment2>& lines) {
    const Segment2 way{from, from + 0.999 * (foot - from)};
    return std::any_of(lines.begin(), lines.end(), [&](const Segment2& line) {
        return orientation(way.a, way.b, line.a) != orientation(way.a, way.b, line.b) &&
               orientation(line.a, line.b, way.a) != Turn::Straight &&
               orientation(line.a, line.b, way.a) != orientation(line.a, line.b, way.b);
    });
}

std::vector<WallDistance> nearestWalls(const Environment& environment, const WallFaces& faces,
                                       Point2 at) {
    struct Near {
        double distance;
        std::size_t face;
        Point2 foot;
    };
    std::vector<Near> near;
    for (std::size_t i = 0; i < faces.lines.size(); ++i)
        if (const auto foot = footOn(faces.lines[i], at))
            near.push_back({distance(at, *foot), i, *foot});
    std::stable_sort(near.begin(), near.end(),
                     [](const Near& a, const Near& b) { return a.distance < b.distance; });
    std::vector<WallDistance> found;
    Vec2 first;
    for (const Near& one : near) {
        const Segment2& face = faces.lines[one.face];
        const Vec2 along = (1 / distance(face.a, face.b)) * (face.b - face.a);
        constexpr double kAcross = 0.7071;  // cosine of 45 degrees
        if (!found.empty() && std::abs(dot(along, first)) > kAcross) continue;
        if (isHidden(at, one.foot, faces.lines)) continue;
        found.push_back(
            {environment.elements()[faces.owners[one.face]].id, one.distance, one.foot});
        if (found.size() == 2) break;
        first = along;
    }
    return found;
}

bool standsStill(const Sensor& sensor) { return !sensor.mount && !sensor.person; }

std::string metresText(double value) { return formatFixed(value, 2); }

std::string degrees(Angle angle) {
    std::string text = formatFixed(angle.degrees(), 1);
    if (text.size() > 2 && text.ends_with(".0")) text.resize(text.size() - 2);
    return text == "-0" ? "0" : text;
}

/// Returns the direction of a wall from a sensor, "+y" or "37 deg": a fence has several sides.
std::string sideText(Vec2 to) {
    if (to == Vec2{}) return "";
    constexpr double kTolerance = 0.05;  // degrees, as the heading is rounded
    const double angle = std::atan2(to.y, to.x) * 180 / std::numbers::pi;
    constexpr std::pair<double, const char*> kAxes[] = {
        {0, "+x"}, {90, "+y"}, {180, "-x"}, {-180, "-x"}, {-90, "-y"}};
    for (const auto& [axis, name] : kAxes)
        if (std::abs(angle - axis) < kTolerance) return std::string(", ") + name;
    return ", " + degrees(Angle::degrees(angle)) + " deg";
}

std::string wallText(const Installation& one, std::size_t which, Point2 at) {
    if (which >= one.walls.size()) return "-";
    const WallDistance& wall = one.walls[which];
    return metresText(wall.distance) + " to " + wall.wall + sideText(wall.foot - at);
}

/// A tilt, and the roll of the sensor about its axis where it has one.
std::string tiltText(const Pose3& pose) {
    const std::string roll = degrees(pose.roll);
    return degrees(pose.tilt) + (roll == "0" ? "" : ", roll " + roll);
}

/// Returns the zones of which a sensor sees half or more.
std::vector<std::string> zonesSeen(const Scene& scene, const Coverage& coverage,
                                   const SensorView& view) {
    std::vector<std::string> zones;
    for (const Element& element : scene.environment.elements()) {
        if (element.record.keyword() != "zone") continue;
        const Polygon outline = zoneOutline(element.record);
        CellSet cells = cellsWithin(coverage.target.grid, std::span(&outline, 1));
        const std::size_t all = cells.count();
        cells &= view.cells;
        if (all > 0 && 2 * cells.count() >= all) zones.push_back(element.id);
    }
    return zones;
}

std::string taskOf(const Scene& scene, const Coverage& coverage, std::size_t sensor) {
    for (std::size_t i = 0; i < coverage.sensors.size(); ++i) {
        const SensorView& view = coverage.sensors[i];
        if (view.index != sensor) continue;
        std::string text;
        for (const std::string& zone : zonesSeen(scene, coverage, view))
            text.append(text.empty() ? "" : ", ").append(zone);
        const SensorMetrics& metrics = coverage.report.sensors[i];
        const auto area = metrics.area.exact ? metrics.area.exact : metrics.area.grid;
        if (area) text.append(text.empty() ? "" : "; ").append(metresText(*area)).append(" m2");
        return text;
    }
    return "-";
}

/// Draws a dashed line with its length where it hides no mark and no other text.
void drawDistance(Picture& picture, Point2 at, Point2 foot, const std::string& text,
                  LabelPlacer& labels) {
    const TextStyle style{0.8 * kEm, false, Align::Center, palette::kInk,
                          palette::kWhite.faded(0.85)};
    const Stroke dashes{palette::kInk, 0.18, {1, 0.6}};
    const double width = textWidth(text, style), way = distance(at, foot);
    for (const double share : {0.5, 0.35, 0.65, 0.2, 0.8}) {
        const Point2 middle = at + share * (foot - at);
        // Text is no longer than the line that it stands for.
        if (way < width / 2 || !labels.take({{middle.x - width / 2, middle.y - style.size / 2},
                                             {middle.x + width / 2, middle.y + style.size / 2}}))
            continue;
        // No line strikes the text through.
        const Vec2 along = (1 / way) * (foot - at);
        const double gap =
            std::min(std::abs(along.x) > 0 ? 0.6 * width / std::abs(along.x) : way,
                     std::abs(along.y) > 0 ? 0.6 * style.size / std::abs(along.y) : way);
        if (gap < share * way) picture.line(at, middle - gap * along, dashes);
        if (gap < (1 - share) * way) picture.line(middle + gap * along, foot, dashes);
        picture.text({middle.x, middle.y + 0.36 * style.size}, text, style);
        return;
    }
    picture.line(at, foot, dashes);
}

}  // namespace

std::string deviceText(const Sensor& sensor) {
    const std::string& model = deviceName(sensor.model);
    return model.empty() ? std::string(kindOf(sensor.model).keyword) : model;
}

std::vector<Installation> installationsOf(const Scene& scene) {
    const Environment& environment = scene.environment;
    std::vector<Installation> installations;
    std::map<double, WallFaces> faces;  // by height
    for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
        const Sensor& sensor = scene.sensors[i];
        if (!standsStill(sensor)) continue;
        // Just below the tops of the highest walls if it hangs above them.
        const double height =
            std::clamp(sensor.pose.position.z, 0.0, std::max(0.0, environment.height() - 0.01));
        auto known = faces.find(height);
        if (known == faces.end()) known = faces.emplace(height, facesAt(environment, height)).first;
        installations.push_back(
            {i, nearestWalls(environment, known->second, sensor.pose.position.onFloor())});
    }
    return installations;
}

PageTable installationTable(const Scene& scene, const Coverage& coverage,
                            const std::vector<Installation>& installations) {
    PageTable table{
        "metres from the plan's origin and from the faces of walls; heading in degrees "
        "counter-clockwise from the x axis, tilt above level; +y: the wall lies in that direction "
        "from the sensor, at right angles",
        "llrrrrrlrrl",
        {"sensor", "device", "x", "y", "height", "heading", "tilt", "view", "nearest wall",
         "next wall", "sees"},
        {}};
    for (const Installation& one : installations) {
        const Sensor& sensor = scene.sensors[one.sensor];
        const Point3 at = sensor.pose.position;
        const SensorKind& kind = kindOf(sensor.model);
        table.rows.push_back(
            {sensor.id, deviceText(sensor), metresText(at.x), metresText(at.y), metresText(at.z),
             degrees(sensor.pose.heading), tiltText(sensor.pose),
             kind.summary == nullptr ? "-" : kind.summary(sensor.model).field_of_view,
             wallText(one, 0, at.onFloor()), wallText(one, 1, at.onFloor()),
             taskOf(scene, coverage, one.sensor)});
    }
    return table;
}

PageTable materialTable(const Scene& scene) {
    struct Item {
        std::size_t count = 0;
        double cost = 0;
    };
    std::map<std::string, Item> items;
    bool has_costs = false;
    std::map<std::string, std::size_t> records;
    for (std::size_t i = 0; i < scene.records.size(); ++i) records.emplace(scene.ids[i], i);
    double sum = 0;
    std::size_t count = 0;
    for (const Sensor& sensor : scene.sensors) {
        Item& item = items[deviceText(sensor)];
        ++item.count;
        ++count;
        const auto record = records.find(sensor.id);
        if (record == records.end() || !scene.records[record->second].has("cost")) continue;
        has_costs = true;
        item.cost += scene.records[record->second].number("cost");
        sum += scene.records[record->second].number("cost");
    }
    PageTable table{"", "lrr", {"device", "number"}, {}};
    if (has_costs) table.heads.emplace_back("cost");
    for (const auto& [device, item] : items) {
        TextRow row = {device, std::to_string(item.count)};
        if (has_costs) row.push_back(item.cost > 0 ? formatDouble(item.cost) : "-");
        table.rows.push_back(std::move(row));
    }
    if (items.size() > 1) {
        TextRow row = {"together", std::to_string(count)};
        if (has_costs) row.push_back(formatDouble(sum));
        table.rows.push_back(std::move(row));
    }
    return table;
}

PageFigure installationPlan(const Scene& scene, const std::vector<Installation>& installations) {
    constexpr double kWide = 176, kHigh = 225, kRim = 4, kBelow = 8;
    const Box2 box = planBox(scene);
    const double denominator =
        usualScale(1000 * std::max(box.width() / (kWide - 2 * kRim),
                                   box.depth() / (kHigh - 2 * kRim - kBelow)));
    const double scale = 1000 / denominator;
    Picture picture(kWide, std::ceil(scale * box.depth() + 2 * kRim + kBelow),
                    PageUnit::Millimetre);
    picture.describe("dimensioned plan", "");
    const PageView view{scale, {box.low.x, box.high.y}, {(kWide - scale * box.width()) / 2, kRim}};
    PlanDrawing plan(picture, scene, {view, kEm, box, kScanHeight, true});
    plan.drawFloor();
    plan.drawThings();
    plan.drawWalls();
    plan.drawOpenings();
    plan.drawZones();
    const Color ink = palette::kSensor;
    LabelPlacer labels({{1, 1}, {kWide - 1, picture.height() - kBelow}}, kEm);
    for (const Installation& one : installations) {
        const Pose3& pose = scene.sensors[one.sensor].pose;
        labels.addMark(view * pose.position.onFloor(), headingOf(pose));
    }
    picture.pushLayer("distances");
    for (const Installation& one : installations) {
        const Point2 at = view * scene.sensors[one.sensor].pose.position.onFloor();
        for (const WallDistance& wall : one.walls)
            drawDistance(picture, at, view * wall.foot, metresText(wall.distance), labels);
    }
    picture.pop();
    picture.pushLayer("sensors");
    for (const Installation& one : installations) {
        const Sensor& sensor = scene.sensors[one.sensor];
        const Point2 at = view * sensor.pose.position.onFloor();
        drawSensorMark(picture, at, {kindOf(sensor.model).sign, headingOf(sensor.pose), ink},
                       0.36 * kEm);
    }
    const TextStyle style{kEm, true, Align::Center, palette::kInk, palette::kWhite.faded(0.85)};
    for (const Installation& one : installations) {
        const Sensor& sensor = scene.sensors[one.sensor];
        const Point2 at = view * sensor.pose.position.onFloor();
        const std::string id = fitText(sensor.id, 12 * kEm, style);
        if (const auto middle =
                labels.placeLabel(at, headingOf(sensor.pose).value_or(Angle()),
                                  textWidth(id, style), kEm, installations.size() > 40))
            drawMarkLabel(picture, at, *middle, id, style);
    }
    picture.pop();
    drawScaleBar(picture, {kRim, picture.height() - 2}, 40, scale, kEm,
                 "  ·  1:" + formatDouble(denominator));
    return {"Plan at 1:" + formatDouble(denominator) +
                " on A4; dashed lines are the distances to walls, in metres.",
            std::move(picture)};
}

}  // namespace ispace
