// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "scene/run/people_ways.h"
#include "scene/scene.h"
#include "sim/sim_time.h"

namespace ispace {

class Demand;

/// The ways of people that `--presence` counts.
struct WaysChoice {
    std::string record;                           ///< folder of a recorded run; "": people wander
    int people = 0;                               ///< that wander
    SimTime duration = std::chrono::minutes(10);  ///< for which they do
};

/// Parses `DIR` or `wander:N[,TIME]`. \throws UsageError
WaysChoice parseWays(const std::string& text);

/// Visits all people at each moment of a recorded run, or of a simulation of that many people,
/// wandering from random positions instead of the scene's, with its robots. Deterministic for a
/// seed. \throws as RunReader, UnmetError as CrowdFloor::draw()
void visitWays(const WaysChoice& choice, const Scene& scene, std::uint64_t seed,
               const PersonVisit& visit);

/// Cuts the ways of visitWays() into pieces.
PeopleWays readWays(const WaysChoice& choice, const Scene& scene, std::uint64_t seed);
/// Returns presenceDemand() of these ways.
std::shared_ptr<const Demand> demandOfPresence(const WaysChoice& choice, const Scene& scene,
                                               std::uint64_t seed, double plane);

}  // namespace ispace
