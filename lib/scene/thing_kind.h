// SPDX-License-Identifier: GPL-3.0-or-later
// Records of extensions that act on a room: they take power, sound, warm and shine, and people use
// them. Sensors, states and activities ask here, and know no keyword.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/pose.h"
#include "record/record.h"

namespace ispace {

/// What a thing takes and gives off in the state of its record.
struct Emission {
    Pose3 pose = {};    ///< in the room: where it sounds and shines, and the axis of its light
    double watts = 0;   ///< electric power
    double heat = 0;    ///< W that warm the zone in which it stands
    double volume = 0;  ///< sound pressure level at a metre, dB; 0: silent
    double lumens = 0;  ///< of its light, even over a pyramid about its axis
    Angle spread = Angle::degrees(120);  ///< full angle of the pyramid, across and upright
};

/// The changes of states that follow when a person uses a thing: `key=value`, or "" for none.
struct UseChanges {
    std::string begin, end;
};

/// Records with a keyword.
struct ThingKind {
    std::vector<std::string> states = {};  ///< keys whose values may change while the world runs
    std::vector<std::string> told = {};    ///< further states, numbers that events of a run tell
    Emission (*emission)(const Record& record) = nullptr;  ///< null: none
    UseChanges (*use)(const Record& record) = nullptr;     ///< null: it stays as it is
};

/// Adds the kind of a keyword, for the program: call it before any scene is read.
void addThingKind(std::string_view keyword, ThingKind kind);

/// Returns the kind of a keyword; null for keywords of the core and others without one.
/// Thread-safe.
const ThingKind* thingKind(std::string_view keyword);
/// Returns the emission of a record; empty if its keyword has none. Thread-safe.
std::optional<Emission> emissionOf(const Record& record);

}  // namespace ispace
