// SPDX-License-Identifier: GPL-3.0-or-later
// Each person's pieces are read backwards: the time of the next detection is then known, and a
// piece counts if that lies within kPresenceDelay. So a person counts as detected up to a second
// before a sensor fires, which is the delay that an application sees, and never after it.
//
// Sensors are measured side by side, each into its own set; sums follow in their order, so that
// figures do not depend on the number of threads.
#include "extensions/presence/presence.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "env/level.h"
#include "geom/tolerance.h"
#include "sense/motion_sense.h"

namespace ispace::presence {

PresenceView::PresenceView(const PeoplePaths& ways, double plane)
    : ways_(ways), firsts_(ways.firsts()) {
    places_.reserve(ways.pieces.size());
    for (const PathPiece& piece : ways.pieces)
        places_.push_back({piece.place.x, piece.place.y, plane});
}

std::vector<std::uint8_t> PresenceView::unhidden(const RayWorld& mesh, const Sensor& sensor) const {
    const Point3 origin = sensor.pose.position;
    const double reach = maxRange(sensor.model) * (1 + kFloatTolerance) + kRayEpsilon;
    std::vector<std::size_t> near;
    std::vector<Point3> targets;
    std::vector<std::uint8_t> unhidden(places_.size(), 0);
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const Vec3 way = places_[i] - origin;
        const double square = dot(way, way);
        if (square == 0) unhidden[i] = 1;
        if (square == 0 || square > reach * reach) continue;
        near.push_back(i);
        targets.push_back(places_[i]);
    }
    std::vector<std::uint8_t> seen(targets.size());
    mesh.query(origin, targets, seen);
    for (std::size_t k = 0; k < near.size(); ++k) unhidden[near[k]] = seen[k];
    return unhidden;
}

CellSet PresenceView::detected(const Sensor& sensor,
                               const std::vector<std::uint8_t>& unhidden) const {
    const FieldOfView view = fieldOfView(sensor).value();
    const auto is_detected = [&](std::size_t i) {
        if (unhidden[i] == 0 || !view.holds(places_[i])) return false;
        const Vec3 way = places_[i] - sensor.pose.position;
        const double distance = length(way);
        const Vec3 direction = distance > 0 ? (1 / distance) * way : Vec3{0, 0, -1};
        return detects(sensor.model, ways_.pieces[i].velocity, direction);
    };
    constexpr double kTolerance = 1e-9;  // s
    CellSet pieces(places_.size());
    for (std::size_t person = 0; person + 1 < firsts_.size(); ++person) {
        double next = std::numeric_limits<double>::infinity();  // time of the next detection
        for (std::size_t i = firsts_[person + 1]; i-- > firsts_[person];) {
            const double time = ways_.pieces[i].time;
            if (is_detected(i)) next = time;
            if (next - time <= kPresenceDelay + kTolerance) pieces.set(i);
        }
    }
    return pieces;
}

CellSet PresenceView::detected(const Sensor& sensor, const RayScenes& worlds) const {
    const Point3 origin = sensor.pose.position;
    const bool rides = sensor.mount || sensor.person;
    if (!detectsMotion(sensor.model) || rides ||
        worlds.environment().level(origin.z)->isInsideSolid(origin.onFloor()))
        return CellSet(places_.size());
    return detected(sensor, unhidden(worlds.mesh(kindOf(sensor.model).stopped_by), sensor));
}

namespace {

/// Sums the pieces from `begin` to before `end`.
void addPieces(const PeoplePaths& ways, const CellSet& seen, std::size_t begin, std::size_t end,
               PresenceFigures& figures) {
    double gap = 0, seen_length = 0;
    for (std::size_t i = begin; i < end; ++i) {
        const double length = ways.pieces[i].length;
        figures.length += length;
        if (seen.test(i)) seen_length += length;
        gap = seen.test(i) ? 0 : gap + length;
        figures.longest_gap = std::max(figures.longest_gap, gap);
    }
    figures.share = figures.length > 0 ? seen_length / figures.length : 0;
}

}  // namespace

Presence measurePresence(const Scene& scene, const PeoplePaths& ways, double plane) {
    std::vector<const Sensor*> sensors;
    RayScenes worlds(scene.environment);
    for (const Sensor& sensor : scene.sensors) {
        if (!detectsMotion(sensor.model)) continue;
        sensors.push_back(&sensor);
        worlds.prepareMesh(kindOf(sensor.model).stopped_by);
    }
    const PresenceView view(ways, plane);
    std::vector<CellSet> seen(sensors.size());
    tbb::parallel_for(std::size_t{0}, sensors.size(),
                      [&](std::size_t k) { seen[k] = view.detected(*sensors[k], worlds); });
    // How many sensors detect each piece.
    std::vector<std::uint16_t> counts(ways.pieces.size());
    CellSet any(ways.pieces.size());
    for (const CellSet& pieces : seen) {
        any |= pieces;
        pieces.forEach([&](std::size_t i) {
            counts[i] = static_cast<std::uint16_t>(std::min(counts[i] + 1, 2));
        });
    }
    Presence presence;
    const std::vector<std::size_t> firsts = ways.firsts();
    double seen_length = 0;
    for (std::size_t k = 0; k < ways.people.size(); ++k) {
        PresenceFigures& person = presence.people.emplace_back();
        person.id = ways.people[k];
        addPieces(ways, any, firsts[k], firsts[k + 1], person);
        presence.all.length += person.length;
        seen_length += person.share * person.length;
        presence.all.longest_gap = std::max(presence.all.longest_gap, person.longest_gap);
    }
    const double whole = presence.all.length;
    presence.all.share = whole > 0 ? seen_length / whole : 0;
    for (std::size_t k = 0; k < sensors.size(); ++k) {
        SensorPresence& sensor = presence.sensors.emplace_back();
        sensor.id = sensors[k]->id;
        if (!(whole > 0)) continue;
        seen[k].forEach([&](std::size_t i) {
            sensor.share += ways.pieces[i].length / whole;
            if (counts[i] == 1) sensor.marginal += ways.pieces[i].length / whole;
        });
    }
    return presence;
}

}  // namespace ispace::presence
