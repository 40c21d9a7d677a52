// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/case_room.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "arrange/objective.h"
#include "base/number.h"

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

CaseRoom::CaseRoom(Scene in, const ArrangeOptions& options, std::uint64_t number)
    : scene(std::move(in)),
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

std::vector<Crowd> crowdsIn(const Scene& scene, std::size_t people, std::uint64_t seed) {
    const CrowdFloor floor(scene);
    std::vector<Crowd> crowds(kRobustSamples);
    for (std::size_t k = 0; people > 0 && k < crowds.size(); ++k)
        crowds[k] = floor.draw(people, {.seed = seed, .frame = k});
    return crowds;
}

double RobustValues::standardError() const {
    if (shares.size() < 2) return 0;
    const auto count = static_cast<double>(shares.size());
    const double middle = std::accumulate(shares.begin(), shares.end(), 0.0) / count;
    double squares = 0;
    for (const double share : shares) squares += (share - middle) * (share - middle);
    return std::sqrt(squares / (count - 1) / count);
}

}  // namespace ispace
