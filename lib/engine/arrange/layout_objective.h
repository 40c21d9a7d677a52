// SPDX-License-Identifier: GPL-3.0-or-later
// Objectives with a search of their own. Extensions make them, see cli/objective_extension.h; those
// that count elements instead of floor are a Demand.
//
// The candidates, their cells, the way a layout is written and its exact coverage stay those of
// arrange(); an objective brings the value of all sensors together, the search for the highest one,
// and a bound. Values are whole numbers, so that equal layouts compare equal and any number of
// threads finds the same one.
//
//     options.objective = std::make_shared<const MyObjective>(zone);   // a LayoutObjective
//     const Arrangement found = arrange(site, groups, options, progress);
//     std::cout << options.objective->finding(found) << '\n';          // the value, and the bound
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "arrange/search/search.h"
#include "base/error.h"

namespace ispace {

class CoverageModel;
struct Arrangement;
struct CountedView;

/// The search of an objective in one model, which outlives it.
class ObjectiveSearch {
  public:
    ObjectiveSearch() = default;
    ObjectiveSearch(const ObjectiveSearch&) = delete;
    ObjectiveSearch& operator=(const ObjectiveSearch&) = delete;
    virtual ~ObjectiveSearch() = default;
    /// Returns the value that is a share of 1.
    [[nodiscard]] virtual std::uint64_t total() const = 0;
    /// Finds the layout with the highest value, and a bound. \pre the model has its candidates
    [[nodiscard]] virtual SearchResult find(Progress& progress) const = 0;
    /// Stores the value of the placed sensors, as find() counts, and figures in the result.
    /// \param views of these sensors on the cells of the search
    virtual void report(std::span<const CountedView> views, Arrangement& result) const = 0;
};

/// What arrange() maximises instead of the weight of covered cells, over the same candidates and
/// cells: a function of all sensors together. Constant and thread-safe while arrange() runs.
class LayoutObjective {
  public:
    LayoutObjective() = default;
    LayoutObjective(const LayoutObjective&) = delete;
    LayoutObjective& operator=(const LayoutObjective&) = delete;
    virtual ~LayoutObjective() = default;
    /// Returns its word in results ("path").
    [[nodiscard]] virtual std::string_view name() const = 0;
    /// Returns true if views into other rooms count.
    [[nodiscard]] virtual bool joinsRooms() const = 0;
    /// Begins a search. \param model has no candidates yet \throws UnmetError, UsageError
    [[nodiscard]] virtual std::unique_ptr<ObjectiveSearch> searchIn(
        const CoverageModel& model) const = 0;
    /// Tells the value and the bound of a layout in its own units, as a sentence without full stop.
    [[nodiscard]] virtual std::string finding(const Arrangement& found) const = 0;
};

}  // namespace ispace
