// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange: a search of rooms that do not see each other.
#pragma once

#include <vector>

#include "arrange/coverage_model.h"
#include "arrange/search/search.h"
#include "base/error.h"

namespace ispace {

/// Returns true if searchParts() finds the best numbers of sensors in each part: there are several
/// parts and one kind of sensors, and only their number limits the choice.
bool isSearchedByParts(const CoverageModel& model);

/// Searches each part of a site with 1, 2, ... sensors, equal parts once, and shares numbers out:
/// in [n - 1] the result for n sensors. The bound holds for every split. Weaker nowhere than a
/// search of all rooms together, and faster: parts are small. The searches do not depend on each
/// other, so that shards can divide each of them. Connected coverage is that of each
/// part.
/// \pre isSearchedByParts()
std::vector<SearchResult> searchParts(const CoverageModel& model, Progress& progress);

}  // namespace ispace
