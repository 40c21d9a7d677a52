// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/beam_cells.h"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "geom/tolerance.h"
#include "sense/scan.h"

namespace ispace {

Laser withBeamStep(Laser laser, Angle step) {
    const double turn = 360, own = laser.step.degrees();
    const double wanted = step > Angle() ? step.degrees() : own;
    const bool is_round = laser.seesAround();
    const double span = laser.sweptSpan().degrees();
    laser.sweep = SweepAxis::None;
    if (is_round) {
        laser.beams = static_cast<int>(std::lround(turn / wanted));
        laser.step = Angle::degrees(turn / laser.beams);
    } else {
        laser.beams = static_cast<int>(std::floor(span / wanted + kStepTolerance)) + 1;
        laser.step = Angle::degrees(wanted);
    }
    return laser;
}

CellSet cellsByBeams(const Grid& grid, const RayWorld& world, const Sensor& sensor) {
    const auto& laser = std::get<Laser>(sensor.model);
    const Point2 origin = sensor.pose.position.onFloor();
    const std::vector<float> ranges = castBeams(world, sensor);
    std::vector<Point2> contour;
    contour.reserve(ranges.size() + 1);
    if (laser.span() < Angle::degrees(360)) contour.push_back(origin);
    Box2 box;
    box.add(origin);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const double range = std::min(static_cast<double>(ranges[i]), laser.max_range);
        const Angle heading = sensor.pose.heading + laser.bearing(static_cast<int>(i));
        contour.push_back(origin + range * unitVector(heading));
        box.add(contour.back());
    }
    Scanline inside(grid, box);
    for (std::size_t i = 0; i < contour.size(); ++i) {
        const Point2 from = contour[i], to = contour[(i + 1) % contour.size()];
        if (from != to) inside.add({from, to});
    }
    CellSet cells(grid.size());
    inside.addInside(cells);
    return cells;
}

}  // namespace ispace
