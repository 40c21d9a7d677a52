// SPDX-License-Identifier: GPL-3.0-or-later
// scan: computes readings of a scene's sensors.
#include <algorithm>
#include <limits>
#include <optional>

#include "base/file.h"
#include "base/memory.h"
#include "base/number.h"
#include "cli/job_server.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "scan/scan_batch.h"
#include "scan/scan_building.h"
#include "scan/scan_options.h"
#include "scan/scan_run.h"
#include "scan/scan_views.h"
#include "scene/findings/findings.h"
#include "scene/scene.h"
#include "sense/warnings.h"
#include "tools.h"

namespace {

using namespace ispace;

/// Counts the poses that are inside a solid.
class BuriedPoses {
  public:
    explicit BuriedPoses(const Environment& environment) : burial_(environment) {}
    void count(const std::vector<ReadingJob>& jobs) {
        for (const ReadingJob& job : jobs)
            if (burial_.isInsideSolid(job.pose.position) && count_++ == 0) first_ = job;
    }
    [[nodiscard]] std::vector<std::string> phrases() const {
        if (count_ == 0) return {};
        const Point3& place = first_.pose.position;
        return {std::to_string(count_) + (count_ == 1 ? " reading was" : " readings were") +
                " taken inside something solid, the first at t=" + formatDouble(first_.time) +
                ", " + formatDouble(place.x) + "," + formatDouble(place.y) + "," +
                formatDouble(place.z)};
    }

  private:
    BurialTest burial_;
    std::int64_t count_ = 0;
    ReadingJob first_;
};

/// Reads the sensors of a scene. Returns the number of readings; 0 if the part exists already.
std::int64_t scanScene(const ScanCommand& command, const ScanToolOptions& options) {
    const SceneInput input = readScene(requestOf(options));
    warnOfImport(options.common, "scan", input);
    const Scene& scene = input.scene;
    const bool moves = !options.poses.empty();
    std::vector<std::string> files = filesOf(input);
    const Sensors sensors = moves ? sensorForPoses(options, scene, shippedDevices(), files)
                                  : placedSensors(options, input);
    command.checkSensors(sensors.read);
    if (!moves)
        warn(options.common, "scan",
             sceneWarnings(scene, {.checks = {"unplaced", "outside", "buried"},
                                   .ids = [&options](const std::string& id) {
                                       return isSelected(id, options.select);
                                   }}));
    const auto format = makeFormat(options.format, sensors, formatOptions(command, options, input));
    warn(options.common, "scan", format->warnings());
    if (format->isBinary()) refuseTerminal(options.common.output, options.format);

    Worlds worlds(scene.environment);
    const MovingBodies bodies(bodiesOf(scene));
    TakerOptions taking{
        .celsius = options.celsius, .follows_poses = moves, .velocities = startVelocities(scene)};
    if (options.noise) taking.noise_seed = options.common.seed;
    std::optional<Photographer> photographer;
    if (std::any_of(sensors.read.begin(), sensors.read.end(),
                    [](const Sensor& one) { return one.is<Camera>(); }))
        taking.photographer = &photographer.emplace(scene, options.photo);
    ReadingSampler taker(sensors, worlds, bodies, taking);
    const ReadingWork work = workOf(command, options, input, sensors, *format);
    if (!work.delivery) {
        logInfo(options.common, "scan", options.common.output + " is done already");
        return 0;
    }
    const std::int64_t count = work.count;
    constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();
    LimitedSource own_part(*work.source, count < 0 ? kAll : count);
    const auto progress = makeProgress("scan", options.common.progress, options.common.quiet);
    progress->begin("readings", std::max<std::int64_t>(count, 0));
    BuriedPoses buried(scene.environment);
    std::int64_t done = 0;
    runReadings(own_part, taker, sensors, *format, work.delivery->how(), options.coordinates,
                *progress, [&](Readings& readings) {
                    if (moves) buried.count(readings.jobs);
                    done += static_cast<std::int64_t>(readings.jobs.size());
                    work.delivery->write(readings);
                });
    work.delivery->commit();
    progress->end();
    warn(options.common, "scan", buried.phrases());
    if (moves) files.push_back(options.poses);
    if (photographer) {
        const std::vector<std::string> textures = textureFiles(scene);
        files.insert(files.end(), textures.begin(), textures.end());
    }
    writeDependencies(options.common, files);
    logInfo(options.common, "scan",
            std::to_string(done) + (done == 1 ? " reading" : " readings") + " written");
    return done;
}

/// Reads the sensors of a room or of a building. Returns as scanScene().
std::int64_t takeReadings(const ScanCommand& command, const ScanToolOptions& options) {
    const auto of_building = scanBuilding(command, options);
    return of_building ? *of_building : scanScene(command, options);
}

/// Returns the suffix of the file that holds all readings of a scene; "/" if they take several.
std::string suffixOfReadings(const ScanToolOptions& options) {
    const std::string& format = options.format;
    if (format == "png" || format == "jpeg" || (cloudFormatOf(format) && !isOneCloud(options)))
        return "/";
    return format == "carmen" ? ".log" : format == "rgb24" ? ".rgb" : "." + format;
}

void scanJob(const ScanCommand& command, const BatchJob& job, const CommonOptions& common,
             JobOutcome& outcome) {
    ScanToolOptions options = command.options();
    options.common = common;
    options.operands = job.operands;
    options.batch.shard.reset();
    options.batch.resume = false;
    const std::int64_t readings = takeReadings(command, options);
    JsonWriter json = jobLine("scan", job);
    json.key("product").value(common.output).key("readings").value(readings);
    outcome.line = json.endObject().take() + '\n';
}

void scan(const ScanCommand& command) {
    const ScanToolOptions& options = command.options();
    if (options.task) {
        limitThreads(options.common.threads);
        return options.task();
    }
    if (!options.batch.list.empty())
        return runBatch(
            {"scan", options.common, options.batch, command.historyLine({}), "",
             suffixOfReadings(options)},
            [&command](const BatchJob& job, const CommonOptions& common, JobOutcome& outcome) {
                scanJob(command, job, common, outcome);
            });
    claimOutputs(options.common);
    if (options.list_models) return writeAll(options.common.output, deviceTable(shippedDevices()));
    if (options.batch.merge) return mergeReadings(command);
    limitThreads(options.common.threads);
    if (!options.view.views.empty()) keepFreedMemory();  // of one storey for the next
    if (scanBuilding(command, options)) return;
    if (!options.view.views.empty()) return takeViews(command);
    if (!options.view.run.empty()) return writeRecorded(command);
    scanScene(command, options);
}

}  // namespace

int ispace::runScan(int argc, char** argv) {
    return runTool("scan", argc, argv,
                   [](int count, char** words) { scan(ispace::ScanCommand(count, words)); });
}
