// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only.
#pragma once

#include <cstdint>

#include "cover/coverage.h"
#include "solve/problem.h"

namespace ispace {

/// True for a sensor of `standing` in a measured scene that has those first.
bool stands(const SensorView& view, const Scene& standing);

/// What a measured scene is worth to a problem whose cells it has: as valueOf() of its sensors.
/// `unit`: the share of what is no receiver.
std::uint64_t valueOf(const Problem& problem, const Coverage& coverage, int unit);

/// True if the views of all sensors hang together, those of `standing` being one part, see
/// Problem::is_connected. \pre the scene measured has the sensors of `standing` first
/// O(sensors^2 * cells / 64)
bool isConnected(const Problem& problem, const Coverage& coverage, const Scene& standing);

}  // namespace ispace
