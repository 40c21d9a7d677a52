// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/mote_report.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "sense/illuminance.h"
#include "sense/walls_between.h"

namespace ispace {

namespace {

constexpr double kNearField = 0.01;  // metres: nearer, signals grow no stronger

std::optional<Point3> senderOf(const MoteRadio& mote, const Moment& now) {
    if (mote.carrier == MoteRadio::kStands) return mote.at;
    const auto mover = static_cast<std::uint32_t>(mote.carrier);
    const std::uint32_t owner = mote.is_on_person ? kFirstPerson + mover : mover;
    for (const MovingBody& body : now.bodies.bodies()) {
        // The trunk is a person's only box.
        if (body.owner != owner || (mote.is_on_person && body.radius > 0)) continue;
        const Point2 foot = body.pose * mote.at.onFloor();
        return Point3{foot.x, foot.y, mote.at.z};
    }
    return std::nullopt;
}

/// Computes by how much a signal is stronger than the weakest that is heard; empty if it is not
/// heard.
std::optional<double> marginOf(const Mote& mote, Point3 from, const Moment& now) {
    const Point3 here = now.pose.position;
    const double distance = std::max(kNearField, length(from - here));
    const double free = 20 * std::log10(mote.radio / distance);
    if (free < 0) return std::nullopt;
    const double margin = free - mote.loss * wallsBetween(here, from, now.mesh());
    return margin >= 0 ? std::optional(margin) : std::nullopt;
}

}  // namespace

MoteReport readingOf(const Mote& mote, const Moment& now) {
    MoteReport report{now.time, now.frame, now.pose, readingOf(mote.meter, now).lux, {}};
    for (const MoteRadio& other : mote.motes) {
        if (other.id == now.sensor.id) continue;
        const auto from = senderOf(other, now);
        if (!from) continue;
        if (const auto margin = marginOf(mote, *from, now))
            report.neighbours.push_back({other.id, *margin});
    }
    return report;
}

}  // namespace ispace
