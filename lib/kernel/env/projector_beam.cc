// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/projector_beam.h"

#include <cmath>
#include <tuple>

#include "env/projector_model.h"

namespace ispace {

namespace {

constexpr double kNearest = 0.01;  // metres before the lens

}  // namespace

std::optional<ProjectorBeam::Spot> ProjectorBeam::spotAt(Point3 place, Vec3 normal) const {
    const Vec3 local = lens.toLocal(place);
    if (local.x < kNearest) return std::nullopt;
    const double y = local.y / (local.x * across), z = local.z / (local.x * upright);
    if (!(std::fabs(y) <= 1 && std::fabs(z) <= 1)) return std::nullopt;
    const double facing = -dot(normal, place - lens.origin);
    if (facing <= 0) return std::nullopt;
    // At depth 1 the light is spread evenly over 4 * across * upright square metres. A surface gets
    // its share by the solid angle, facing / r^3, over that of the plane at depth 1, (x / r)^3.
    const double lux = lumens / (4 * across * upright) * facing / (local.x * local.x * local.x);
    if (!std::isfinite(lux)) return std::nullopt;
    return Spot{(1 - y) / 2, (1 - z) / 2, lux};
}

bool operator==(const ProjectorBeam& a, const ProjectorBeam& b) {
    const auto values = [](const ProjectorBeam& beam) {
        const auto& [origin, forward, left, up] = beam.lens;
        return std::tuple(origin, forward, left, up, beam.across, beam.upright, beam.lumens);
    };
    return values(a) == values(b);
}

std::optional<ProjectorBeam> projectorBeam(const Record& record) {
    const double level = record.number("level");
    if (!record.flag("on") || level == 0) return std::nullopt;
    const ProjectorModel model = projectorModel(record);
    return ProjectorBeam{projectorLens(record, record.angle("pan"), record.angle("tilt")),
                         model.across, model.upright, level * model.lumens};
}

}  // namespace ispace
