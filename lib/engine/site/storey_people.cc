// SPDX-License-Identifier: GPL-3.0-or-later
// People by storeys: the largest remainders of shares of the free floor (Hare's quota), the first
// storey among equals; so numbers are whole and add up.
#include "site/storey_people.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "env/level.h"
#include "geom/arrangement.h"
#include "site/coupling.h"

namespace ispace {

std::uint64_t seedOfStorey(std::uint64_t seed, std::size_t storey) {
    constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15;  // of the golden ratio: no pattern
    return seed + kGolden * storey;
}

std::vector<std::size_t> spreadOverStoreys(const SiteCoverage& coverage, std::size_t people) {
    const std::size_t count = coverage.storeys.size();
    std::vector<std::size_t> spread(count);
    if (count == 0) return spread;
    if (!(coverage.free_area > 0)) {
        spread[0] = people;
        return spread;
    }
    std::vector<std::pair<double, std::size_t>> rests;
    std::size_t placed = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double share =
            static_cast<double>(people) * coverage.storeys[i].report.free_area / coverage.free_area;
        spread[i] = static_cast<std::size_t>(share);
        placed += spread[i];
        rests.emplace_back(std::floor(share) - share, i);
    }
    std::sort(rests.begin(), rests.end());
    for (std::size_t k = 0; placed < people; ++k, ++placed) ++spread[rests[k % count].second];
    return spread;
}

std::vector<std::size_t> spreadOverStoreys(const SiteScene& building, double plane,
                                           std::size_t people) {
    SiteCoverage floors;
    for (const auto& floor : Coupling(building).floors(plane)) {
        CoverageReport& report = floors.storeys.emplace_back().report;
        report.free_area = totalArea(floor->environment.level(kScanHeight)->freeFloor());
        floors.free_area += report.free_area;
    }
    return spreadOverStoreys(floors, people);
}

}  // namespace ispace
