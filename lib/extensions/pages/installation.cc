// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/installation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "base/number.h"
#include "extensions/pages/indoor_floor.h"
#include "raster/grid.h"

namespace ispace::pages {

namespace {

/// To the millimetre, as mounts are measured.
std::string metresText(double value) { return formatFixed(value, 3); }

std::string degrees(Angle angle) {
    std::string text = formatFixed(angle.degrees(), 1);
    if (text.size() > 2 && text.ends_with(".0")) text.resize(text.size() - 2);
    return text == "-0" ? "0" : text;
}

/// Returns a direction, "+y" or "37 deg".
std::string sideText(Vec2 to) {
    constexpr double kTolerance = 0.05;  // degrees, as the heading is rounded
    const double angle = std::atan2(to.y, to.x) * 180 / std::numbers::pi;
    constexpr std::pair<double, const char*> kAxes[] = {
        {0, "+x"}, {90, "+y"}, {180, "-x"}, {-180, "-x"}, {-90, "-y"}};
    for (const auto& [axis, name] : kAxes)
        if (std::abs(angle - axis) < kTolerance) return name;
    return degrees(Angle::degrees(angle)) + " deg";
}

std::string wallText(const Installation& one, std::size_t which, Point2 at) {
    if (which >= one.walls.size()) return "-";
    const WallDistance& wall = one.walls[which];
    if (wall.end)
        return metresText(wall.distance) + " along " + wall.wall + " from (" +
               metresText(wall.end->x) + ", " + metresText(wall.end->y) + "), " +
               sideText(wall.along());
    if (wall.isOnWall()) return "on " + wall.wall;
    return metresText(wall.distance) + " to " + wall.wall + ", " + sideText(wall.foot - at);
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

std::string taskOf(const Scene& scene, const Coverage& coverage,
                   const std::vector<IndoorFloor>& floors, std::size_t sensor) {
    for (std::size_t i = 0; i < coverage.sensors.size(); ++i) {
        const SensorView& view = coverage.sensors[i];
        if (view.index != sensor) continue;
        std::string text;
        for (const std::string& zone : zonesSeen(scene, coverage, view))
            text.append(text.empty() ? "" : ", ").append(zone);
        return text.append(text.empty() ? "" : "; ")
            .append(formatFixed(floors[i].seen, 2))
            .append(" m2");
    }
    return "-";
}

}  // namespace

std::string deviceText(const Sensor& sensor) {
    const std::string& model = deviceName(sensor.model);
    return model.empty() ? std::string(kindOf(sensor.model).keyword) : model;
}

PageTable installationTable(const Scene& scene, const Coverage& coverage,
                            const std::vector<Installation>& installations,
                            const std::vector<Cable>& cables) {
    PageTable table{
        "metres from the plan's origin and from the faces of walls; heading in degrees "
        "counter-clockwise from the x axis, tilt above level; +y: the wall lies in that direction "
        "from the sensor, at right angles; along: from that corner, parallel to the wall, to "
        "the sensor",
        "llrrrrrlrrl",
        {"sensor", "device", "x", "y", "height", "heading", "tilt", "lens or view", "nearest wall",
         "next wall", "sees"},
        {}};
    const std::vector<IndoorFloor> floors = indoorFloors(scene, coverage);
    if (!cables.empty()) {
        table.caption += "; cable: along the walls, and up or down to the panel";
        table.heads.insert(table.heads.end() - 1, "cable");
        table.sides.insert(table.sides.end() - 1, 'r');
    }
    for (const Installation& one : installations) {
        const Sensor& sensor = scene.sensors[one.sensor];
        const Point3 at = sensor.pose.position;
        const SensorKind& kind = kindOf(sensor.model);
        table.rows.push_back(
            {sensor.id, deviceText(sensor), metresText(at.x), metresText(at.y), metresText(at.z),
             degrees(sensor.pose.heading), tiltText(sensor.pose),
             kind.summary == nullptr ? "-" : kind.summary(sensor.model).field_of_view,
             wallText(one, 0, at.onFloor()), wallText(one, 1, at.onFloor()),
             taskOf(scene, coverage, floors, one.sensor)});
        if (cables.empty()) continue;
        const auto cable = std::find_if(cables.begin(), cables.end(), [&one](const Cable& each) {
            return each.sensor == one.sensor;
        });
        const bool is_laid = cable != cables.end() && !cable->panel.empty();
        TextRow& row = table.rows.back();
        row.insert(row.end() - 1,
                   is_laid ? formatFixed(cable->length, 2) + " to " + cable->panel : "-");
    }
    return table;
}

PageTable wallFacesTable(const std::vector<Installation>& installations) {
    PageTable table{"ends of the walls' faces from which distances count, metres",
                    "lr",
                    {"wall", "x", "y", "to x", "to y"},
                    {}};
    std::set<std::string> listed;
    for (const Installation& one : installations)
        for (const WallDistance& wall : one.walls)
            if (listed.insert(wall.wall).second)
                table.rows.push_back({wall.wall, metresText(wall.face.a.x),
                                      metresText(wall.face.a.y), metresText(wall.face.b.x),
                                      metresText(wall.face.b.y)});
    return table;
}

std::vector<PageSection> cameraSheets(const Scene& scene, const Coverage& coverage,
                                      const PageTable& installation,
                                      std::vector<PageFigure>& pictures) {
    // Table, picture and floor fit on one sheet of either paper: shares of the column's width.
    constexpr double kMostHeight = 0.52, kFloor = 0.3;
    std::vector<PageSection> sheets;
    for (const TextRow& row : installation.rows) {
        const auto camera =
            std::find_if(scene.sensors.begin(), scene.sensors.end(), [&row](const Sensor& sensor) {
                return sensor.id == row.front() && sensor.is<Camera>();
            });
        if (camera == scene.sensors.end()) continue;
        PageSection sheet{"sheet-" + std::to_string(sheets.size() + 1),
                          (row.front().starts_with("camera") ? "" : "Camera ") + row.front(),
                          {}};
        sheet.begins_sheet = true;
        PageTable table{
            "where it is mounted; metres and degrees as in the table of the installation",
            "ll",
            {"", row.front()},
            {}};
        for (std::size_t i = 1; i < row.size(); ++i)
            table.rows.push_back({installation.heads[i], row[i]});
        sheet.blocks.push_back(std::move(table));
        const auto picture =
            std::find_if(pictures.begin(), pictures.end(), [&row](const PageFigure& figure) {
                return figure.caption.starts_with(row.front() + ": picture");
            });
        if (picture != pictures.end()) {
            picture->width =
                std::min(1.0, kMostHeight * picture->picture.width() / picture->picture.height());
            sheet.blocks.push_back(std::move(*picture));
            pictures.erase(picture);
        }
        // In a building views have the storey before their ids, and some are of other storeys.
        const auto index = static_cast<std::size_t>(camera - scene.sensors.begin());
        const auto view =
            std::find_if(coverage.sensors.begin(), coverage.sensors.end(),
                         [index](const SensorView& one) { return one.index == index; });
        if (view != coverage.sensors.end()) {
            PageFigure floor = floorFigure(
                scene, coverage, static_cast<std::size_t>(view - coverage.sensors.begin()));
            floor.width = kFloor;
            sheet.blocks.emplace_back(std::move(floor));
        }
        sheets.push_back(std::move(sheet));
    }
    return sheets;
}

}  // namespace ispace::pages
