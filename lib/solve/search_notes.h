// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include "base/progress.h"
#include "solve/search.h"

namespace ispace {

/// Tells value and bound: "best 85.7 %, at most 85.9 %", of all there is.
void noteProgress(const Problem& problem, std::uint64_t value, std::uint64_t bound,
                  Progress& progress);
inline void noteProgress(const Problem& problem, const SearchResult& result, Progress& progress) {
    noteProgress(problem, result.best.value, result.bound, progress);
}

}  // namespace ispace
