// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/motes: nodes of wireless sensor networks, which measure light and hear each other.
// Uses sense and below.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>

#include "extensions/luxes/lux.h"
#include "extensions/motes/mote_grid.h"
#include "geom/pose.h"
#include "record/record.h"
#include "scene/sensor/shared_list.h"

namespace ispace {

struct SensorKind;

}  // namespace ispace

namespace ispace::motes {

/// A mote of the room, as the others hear it.
struct MoteRadio {
    static constexpr std::size_t kStands = std::numeric_limits<std::size_t>::max();

    std::string id;
    Point3 at;                      ///< if it is carried, from its carrier's body
    std::size_t carrier = kStands;  ///< index among the scene's robots or people
    bool is_on_person = false;
    friend bool operator==(const MoteRadio&, const MoteRadio&) = default;
};

/// A node of a wireless sensor network: it measures light, and hears other nodes.
struct Mote {
    /// Neighbours that it lists at most, as nodes have tables of neighbours.
    static constexpr std::size_t kMostNeighbours = 64;

    std::string model;     ///< "" for the bare mote
    luxes::Lux meter;      ///< its light sensor, which faces along the mote's axis
    double radio = 30;     ///< metres: from farther nodes it hears none, without walls between
    double loss = 6;       ///< dB that each wall between takes
    double rate = 1;       ///< readings a second
    double max_range = 0;  ///< it covers no floor
    SharedList<MoteRadio> motes;  ///< of the room, this one included
    SharedList<MoteGrid> grid;    ///< of `motes`: one, or none without motes

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    /// Walls between stop a ray each.
    [[nodiscard]] std::size_t rays() const {
        return meter.rays() + 4 * std::min(motes.size(), kMostNeighbours);
    }
    [[nodiscard]] static bool isOmnidirectional(const Pose3& /*mount*/) { return false; }
    [[nodiscard]] bool isNoisy() const { return meter.isNoisy(); }
    static const SensorKind kKind;
    friend bool operator==(const Mote&, const Mote&) = default;
};

/// Returns `base` with the parameters that a `mote` record writes, without lights and motes; the
/// model stays.
Mote withParameters(Mote base, const Record& record);

/// Adds the kind, for the program.
void addMotes();

}  // namespace ispace::motes
