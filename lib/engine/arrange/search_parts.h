// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange: a search of rooms that do not see each other.
//
// Sensors of one part add no value in another, so the best layout of n sensors is the best split of
// n over parts that are each searched alone; shareOut() finds it by dynamic programming. Of twelve
// equal storeys one is searched.
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
/// other, so that shards can divide each of them. Connected coverage is that of each part. Once
/// progress says stop, further sensors of a part are arbitrary, with the part's total as their
/// bound. Runs search() for each different part and each number up to that of the kind.
/// \pre isSearchedByParts()
std::vector<SearchResult> searchParts(const CoverageModel& model, Progress& progress);

}  // namespace ispace
