// SPDX-License-Identifier: GPL-3.0-or-later
// Masks for the filters of Nav2's costmaps.
#include <algorithm>
#include <cmath>

#include "cover/coverage_formats.h"
#include "raster/nav2_mask.h"

namespace ispace {

namespace {

constexpr double kMostValue = 100;

CoverageFiles filesOf(const Nav2Mask& mask, const std::string& picture_name) {
    Nav2MaskFiles files = nav2MaskFiles(mask, picture_name);
    return {std::move(files.map), std::move(files.picture)};
}

}  // namespace

CoverageFiles coverageSpeedMask(const Coverage& coverage, double cell,
                                std::span<const double> speeds, const std::string& picture_name) {
    const Target& target = coverage.target;
    Nav2Mask mask{kSpeedFilter, target.grid, cell, {}};
    mask.values.resize(target.grid.size());
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    target.free.forEach([&](std::size_t at) {
        const double speed = speeds[std::min<std::size_t>(times[at], speeds.size() - 1)];
        mask.values[at] = static_cast<std::uint8_t>(std::lround(kMostValue * (1 - speed)));
    });
    return filesOf(mask, picture_name);
}

CoverageFiles coverageKeepoutMask(const Coverage& coverage, double cell,
                                  const std::string& picture_name) {
    const Target& target = coverage.target;
    Nav2Mask mask{kKeepoutFilter, target.grid, cell, {}};
    mask.values.resize(target.grid.size());
    const CellSet covered = coveredCells(coverage);
    target.free.forEach([&](std::size_t at) {
        if (!covered.test(at)) mask.values[at] = static_cast<std::uint8_t>(kMostValue);
    });
    return filesOf(mask, picture_name);
}

}  // namespace ispace
