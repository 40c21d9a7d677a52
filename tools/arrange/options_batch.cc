// SPDX-License-Identifier: GPL-3.0-or-later
// --shard, --merge, --resume and what goes with them.
#include <algorithm>
#include <iterator>
#include <utility>

#include "arrange/options.h"
#include "base/error.h"
#include "solve/search_share.h"

namespace ispace {

void ArrangeCommand::addShareOptions() {
    addBatchOptions(line_, options_.batch, "the slowest part of its optimizer");
    std::vector<std::string> words;
    for (const Shared what : kShared) words.emplace_back(nameOf(what));
    line_.choice("--share", words_.share, words,
                 "work that shards divide: views of the candidates (default of greedy and with "
                 "--target), random starts (of swap), or subtrees of the proof (of exact)",
                 Enters::Nothing);
    constexpr double kLongest = 86400;
    line_.duration("--checkpoint-interval", options_.checkpoint_interval, 0, kLongest,
                   "with --resume: time between two states of a proof that are kept",
                   Enters::Nothing);
}

void ArrangeCommand::settleBatch() {
    const ArrangeOptions& how = options_.how;
    SearchShare& share = options_.how.search.share;
    share.own = options_.batch.shard;
    const Optimizer optimizer = how.search.optimizer;
    share.what = how.target || optimizer == Optimizer::Greedy ? Shared::Candidates
                 : optimizer == Optimizer::Swap               ? Shared::Starts
                                                              : Shared::Tree;
    if (!words_.share.empty())
        share.what = *std::find_if(std::begin(kShared), std::end(kShared),
                                   [&](Shared what) { return nameOf(what) == words_.share; });
    if (line_.given("--checkpoint-interval") && !options_.batch.resume)
        throw UsageError("--checkpoint-interval is about --resume: give both");
    if (!options_.batch.shard) {
        if (line_.given("--share")) throw UsageError("--share is about --shard: give both");
        return;
    }
    const std::string what(nameOf(share.what));
    if (how.target && share.what != Shared::Candidates)
        throw UsageError("--share " + what +
                         ": with --target there are many searches; shards can share candidates");
    if (share.what == Shared::Starts && optimizer == Optimizer::Greedy)
        throw UsageError("--share starts: --optimize greedy has none");
    if (share.what == Shared::Tree && optimizer != Optimizer::Exact)
        throw UsageError("--share tree: only --optimize exact has one");
    if (share.what == Shared::Candidates && how.strategy == Strategy::Random &&
        how.mount.on != MountOn::Frame)
        throw UsageError(
            "--shard: --strategy random draws places about the best of those before, so its "
            "candidates cannot be shared; share the starts of --optimize swap, or run it with "
            "several --seed and keep the best");
    if (share.what != Shared::Tree && options_.time_limit)
        throw UsageError(
            "--time-limit would leave gaps in what shards share; only parts of a "
            "proof (--optimize exact) are of use when cut short");
    for (const auto& [name, file] : {std::pair("--curve", &options_.curve_file),
                                     {"--trace", &options_.trace_file},
                                     {"--export-mps", &options_.mps_file}})
        if (!file->empty())
            throw UsageError(std::string(name) + " needs all of the search: give it to --merge");
}

void ArrangeCommand::becomeMerge(const ArrangeToolOptions& merge, Shared what, int shards) {
    const std::uint64_t seed = options_.common.seed;
    options_.common = merge.common;
    options_.common.seed = seed;
    options_.rules.includes = merge.rules.includes;
    options_.rules.max_work = merge.rules.max_work;
    options_.trace_file = merge.trace_file;
    options_.curve_file = merge.curve_file;
    options_.mps_file = merge.mps_file;
    options_.batch = BatchOptions();
    options_.time_limit.reset();
    options_.how.wants_curve = merge.how.wants_curve;
    options_.how.wants_trace = merge.how.wants_trace;
    options_.how.max_bytes = merge.how.max_bytes;
    options_.how.search.share.what = what;
    options_.how.search.share.joined = shards;
}

}  // namespace ispace
