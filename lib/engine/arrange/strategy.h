// SPDX-License-Identifier: GPL-3.0-or-later
// The table of strategies: name, options, defaults and proposal of each.
//
// The command line, its help and its refusals come from these rows: a strategy is a function and a
// row. Proposals are pure functions; sites are validated later (placement_rules.h).
//
//     const StrategyRow* const row = strategyNamed("wall");
//     const std::vector<Site> sites = row->propose({environment, 0.15, 4, options});
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/placement_rules.h"
#include "env/environment.h"

namespace ispace {

/// A command-line option of some strategies: a count, a length in metres, a density, or the file
/// that a list of sites is read from.
struct StrategyOption {
    using Field =
        std::variant<int ArrangeOptions::*, std::optional<int> ArrangeOptions::*,
                     double ArrangeOptions::*, std::optional<double> ArrangeOptions::*,
                     CandidateDensity ArrangeOptions::*, std::vector<Site> ArrangeOptions::*>;
    const char* name;
    Field field;
    double lowest = 0, highest = 0;  ///< of a density: of its steps
    const char* help;
    std::optional<MountOn> or_mount = {};    ///< also an option of this mount
    bool is_needed = false;                  ///< required by its strategy, which it implies
    const char* refusal = "give that, too";  ///< advice after an option that the strategy rejects
};

/// Input of a strategy's proposal.
struct ProposalRequest {
    const Environment& environment;
    double height;     ///< of the sensor
    double max_range;  ///< of the sensor
    const ArrangeOptions& options;
};

/// A strategy that proposes sites. To add one, write its function and a row.
struct StrategyRow {
    Strategy strategy;
    std::string_view name;  ///< on the command line and in results
    std::string_view help;
    bool is_of_thesis;                        ///< defaults: its grid of cells and greedy search
    int headings;                             ///< default number per site; 0: of options.density
    std::span<const StrategyOption> options;  ///< rejected by strategies that do not list them
    /// Returns sites, valid or not. Strategy::Random returns an empty list: its sites depend on the
    /// candidates built before, see CandidatePool.
    std::vector<Site> (*propose)(const ProposalRequest& request);
    std::string_view hint = {};  ///< advice if no proposed site is valid
};

/// Returns all strategies, the default first.
std::span<const StrategyRow> strategies();
const StrategyRow& rowOf(Strategy strategy);
/// Finds the row with this name; null if there is no such row.
const StrategyRow* strategyNamed(std::string_view name);
/// Returns true if it is an option of this strategy or mount.
bool takes(Strategy strategy, std::optional<MountOn> mount, const StrategyOption& option);

/// Returns the headings to try at each site, if the strategy does not choose them itself.
std::vector<Angle> headingsPerPlace(const ArrangeOptions& options);

}  // namespace ispace
