// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only: sensors that add nothing to what the others are worth.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cover/coverage.h"
#include "geom/point.h"
#include "solve/problem.h"

namespace ispace {

/// Choices without which, all of them together, the rest is worth as much and hangs together as
/// well; ascending. Later ones rather than earlier ones. O(choices * cells / 64 + runs)
std::vector<std::size_t> idleChoices(const Problem& problem, std::span<const Choice> chosen);

/// The same among the sensors of a measured scene that stand behind those of `standing`: their ids.
/// `unit`: the share of what is no receiver.
std::vector<std::string> idleSensors(const Problem& problem, const Coverage& coverage,
                                     const Scene& standing, int unit);

/// Moves idle choices apart: each in turn to the site that is farthest from all other sensors, of
/// those that see anything that counts, with the heading in which most is seen that few others see.
/// What hangs together stays so. `standing`: where the sensors are that stand already.
void spreadIdle(const Problem& problem, std::span<const Point3> standing,
                const std::function<Point3(const Choice&)>& position_of,
                std::vector<Choice>& chosen);

}  // namespace ispace
