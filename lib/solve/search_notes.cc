// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/search_notes.h"

#include <algorithm>
#include <cstdio>

namespace ispace {

void noteProgress(const Problem& problem, std::uint64_t value, std::uint64_t bound,
                  Progress& progress) {
    const double total = static_cast<double>(std::max<std::uint64_t>(problem.totalWeight(), 1));
    char text[80];
    const int length = std::snprintf(text, sizeof text, "best %.1f %%, at most %.1f %%",
                                     100 * static_cast<double>(value) / total,
                                     100 * static_cast<double>(bound) / total);
    progress.note({text, static_cast<std::size_t>(length)});
}

}  // namespace ispace
