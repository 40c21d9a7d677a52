// SPDX-License-Identifier: GPL-3.0-or-later
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
    bool is_needed = false;                  ///< by its strategy, which it implies
    const char* refusal = "give that, too";  ///< what to do where the strategy takes it not
};

/// What a strategy proposes places for.
struct ProposalRequest {
    const Environment& environment;
    double height;     ///< of the sensor
    double max_range;  ///< of the sensor
    const ArrangeOptions& options;
};

/// A strategy for proposing places. To add one, write its function and a row.
struct StrategyRow {
    Strategy strategy;
    std::string_view name;  ///< on the command line and in results
    std::string_view help;
    bool is_of_thesis;                        ///< defaults: its grid of cells and greedy search
    int headings;                             ///< default number per place; 0: of options.density
    std::span<const StrategyOption> options;  ///< refused where a strategy does not list them
    /// Proposes sites, valid or not. Strategy::Random proposes none: its places depend on the
    /// candidates made before, see CandidatePool.
    std::vector<Site> (*propose)(const ProposalRequest& request);
    std::string_view hint = {};  ///< what may help if no proposed place is valid
};

/// All strategies, the default first.
std::span<const StrategyRow> strategies();
const StrategyRow& rowOf(Strategy strategy);
/// The row with this name; null if there is none.
const StrategyRow* strategyNamed(std::string_view name);
/// True if it is an option of this strategy or mount.
bool takes(Strategy strategy, std::optional<MountOn> mount, const StrategyOption& option);

/// The headings to try at each place, if the strategy does not choose them itself.
std::vector<Angle> headingsPerPlace(const ArrangeOptions& options);

}  // namespace ispace
