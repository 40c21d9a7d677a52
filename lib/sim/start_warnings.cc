// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/start_warnings.h"

#include <algorithm>

#include "base/number.h"
#include "env/point_location.h"

namespace ispace {

std::vector<std::string> outsideWarnings(const Scene& scene, std::string_view id) {
    std::vector<std::string> warnings;
    const RegionIndex& indoor = scene.environment.indoorIndex();
    const auto is_outside = [&indoor](Point2 p) { return indoor.locate(p) == Side::Outside; };
    const auto place = [](Point2 p) { return formatDouble(p.x) + ',' + formatDouble(p.y); };
    const auto look = [&](const auto& mover) {
        if (!id.empty() && mover.id != id) return;
        const Point2 start = mover.pose.position;
        const std::vector<Point2>& path = mover.course.path;
        if (is_outside(start)) {
            warnings.push_back(mover.id + " stands outside the room at " + place(start));
        } else if (const auto lost = std::find_if(path.begin(), path.end(), is_outside);
                   lost != path.end()) {
            warnings.push_back("the path of " + mover.id + " leads out of the room to " +
                               place(*lost));
        }
    };
    for (const PlacedRobot& robot : scene.robots) look(robot);
    for (const PlacedPerson& person : scene.people) look(person);
    return warnings;
}

std::vector<std::string> startWarnings(const World& world, std::string_view id) {
    std::vector<std::string> warnings;
    for (const std::size_t robot : world.keptStarts()) {
        const std::string& name = world.robots()[robot].id;
        if (id.empty() || name == id)
            warnings.push_back("the start_noise of " + name +
                               " leads nowhere free: it starts where its record says");
    }
    return warnings;
}

}  // namespace ispace
