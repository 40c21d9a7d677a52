// SPDX-License-Identifier: GPL-3.0-or-later
// Movers with walk=wander: time on a storey, and trips to others. Random numbers are keyed by seed,
// id and a count of draws.
#include <array>
#include <span>
#include <vector>

#include "base/random.h"
#include "extensions/passages/building_run.h"
#include "extensions/passages/building_run_data.h"

namespace ispace::passages {

namespace {

/// Seconds on a storey: the least, and the range above it.
constexpr double kStay = 60, kStayLonger = 120;
/// Random points of other storeys that are tried at a time.
constexpr int kTries = 8;

}  // namespace

double BuildingRun::Data::random(const std::string& id, Wanderer& wanderer) const {
    std::array<float, 1> value{};
    draw({options.run.seed, Purpose::Storeys, hashOf(id), wanderer.draws++}, 0, {.uniform = value});
    return value.front();
}

/// Before each step.
void BuildingRun::Data::advanceWanderers() {
    const SimTime now = rooms.front().world->time();
    for (auto& [id, wanderer] : wanderers) {
        if (wanderer.trip) continue;
        const World& world = worldOf(travellers.find(id)->second);
        // On the path of its record, or driven by a client.
        if (!world.isWandering(world.moverNamed(id).value()))
            wanderer.until.reset();
        else if (!wanderer.until)
            wanderer.until = now + simSeconds(kStay + kStayLonger * random(id, wanderer));
        else if (now >= *wanderer.until)
            visitOtherStorey(id, wanderer);
    }
}

/// Begins a trip to a random point, if there is one with a way among some.
void BuildingRun::Data::visitOtherStorey(const std::string& id, Wanderer& wanderer) {
    wanderer.until.reset();
    const Traveller& who = travellers.find(id)->second;
    const std::size_t storeys = building.scenes.size();
    if (storeys < 2) return;
    for (int i = 0; i < kTries; ++i) {
        auto storey =
            static_cast<std::size_t>(random(id, wanderer) * static_cast<double>(storeys - 1));
        if (storey >= *rooms[who.room].storey) ++storey;
        const Box2 box = bounds(building.scenes[storey]->environment.indoor());
        const double x = box.low.x + box.width() * random(id, wanderer);
        const double y = box.low.y + box.depth() * random(id, wanderer);
        if (!waysOf(who).finder(storey).isFree({x, y})) continue;
        BuildingTrip trip;
        trip.plan.points = {{storey, {x, y}}};
        const TripAnswer answer = begin(id, std::move(trip));
        if (!answer.refusal.empty()) continue;
        wanderer.trip = answer.id;
        return;
    }
}

/// After a trip: wanders again unless a client ended it.
void BuildingRun::Data::wanderOn(const std::string& id, int command, Outcome outcome) {
    const auto found = wanderers.find(id);
    if (found == wanderers.end() || found->second.trip != command) return;
    found->second.trip.reset();
    if (outcome == Outcome::Replaced || outcome == Outcome::Stopped) return;
    World& world = worldOf(travellers.find(id)->second);
    MotionPlan walk;
    walk.wander = true;
    world.follow(world.moverNamed(id).value(), walk);
}

}  // namespace ispace::passages
