// SPDX-License-Identifier: GPL-3.0-or-later
// Inputs of arrange, its warnings and its report.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/arrange_options.h"
#include "cli/operands.h"
#include "cli/site_operands.h"

namespace ispace {

/// Inputs of the search.
struct ArrangeWork {
    SiteInput input;
    std::vector<SensorGroup> groups;
    ArrangeOptions how;
    std::vector<RoomGoals> goals;  ///< by room
    std::shared_ptr<const ArrangeSite> site;
    std::vector<std::string> files;  ///< for -MD
    std::string places;              ///< the text of --places

    /// Searches. \throws as arrange()
    [[nodiscard]] Arrangement run(Progress& progress, std::ostream* mps = nullptr) const;
    /// Returns the elements of the demand that a layout serves, by room. \pre there is a demand
    [[nodiscard]] std::vector<ServedDemand> served(const Arrangement& arrangement) const;
    /// Returns Demand::content() of all rooms; "" without a demand.
    [[nodiscard]] std::string contentOfDemand() const;
};

/// Reads room, layout, sensors, zones and sites. \throws UsageError without a sensor to place, and
/// as the readers
ArrangeWork readWork(const ArrangeToolOptions& options);

/// Warns, before the search, of heights and strategies that cannot do well.
void warnOfSearch(const ArrangeToolOptions& options, const ArrangeWork& work);

/// Warns of sensors that cover zero cells, that are redundant, or that share a site.
/// \throws UnmetError if a goal is not reached or a sensor has no site
void checkGoals(const ArrangeToolOptions& options, const ArrangeWork& work,
                const Arrangement& arrangement);

/// Returns the result, its gap, and the objective of the bound: one or more lines for stderr.
std::string reportText(const ArrangeWork& work, const Arrangement& arrangement);

/// Returns the name of one of several outputs: "best-2.3dm".
std::string numberedFile(const std::string& output, std::size_t number);
/// Returns a line for each alternative, with its value and gap; "" without.
std::string alternativesText(const std::string& output, const Arrangement& arrangement);
/// Returns the gap between candidate value and bound as a share of the bound; 0 for a layout that
/// is proven optimal.
double gapOf(const Arrangement& arrangement);

/// Returns the reason why a target was not reached, as a sentence without full stop.
std::string shortfallText(const ArrangeOptions& how, const Arrangement& arrangement);

/// Tells that a target reached by cells is missed by exact area, as a sentence without full stop;
/// "" if it is not.
std::string inexactText(const ArrangeOptions& how, const Arrangement& arrangement);

/// Lists redundant sensors as a sentence without full stop; "" without any.
std::string idleText(const Arrangement& arrangement);
/// Lists sensors that share a site, where only one can be mounted; "" without any. The search
/// allows it: its bound holds all the more for distinct sites.
std::string doubledText(const Arrangement& arrangement);

}  // namespace ispace
