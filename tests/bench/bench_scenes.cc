// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench_scenes.h"

#include <random>

#include "base/number.h"
#include "io/input.h"
#include "layout/schemas.h"
#include "place/candidates.h"
#include "record/text.h"

namespace ispace::bench {

namespace {

constexpr double kRoomWidth = 4, kRoomDepth = 5, kCorridor = 2, kDoor = 1;

std::string tuple(double x, double y) { return formatDouble(x) + ',' + formatDouble(y); }

std::string wall(double x0, double y0, double x1, double y1) {
    return "wall from=" + tuple(x0, y0) + " to=" + tuple(x1, y1) + '\n';
}

/// A room whose door opens at its upper side.
std::string room(double x, double y, bool last) {
    std::string text = wall(x, y + kRoomDepth, x + 1, y + kRoomDepth) +
                       wall(x + 1 + kDoor, y + kRoomDepth, x + kRoomWidth, y + kRoomDepth);
    if (!last) text += wall(x + kRoomWidth, y, x + kRoomWidth, y + kRoomDepth);
    text += "desk at=" + tuple(x + 2.8, y + 1) + " size=1.6,0.8,0.72\n";
    text += "chair at=" + tuple(x + 2.8, y + 2) + " heading=-90\n";
    text += "table at=" + tuple(x + 1.2, y + 3.4) + " size=1,1,0.72\n";
    return text;
}

}  // namespace

DeviceCatalogue devices() {
    return DeviceCatalogue::load(std::string(ISPACE_SOURCE_DIR) + "/share/devices");
}

std::string sceneFile(const std::string& name) {
    return std::string(ISPACE_SOURCE_DIR) + "/share/scenes/" + name;
}

Scene loadScene(const std::string& file) {
    const Document document = readDocument(file, ImportOptions(), sceneSchemas());
    return makeScene(document, nullptr, devices());
}

Scene officeScene(int columns, int rows) {
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
    const Document document = readRecordText(text, "office", sceneSchemas());
    return makeScene(document, nullptr, DeviceCatalogue());
}

std::vector<PlacedLaser> fans(const Scene& scene, std::size_t count, bool level) {
    constexpr double kHigh = 1.5;
    const double height = level ? kScanHeight : kHigh;
    const Slice slice = scene.environment.slice(height);
    const Box2& limits = scene.environment.limits();
    std::mt19937_64 random(42);
    std::uniform_real_distribution<double> x(limits.low.x, limits.high.x);
    std::uniform_real_distribution<double> y(limits.low.y, limits.high.y);
    std::uniform_real_distribution<double> heading(-180, 180);
    std::vector<PlacedLaser> sensors;
    while (sensors.size() < count) {
        const Point2 place{x(random), y(random)};
        if (!isStandable(scene.environment, slice, place)) continue;
        PlacedLaser sensor;
        sensor.id = "l" + std::to_string(sensors.size() + 1);
        sensor.laser.max_range = 30;
        sensor.laser.first = Angle::degrees(-135);
        sensor.laser.step = Angle::degrees(0.25);
        sensor.laser.beams = 1081;
        sensor.pose.position = {place.x, place.y, height};
        sensor.pose.heading = Angle::degrees(heading(random));
        if (!level) sensor.pose.tilt = Angle::degrees(-20);
        sensors.push_back(sensor);
    }
    return sensors;
}

}  // namespace ispace::bench
