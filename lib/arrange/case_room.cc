// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/case_room.h"

#include <utility>

#include "arrange/objective.h"
#include "base/number.h"
#include "coverage/crowd.h"

namespace ispace {

Pose3 SiteErrors::mounted(const Sensor& sensor) const {
    Sensor probe = sensor;
    probe.id.clear();
    const Point3 at = sensor.pose.position;
    for (const double number : {at.x, at.y, at.z}) probe.id += formatDouble(number) + ' ';
    probe.pose.heading = Angle();
    const RandomKey key{.seed = seed_, .frame = mounting_};
    Pose3 pose = mountedPose(*environment_, probe, tolerance_, key);
    pose.heading = wrapped(sensor.pose.heading + pose.heading);
    return pose;
}

CaseRoom::CaseRoom(Scene in, std::string called, const ArrangeOptions& options,
                   std::uint64_t number)
    : scene(std::move(in)),
      name(std::move(called)),
      worlds(scene.environment),
      sight(scene.environment, options.plane, &worlds) {
    if (options.robust.of == RobustChoice::Of::Mounting)
        errors.emplace(scene.environment, options.robust.tolerance,
                       options.robust.seed.value_or(options.seed), number);
    for (Sensor& sensor : scene.sensors) {
        limitCovered(sensor.model, options);
        sensor = mounted(std::move(sensor));
    }
}

Sensor CaseRoom::mounted(Sensor sensor) const {
    if (errors && !sensor.mount && !sensor.person) sensor.pose = errors->mounted(sensor);
    return sensor;
}

CellSet CaseRoom::stacked(const CellSet& cells, std::size_t all) const {
    CellSet stack(all);
    for (const std::size_t first : firsts)
        cells.forEach([&](std::size_t cell) { stack.set(first + cell); });
    return stack;
}

std::vector<std::unique_ptr<CaseRoom>> caseRoomsOf(const Scene& scene,
                                                   const ArrangeOptions& options) {
    const RobustChoice& robust = options.robust;
    std::vector<std::unique_ptr<CaseRoom>> rooms;
    const auto add = [&](Scene in, std::string name) {
        const std::uint64_t number = rooms.size();
        rooms.push_back(
            std::make_unique<CaseRoom>(std::move(in), std::move(name), options, number));
    };
    switch (robust.of) {
        case RobustChoice::Of::Nothing:
            break;
        case RobustChoice::Of::Rooms:
            add(scene, robust.name);
            for (const NamedScene& room : robust.rooms) add(*room.scene, room.name);
            break;
        case RobustChoice::Of::Failures:
            add(scene, "");
            break;
        case RobustChoice::Of::Mounting:
            for (int k = 0; k < kRobustSamples; ++k) add(scene, "");
            break;
        case RobustChoice::Of::Crowd: {
            const CrowdFloor floor(scene);
            for (int k = 0; k < kRobustSamples; ++k)
                add(withCrowd(scene, floor.draw(static_cast<std::size_t>(robust.people),
                                                {.seed = options.seed,
                                                 .frame = static_cast<std::uint64_t>(k)})),
                    "");
            break;
        }
    }
    return rooms;
}

}  // namespace ispace
