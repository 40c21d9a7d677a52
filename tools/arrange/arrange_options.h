// SPDX-License-Identifier: GPL-3.0-or-later
// The command line of arrange: the core's options, and those of its extensions.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/strategy.h"
#include "cli/arrange_group.h"
#include "cli/batch.h"
#include "cli/command_line.h"
#include "cli/common_options.h"
#include "cli/objective_extension.h"
#include "cli/option_group.h"
#include "cli/proof_extension.h"
#include "cli/report_group.h"

namespace ispace {

/// Options that name zones, which are looked up in the environment.
struct ZoneWords {
    std::vector<std::string> targets, keep_out, keep_in;
    std::vector<std::string> weights;  ///< ZONE=W
};

struct ArrangeToolOptions {
    CommonOptions common;
    std::vector<std::string> operands;
    std::vector<std::string> sensors;  ///< MODEL[,KEY=VALUE…][:COUNT]
    std::vector<std::string> fixed;    ///< globs of ids; empty: all placed sensors stay
    ArrangeOptions how;
    ZoneWords zones;
    std::shared_ptr<const ObjectiveGroup> objective;  ///< of an extension; null: none
    std::shared_ptr<const ProofGroup> proof;          ///< likewise
    std::shared_ptr<ArrangeExtensions> groups;        ///< of extensions
    std::string places_file;
    std::string trace_file, curve_file, mps_file, report_file, heat_file;
    std::shared_ptr<ReportExtensions> reports;  ///< of extensions, for people
    ExtensionTask task;                         ///< instead of a layout; empty: none
    std::optional<double> time_limit;           ///< seconds
    BatchOptions batch;
    double checkpoint_interval = 5;  ///< seconds, of --resume
    SceneRules rules;

    /// Returns the file of the certificate of a proof; "": none is wanted.
    [[nodiscard]] std::string certificateFile() const {
        return proof ? *proof->certificate().file : "";
    }
};

class ArrangeCommand : public ToolCommand<ArrangeToolOptions> {
  public:
    /// Opens no file. \throws UsageError, TextRequested
    ArrangeCommand(int argc, const char* const* argv);

    /// Converts the command of a shard to that of the merge of that number of shards, which may
    /// have other outputs, threads and verbosity.
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
    void settleObjective();
    void settleDemand();
    void checkStrategyOption(const StrategyRow& row, const StrategyOption& option) const;
    void settleFiles() const;
    void settleBatch();

    /// Words of options that are converted once all options are known.
    struct Words {
        std::string effort, strategy, optimize, mount, judge, share, proof;
        CellWords cells;
    };
    Words words_;
    ObjectiveExtensions objectives_;
    ProofExtensions proofs_;
};

}  // namespace ispace
