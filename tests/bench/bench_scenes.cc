// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench_scenes.h"
#include "extensions/cad/tests/test_dxf.h"
#include "support/test_paths.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <random>

#include "arrange/placement_rules.h"
#include "base/number.h"
#ifdef ISPACE_HAS_CAD
#include "extensions/cad/cad.h"
#endif
#include "io/importers.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/sensor_spec.h"

namespace ispace::bench {

namespace {

constexpr double kRoomWidth = 4, kRoomDepth = 5, kCorridor = 2, kDoor = 1;

std::string tuple(double x, double y) { return formatDouble(x) + ',' + formatDouble(y); }

std::string wall(double x0, double y0, double x1, double y1) {
    return "wall from=" + tuple(x0, y0) + " to=" + tuple(x1, y1) + '\n';
}

/// A room with a door in its upper side.
std::string room(double x, double y, bool last) {
    std::string text = wall(x, y + kRoomDepth, x + 1, y + kRoomDepth) +
                       wall(x + 1 + kDoor, y + kRoomDepth, x + kRoomWidth, y + kRoomDepth);
    if (!last) text += wall(x + kRoomWidth, y, x + kRoomWidth, y + kRoomDepth);
    text += "desk at=" + tuple(x + 2.8, y + 1) + " size=1.6,0.8,0.72\n";
    text += "chair at=" + tuple(x + 2.8, y + 2) + " heading=-90\n";
    text += "table at=" + tuple(x + 1.2, y + 3.4) + " size=1,1,0.72\n";
    return text;
}

/// A room on a corridor, with a door in its walls and perhaps a window.
std::string roomWithDoor(double x, double y, int number, Building& out) {
    const std::string id = "front" + std::to_string(number);
    const double top = y + kRoomDepth, right = x + kRoomWidth;
    const bool is_open = number % 4 != 0;
    std::string text = "wall id=" + id + " from=" + tuple(x, top) + " to=" + tuple(right, top) +
                       '\n' + wall(right, y, right, top) + "door wall=" + id + " offset=1.5" +
                       (is_open ? " open=yes\n" : "\n");
    out.walls += 2;
    if (!is_open) out.indoor_area -= kRoomWidth * kRoomDepth;
    if (number % 3 == 0) text += "window wall=" + id + " offset=3\n";
    if (number % 2 == 0) {
        text += "desk at=" + tuple(x + 2.8, y + 1) + " size=1.6,0.8,0.72\n";
        text += "chair at=" + tuple(x + 2.8, y + 2) + " heading=-90\n";
    }
    if (number % 5 == 0) text += "pillar at=" + tuple(x + 1, y + 2) + '\n';
    return text;
}

}  // namespace

DeviceCatalogue devices() { return loadDevices(testing::sourcePath("share/devices")); }

std::string sceneFile(const std::string& name) {
    return testing::sourcePath("share/scenes/") + name;
}

Document readRoom(const std::string& file) {
#ifdef ISPACE_HAS_CAD
    [[maybe_unused]] static const bool reads_plans = [] {
        addImporters(cad::cadImporters());
        return true;
    }();
#endif
    return readDocument(file, ImportOptions(), sceneSchemas());
}

Scene loadScene(const std::string& file) { return makeScene(readRoom(file), nullptr, devices()); }

std::string officeText(int columns, int rows) {
    const double width = columns * kRoomWidth;
    const double pitch = kRoomDepth + kCorridor;
    std::string text = "#env 1\nfence path=0,0;" + tuple(width, 0) + ';' +
                       tuple(width, rows * pitch) + ';' + tuple(0, rows * pitch) + " closed=yes\n";
    for (int row = 0; row < rows; ++row) {
        // The rear wall of all rows but the first, which stand at the fence; it ends short of the
        // fence, so that one gets around it.
        if (row > 0) text += wall(0, row * pitch, width - kDoor, row * pitch);
        for (int column = 0; column < columns; ++column) {
            text += room(column * kRoomWidth, row * pitch, column + 1 == columns);
        }
    }
    return text;
}

Scene officeScene(int columns, int rows) { return sceneOfText(officeText(columns, rows)); }

Scene sceneOfText(const std::string& text) {
    return makeScene(readRecordText(text, "plan", sceneSchemas()), nullptr, DeviceCatalogue());
}

std::size_t linesOf(const Scene& scene) {
    std::size_t lines = 0;
    scene.environment.slice(kScanHeight).forEachLine([&lines](const Segment2&) { ++lines; });
    return lines;
}

namespace {

Record recordOfModel(std::string_view keyword, const std::string& model) {
    return readSensorSpec(model, {&keyword, 1}, sceneSchemas(), devices()).record;
}

}  // namespace

Laser laserOfModel(const std::string& model) {
    return std::get<Laser>(sensorModelOf(recordOfModel("laser", model), devices()));
}

Ranger rangerOfModel(const std::string& model) {
    return std::get<Ranger>(sensorModelOf(recordOfModel("ranger", model), devices()));
}

Building building(std::size_t walls) {
    // Two walls a room, and one behind each row.
    const double pitch = kRoomDepth + kCorridor;
    const auto rooms = static_cast<double>(walls) / 2;
    const int columns = static_cast<int>(std::ceil(std::sqrt(rooms * pitch / kRoomWidth)));
    const int rows = static_cast<int>(std::ceil(rooms / columns));
    const double width = columns * kRoomWidth;
    Building out;
    out.text = "#env 1\nfence path=0,0;" + tuple(width, 0) + ';' + tuple(width, rows * pitch) +
               ';' + tuple(0, rows * pitch) + " closed=yes\n";
    out.indoor_area = width * rows * pitch;
    int number = 0;
    for (int row = 0; row < rows; ++row) {
        const double y = row * pitch;
        // It ends short of the fence, so that one gets around it.
        if (row > 0) out.text += wall(0, y, width - kDoor, y);
        for (int column = 0; column < columns; ++column, ++number)
            out.text += roomWithDoor(column * kRoomWidth, y, number, out);
        out.walls += row > 0 ? 1 : 0;
    }
    return out;
}

Building drawnCubicles(std::size_t lines, bool doors) {
    constexpr double kSide = 2.5, kHinge = 1, kGap = 0.8;
    const std::string layer = "WALLS";
    // Two walls a cubicle, in two parts each.
    const auto cubicles = static_cast<double>(lines) / (doors ? 8 : 4);
    const int count = static_cast<int>(std::sqrt(cubicles));
    const double width = count * kSide;
    std::string entities = cad::rectangle(layer, 0, 0, width, width);
    Building out{{}, 4, width * width};
    const auto add = [&](Point2 from, double heading) {
        const Vec2 along = unitVector(Angle::degrees(heading));
        const Point2 hinge = from + kHinge * along, gap_end = hinge + kGap * along;
        const Point2 to = from + kSide * along, open = hinge + kGap * perpendicular(along);
        entities += cad::line(layer, from.x, from.y, hinge.x, hinge.y) +
                    cad::line(layer, gap_end.x, gap_end.y, to.x, to.y);
        if (doors)
            entities += cad::line(layer, hinge.x, hinge.y, open.x, open.y) +
                        cad::arc(layer, hinge.x, hinge.y, kGap, heading, heading + 90);
        out.walls += doors ? 4 : 2;
    };
    for (int row = 0; row < count; ++row)
        for (int column = 0; column < count; ++column) {
            const Point2 corner{column * kSide, row * kSide};
            if (row > 0) add(corner, 0);
            if (column > 0) add(corner, 90);
        }
    out.text = cad::drawing(entities, "", 6);
    return out;
}

std::shared_ptr<const TriangleMesh> bumpyGlobe(std::uint32_t rings, std::uint32_t sectors) {
    const auto mesh = std::make_shared<TriangleMesh>();
    const auto add = [&mesh](double polar, double azimuth) {
        const double radius = 0.5 + 0.02 * std::sin(40 * polar) * std::sin(30 * azimuth);
        mesh->vertices.push_back({static_cast<float>(radius * std::sin(polar) * std::cos(azimuth)),
                                  static_cast<float>(radius * std::sin(polar) * std::sin(azimuth)),
                                  static_cast<float>(0.6 + radius * std::cos(polar))});
    };
    add(0, 0);
    for (std::uint32_t ring = 1; ring < rings; ++ring)
        for (std::uint32_t sector = 0; sector < sectors; ++sector)
            add(std::numbers::pi * ring / rings, 2 * std::numbers::pi * sector / sectors);
    add(std::numbers::pi, 0);
    const auto south = static_cast<std::uint32_t>(mesh->vertices.size() - 1);
    const auto at = [&](std::uint32_t ring, std::uint32_t sector) {
        if (ring == 0) return 0U;
        return ring == rings ? south : 1 + (ring - 1) * sectors + sector % sectors;
    };
    for (std::uint32_t ring = 0; ring < rings; ++ring)
        for (std::uint32_t sector = 0; sector < sectors; ++sector) {
            const std::uint32_t a = at(ring, sector), b = at(ring + 1, sector);
            const std::uint32_t c = at(ring + 1, sector + 1), d = at(ring, sector + 1);
            if (b != c) mesh->triangles.push_back({a, b, c});
            if (a != d) mesh->triangles.push_back({a, c, d});
        }
    mesh->digest = meshDigest(*mesh);
    return mesh;
}

std::string willowMap() {
    const char* const folder = std::getenv("ISPACE_TEST_DATA");
    const std::string map = folder == nullptr ? "" : folder + std::string("/willow-full.yaml");
    return !map.empty() && std::filesystem::exists(map) ? map : "";
}

std::vector<Sensor> fans(const Scene& scene, std::size_t count, bool level) {
    // No furniture ends there: a beam along its top is a matter of the last bit.
    constexpr double kHigh = 1.55;
    const double height = level ? kScanHeight : kHigh;
    SiteRules rules;
    rules.height = height;
    const SiteValidity validity(scene.environment, rules);
    const Box2& limits = scene.environment.limits();
    std::mt19937_64 random(42);
    std::uniform_real_distribution<double> x(limits.low.x, limits.high.x);
    std::uniform_real_distribution<double> y(limits.low.y, limits.high.y);
    std::uniform_real_distribution<double> heading(-180, 180);
    std::vector<Sensor> sensors;
    while (sensors.size() < count) {
        const Point2 place{x(random), y(random)};
        if (!validity.isValid(place)) continue;
        Sensor sensor;
        sensor.id = "l" + std::to_string(sensors.size() + 1);
        sensor.as<Laser>().max_range = 30;
        sensor.as<Laser>().first = Angle::degrees(-135);
        sensor.as<Laser>().step = Angle::degrees(0.25);
        sensor.as<Laser>().beams = 1081;
        sensor.pose.position = {place.x, place.y, height};
        sensor.pose.heading = Angle::degrees(heading(random));
        if (!level) sensor.pose.tilt = Angle::degrees(-20);
        sensors.push_back(sensor);
    }
    return sensors;
}

}  // namespace ispace::bench
