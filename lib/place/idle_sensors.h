// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only: sensors that add nothing to the value of the others.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "geom/point.h"
#include "solve/problem.h"

namespace ispace {

class SceneProblem;
struct CountedView;

/// Choices that can all be left out without loss of value or of connection, ascending; later ones
/// are preferred. O(choices * cells / 64 + runs)
std::vector<std::size_t> idleChoices(const Problem& problem, std::span<const Choice> chosen);

/// The same for the views of placed sensors, by their indices.
std::vector<std::size_t> idleViews(const SceneProblem& model, std::span<const CountedView> views);

/// Spreads idle choices: moves each in turn to the site farthest from all other sensors, among
/// those that see anything of weight, with the heading that sees most of what few others see.
/// Connected coverage stays connected. `standing`: positions of sensors that stand already.
void spreadIdle(const Problem& problem, std::span<const Point3> standing,
                const std::function<Point3(const Choice&)>& position_of,
                std::vector<Choice>& chosen);

}  // namespace ispace
