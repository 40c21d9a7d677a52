// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/arrange only.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "arrange/arrange.h"
#include "coverage/target.h"
#include "scene/scene.h"

namespace ispace {

struct Arrangement;
struct CountedView;
class MeasuredScene;

/// One thing that arrange optimises. To add one, write its functions and a row.
struct Objective {
    std::string_view name, option;
    bool (*is_asked)(const ArrangeOptions&);
    /// A factor of each cell's weight, 0 where the cell does not count; null: 1.
    std::vector<double> (*weights)(const Target&, const ArrangeOptions&) = nullptr;
    /// Limits what a sensor covers, before anything is measured; null: no limit.
    void (*limit)(SensorModel&, const ArrangeOptions&) = nullptr;
    /// Sets what the result says of it. \param views of the placed sensors on the search's grid;
    /// null: the coverage of the result says it
    void (*report)(const MeasuredScene&, std::span<const CountedView> views,
                   Arrangement&) = nullptr;
};

/// Coverage, weights, density, redundancy, cost.
std::span<const Objective> objectives();

/// The product of the weights of all objectives that are asked for. O(cells * zones)
std::vector<double> cellWeights(const Target& target, const ArrangeOptions& options);
/// The sensor as all objectives that are asked for limit it.
void limitCovered(SensorModel& model, const ArrangeOptions& options);

}  // namespace ispace
