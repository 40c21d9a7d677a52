// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/scan_run.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "io/calibration.h"
#include "report/reading_picture.h"
#include "scan/scan_batch.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor_spec.h"
#include "sense/burial.h"

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

std::unique_ptr<ReadingSource> sourceFor(const ScanToolOptions& options, const SiteSensors& site,
                                         const std::shared_ptr<const std::string>& poses_text) {
    const Sensors& sensors = site.sensors;
    if (options.poses.empty())
        return std::make_unique<StillSource>(sensors, options.frames.value_or(1), site.rooms);
    PoseLines poses(readerOfPoses(options, poses_text), displayName(options.poses));
    if (!options.motion) return std::make_unique<PoseSource>(std::move(poses));
    const SensorModel& model = sensors.read.front().model;
    return std::make_unique<MotionSource>(std::move(poses), readingRate(model), readingTime(model),
                                          options.frames);
}

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

namespace {

SiteSensors placedSensors(const ScanToolOptions& options, const SiteInput& input) {
    SiteSensors found = sensorsOf(input.rooms(), input.ids(), inOwnStorey(input, options.select));
    if (!found.sensors.read.empty()) return found;
    if (!options.select.empty())
        throw UsageError(
            "--select chooses nothing that is read: receivers hear tags, and sensors "
            "need a place");
    const std::string& file = input.layout ? input.layout_operand : input.environment_operand;
    throw FormatError(
        {displayName(file), 0, 0,
         "no placed sensor with readings: give one `at=x,y`, or let arrange place it"});
}

/// Readings of a run, and their output.
struct ReadingWork {
    std::unique_ptr<ReadingSource> source;
    std::unique_ptr<Delivery> delivery;  ///< null: all readings are complete
    std::int64_t count = -1;             ///< of readings; -1 if unknown
};

/// Returns the readings that this run takes: all, or its part less the completed ones.
ReadingWork workOf(const ScanCommand& command, const ScanToolOptions& options,
                   const SiteInput& input, const SiteSensors& site, const ReadingFormat& format) {
    const bool moves = !options.poses.empty();
    const Sensors& sensors = site.sensors;
    const auto poses = posesText(options);
    ReadingWork work;
    work.source = sourceFor(options, site, poses);
    if (!moves) work.count = static_cast<const StillSource&>(*work.source).count();
    if (!isBatch(options)) {
        work.delivery = makeDelivery(options, sensors, format, work.count);
        return work;
    }
    constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();
    if (moves) work.count = sourceFor(options, site, poses)->skip(kAll);
    OwnReadings own = ownReadings(options, readingsJob(command, input, format, *poses, work.count),
                                  sensors, format);
    work.delivery = std::move(own.delivery);
    work.source->skip(own.block.first);
    work.count = own.block.end - own.block.first;
    return work;
}

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

/// A sensor that may take the poses.
struct KnownSensor {
    std::size_t room = 0, record = 0;
    std::string id;  ///< across the site
};

KnownSensor onlySensor(const SiteInput& site, const std::vector<std::string>& globs) {
    std::vector<KnownSensor> found;
    for (std::size_t room = 0; room < site.rooms().size(); ++room)
        for (const std::size_t record : sensorRecords(*site.rooms()[room], movable(), {}))
            if (KnownSensor one{room, record, site.idOf(room, site.rooms()[room]->ids[record])};
                isSelected(one.id, globs))
                found.push_back(std::move(one));
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

/// The sensor that takes the poses.
struct MovedSensor {
    SiteSensors found;             ///< it alone, in the frame of the site
    std::size_t carrier_room = 0;  ///< of the robot or person that carries it
};

/// Returns the sensor that takes the poses: that of --model, or the only laser, ranger or camera of
/// the site, placed or not. It does not see the robot or person that carries it. \param sources
/// the file that --model names is appended \throws UsageError for a bad --model and for an
/// ambiguous sensor; FormatError as withParameters()
MovedSensor sensorForPoses(const ScanToolOptions& options, const SiteInput& site,
                           const DeviceCatalogue& devices, std::vector<std::string>& sources) {
    MovedSensor moved;
    std::vector<Sensor>& read = moved.found.sensors.read;
    if (!options.model.empty()) {
        const Record record =
            ofOption("--model", [&] { return recordOfModel(options.model, devices, sources); });
        const std::string& written = record.writtenId();
        read.push_back({written.empty() ? record.keyword() + "1" : written,
                        sensorModelOf(record, devices),
                        {}});
    } else {
        const KnownSensor only = onlySensor(site, inOwnStorey(site, options.select));
        const Scene& scene = *site.rooms()[only.room];
        read.push_back({only.id, sensorModelOf(scene.records[only.record], devices), {}});
        if (const Sensor* placed = placedSensor(scene, scene.ids[only.record])) {
            read.front().mount = placed->mount;
            read.front().person = placed->person;
            moved.carrier_room = only.room;
        }
    }
    const Sensor& sensor = read.front();
    const std::string& id = sensor.id;
    if (options.motion && sensor.is<Laser>() && sensor.as<Laser>().sweep != SweepAxis::None)
        throw UsageError("--motion: a laser either sweeps or drives, and " + id + " sweeps");
    moved.found.rooms = {{"", site.rooms().front().get(), 1, 0}};
    return moved;
}

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

FormatOptions formatOptions(const ScanCommand& command, const SiteInput& input,
                            std::vector<SensorRoom> rooms) {
    const ScanToolOptions& options = command.options();
    History history = input.layout ? input.layout->history : History();
    history.push_back(command.historyLine(input.named));
    return {.history = std::move(history),
            .seed = options.common.seed,
            .coordinates = options.coordinates,
            .encoding = options.encoding,
            .depth_per_metre = options.depth_per_metre,
            .color = options.color,
            .spectrum = options.spectrum,
            .drawings = &readingDrawings(),
            .map_pixels = options.map_pixels,
            .compression = options.compression,
            .las_minor = options.las_minor,
            .labels = options.photo.labels,
            .depths = options.photo.depths,
            .rooms = std::move(rooms)};
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

namespace {

/// Reads sensors in one room.
class RoomSampler {
  public:
    /// \param moved null: placed sensors \pre all arguments outlive it
    RoomSampler(const ScanToolOptions& options, const SeenSite& site, std::size_t room,
                const SiteSensors& all, const MovedSensor* moved)
        : scene_(site.scene(room)),
          worlds_(scene_->environment),
          bodies_(bodiesOf(*scene_)),
          room_(site.input().rooms()[room]),
          burial_(room_->environment),
          sensors_{all.sensors.read, {}} {
        TakerOptions taking{.celsius = options.celsius,
                            .follows_poses = moved != nullptr,
                            .velocities = startVelocities(*scene_)};
        if (options.noise) taking.noise_seed = options.common.seed;
        bool has_camera = false;
        for (std::size_t i = 0; i < sensors_.read.size(); ++i)
            has_camera = has_camera || (sensors_.read[i].is<Camera>() &&
                                        (moved != nullptr || roomOf(all.rooms, i) == room));
        if (has_camera) taking.photographer = &photographer_.emplace(*scene_, options.photo);
        if (moved == nullptr) {
            const auto receivers = receiversIn(all.rooms, room, all.sensors);
            sensors_.receivers.assign(receivers.begin(), receivers.end());
        } else if (moved->carrier_room != room) {
            sensors_.read.front().mount.reset();
            sensors_.read.front().person.reset();
        }
        sampler_.emplace(sensors_, worlds_, bodies_, taking);
    }

    [[nodiscard]] ReadingSampler& sampler() { return *sampler_; }
    [[nodiscard]] std::vector<std::string> textures() const {
        return photographer_ ? textureFiles(*scene_) : std::vector<std::string>();
    }
    /// Returns true for a position in a solid of the room. \param point in the room
    [[nodiscard]] bool isInsideSolid(Point3 point) { return burial_.isInsideSolid(point); }

  private:
    std::shared_ptr<const Scene> scene_;
    RayScenes worlds_;
    MovingBodies bodies_;
    std::shared_ptr<const Scene> room_;  // by itself
    BurialTest burial_;
    Sensors sensors_;  // of all rooms, with the receivers of this one
    std::optional<Photographer> photographer_;
    std::optional<ReadingSampler> sampler_;
};

/// Counts the poses that are inside a solid.
class BuriedPoses {
  public:
    explicit BuriedPoses(const SeenSite& site) : site_(&site) {}
    void count(std::size_t room, RoomSampler& sampler, const std::vector<ReadingJob>& jobs) {
        const auto site_from_room = site_->siteFromRoom(room);
        for (const ReadingJob& job : jobs) {
            const Point3 point =
                (site_from_room ? toInner(*site_from_room, job.pose) : job.pose).position;
            const Coupling* const coupling = site_->coupling();
            const bool is_buried = sampler.isInsideSolid(point) ||
                                   (coupling != nullptr && coupling->slabAround(room, point));
            if (is_buried && count_++ == 0) first_ = job;
        }
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
    const SeenSite* site_;
    std::int64_t count_ = 0;
    ReadingJob first_;
};

}  // namespace

void shareFrame(const ScanToolOptions& options, const SeenSite& site,
                std::vector<SensorRoom>& rooms) {
    if (OutputSet::of(options.common.output)) return;
    for (std::size_t i = 0; i < rooms.size(); ++i) rooms[i].site_from_room = site.siteFromRoom(i);
}

std::int64_t takeReadings(const ScanCommand& command, const ScanToolOptions& options) {
    const SiteInput input = readSite(requestOf(options));
    warnOfImport(options.common, "scan", input);
    const bool moves = !options.poses.empty();
    if (moves && options.photo.labels) mustBeOneRoom(input, "--layers labels with --poses");
    std::vector<std::string> files = input.files;
    std::optional<MovedSensor> moved;
    if (moves) moved = sensorForPoses(options, input, shippedDevices(), files);
    const SeenSite site(input);
    SiteSensors all = moved ? moved->found : placedSensors(options, input);
    if (!moves) shareFrame(options, site, all.rooms);
    const Sensors& sensors = all.sensors;
    command.checkSensors(sensors.read);
    if (!moves)
        warn(options.common, "scan",
             siteWarnings(input, {.checks = {"unplaced", "outside", "buried"},
                                  .ids = [&options](const std::string& id) {
                                      return isSelected(id, options.select);
                                  }}));
    if (options.noise && std::none_of(sensors.read.begin(), sensors.read.end(),
                                      [](const Sensor& one) { return isNoisy(one.model); }))
        warn(options.common, "scan", "--noise changes nothing: no sensor that is read has noise");
    const auto format =
        makeFormat(options.format, sensors, formatOptions(command, input, all.rooms));
    warn(options.common, "scan", format->warnings());
    if (format->isBinary()) refuseTerminal(options.common.output, options.format);

    const auto room_of = [&](const ReadingJob& job) {
        return moves ? site.roomAt(job.pose.position) : roomOf(all.rooms, job.sensor);
    };
    std::vector<std::string> textures;
    std::map<std::size_t, RoomSampler> samplers;  // of placed sensors that of one room at a time
    const auto sampler_in = [&](std::size_t room) -> RoomSampler& {
        if (!moves && !samplers.contains(room)) samplers.clear();
        const auto [known, is_new] =
            samplers.try_emplace(room, options, site, room, all, moved ? &*moved : nullptr);
        if (is_new)
            for (std::string& file : known->second.textures()) textures.push_back(std::move(file));
        return known->second;
    };
    // What cannot be read is found before a stream begins.
    sampler_in(moves ? moved->carrier_room : roomOf(all.rooms, 0));
    const ReadingWork work = workOf(command, options, input, all, *format);
    if (!work.delivery) {
        logInfo(options.common, "scan", options.common.output + " is done already");
        return 0;
    }
    constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();
    LimitedSource own_part(*work.source, work.count < 0 ? kAll : work.count);
    RoomParts parts(own_part, room_of);
    const auto progress = makeProgress("scan", options.common.progress, options.common.quiet);
    progress->begin("readings", std::max<std::int64_t>(work.count, 0));
    BuriedPoses buried(site);
    std::int64_t done = 0;
    while (const auto room = parts.begin(batchSize(sensors))) {
        RoomSampler& sampler = sampler_in(*room);
        const auto site_from_room = moves ? site.siteFromRoom(*room) : std::nullopt;
        const auto write = [&](Readings& readings) {
            if (moves) buried.count(*room, sampler, readings.jobs);
            done += static_cast<std::int64_t>(readings.jobs.size());
            work.delivery->write(readings);
        };
        runReadings(parts, sampler.sampler(), sensors, *format, work.delivery->how(),
                    options.coordinates, *progress, write,
                    site_from_room ? &*site_from_room : nullptr);
    }
    work.delivery->commit();
    progress->end();
    warn(options.common, "scan", buried.phrases());
    if (moves) files.push_back(options.poses);
    files.insert(files.end(), textures.begin(), textures.end());
    writeDependencies(options.common, files);
    logInfo(options.common, "scan",
            std::to_string(done) + (done == 1 ? " reading" : " readings") + " written");
    return done;
}

}  // namespace ispace
