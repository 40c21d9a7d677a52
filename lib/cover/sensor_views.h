// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/cover only.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cover/coverage.h"

namespace ispace {

/// What every laser, ranger and receiver of a scene sees, in this order; shared out over all cores.
std::vector<SensorView> viewsOf(const Scene& scene, Worlds& worlds, const Grid& grid,
                                const CoverageOptions& options);

/// The region that at least kMinReceivers of these hear; nothing if it is not known.
std::optional<std::vector<Curve>> regionHeardByEnough(std::span<const SensorView* const> receivers);

/// The sets that count, of these views: each laser and ranger, then all receivers together.
std::vector<SeenSet> setsOf(const std::vector<SensorView>& views, const Grid& grid);

}  // namespace ispace
