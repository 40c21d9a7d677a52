// SPDX-License-Identifier: GPL-3.0-or-later
// scan: simulates what the sensors of a scene read.
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/run_tool.h"
#include "layout/scene.h"
#include "scan/batch.h"
#include "scan/options.h"
#include "scan/readings.h"
#include "scan/recorded.h"
#include "scan/views.h"
#include "sense/sensors.h"
#include "sense/warnings.h"

namespace {

using namespace ispace;

Sensors placedSensors(const ScanToolOptions& options, const SceneInput& input) {
    Sensors sensors = sensorsOf(input.scene, options.select);
    if (!sensors.read.empty()) return sensors;
    if (!options.select.empty())
        throw UsageError(
            "--select chooses nothing that is read: receivers hear tags, and sensors "
            "need a place");
    const std::string& file = input.layout ? input.layout_operand : input.environment_operand;
    throw FormatError(
        {displayName(file), 0, 0,
         "no placed laser, ranger, camera or tag: give one `at=x,y`, or let arrange place it"});
}

/// Counts the poses that are inside something solid.
class BuriedPoses {
  public:
    explicit BuriedPoses(const Environment& environment) : burial_(environment) {}
    void count(const std::vector<ReadingJob>& jobs) {
        for (const ReadingJob& job : jobs)
            if (burial_.isBuried(job.pose.position) && count_++ == 0) first_ = job;
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

/// The text of --poses, held for a batch, which needs it more than once.
std::shared_ptr<const std::string> posesText(const ScanToolOptions& options) {
    if (options.poses.empty() || !isBatch(options)) return std::make_shared<std::string>();
    return std::make_shared<std::string>(options.poses == "-" ? readStdin()
                                                              : readAll(options.poses));
}

ByteReader readerOfPoses(const ScanToolOptions& options,
                         const std::shared_ptr<const std::string>& text) {
    if (isBatch(options))
        return [text, at = std::size_t{0}](std::string& bytes) mutable {
            constexpr std::size_t kChunk = 1 << 16;
            const std::string_view piece = std::string_view(*text).substr(at, kChunk);
            bytes += piece;
            at += piece.size();
            return !piece.empty();
        };
    if (options.poses == "-" && isTerminalInput())
        throw UsageError("stdin is a terminal: give a file of poses, or send them through a pipe");
    return [file = std::make_shared<InputFile>(options.poses)](std::string& bytes) {
        return file->read(bytes);
    };
}

std::unique_ptr<ReadingSource> sourceFor(const ScanToolOptions& options, const Sensors& sensors,
                                         const std::shared_ptr<const std::string>& poses_text) {
    if (options.poses.empty())
        return std::make_unique<StillSource>(sensors, options.frames.value_or(1));
    PoseLines poses(readerOfPoses(options, poses_text), displayName(options.poses));
    if (!options.motion) return std::make_unique<PoseSource>(std::move(poses));
    const SensorModel& model = sensors.read.front().model;
    return std::make_unique<MotionSource>(std::move(poses), readingRate(model), readingTime(model),
                                          options.frames);
}

/// What a run has to take, and where it goes.
struct ReadingWork {
    std::unique_ptr<ReadingSource> source;
    std::unique_ptr<Delivery> delivery;  ///< null: all is done
    std::int64_t count = -1;             ///< of readings; -1 if nobody knows
};

ReadingWork workOf(const ScanCommand& command, const SceneInput& input, const Sensors& sensors,
                   const ReadingFormat& format) {
    const ScanToolOptions& options = command.options();
    const bool moves = !options.poses.empty();
    const auto poses = posesText(options);
    ReadingWork work;
    work.source = sourceFor(options, sensors, poses);
    if (!moves) work.count = static_cast<const StillSource&>(*work.source).count();
    if (!isBatch(options)) {
        work.delivery = makeDelivery(options, sensors, format, work.count);
        return work;
    }
    constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();
    if (moves) work.count = sourceFor(options, sensors, poses)->skip(kAll);
    OwnReadings own = ownReadings(options, readingsJob(command, input, format, *poses, work.count),
                                  sensors, format);
    work.delivery = std::move(own.delivery);
    work.source->skip(own.block.first);
    work.count = own.block.end - own.block.first;
    return work;
}

SceneRequest requestOf(const ScanToolOptions& options) {
    // The sensor of --poses may come from a LAYOUT, too.
    const bool wants_layout =
        options.poses.empty() || (options.model.empty() && options.poses != "-");
    const bool takes_stdin =
        std::find(options.operands.begin(), options.operands.end(), "-") != options.operands.end();
    if (options.poses == "-" && takes_stdin)
        throw UsageError("stdin cannot be read twice: only one of operands and --poses can be -");
    // A receiver alone reads nothing.
    return {options.operands,
            options.any_environment,
            wants_layout,
            {"laser", "ranger", "camera", "tag"}};
}

void scan(const ScanCommand& command) {
    const ScanToolOptions& options = command.options();
    claimOutputs(options.common);
    if (options.list_models) return writeAll(options.common.output, deviceTable(shippedDevices()));
    if (options.batch.merge) return mergeReadings(command);
    limitThreads(options.common.threads);
    if (!options.view.views.empty()) return takeViews(command);
    if (!options.view.run.empty()) return writeRecorded(command);
    const SceneInput input = readScene(requestOf(options));
    warn(options.common, "scan", input.environment.warnings);
    const Scene& scene = input.scene;
    const bool moves = !options.poses.empty();
    std::vector<std::string> files = filesOf(input);
    const Sensors sensors = moves ? sensorForPoses(options, scene, shippedDevices(), files)
                                  : placedSensors(options, input);
    command.checkSensors(sensors.read);
    if (!moves) warn(options.common, "scan", sensorWarnings(scene, sensors, options.select));
    const auto format = makeFormat(options.format, sensors, formatOptions(command, input));
    warn(options.common, "scan", format->warnings());
    if (format->isBinary()) refuseTerminal(options.common.output, options.format);

    Worlds worlds(scene.environment);
    const MovingBodies bodies(bodiesOf(scene));
    TakerOptions taking{.celsius = options.celsius, .follows_poses = moves};
    if (options.noise) taking.noise_seed = options.common.seed;
    std::optional<Photographer> photographer;
    if (std::any_of(sensors.read.begin(), sensors.read.end(),
                    [](const Sensor& one) { return one.is<Camera>(); }))
        taking.photographer = &photographer.emplace(scene, options.photo);
    ReadingTaker taker(sensors, worlds, bodies, taking);
    const ReadingWork work = workOf(command, input, sensors, *format);
    if (!work.delivery)
        return talk(options.common, "scan", options.common.output + " is done already");
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
    talk(options.common, "scan",
         std::to_string(done) + (done == 1 ? " reading" : " readings") + " written");
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("scan", [&] { scan(ispace::ScanCommand(argc, argv)); });
}
