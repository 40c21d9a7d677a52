// SPDX-License-Identifier: GPL-3.0-or-later
// Which ways --presence counts: those of a record, or of people that wander by a seed. The same
// seed, scene and version give the same ways.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/site_operands.h"
#include "extensions/presence/people_paths.h"
#include "scene/scene.h"
#include "sim/sim_time.h"
#include "site/site_scene.h"

namespace ispace::presence {

/// The ways of people that `--presence` counts.
struct PathsChoice {
    std::string record;                           ///< folder of a recorded run; "": people wander
    int people = 0;                               ///< that wander
    SimTime duration = std::chrono::minutes(10);  ///< for which they do
};

/// Parses `DIR` or `wander:N[,TIME]`. \throws UsageError
PathsChoice parseWays(const std::string& text);

/// Visits all people at each moment of a recorded run, or of a simulation of that many people,
/// wandering from random positions instead of the scene's, with its robots. Deterministic for a
/// seed. \throws as RunReader, UnmetError as CrowdFloor::draw()
void visitPaths(const PathsChoice& choice, const Scene& scene, std::uint64_t seed,
                const PersonVisit& visit);

/// Cuts the ways of visitPaths() into pieces.
PeoplePaths readPaths(const PathsChoice& choice, const Scene& scene, std::uint64_t seed);

/// The ways in one room of a site.
struct RoomPaths {
    PathsChoice choice;      ///< its folder of the record, or its people
    std::uint64_t seed = 0;  ///< see seedOfStorey()
    /// Returns true for a room without people.
    [[nodiscard]] bool isEmpty() const { return choice.record.empty() && choice.people == 0; }
};
/// Returns the ways in each storey of a building: those of its record, or of wanderers.
/// \param people wanderers by storey
std::vector<RoomPaths> waysOfStoreys(const PathsChoice& choice, const SiteScene& building,
                                     std::span<const std::size_t> people, std::uint64_t seed);
/// Returns the ways in each room of a site; wanderers are spread by free floor. \param plane of the
/// free floor \param option for messages \throws UsageError for several rooms and the record of one
std::vector<RoomPaths> waysIn(const SiteInput& site, const std::string& option,
                              const PathsChoice& choice, std::uint64_t seed, double plane);
/// Cuts the ways in a room into pieces.
PeoplePaths readPaths(const RoomPaths& ways, const Scene& scene);

}  // namespace ispace::presence
