// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange: the table of objectives.
//
// Objectives combine: weights of cells are multiplied, limits of views are applied one after
// another, and each row that is asked for reports its figure. The search itself is that of the
// first row with `find`.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/search/search.h"
#include "base/error.h"
#include "coverage/target.h"
#include "scene/scene.h"

namespace ispace {

struct Arrangement;
struct CountedView;
class CoverageModel;

/// A quantity that arrange optimises. To add one, write its functions and a row.
struct Objective {
    std::string_view name;
    bool (*is_asked)(const ArrangeOptions&);
    /// Computes a factor of each cell's weight, 0 where the cell does not count; null: 1.
    std::vector<double> (*weights)(const Target&, const ArrangeOptions&) = nullptr;
    /// Limits the region that a sensor covers, before any view is computed; null: no limit.
    void (*limit)(SensorModel&, const ArrangeOptions&) = nullptr;
    /// Stores the objective's figures in the result.
    /// \param views of the placed sensors on the search's grid; null: the coverage already is the
    ///        figure
    void (*report)(const CoverageModel&, std::span<const CountedView> views,
                   Arrangement&) = nullptr;
};

/// Returns the rows: coverage, weights, density, redundancy, rule, demand, cases, cost.
std::span<const Objective> objectives();

/// Computes the product of the weights of all requested objectives. O(cells * zones)
std::vector<double> cellWeights(const Target& target, const ArrangeOptions& options);
/// Applies the limits of all requested objectives to the sensor: it covers less, and sees as much.
void limitCovered(SensorModel& model, const ArrangeOptions& options);

}  // namespace ispace
