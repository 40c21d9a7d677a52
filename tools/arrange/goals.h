// SPDX-License-Identifier: GPL-3.0-or-later
// What a user of arrange may not have meant, and what of it was not reached.
#pragma once

#include "arrange/work.h"

namespace ispace {

/// Warns, before the search, of heights and strategies that cannot do well.
void warnOfSearch(const ArrangeToolOptions& options, const ArrangeWork& work);

/// Warns of sensors that see nothing, that are too many, or that stand in one place.
/// \throws UnmetError if a goal is not reached or a sensor has no place
void checkGoals(const ArrangeToolOptions& options, const ArrangeWork& work,
                const Arrangement& arrangement);

}  // namespace ispace
