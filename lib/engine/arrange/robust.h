// SPDX-License-Identifier: GPL-3.0-or-later
// Cases in which a robust layout has to hold.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arrange/site.h"
#include "coverage/crowd.h"
#include "coverage/mounting.h"
#include "scene/scene.h"

namespace ispace {

/// The site with other furniture or doors: as many rooms, in the same order.
struct NamedSite {
    std::string name;
    std::shared_ptr<const ArrangeSite> site;  ///< its goals do not count
};

/// Number of mountings and of crowds that a search considers: the first ones of coverage(1).
constexpr int kRobustSamples = 16;
/// A search considers all sets of this many sensors, at most.
constexpr int kMaxFailures = 3;

/// The cases of a robust search. It maximises the least value, or the mean.
struct RobustChoice {
    enum class Of {
        Nothing,
        Rooms,     ///< the site, and the same with other furniture or doors
        Failures,  ///< of any K sensors of the layout
        Mounting,  ///< random errors of mounting, the same for all candidates of a site
        Crowd,     ///< people at random positions; a sensor inside of one is blind
    };
    Of of = Of::Nothing;
    bool is_worst = true;
    std::string name = {};  ///< of the site itself, of rooms
    std::vector<NamedSite> rooms = {};
    int failures = 0, people = 0;
    MountingTolerance tolerance = {};
    std::optional<std::uint64_t> seed = {};  ///< of mountings; empty: that of the options

    [[nodiscard]] bool isAsked() const { return of != Of::Nothing; }
};

/// Draws the crowds of a room, kRobustSamples. \throws UnmetError as CrowdFloor::draw()
std::vector<Crowd> crowdsIn(const Scene& scene, std::size_t people, std::uint64_t seed);

/// The values of a layout in the cases of the search.
struct RobustValues {
    std::vector<std::string> names;   ///< of sites, of rooms
    std::vector<double> shares = {};  ///< by case; with failures: of the worst case alone
    /// With failures: the sensors of the worst case.
    std::vector<std::string> failed = {};
    double worst = 0, mean = 0;

    /// Returns the standard error of the mean of independent cases; 0 for a single one.
    [[nodiscard]] double standardError() const;
};

}  // namespace ispace
