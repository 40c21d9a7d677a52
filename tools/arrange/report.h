// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "arrange/options.h"
#include "place/arrangement.h"

namespace ispace {

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
