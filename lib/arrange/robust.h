// SPDX-License-Identifier: GPL-3.0-or-later
// Cases in which a robust layout has to hold.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coverage/robustness.h"
#include "scene/scene.h"

namespace ispace {

struct NamedScene {
    std::string name;
    std::shared_ptr<const Scene> scene;
};

/// Number of mountings and of crowds that a search considers: the first ones of coverage(1).
constexpr int kRobustSamples = 16;
/// A search considers all sets of this many sensors, at most.
constexpr int kMaxFailures = 3;

/// The cases of a robust search. It maximises the least value, or the mean.
struct RobustChoice {
    enum class Of {
        Nothing,
        Rooms,     ///< the scene, and the same with other furniture or doors
        Failures,  ///< of any K sensors of the layout
        Mounting,  ///< random errors of mounting, the same for all candidates of a site
        Crowd,     ///< people at random positions; a sensor inside of one is blind
    };
    Of of = Of::Nothing;
    bool is_worst = true;
    std::string name = {};  ///< of the scene itself, of rooms
    std::vector<NamedScene> rooms = {};
    int failures = 0, people = 0;
    MountingTolerance tolerance = {};
    std::optional<std::uint64_t> seed = {};  ///< of mountings; empty: that of the options

    [[nodiscard]] bool isAsked() const { return of != Of::Nothing; }
};

/// The values of a layout in the cases of the search.
struct RobustValues {
    std::vector<std::string> names;   ///< of rooms
    std::vector<double> shares = {};  ///< by case; with failures: of the worst case alone
    /// With failures: the sensors of the worst case.
    std::vector<std::string> failed = {};
    double worst = 0, mean = 0;
};

}  // namespace ispace
