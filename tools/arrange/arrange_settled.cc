// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion and checks of options, once all of them are read.
#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrange/arrange_options.h"
#include "arrange/search/search_share.h"
#include "base/error.h"
#include "cli/outputs.h"
#include "cli/storey_operands.h"
#include "report/curve_chart.h"

namespace ispace {

namespace {

[[noreturn]] void refuseWithEffort(const std::string& option) {
    throw UsageError("--effort chooses places and headings itself: leave out " + option);
}

/// \pre it is the word of one of them
template <typename Value, std::size_t kCount>
Value valueOf(const std::string& word, const Value (&values)[kCount]) {
    return *std::find_if(std::begin(values), std::end(values),
                         [&word](Value value) { return nameOf(value) == word; });
}

}  // namespace

void ArrangeCommand::settle() {
    ArrangeOptions& how = options_.how;
    options_.proof = ofOption("--proof", [this] { return proofs_.find(words_.proof); });
    proofs_.check(line_, options_.proof.get());
    std::vector<const char*> single = {"--curve",        "--trace", "--report",
                                       "--export-mps",   "--share", "--checkpoint-interval",
                                       "--alternatives", "--heat"};
    for (const ReportGroup::SideFile& beside : options_.reports->files())
        single.push_back(beside.option);
    if (options_.proof) single.push_back(options_.proof->certificate().name);
    checkBatchOptions(line_, options_.batch, options_.common, options_.operands, single);
    if (!options_.batch.list.empty() && options_.places_file == "-")
        throw UsageError("--places: stdin is not read again for each line of LIST: give a file");
    referToReport(options_.common.output);
    if (!options_.batch.shard || !options_.batch.list.empty())
        (void)outputFormat({}, options_.common.output, {"3dm"});  // rejects another suffix
    if (!words_.mount.empty()) how.mount.on = valueOf(words_.mount, kMounts);
    settleStrategy();
    how.cells = words_.cells.choice();
    if (how.mount.on == MountOn::Frame &&
        (line_.given("--strategy") || line_.given("--effort") || line_.given("--z")))
        throw UsageError(
            "--mount frame: the bars of the frame are the places; leave out "
            "--strategy, --effort and --z");
    if (how.refine && how.mount.on == MountOn::Frame)
        throw UsageError(
            "--refine moves sensors anywhere, and bars of a frame are few: leave out "
            "one of --refine and --mount frame");
    if (how.search.optimizer == Optimizer::Greedy)
        for (const char* option : {"--starts", "--gap"})
            if (line_.given(option))
                throw UsageError(std::string(option) +
                                 " is about --optimize swap or exact: give one of them, too");
    if (how.target && how.budget)
        throw UsageError("--target asks for the least cost: leave out --budget");
    for (const std::string& weight : options_.zones.weights) (void)splitWeight(weight);
    how.indoor_only = words_.judge != "no";
    if (how.refine && (how.beam_step || !how.indoor_only))
        throw UsageError(
            "--refine measures what is in view of the indoor floor: leave out --reso and "
            "--judge no");
    if (options_.proof) options_.proof->take(line_, how);
    settleObjective();
    options_.groups->take(line_, how);
    settleDemand();
    how.wants_curve = !options_.curve_file.empty();
    how.wants_trace = !options_.trace_file.empty();
    how.wants_gains = !options_.heat_file.empty();
    how.seed = options_.common.seed;
    how.search.swap.seed = options_.common.seed;
    settleFiles();
    settleBatch();
}

void ArrangeCommand::settleObjective() {
    if (!options_.objective) return;
    std::vector<std::string_view> others = options_.groups->ofFloor();
    if (const auto of_option = objectives_.asked()) others.push_back(of_option->option());
    options_.objective->settle(line_, others, options_.how);
}

void ArrangeCommand::settleDemand() {
    objectives_.check(line_, options_.objective.get());
    const std::shared_ptr<const ObjectiveGroup> of_option = objectives_.asked();
    if (of_option && options_.objective)
        throw UsageError("--objective " + std::string(options_.objective->word()) + " and " +
                         std::string(of_option->option()) + " both say what counts: leave out one");
    if (of_option) options_.objective = of_option;
    if (!options_.objective || options_.how.objective) return;
    const std::string name = of_option ? std::string(of_option->option())
                                       : "--objective " + std::string(options_.objective->word());
    std::vector<std::string_view> of_floor = {"--zone",  "--weight", "--refine",   "--proof",
                                              "--judge", "--reso",   "--connected"};
    const std::vector<std::string_view> of_groups = options_.groups->ofFloor();
    of_floor.insert(of_floor.end(), of_groups.begin(), of_groups.end());
    const ObjectiveGroup::Counted counted = options_.objective->counted();
    for (const std::string_view option : of_floor)
        if (line_.given(std::string(option)) &&
            std::ranges::find(counted.options, option) == counted.options.end())
            throw UsageError(name + " counts " + std::string(counted.what) + ": leave out " +
                             std::string(option));
}

void ArrangeCommand::checkStrategyOption(const StrategyRow& row,
                                         const StrategyOption& option) const {
    const ArrangeOptions& how = options_.how;
    const std::string name(row.name);
    if (!line_.given(option.name)) {
        if (option.is_needed && how.strategy == row.strategy)
            throw UsageError("--strategy " + name + ": give the " + name + " with " + option.name +
                             " FILE");
        return;
    }
    if (takes(how.strategy, how.mount.on, option)) return;
    if (!words_.effort.empty()) refuseWithEffort(option.name);
    throw UsageError(std::string(option.name) + " is about --strategy " + name + ": " +
                     option.refusal);
}

void ArrangeCommand::settleStrategy() {
    ArrangeOptions& how = options_.how;
    if (!words_.effort.empty()) {
        how.strategy = words_.effort == "low" ? Strategy::Random : Strategy::Grid;
        how.headings = words_.effort == "high" ? 16 : 8;
        for (const char* option : {"--strategy", "--deg"})
            if (line_.given(option)) refuseWithEffort(option);
    } else if (!words_.strategy.empty()) {
        how.strategy = strategyNamed(words_.strategy)->strategy;
    } else {
        for (const StrategyRow& row : strategies())
            for (const StrategyOption& option : row.options)
                if (option.is_needed && line_.given(option.name)) how.strategy = row.strategy;
    }
    for (const StrategyRow& row : strategies())
        for (const StrategyOption& option : row.options) checkStrategyOption(row, option);
    const bool is_thesis = isOfThesis(how.strategy);
    how.search.optimizer = is_thesis ? Optimizer::Greedy : Optimizer::Swap;
    if (!words_.optimize.empty()) how.search.optimizer = valueOf(words_.optimize, kOptimizers);
}

namespace {

/// Lists the files beside the layout, each with its option.
std::vector<std::pair<const char*, const std::string*>> sideFiles(
    const ArrangeToolOptions& options) {
    std::vector<std::pair<const char*, const std::string*>> files = {
        {"--curve", &options.curve_file},
        {"--trace", &options.trace_file},
        {"--report", &options.report_file}};
    for (const ReportGroup::SideFile& beside : options.reports->files())
        files.emplace_back(beside.option, beside.file);
    files.emplace_back("--heat", &options.heat_file);
    files.emplace_back("--export-mps", &options.mps_file);
    if (options.proof)
        files.emplace_back(options.proof->certificate().name, options.proof->certificate().file);
    return files;
}

}  // namespace

void ArrangeCommand::settleFiles() const {
    if (line_.given("--alternatives")) {
        if (options_.how.target)
            throw UsageError("--alternatives: with --target layouts differ in cost, not in value");
        if (isStdout(options_.common.output))
            throw UsageError("--alternatives writes files beside the layout: give -o FILE");
        if (options_.batch.shard)
            throw UsageError("--alternatives needs all of the search: give it to --merge");
    }
    for (const auto& [name, file] : sideFiles(options_))
        if (isStdout(*file))
            throw UsageError(std::string(name) + ": stdout is for the layout; give it a file");
    if (options_.batch.list.empty()) mustBeOneFile("--output", options_.common.output);
    for (const auto& [name, file] : sideFiles(options_))
        if (std::string_view(name) != "--heat") mustBeOneFile(name, *file);
    if (!options_.curve_file.empty()) (void)outputFormat({}, options_.curve_file, curveFormats());
    options_.reports->take(options_.report_file);
    if (!options_.heat_file.empty())
        (void)outputFormat({}, options_.heat_file, {"png", "svg", "pdf"});
}

void ArrangeCommand::settleBatch() {
    if (!options_.batch.list.empty()) return;  // its shards share the lines
    const ArrangeOptions& how = options_.how;
    SearchShare& share = options_.how.search.share;
    share.own = options_.batch.shard;
    const Optimizer optimizer = how.search.optimizer;
    share.what = how.prover                                     ? Shared::Poses
                 : how.target || optimizer == Optimizer::Greedy ? Shared::Candidates
                 : optimizer == Optimizer::Swap                 ? Shared::Starts
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
    if ((how.prover != nullptr) != (share.what == Shared::Poses))
        throw UsageError(how.prover ? "--share " + what + ": shards of --proof poses share poses"
                                    : "--share poses is about --proof poses: give it, too");
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
    if (!isOfProof(share.what) && options_.time_limit)
        throw UsageError(
            "--time-limit would leave gaps in what shards share; only parts of a "
            "proof (--optimize exact, --proof poses) are of use when cut short");
    for (const auto& [name, file] : sideFiles(options_))
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
    options_.report_file = merge.report_file;
    options_.reports = merge.reports;
    options_.heat_file = merge.heat_file;
    options_.how.wants_gains = merge.how.wants_gains;
    options_.batch = BatchOptions();
    options_.time_limit.reset();
    options_.how.wants_curve = merge.how.wants_curve;
    options_.how.alternatives = merge.how.alternatives;
    options_.how.wants_trace = merge.how.wants_trace;
    options_.how.max_bytes = merge.how.max_bytes;
    options_.how.search.share.what = what;
    options_.how.search.share.joined = shards;
}

}  // namespace ispace
