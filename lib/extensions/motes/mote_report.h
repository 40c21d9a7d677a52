// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a mote: the light on it, and the neighbours in its radio's reach. Deterministic and
// thread-safe.
#pragma once

#include <string>
#include <vector>

#include "extensions/motes/mote.h"
#include "sense/added_reading.h"

namespace ispace {

struct ReadingKind;

}  // namespace ispace

namespace ispace::motes {

/// A mote that another hears.
struct Neighbour {
    std::string mote;   ///< id, as the report's: in a building with its storey
    double margin = 0;  ///< dB above the weakest signal that is heard
};

/// A reading of a mote.
struct MoteReport {
    double lux = 0;                     ///< as a `lux` at its pose reports
    std::vector<Neighbour> neighbours;  ///< in the order of the scene, the strongest if it hears
                                        ///< more than Mote::kMostNeighbours

    static const ReadingKind kKind;
};

/// Measures the light on a mote and lists the motes that it hears: those whose signal, in free
/// space and less `loss` for each wall between (see wallsBetween(), sense/walls_between.h), is as
/// strong as over `radio` metres. Movers weaken no signal. A mote on a robot or a person sends from
/// the axis of the mover's body, at the height of its record. Near motes are tried first, and
/// far ones only while the table has space for weaker signals.
MoteReport readingOf(const Mote& mote, const Moment& now);

}  // namespace ispace::motes
