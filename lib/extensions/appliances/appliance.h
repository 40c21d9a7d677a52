// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/appliances: kettles, ovens and other things that take power, and plugs that meter
// it. Uses server and below.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/pose.h"
#include "record/schema.h"
#include "scene/scene.h"
#include "sim/sim_time.h"

namespace ispace::appliances {

/// What an appliance does. It takes power in all but Off.
enum class ApplianceState {
    Off,      ///< without mains
    Standby,  ///< waits, or rests between two parts of its work
    Start,    ///< begins: heats up, or its motor starts
    Hold      ///< works on
};
std::string_view nameOf(ApplianceState state);

/// Power of an appliance and what it gives off, as in the catalogue unless its record says so.
struct ApplianceFigures {
    double start = 0, hold = 0, standby = 0;              ///< W
    double start_time = 0, hold_time = 0, rest_time = 0;  ///< s, see Appliance
    double start_sound = 0, hold_sound = 0;               ///< dB at a metre; 0: silent
    double heat = 1;    ///< share of the power that warms the zone
    double lumens = 0;  ///< in Hold
};

/// A row of the catalogue.
struct ApplianceKind {
    std::string_view name;
    ApplianceFigures figures;
    bool works_alone = false;  ///< goes on when its user leaves
    std::string_view source;   ///< of the figures
};
/// Returns the catalogue, by name.
std::span<const ApplianceKind> applianceKinds();

/// An appliance as its record has it.
///
/// Switched on it is in Start for `start_time` (none: 0) and then in Hold for `hold_time` (0: until
/// it is switched off). Then it is done, and off; with a `rest_time` it rests that long in Standby
/// and starts again, as the compressor of a fridge does.
struct Appliance {
    std::string kind;
    Pose3 pose;
    ApplianceFigures figures;
    bool is_on = false;  ///< switched on
    ApplianceState state = ApplianceState::Standby;

    [[nodiscard]] double watts() const;
    [[nodiscard]] bool works() const {
        return state == ApplianceState::Start || state == ApplianceState::Hold;
    }
};
/// \pre the record is an `appliance`
Appliance applianceOf(const Record& record);

/// The phase of an appliance, which its record follows.
struct AppliancePhase {
    bool is_on = false;
    ApplianceState state = ApplianceState::Standby;
    bool has_mains = true;  ///< no plug cuts it off
    SimTime since{};
};

/// Returns the phase of an appliance whose record, or plug, was changed: a switch starts or ends
/// its work, a state that was set switches it, and one without mains is off until they return.
/// \param before null at the start of a run
AppliancePhase phaseAfterChange(const Appliance& now, const AppliancePhase* before, bool has_mains,
                                SimTime time);
/// Returns the time at which the phase ends by itself; empty: never.
std::optional<SimTime> endOf(const ApplianceFigures& figures, const AppliancePhase& phase);
/// Returns the phase that follows then. \pre endOf() is not empty
AppliancePhase nextPhase(const ApplianceFigures& figures, const AppliancePhase& phase);
/// Returns the phase at a time, after those that have ended by then: at most kMostPhases, from
/// which a shorter cycle than that goes on at that time.
AppliancePhase phaseAt(const ApplianceFigures& figures, AppliancePhase phase, SimTime time);
constexpr int kMostPhases = 100;

/// A plug between the mains and an appliance.
struct Plug {
    std::string id, of;  ///< of records
    bool is_on = true;
    double count = 0.01;  ///< kWh by which its counter counts
};
/// Returns the plugs of a scene, in order, without those of no appliance or of one that has
/// another: addApplianceChecks() finds these.
std::vector<Plug> plugsOf(const Scene& scene);

/// Returns the schemas of `appliance` and `plug`.
std::vector<Schema> applianceSchemas();
/// Adds what sensors, states and people need to know of the records, and their checks.
void addAppliances();

}  // namespace ispace::appliances
