// SPDX-License-Identifier: GPL-3.0-or-later
// arrange: places sensors in a room and writes the layout.
#include <iostream>

#include "arrange/options.h"
#include "arrange/report.h"
#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "cli/dependencies.h"
#include "cli/file_stream.h"
#include "cli/operands.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "cli/search_watch.h"
#include "layout/schemas.h"
#include "place/layout_document.h"
#include "record/text.h"

namespace {

using namespace ispace;

/// What is read before the search.
struct Work {
    SceneInput input;
    std::vector<SensorGroup> groups;
    ArrangeOptions how;
    std::vector<std::string> files;  ///< for -MD
};

void warn(const ArrangeToolOptions& options, const std::string& text) {
    if (!options.common.quiet) std::cerr << "arrange: warning: " << text << '\n';
}

NamedZone zoneOf(const ArrangeToolOptions& options, const std::string& text,
                 const Environment& environment) {
    NamedZone zone = readZone(text, environment);
    if (zone.is_center_outside)
        warn(options, "the centre of gravity of " + zone.name +
                          " lies outside of it; its inside is told by (" +
                          formatFixed(zone.inside.x, 2) + ", " + formatFixed(zone.inside.y, 2) +
                          ") instead");
    return zone;
}

void readZones(const ArrangeToolOptions& options, const Environment& environment,
               ArrangeOptions& how) {
    const ZoneWords& words = options.zones;
    for (const std::string& text : words.targets)
        how.worth.targets.push_back(zoneOf(options, text, environment));
    for (const std::string& text : words.keep_out)
        how.mount.keep_out.push_back(zoneOf(options, text, environment));
    for (const std::string& text : words.keep_in)
        how.mount.keep_in.push_back(zoneOf(options, text, environment));
    for (const std::string& text : words.weights) {
        const auto [zone, weight] = splitWeight(text);
        how.worth.weights.emplace_back(zoneOf(options, zone, environment), weight);
    }
}

Work read(const ArrangeToolOptions& options) {
    const DeviceCatalogue devices = DeviceCatalogue::load(shareFolder() + "/devices");
    std::vector<SensorSpec> added;
    added.reserve(options.sensors.size());
    for (const std::string& spec : options.sensors)
        added.push_back(readSensorSpec(spec, kArrangedKinds, sceneSchemas(), devices));
    Work work{readScene({options.operands, options.any_environment, false}), {}, options.how, {}};
    SceneInput& input = work.input;
    if (!options.fixed.empty()) {
        if (!input.layout) throw UsageError("--fixed is about the sensors of a LAYOUT: give one");
        input.layout = withoutPlaces(*input.layout, options.fixed);
        input.scene = makeScene(input.environment, &*input.layout, devices);
    }
    const bool open = options.how.target || options.how.budget;
    work.groups = groupsToPlace(input.scene, added, devices, open);
    if (work.groups.empty())
        throw UsageError("nothing to place: give --sensor, or a LAYOUT with a sensor without `at`");
    readZones(options, input.scene.environment, work.how);
    work.files = filesOf(input);
    if (!options.places_file.empty()) {
        const bool reads_stdin = options.places_file == "-";
        work.how.list =
            readSites(reads_stdin ? readStdin() : readAll(options.places_file), options.places_file,
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
    if (!options.curve_file.empty()) writeCurve(options, arrangement.curve);
    writeAll(options.common.output, writeRecordText(layout));
    writeDependencies(options.common, work.files);
}

void arrangeSensors(const ArrangeCommand& command) {
    const ArrangeToolOptions& options = command.options();
    const ThreadLimit threads(options.common.threads);
    const Work work = read(options);
    refuseReplacing(work.files, {options.trace_file, options.curve_file, options.mps_file});
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
            if (watch.signal() != 0) endBySignal(watch.signal());
            throw;
        }
        if (mps) mps->commit();
        writeLayout(command, work, arrangement);
        signal = watch.signal();
    }
    if (!options.common.quiet)
        std::cerr << reportText(work.how, arrangement, options.common.verbose);
    if (signal != 0) endBySignal(signal);
    if (!arrangement.is_reached) throw UnmetError(shortfallText(work.how, arrangement));
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("arrange", [&] { arrangeSensors(ispace::ArrangeCommand(argc, argv)); });
}
