// SPDX-License-Identifier: GPL-3.0-or-later
// arrange: places sensors in a room and writes the layout.
#include <algorithm>
#include <iostream>

#include "arrange/batch.h"
#include "arrange/options.h"
#include "arrange/report.h"
#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/run_tool.h"
#include "layout/scene.h"
#include "layout/schemas.h"
#include "place/arrangement.h"
#include "place/curve.h"
#include "record/text.h"
#include "sense/ultrasound.h"
#include "solve/problem.h"

namespace {

using namespace ispace;

/// What is read before the search.
struct Work {
    SceneInput input;
    std::vector<SensorGroup> groups;
    ArrangeOptions how;
    std::vector<std::string> files;  ///< for -MD
    std::string places;              ///< the text of --places
};

/// True if what a signal leaves of the run is of no use, or is kept elsewhere.
bool endsWithoutProduct(const ArrangeToolOptions& options) {
    return options.batch.resume ||
           (options.batch.shard && options.how.search.share.what != Shared::Tree);
}

NamedZone zoneOf(const ArrangeToolOptions& options, const std::string& text,
                 const Environment& environment) {
    NamedZone zone = readZone(text, environment);
    if (zone.is_center_outside)
        warn(options.common, "arrange",
             "the centre of gravity of " + zone.name + " lies outside of it; a point inside is (" +
                 formatFixed(zone.inside.x, 2) + ", " + formatFixed(zone.inside.y, 2) +
                 "): is it the zone that is meant?");
    return zone;
}

void readZones(const ArrangeToolOptions& options, const Environment& environment,
               ArrangeOptions& how) {
    const ZoneWords& words = options.zones;
    for (const std::string& text : words.targets)
        how.weights.targets.push_back(zoneOf(options, text, environment));
    for (const std::string& text : words.keep_out)
        how.mount.keep_out.push_back(zoneOf(options, text, environment));
    for (const std::string& text : words.keep_in)
        how.mount.keep_in.push_back(zoneOf(options, text, environment));
    for (const std::string& text : words.weights) {
        const auto [zone, weight] = splitWeight(text);
        how.weights.weights.emplace_back(zoneOf(options, zone, environment), weight);
    }
}

Work read(const ArrangeToolOptions& options) {
    std::vector<std::string> streams = options.operands;
    streams.push_back(options.places_file);
    mustReadStdinOnce(streams);
    const DeviceCatalogue& devices = devicesForSensors(options.sensors);
    const std::vector<std::string_view> kinds = keywordsOf(&SensorKind::is_arranged);
    std::vector<SensorSpec> added;
    added.reserve(options.sensors.size());
    for (const std::string& spec : options.sensors)
        added.push_back(ofOption(
            "--sensor", [&] { return readSensorSpec(spec, kinds, sceneSchemas(), devices); }));
    Work work{
        readScene({options.operands, options.any_environment, false}), {}, options.how, {}, {}};
    SceneInput& input = work.input;
    warn(options.common, "arrange", input.environment.warnings);
    if (!options.fixed.empty()) {
        if (!input.layout) throw UsageError("--fixed is about the sensors of a LAYOUT: give one");
        input.layout = withoutPlaces(*input.layout, options.fixed);
        input.scene = makeScene(input.environment, &*input.layout,
                                devicesFor({&input.environment, &*input.layout}));
    }
    const bool open = options.how.target || options.how.budget;
    work.groups = groupsToPlace(input.scene, added, devices, open);
    if (work.groups.empty())
        throw UsageError("nothing to place: give --sensor, or a LAYOUT with a sensor without `at`");
    readZones(options, input.scene.environment, work.how);
    work.files = filesOf(input);
    if (!options.places_file.empty()) {
        work.places = options.places_file == "-" ? readStdin() : readAll(options.places_file);
        work.how.list =
            readSites(work.places, options.places_file,
                      headingsAround(work.how.headings.value_or(work.how.density.headings)));
        work.files.push_back(options.places_file);
    }
    return work;
}

void writeLayout(const ArrangeCommand& command, const Work& work, const Arrangement& arrangement) {
    const ArrangeToolOptions& options = command.options();
    const SceneInput& input = work.input;
    LayoutParts parts{input.layout ? input.layout->history : History(),
                      environmentFileFor(options.common.output, input.environment_operand),
                      input.scene.digest, std::string(nameOf(work.how.strategy)),
                      std::string(nameOf(work.how.search.optimizer))};
    parts.history.push_back(command.historyLine(input.named));
    const Document layout =
        layoutDocument(parts, input.layout ? &*input.layout : nullptr, work.groups, arrangement);
    if (!options.trace_file.empty())
        writeAll(options.trace_file, writeTrace({parts.history, arrangement.tried}));
    if (const std::string& file = options.curve_file; !file.empty())
        writeAll(file, curveFile(arrangement.curve, outputFormat({}, file, curveFormats())));
    writeAll(options.common.output, writeRecordText(layout));
    writeDependencies(options.common, work.files);
}

/// Sensors that stand and those that may be placed.
struct Numbers {
    std::size_t receivers = 0, others = 0;
};

Numbers numbersOf(const Work& work) {
    const Scene& scene = work.input.scene;
    Numbers numbers;
    for (const Sensor& sensor : scene.sensors)
        if (kindOf(sensor.model).perceives)
            ++(isPartial(sensor.model) ? numbers.receivers : numbers.others);
    for (const SensorGroup& group : work.groups) {
        auto most = static_cast<std::size_t>(group.most);
        if (work.how.budget)
            most = affordableCount(*work.how.budget, 0, group.record.number("cost"), most);
        (isPartial(group.model) ? numbers.receivers : numbers.others) += most;
    }
    return numbers;
}

/// Where the pixels of a camera are too few; "" without one, or if any number will do.
std::string reasonOfDensity(const Work& work) {
    const double density = work.how.pixel_density;
    if (!(density > 0)) return "";
    for (const SensorGroup& group : work.groups)
        if (const auto* camera = std::get_if<Camera>(&group.model))
            return "nowhere on the " + std::string(work.how.plane > 0 ? "plane" : "floor") +
                   " are there " + formatDouble(density) + " pixels a metre (--density): " +
                   (camera->model.empty() ? "a camera" : camera->model) + " has so many up to " +
                   formatFixed(rangeOf(*camera, density), 2) + " m away";
    return "";
}

/// Why nothing is covered; "" where something is.
std::string reasonForNothing(const Work& work, const Arrangement& arrangement) {
    const auto [receivers, others] = numbersOf(work);
    const std::size_t together = others + receivers / kMinReceivers;
    const auto times = static_cast<std::size_t>(work.how.redundancy);
    if (receivers > 0 && receivers < kMinReceivers)
        return "ultrasound covers nothing: at least " + std::to_string(kMinReceivers) +
               " receivers have to hear a tag, here are " + std::to_string(receivers);
    if (times > 1 && together < times)
        return "nothing counts: floor has to be seen by " + std::to_string(times) +
               " sensors, and there are " + std::to_string(together);
    if (arrangement.coverage > 0 || arrangement.sensors.empty()) return "";
    if (!work.how.judges_inside && arrangement.candidate_value > 0) return "";
    if (std::string text = reasonOfDensity(work); !text.empty()) return text;
    return "the sensors cover nothing: look at their heights, tilts and ranges, and at what "
           "`coverage` draws (-o map.png)";
}

/// Section 4.4.5 of the thesis; "" where it does not apply.
std::string hintAlongWalls(const Work& work) {
    constexpr double kSlack = 1e-9;  // degrees
    const bool has_headings = work.how.headings.has_value();
    if (work.how.strategy != Strategy::Wall || has_headings || work.how.mount.on == MountOn::Frame)
        return "";
    for (const SensorGroup& group : work.groups) {
        const auto* laser = std::get_if<Laser>(&group.model);
        const double span = laser == nullptr ? 0 : laser->sweptSpan().degrees();
        if (span > 180 + kSlack)
            return "along walls " + formatDouble(roundSignificant(span - 180, 4)) + " of the " +
                   formatDouble(roundSignificant(span, 4)) +
                   " degrees of a laser's field of view face the wall: --strategy grid or random "
                   "may cover more";
    }
    return "";
}

/// Nothing hangs above the room.
void warnOfHeights(const ArrangeToolOptions& options, const Work& work) {
    const double top = work.input.scene.environment.height();
    for (const double height : work.how.mount.heights)
        if (height > top)
            warn(options.common, "arrange",
                 "--z " + formatDouble(height) + ": the room is " + formatDouble(top) +
                     " m high, and nothing is there to mount a sensor on");
}

/// Where nothing is covered there is a reason, which is worth a word; and so are sensors too many.
void warnOfNothing(const ArrangeToolOptions& options, const Work& work,
                   const Arrangement& arrangement) {
    std::string text = reasonForNothing(work, arrangement);
    if (text.empty()) text = idleText(arrangement);
    if (!text.empty()) warn(options.common, "arrange", text);
}

/// Words on the layout, and what is not as it was asked for.
void report(const ArrangeToolOptions& options, const Work& work, const Arrangement& arrangement) {
    if (!options.common.quiet) std::cerr << reportText(work.how, arrangement);
    talk(options.common, "arrange",
         "total effective area " + formatFixed(arrangement.area, 2) + " m2, cost " +
             formatDouble(arrangement.cost));
}

void checkGoals(const ArrangeToolOptions& options, const Work& work,
                const Arrangement& arrangement) {
    warnOfNothing(options, work, arrangement);
    if (const std::string text = doubledText(arrangement); !text.empty())
        warn(options.common, "arrange", text);
    if (!arrangement.is_reached) {
        std::string text = shortfallText(work.how, arrangement);
        if (arrangement.candidate_bound <= 0)
            if (const std::string reason = reasonOfDensity(work); !reason.empty())
                text += "; " + reason;
        throw UnmetError(text);
    }
    if (arrangement.unplaced > 0)
        throw UnmetError(std::to_string(arrangement.unplaced) +
                         " of the sensors are not placed: there are " +
                         (work.how.is_connected
                              ? "no candidates left from which views hang together (--connected)"
                              : "fewer candidates than sensors"));
}

/// The ledger of a job that is shared out or may be gone on with; null for others, and for a part
/// that is done already. \param parts those of a merge
std::unique_ptr<JobLedger> ledgerOf(const ArrangeCommand& command, const Work& work,
                                    const std::vector<PartFile>& parts, bool& is_done) {
    const ArrangeToolOptions& options = command.options();
    const BatchOptions& batch = options.batch;
    JobId job = arrangeJob(command, work.input, work.places);
    if (!parts.empty()) {
        const JobId& made = parts.front().head().job;
        job.form = made.form;
        if (const std::string difference = job.differenceFrom(made); !difference.empty())
            throw FormatError({parts.front().file(), 0, 0,
                               "not of what is read now: " + difference + " differs"});
        return std::make_unique<JobLedger>(parts);
    }
    if (!batch.shard && !batch.resume) return nullptr;
    if (batch.shard)
        for (const std::string* file :
             {&work.input.environment_operand, &work.input.layout_operand, &options.places_file})
            if (!file->empty() && isStream(*file))
                throw UsageError("--shard: the merge reads its input again; give it as a file");
    const PartHead head{job, batch.shard.value_or(Shard())};
    is_done = batch.shard && batch.resume && isDoneAlready(options.common.output, head);
    return is_done ? nullptr : std::make_unique<JobLedger>(command, head);
}

void runCommand(const ArrangeCommand& command, const std::vector<PartFile>& parts) {
    const ArrangeToolOptions& options = command.options();
    limitThreads(options.common.threads);
    claimOutputs(options.common);
    claimOutput(options.trace_file, "--trace");
    claimOutput(options.curve_file, "--curve");
    claimOutput(options.mps_file, "--export-mps");
    Work work = read(options);
    if (const std::string hint = hintAlongWalls(work); !hint.empty())
        warn(options.common, "arrange", hint);
    for (const std::string* file :
         {&options.common.output, &options.trace_file, &options.curve_file, &options.mps_file})
        mustBeWritable(*file);
    warnOfHeights(options, work);
    bool is_done = false;
    const auto ledger = ledgerOf(command, work, parts, is_done);
    if (is_done) return talk(options.common, "arrange", options.common.output + " is done already");
    work.how.search.share.ledger = ledger.get();
    int signal = 0;
    Arrangement arrangement;
    {
        SearchWatch watch(makeProgress("arrange", options.common.progress, options.common.quiet),
                          options.time_limit);
        std::optional<FileStream> mps;
        if (!options.mps_file.empty()) mps.emplace(options.mps_file);
        try {
            arrangement = arrange(work.input.scene, work.groups, work.how, watch,
                                  mps ? &mps->stream() : nullptr);
        } catch (const UnmetError&) {
            if (watch.signal() == 0) throw;
            if (!options.common.quiet)
                std::cerr << "arrange: stopped before there was a layout: nothing is written\n";
            endBySignal(watch.signal());
        }
        if (mps) mps->commit();
        signal = watch.signal();
        if (signal != 0 && endsWithoutProduct(options)) {
            if (!options.common.quiet)
                std::cerr << "arrange: stopped: nothing is written"
                          << (options.batch.resume ? ", the same command goes on\n" : "\n");
            endBySignal(signal);
        }
        if (options.batch.shard)
            ledger->writePart();
        else
            writeLayout(command, work, arrangement);
        if (ledger && (options.batch.shard || arrangement.is_complete)) ledger->removeCheckpoint();
        signal = watch.signal();
    }
    if (ledger && !ledger->trouble().empty())
        warn(options.common, "arrange", "what was done could not be kept: " + ledger->trouble());
    if (options.batch.shard) {
        writeDependencies(options.common, work.files);
        if (signal != 0) endBySignal(signal);
        return talk(options.common, "arrange",
                    "shard " + options.batch.shard->text() + " is written");
    }
    report(options, work, arrangement);
    if (signal != 0) endBySignal(signal);
    checkGoals(options, work, arrangement);
}

void arrangeSensors(const ArrangeCommand& command) {
    const ArrangeToolOptions& options = command.options();
    if (!options.batch.merge) return runCommand(command, {});
    const std::vector<PartFile> parts = openParts(options.operands, "arrange");
    runCommand(*commandOf(parts, options), parts);
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("arrange", [&] { arrangeSensors(ispace::ArrangeCommand(argc, argv)); });
}
