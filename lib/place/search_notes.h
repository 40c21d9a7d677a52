// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only.
#pragma once

#include "base/progress.h"
#include "place/search.h"

namespace ispace {

/// Tells value and bound: "best 85.7 %, at most 85.9 %", of all there is.
void noteProgress(const Problem& problem, const SearchResult& result, Progress& progress);

}  // namespace ispace
