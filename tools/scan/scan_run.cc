// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/scan_run.h"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/run_files.h"
#include "cli/outputs.h"
#include "io/calibration.h"
#include "scan/scan_batch.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor_spec.h"

namespace ispace {

namespace {

/// Returns the text of --poses, held for a batch, which requires it more than once.
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

}  // namespace

namespace {

/// A receiver alone has no readings.
bool hasReadings(const SensorKind& kind) { return kind.is_read && kind.together == 1; }

}  // namespace

SceneRequest requestOf(const ScanToolOptions& options) {
    // The sensor of --poses may come from a LAYOUT, too.
    const bool wants_layout =
        options.batch.list.empty() &&
        (options.poses.empty() || (options.model.empty() && options.poses != "-"));
    const bool takes_stdin =
        std::find(options.operands.begin(), options.operands.end(), "-") != options.operands.end();
    if (options.poses == "-" && takes_stdin)
        throw UsageError("stdin cannot be read twice: only one of operands and --poses can be -");
    return {options.operands, options.rules, wants_layout, hasReadings};
}

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
         "no placed sensor with readings: give one `at=x,y`, or let arrange place it"});
}

ReadingWork workOf(const ScanCommand& command, const ScanToolOptions& options,
                   const SceneInput& input, const Sensors& sensors, const ReadingFormat& format) {
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

namespace {

/// Keywords of sensors that poses can move.
std::vector<std::string_view> movable() { return keywordsOf(&SensorKind::follows_poses); }

/// \param sources receives the calibration that it names
Record recordOfModel(const std::string& model, const DeviceCatalogue& devices,
                     std::vector<std::string>& sources) {
    const SensorSpec spec = readSensorSpec(model, movable(), sceneSchemas(), devices);
    Document only;
    only.records.push_back(spec.record);
    const Record& record = only.records.front();
    // Bad parameters are errors of the command line.
    try {
        loadCalibrations(only, "-");
        static_cast<void>(sensorModelOf(record, devices));
    } catch (const FormatError& error) {
        throw UsageError(error.diagnostics().front().message);
    }
    if (spec.count.value_or(1) > 1) throw UsageError("one sensor takes the poses, not several");
    for (const char* key : {"at", "heading", "tilt", "roll", "on"})
        if (record.has(key))
            throw UsageError(std::string("`") + key + "` is told by the poses; leave it out");
    sources.insert(sources.end(), only.sources.begin(), only.sources.end());
    return record;
}

std::size_t onlySensor(const Scene& scene, const std::vector<std::string>& globs) {
    const std::vector<std::size_t> found = sensorRecords(scene, movable(), globs);
    if (found.size() == 1) return found.front();
    throw UsageError("--poses: " + std::to_string(found.size()) +
                     " sensors could take them; say which with --model or --select");
}

/// Returns the sensor with the id if the scene has placed it, or null.
const Sensor* placedSensor(const Scene& scene, const std::string& id) {
    const auto found = std::find_if(scene.sensors.begin(), scene.sensors.end(),
                                    [&id](const Sensor& sensor) { return sensor.id == id; });
    return found == scene.sensors.end() ? nullptr : &*found;
}

}  // namespace

Sensors sensorForPoses(const ScanToolOptions& options, const Scene& scene,
                       const DeviceCatalogue& devices, std::vector<std::string>& sources) {
    std::optional<Record> of_model;
    std::string id;
    if (!options.model.empty()) {
        of_model =
            ofOption("--model", [&] { return recordOfModel(options.model, devices, sources); });
        id = of_model->writtenId().empty() ? of_model->keyword() + "1" : of_model->writtenId();
    }
    const std::size_t only = of_model ? 0 : onlySensor(scene, options.select);
    const Record& record = of_model ? *of_model : scene.records[only];
    if (!of_model) id = scene.ids[only];

    Sensors sensors;
    sensors.read.push_back({id, sensorModelOf(record, devices), {}});
    if (const Sensor* placed = of_model ? nullptr : placedSensor(scene, id)) {
        sensors.read.front().mount = placed->mount;
        sensors.read.front().person = placed->person;
    }
    const Sensor& sensor = sensors.read.front();
    if (options.motion && sensor.is<Laser>() && sensor.as<Laser>().sweep != SweepAxis::None)
        throw UsageError("--motion: a laser either sweeps or drives, and " + id + " sweeps");
    return sensors;
}

namespace {

class Stream final : public Delivery {
  public:
    Stream(const std::string& output, const ReadingFormat& format)
        : file_(output), stream_(format.stream([this](auto bytes) { file_.write(bytes); })) {}
    [[nodiscard]] Packing how() const override { return Packing::Stream; }
    void write(Readings& readings) override { stream_->write(readings.text); }
    void commit() override {
        stream_->finish();
        file_.commit();
    }

  private:
    OutputFile file_;
    std::unique_ptr<ReadingStream> stream_;
};

/// Writes each reading to separate files.
class Files final : public Delivery {
  public:
    Files(OutputSet names, const Sensors& sensors) : names_(std::move(names)), sensors_(sensors) {}
    [[nodiscard]] Packing how() const override { return Packing::Files; }
    void write(Readings& readings) override {
        for (std::size_t i = 0; i < readings.jobs.size(); ++i) {
            const ReadingJob& job = readings.jobs[i];
            const std::string& id = sensors_.read[job.sensor].id;
            std::vector<NamedBytes> together;
            for (const ReadingFile& file : readings.files[i])
                together.push_back({together.empty()
                                        ? names_.fileOf(id, job.frame, file.ending)
                                        : names_.fileBeside(id, job.frame, file.ending),
                                    file.bytes});
            writeTogether(together);
        }
    }
    void commit() override {}

  private:
    OutputSet names_;
    const Sensors& sensors_;
};

/// Writes the only reading: its first file has the given name, the others accompany it if that is a
/// file.
class OneFile final : public Delivery {
  public:
    OneFile(const std::string& output, const std::vector<std::string>& endings) : output_(output) {
        files_.push_back(std::make_unique<OutputFile>(output));
        if (isStream(output)) return;
        for (std::size_t i = 1; i < endings.size(); ++i)
            claimOutput(withoutSuffix(output) + endings[i], "a file that stands beside it");
    }
    [[nodiscard]] Packing how() const override { return Packing::Files; }
    void write(Readings& readings) override {
        for (const std::vector<ReadingFile>& files : readings.files)
            for (const ReadingFile& file : files) {
                const bool beside = &file != files.data();
                if (beside && isStream(output_)) break;
                if (beside)
                    files_.push_back(
                        std::make_unique<OutputFile>(withoutSuffix(output_) + file.ending));
                files_.back()->write(file.bytes);
            }
    }
    void commit() override {
        std::vector<OutputFile*> together;
        for (const auto& file : files_) together.push_back(file.get());
        OutputFile::commitTogether(together);
    }

  private:
    std::string output_;
    std::vector<std::unique_ptr<OutputFile>> files_;
};

/// Returns the points of each row of a sensor, and rows of a reading.
std::size_t rowWidth(const Sensor& sensor) {
    return static_cast<std::size_t>(sensor.is<Laser>() ? sensor.as<Laser>().beams
                                                       : sensor.as<Ranger>().columns);
}
std::size_t rowsOf(const Sensor& sensor) {
    return static_cast<std::size_t>(sensor.is<Laser>() ? sensor.as<Laser>().scans()
                                                       : sensor.as<Ranger>().rows);
}

/// All points in one cloud.
class OneCloud final : public Delivery {
  public:
    /// \param count all readings, -1 if unknown
    OneCloud(const ScanToolOptions& options, const Sensors& sensors, std::int64_t count)
        : file_(options.common.output), frames_(framesOf(sensors, count)) {
        CloudRows rows;
        for (const Sensor& sensor : sensors.read) rows.add(rowWidth(sensor), rowsOf(sensor));
        checkPoints(rows.points * frames_);
        cloud_.emplace(*cloudFormatOf(options.format), options.encoding, rows.width,
                       count < 0 ? std::nullopt : std::optional(rows.count * frames_),
                       [this](std::string_view bytes) { file_.write(bytes); });
    }
    [[nodiscard]] Packing how() const override { return Packing::Clouds; }
    void write(Readings& readings) override {
        for (const PointCloud& cloud : readings.clouds) {
            points_ += cloud.size();
            checkPoints(points_);
            cloud_->add(cloud);
        }
    }
    void commit() override {
        cloud_->finish();
        file_.commit();
    }

  private:
    static std::size_t framesOf(const Sensors& sensors, std::int64_t count) {
        return static_cast<std::size_t>(std::max<std::int64_t>(count, 0)) / sensors.read.size();
    }

    OutputFile file_;
    std::size_t frames_, points_ = 0;
    std::optional<CloudStream> cloud_;
};

}  // namespace

bool isOneCloud(const ScanToolOptions& options) {
    return cloudFormatOf(options.format) && options.coordinates == Coordinates::World;
}

void checkPoints(std::size_t points) {
    constexpr std::size_t kMax = 100'000'000;
    if (points > kMax)
        throw FormatError({"", 0, 0,
                           "a cloud of " + std::to_string(points) + " points, wanted at most " +
                               std::to_string(kMax) +
                               " in one file; name a folder (-o DIR/) for a file each reading, "
                               "or take fewer"});
}

FormatOptions formatOptions(const ScanCommand& command, const ScanToolOptions& options,
                            const SceneInput& input) {
    History history = input.layout ? input.layout->history : History();
    history.push_back(command.historyLine(input.named));
    return {.history = std::move(history),
            .seed = options.common.seed,
            .coordinates = options.coordinates,
            .encoding = options.encoding,
            .depth_per_metre = options.depth_per_metre,
            .color = options.color,
            .spectrum = options.spectrum,
            .map_pixels = options.map_pixels,
            .compression = options.compression,
            .las_minor = options.las_minor,
            .labels = options.photo.labels,
            .depths = options.photo.depths,
            .scene = &input.scene};
}

std::unique_ptr<Delivery> makeDelivery(const ScanToolOptions& options, const Sensors& sensors,
                                       const ReadingFormat& format, std::int64_t count) {
    const std::string& output = options.common.output;
    if (auto names = OutputSet::of(output)) {
        std::vector<std::string> ids;
        ids.reserve(sensors.read.size());
        for (const Sensor& sensor : sensors.read) ids.push_back(sensor.id);
        if (options.common.dependencies.wanted)
            throw UsageError("-MD writes a rule for one product, and a set is many files");
        names->prepare(ids, options.frames.value_or(1) > 1 || count < 0, format.endings());
        return std::make_unique<Files>(std::move(*names), sensors);
    }
    format.checkStream();
    if (format.isStream()) return std::make_unique<Stream>(output, format);
    if (count == 1) return std::make_unique<OneFile>(output, format.endings());
    if (isOneCloud(options)) return std::make_unique<OneCloud>(options, sensors, count);
    const std::string many = count < 0 ? "poses" : std::to_string(count) + " readings";
    throw UsageError(many + " make as many files of " + options.format +
                     ": name a folder (-o DIR/) or a pattern (-o '%s-%04d." + options.format +
                     "')" + (count < 0 ? "" : ", or choose one sensor with --select"));
}

}  // namespace ispace
