// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/strategy.h"
#include "cli/batch.h"
#include "cli/command_line.h"
#include "cli/common_options.h"

namespace ispace {

/// What names zones, which only the environment knows.
struct ZoneWords {
    std::vector<std::string> targets, keep_out, keep_in;
    std::vector<std::string> weights;  ///< ZONE=W
};

struct ArrangeToolOptions {
    CommonOptions common;
    std::vector<std::string> operands;
    std::vector<std::string> sensors;  ///< MODEL[,KEY=VALUE…][:COUNT]
    std::vector<std::string> fixed;    ///< globs of ids; none: all that is placed stays
    ArrangeOptions how;
    ZoneWords zones;
    std::string places_file;
    std::string trace_file, curve_file, mps_file;
    std::optional<double> time_limit;  ///< seconds
    BatchOptions batch;
    double checkpoint_interval = 5;  ///< seconds, of --resume
    SceneRules rules;
};

class ArrangeCommand : public ToolCommand<ArrangeToolOptions> {
  public:
    /// Opens no file. \throws UsageError, TextRequested
    ArrangeCommand(int argc, const char* const* argv);

    /// Makes the command of a shard that of the merge of so many, which may have other outputs,
    /// threads and talk.
    void becomeMerge(const ArrangeToolOptions& merge, Shared what, int shards);

  private:
    void addPlaceOptions();
    void addStrategyOption(const StrategyRow& row, const StrategyOption& option);
    void addMountOptions();
    void addGoalOptions();
    void addSearchOptions();
    void addFileOptions();
    void addShareOptions();
    void settle();
    void settleStrategy();
    void checkStrategyOption(const StrategyRow& row, const StrategyOption& option) const;
    void settleFiles() const;
    void settleBatch();

    /// Words of options that become something else once all are known.
    struct Words {
        std::string effort, strategy, optimize, mount, judge, share;
        CellWords cells;
    };
    Words words_;
};

/// What `--weight ZONE=W` says. \throws UsageError
std::pair<std::string, double> splitWeight(const std::string& text);

}  // namespace ispace
