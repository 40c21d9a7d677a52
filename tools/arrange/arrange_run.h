// SPDX-License-Identifier: GPL-3.0-or-later
// What a user of arrange may not have meant, and what of it was not reached.
#pragma once

#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/arrange_options.h"
#include "cli/operands.h"

namespace ispace {

/// What is read before the search.
struct ArrangeWork {
    SceneInput input;
    std::vector<SensorGroup> groups;
    ArrangeOptions how;
    std::vector<std::string> files;  ///< for -MD
    std::string places;              ///< the text of --places
};

/// Reads room, layout, sensors, zones and places. \throws UsageError if nothing is to be placed,
/// and as the readers
ArrangeWork readWork(const ArrangeToolOptions& options);

/// Warns, before the search, of heights and strategies that cannot do well.
void warnOfSearch(const ArrangeToolOptions& options, const ArrangeWork& work);

/// Warns of sensors that see nothing, that are too many, or that stand in one place.
/// \throws UnmetError if a goal is not reached or a sensor has no place
void checkGoals(const ArrangeToolOptions& options, const ArrangeWork& work,
                const Arrangement& arrangement);

/// What came out, how near it is to the bound, and what the bound is over: a line or some, for
/// stderr.
std::string reportText(const ArrangeOptions& how, const Arrangement& arrangement);

/// Why a target was not reached, as a sentence without end.
std::string shortfallText(const ArrangeOptions& how, const Arrangement& arrangement);

/// The sensors that could as well be left out, as a sentence without end; "" if there are none.
std::string idleText(const Arrangement& arrangement);
/// Which sensors are at one place, where only one can be mounted; "" if none are. The search allows
/// it: what it proves then holds all the more for places of their own.
std::string doubledText(const Arrangement& arrangement);

}  // namespace ispace
