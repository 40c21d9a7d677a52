// SPDX-License-Identifier: GPL-3.0-or-later
// Three ways, by the operands and the log: ENV LAYOUT (plan_fit.h), LAYOUT with --by-people or
// --by-robots (body_fit.h), and a drive without operands (drive_fit.h). Cameras follow lasers, as
// they are placed by the people that lasers see.
//
// Operands and outputs are checked before a room or layout is read, and the log follows. The
// product is the layout with new poses, rounded to nine decimals, and a line of history for each
// sensor with its covariance; sensors that the log does not show keep theirs, with a warning. A
// laser that does not fit the room fails the run; a camera that cannot be placed does not.
#include "extensions/calibration/calibrate.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/confined.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "extensions/calibration/body_fit.h"
#include "extensions/calibration/camera_fit.h"
#include "extensions/calibration/drive_fit.h"
#include "extensions/calibration/occupancy.h"
#include "extensions/calibration/plan_fit.h"
#include "extensions/reality/log.h"
#include "raster/picture.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "sense/scan.h"

namespace ispace::calibration {

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kKnees = 0.65;  // metres

/// A fixed laser and its scans in the log.
struct CalibratedLaser {
    WatchingLaser seen;  ///< with the beams of the log
    Record record;
    PlanFit fit = {};
};

/// A fixed camera, and what the log shows of it.
struct CalibratedCamera {
    Sensor sensor;
    Record record;
    std::vector<const reality::LogPicture*> pictures = {};
    CameraFit fit = {};
    std::string refusal = {};  ///< why its pose stays; "" for a camera with a fit
};

/// Returns true if a source of a log is the sensor: by its id, or by a topic with it, "/l1/scan".
bool isSource(const std::string& source, const std::string& id) {
    return source == id || ('/' + source + '/').find('/' + id + '/') != std::string::npos;
}

/// Returns the scans of each source.
std::map<std::string, std::vector<reality::LogScan*>> scansBySource(reality::Log& log) {
    std::map<std::string, std::vector<reality::LogScan*>> sources;
    for (reality::LogScan& scan : log.scans) sources[scan.sensor].push_back(&scan);
    return sources;
}

/// Takes over the beams that the log states, and the scans. \throws FormatError
void takeScans(const std::string& log, std::span<reality::LogScan* const> scans,
               CalibratedLaser& laser) {
    const reality::LogScan& first = *scans.front();
    const std::size_t beams = first.ranges.size();
    auto& model = laser.seen.sensor.as<Laser>();
    model.first = first.first;
    model.step = first.step;
    model.beams = static_cast<int>(beams);
    if (std::isfinite(first.max_range) && first.max_range > 0) model.max_range = first.max_range;
    for (reality::LogScan* scan : scans) {
        if (scan->poses.corrected || scan->poses.odometry)
            throw FormatError(Diagnostic{
                displayName(log), 0, 0,
                "the sensor " + scan->sensor + " moves: --calibrate is about fixed lasers"});
        if (scan->ranges.size() != beams || scan->first != first.first)
            throw FormatError(Diagnostic{displayName(log), 0, 0,
                                         "scans of " + scan->sensor + " have different beams"});
        laser.seen.times.push_back(scan->time);
        laser.seen.scans.push_back(std::move(scan->ranges));
    }
}

/// Returns the fixed sensors of a keyword in a scene, with their records.
std::vector<std::pair<Sensor, Record>> fixedSensors(const Scene& scene, std::string_view keyword) {
    std::vector<std::pair<Sensor, Record>> sensors;
    for (const PlacedRecord& placed : scene.placed) {
        const Record& record = scene.records[placed.record];
        if (record.keyword() != keyword || placed.mount) continue;
        const Sensor& sensor = scene.sensors[placed.index];
        if (!sensor.mount && !sensor.person) sensors.emplace_back(sensor, record);
    }
    return sensors;
}

/// Returns those of a layout alone, without its room.
std::vector<std::pair<Sensor, Record>> fixedSensors(const Document& layout,
                                                    std::string_view keyword) {
    std::vector<std::pair<Sensor, Record>> sensors;
    const std::vector<std::string> ids = assignIds(layout.records);
    const DeviceCatalogue& devices = devicesFor({&layout});
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const Record& record = layout.records[i];
        if (record.keyword() == keyword && !record.has("on"))
            sensors.emplace_back(Sensor{ids[i], sensorModelOf(record, devices), poseOf(record)},
                                 record);
    }
    return sensors;
}

/// Returns the fixed lasers of a scene or a layout that do not sweep.
template <typename Source>
std::vector<CalibratedLaser> fixedLasers(const Source& source) {
    std::vector<CalibratedLaser> lasers;
    for (auto& [sensor, record] : fixedSensors(source, "laser"))
        if (sensor.template as<Laser>().sweep == SweepAxis::None)
            lasers.push_back({{std::move(sensor), {}, {}}, std::move(record)});
    return lasers;
}

/// Returns the fixed cameras that the log has pictures of. If it has any, warns of cameras without
/// pictures and of pictures without a camera.
template <typename Source>
std::vector<CalibratedCamera> fixedCameras(const TaskInput& task, const Source& source,
                                           const reality::Log& log) {
    std::map<std::string, std::vector<const reality::LogPicture*>> pictures;
    for (const reality::LogPicture& picture : log.pictures)
        pictures[picture.sensor].push_back(&picture);
    std::vector<CalibratedCamera> cameras;
    if (pictures.empty()) return cameras;
    auto fixed = fixedSensors(source, "camera");
    // As with lasers, one camera and one source need no common name.
    const bool is_one = fixed.size() == 1 && pictures.size() == 1;
    for (auto& [sensor, record] : fixed) {
        const auto found = std::find_if(
            pictures.begin(), pictures.end(),
            [&id = sensor.id, is_one](auto& one) { return is_one || isSource(one.first, id); });
        if (found == pictures.end()) {
            warn(task.common, "envc",
                 "the log has no pictures of " + sensor.id + ": its pose stays");
            continue;
        }
        cameras.push_back({std::move(sensor), std::move(record), std::move(found->second)});
        pictures.erase(found);
    }
    for (const auto& [name, unused] : pictures)
        warn(task.common, "envc",
             "pictures of " + printable(name) + " are of no fixed camera of the layout");
    return cameras;
}

/// Pairs fixed lasers with the sources of a log.
class LaserPairs {
  public:
    LaserPairs(const TaskInput& task, reality::Log& log) : task_(task), log_(log) {}

    /// Returns those of the lasers that the log has scans of.
    std::vector<CalibratedLaser> of(std::vector<CalibratedLaser> lasers) {
        auto sources = scansBySource(log_);
        const std::size_t all = lasers.size();
        for (CalibratedLaser& laser : lasers) {
            const auto found = std::find_if(sources.begin(), sources.end(), [&](const auto& one) {
                // One laser and one source need no common name.
                return isSource(one.first, laser.seen.sensor.id) ||
                       (all == 1 && sources.size() == 1);
            });
            if (found == sources.end()) continue;
            takeScans(log_.name, found->second, laser);
            sources.erase(found);
        }
        if (std::all_of(lasers.begin(), lasers.end(),
                        [](const CalibratedLaser& laser) { return laser.seen.scans.empty(); }))
            refuse(lasers, sources);
        for (const CalibratedLaser& laser : lasers)
            if (laser.seen.scans.empty())
                warn(task_.common, "envc",
                     "the log has no scans of " + laser.seen.sensor.id + ": its pose stays");
        for (const auto& [source, scans] : sources)
            warn(task_.common, "envc",
                 "scans of " + printable(source) + " are of no fixed laser of the layout");
        std::erase_if(lasers,
                      [](const CalibratedLaser& laser) { return laser.seen.scans.empty(); });
        return lasers;
    }

  private:
    [[noreturn]] void refuse(
        const std::vector<CalibratedLaser>& lasers,
        const std::map<std::string, std::vector<reality::LogScan*>>& sources) const {
        std::vector<std::string> ids, names;
        for (const CalibratedLaser& laser : lasers) ids.push_back(laser.seen.sensor.id);
        for (const auto& [source, scans] : sources) names.push_back(printable(source));
        throw FormatError(Diagnostic{
            displayName(log_.name), 0, 0,
            ids.empty() ? "the layout has no fixed laser"
            : names.empty()
                ? "the log has no scans of lasers"
                : "no scans of " + listOf(ids) + "; the log has those of " + listOf(names)});
    }

    const TaskInput& task_;
    reality::Log& log_;
};

double sigmaOf(const PlanCovariance& covariance, std::size_t axis) {
    return std::sqrt(covariance[axis][axis]);
}

std::string sigmaText(double sigma, int decimals, double factor, const char* unit) {
    return std::isinf(sigma) ? "unknown" : formatFixed(factor * sigma, decimals) + unit;
}

/// "x 0.03 mm, y unknown, heading 0.0004 deg".
std::string sigmasText(const PlanFit& fit) {
    return "x " + sigmaText(sigmaOf(fit.covariance, 0), 3, 1e3, " mm") + ", y " +
           sigmaText(sigmaOf(fit.covariance, 1), 3, 1e3, " mm") + ", heading " +
           sigmaText(sigmaOf(fit.covariance, 2), 4, kDegrees, " deg");
}

std::string poseText(const Pose3& pose) {
    return placeText(pose.position.onFloor()) + " heading " +
           formatFixed(pose.heading.degrees(), 1) + " deg";
}

/// "l1: moved by 0.361 m and -5.00 deg".
std::string movedText(const CalibratedLaser& laser) {
    const Pose3 &before = laser.seen.sensor.pose, &after = laser.fit.pose;
    const double moved = distance(before.position.onFloor(), after.position.onFloor());
    const double turned = wrapped(after.heading - before.heading).degrees();
    return laser.seen.sensor.id + ": moved by " + formatFixed(moved, 3) + " m and " +
           formatFixed(turned, 2) + " deg";
}

/// Reports a laser on stderr.
void report(const TaskInput& task, const CalibratedLaser& laser) {
    const PlanFit& fit = laser.fit;
    report(task.common, "envc",
           movedText(laser) + " by " + countText(fit.scans, "scan") + "; standard deviations " +
               sigmasText(fit) + "; " + formatFixed(100 * fit.inliers, 0) + " % of " +
               std::to_string(fit.beams) + " beams within " + formatFixed(kPlanInlier, 1) +
               " m of the plan");
    for (const FreeMotion& motion : fit.unknown)
        warn(task.common, "envc",
             laser.seen.sensor.id + ": the scans are equal for all poses " + motion.text(fit.pose) +
                 "; that of the layout is kept in this respect");
    constexpr std::size_t kMost = 3;
    for (std::size_t i = 0; i < std::min(kMost, fit.equals.size()); ++i)
        warn(task.common, "envc",
             laser.seen.sensor.id + ": the pose " + poseText(fit.equals[i]) +
                 " is as likely; the one next to that of the layout is taken" +
                 (i + 1 == kMost && fit.equals.size() > kMost
                      ? ", and so are " + std::to_string(fit.equals.size() - kMost) + " more"
                      : ""));
}

/// Upper triangle of a covariance, row by row.
std::vector<double> upperTriangle(const PlanCovariance& covariance) {
    std::vector<double> values;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = i; j < 3; ++j) values.push_back(covariance[i][j]);
    return values;
}

/// The line of the layout's history about a laser.
std::string historyOf(const CalibratedLaser& laser) {
    const PlanFit& fit = laser.fit;
    std::string line = "calibrated " + laser.seen.sensor.id + " by " +
                       countText(fit.scans, "scan") +
                       ": covariance of x, y (m), heading (rad), upper triangle:";
    for (const double value : upperTriangle(fit.covariance))
        line += std::isinf(value) ? " inf" : ' ' + formatDouble(roundSignificant(value, 4));
    for (const FreeMotion& motion : fit.unknown)
        line += "; not determined " + motion.text(fit.pose);
    if (!fit.equals.empty()) line += "; other poses are as likely";
    return line;
}

void addPose(JsonWriter& json, const Pose3& pose) {
    json.key("at").beginArray();
    json.value(pose.position.x).value(pose.position.y).value(pose.position.z).endArray();
    json.key("heading").value(wrapped(pose.heading).degrees());
}

void addCovariance(JsonWriter& json, const PlanCovariance& covariance) {
    json.key("covariance").beginArray();
    for (const auto& row : covariance) {
        json.beginArray();
        for (const double value : row) json.value(value);
        json.endArray();
    }
    json.endArray();
}

void addCameras(JsonWriter& json, std::span<const CalibratedCamera> cameras);

std::string calibrationJson(std::span<const CalibratedLaser> lasers,
                            std::span<const CalibratedCamera> cameras) {
    JsonWriter json;
    beginReport(json, "ispace-calibration/1", "envc").key("sensors").beginArray();
    for (const CalibratedLaser& laser : lasers) {
        const PlanFit& fit = laser.fit;
        json.beginObject().key("id").value(laser.seen.sensor.id);
        addPose(json, fit.pose);
        addCovariance(json, fit.covariance);
        json.key("scans").value(fit.scans).key("beams").value(fit.beams);
        json.key("inliers").value(fit.inliers).key("sigma").value(fit.sigma);
        json.key("unknown").beginArray();
        for (const FreeMotion& motion : fit.unknown)
            json.value(std::vector<double>{motion.x, motion.y, motion.turn});
        json.endArray().key("equals").beginArray();
        for (const Pose3& pose : fit.equals) {
            json.beginObject();
            addPose(json, pose);
            json.endObject();
        }
        json.endArray().endObject();
    }
    json.endArray();
    addCameras(json, cameras);
    return json.endObject().take() + '\n';
}

/// Returns the record of a sensor in the layout; the record of ENV is added there.
Record& recordIn(Document& layout, const Record& source, const std::string& id) {
    auto found =
        std::find_if(layout.records.begin(), layout.records.end(), [&source](const Record& record) {
            return record == source && record.place().line == source.place().line &&
                   record.place().column == source.place().column;
        });
    if (found == layout.records.end()) {
        found = layout.records.insert(found, source);
        if (found->writtenId().empty()) found->set("id", id);
    }
    return *found;
}

/// Writes the pose of a laser into its record in the layout, or adds the record of ENV there.
void setPose(const CalibratedLaser& laser, Document& layout) {
    Record* const found = &recordIn(layout, laser.record, laser.seen.sensor.id);
    const Pose3& pose = laser.fit.pose;
    Tuple at{nineDecimals(pose.position.x), nineDecimals(pose.position.y)};
    if (found->has("at") && found->tuple("at").size() == 3) at.push_back(found->tuple("at")[2]);
    found->set("at", at);
    found->set("heading", nineDecimals(wrapped(pose.heading).degrees()));
}

/// The same of lasers by people.
std::string peopleJson(std::span<const CalibratedLaser> lasers, const BodyFit& fit,
                       const BodyTarget& target, std::span<const CalibratedCamera> cameras) {
    JsonWriter json;
    beginReport(json, "ispace-calibration/1", "envc").key("sensors").beginArray();
    for (std::size_t i = 0; i < lasers.size(); ++i) {
        json.beginObject().key("id").value(lasers[i].seen.sensor.id);
        addPose(json, fit.poses[i]);
        addCovariance(json, fit.covariances[i]);
        json.key("scans").value(lasers[i].seen.scans.size());
        json.key("legs").value(fit.legs[i]).endObject();
    }
    json.endArray().key(target.isPerson() ? "people" : "robots").beginObject();
    if (target.isPerson()) {
        json.key("height").value(fit.height).key("height_sigma").value(fit.height_sigma);
    } else {
        json.key("radius").value(fit.radius).key("radius_sigma").value(fit.radius_sigma);
    }
    json.key("moments").value(fit.moments).key("scatter").value(fit.scatter).endObject();
    addCameras(json, cameras);
    return json.endObject().take() + '\n';
}

/// Reports the lasers on stderr, and adds them to the layout.
void takePeople(const TaskInput& task, const BodyFit& fit, const BodyTarget& target,
                std::vector<CalibratedLaser>& lasers, Document& layout) {
    const std::string bodies =
        target.isPerson() ? "people of " + formatFixed(fit.height, 2) + " m (+- " +
                                formatFixed(fit.height_sigma, 2) + " m by the size of their legs)"
                          : "robots with a radius of " + formatFixed(fit.radius, 4) + " m (+- " +
                                formatFixed(fit.radius_sigma, 4) + " m)";
    report(task.common, "envc",
           bodies + " at " + std::to_string(fit.moments) + " moments; the pose of " +
               lasers[0].seen.sensor.id + " is that of the layout, the others stand to it");
    for (std::size_t i = 1; i < lasers.size(); ++i) {
        CalibratedLaser& laser = lasers[i];
        laser.fit.pose = fit.poses[i];
        laser.fit.covariance = fit.covariances[i];
        laser.fit.scans = laser.seen.scans.size();
        report(task.common, "envc",
               movedText(laser) + " by " +
                   countText(fit.legs[i], target.isPerson() ? "leg" : "robot") +
                   "; standard deviations " + sigmasText(laser.fit));
        setPose(laser, layout);
        layout.history.push_back(historyOf(laser));
    }
}

/// Returns what the pictures of a camera show, and where lasers saw people meanwhile.
std::vector<PictureMoment> momentsOf(const CalibratedCamera& camera,
                                     std::span<const SeenPerson> people, const std::string& log) {
    // At most so many pictures, over the whole time: more tell little more.
    constexpr std::size_t kMost = 600;
    const auto& all = camera.pictures;
    const std::size_t count = std::min(kMost, all.size());
    const auto numbered = [&](std::size_t i) { return all[i * all.size() / count]; };
    ConfinedReader reader;
    const auto& model = camera.sensor.as<Camera>();
    const auto bodies = bodiesInPictures(count, [&](std::size_t i) {
        const reality::LogPicture& picture = *numbered(i);
        const std::string name = picture.file.empty()
                                     ? displayName(log) + ", " + camera.sensor.id + " at " +
                                           formatDouble(picture.time) + " s"
                                     : picture.file;
        ColorPicture color = parseColorPicture(
            picture.file.empty() ? picture.bytes : readAll(picture.file, InputKind::Regular), name,
            reader);
        if (color.width != model.columns || color.height != model.rows)
            throw FormatError({name, 0, 0,
                               "the picture has " + std::to_string(color.width) + " x " +
                                   std::to_string(color.height) + " pixels, and " +
                                   camera.sensor.id + " has " + std::to_string(model.columns) +
                                   " x " + std::to_string(model.rows) + " by its record"});
        return color;
    });
    std::vector<PictureMoment> moments;
    moments.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        moments.push_back({peopleAt(people, numbered(i)->time), bodies[i]});
    return moments;
}

/// Writes the pose of a camera into its record in the layout, or adds the record of ENV there.
void setPose(const CalibratedCamera& camera, Document& layout) {
    Record& record = recordIn(layout, camera.record, camera.sensor.id);
    const Pose3& pose = camera.fit.pose;
    record.set("at", Tuple{nineDecimals(pose.position.x), nineDecimals(pose.position.y),
                           nineDecimals(pose.position.z)});
    record.set("heading", nineDecimals(wrapped(pose.heading).degrees()));
    record.set("tilt", nineDecimals(wrapped(pose.tilt).degrees()));
    record.set("roll", nineDecimals(wrapped(pose.roll).degrees()));
}

/// Reports a camera with a fit on stderr.
void report(const TaskInput& task, const CalibratedCamera& camera) {
    const CameraFit& fit = camera.fit;
    const auto sigma = [&fit](std::size_t a, std::size_t b, std::size_t c) {
        return std::sqrt(fit.covariance[a][a] + fit.covariance[b][b] + fit.covariance[c][c]);
    };
    report(task.common, "envc",
           camera.sensor.id + ": moved by " +
               formatFixed(length(fit.pose.position - camera.sensor.pose.position), 3) + " m by " +
               countText(fit.pictures, "picture") + "; standard deviations " +
               formatFixed(1000 * sigma(0, 1, 2), 1) + " mm and " +
               formatFixed(kDegrees * sigma(3, 4, 5), 3) + " deg; outlines of people " +
               formatFixed(fit.height.mean, 2) + " m high within " + formatFixed(fit.pixels, 1) +
               " pixels");
}

/// The line of the layout's history about a camera.
std::string historyOf(const CalibratedCamera& camera) {
    std::string line = "calibrated " + camera.sensor.id + " by " +
                       countText(camera.fit.pictures, "picture") +
                       ": covariance of x, y, z (m), turn about x, y, z (rad), upper triangle:";
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = i; j < 6; ++j)
            line += ' ' + formatDouble(roundSignificant(camera.fit.covariance[i][j], 4));
    return line;
}

/// Estimates the poses of cameras by people that lasers at known poses see, reports them on stderr
/// and adds them to the layout. Cameras that cannot be placed get a refusal and keep their poses.
/// \param lasers at their poses, those that see legs
/// \throws FormatError for pictures that cannot be read or are of another size
void calibrateCameras(const TaskInput& task, std::span<const WatchingLaser> lasers,
                      const PeopleHeight& height, const reality::Log& log,
                      std::vector<CalibratedCamera>& cameras, Document& layout) {
    if (cameras.empty()) return;
    const std::vector<SeenPerson> people = peopleSeen(lasers, height.mean);
    for (CalibratedCamera& camera : cameras) {
        try {
            if (lasers.empty())
                throw FormatError({"", 0, 0,
                                   "no level laser below " + formatFixed(kKnees, 2) +
                                       " m shows the legs of people, by which " + camera.sensor.id +
                                       " is placed"});
            camera.fit = fitToPictures(camera.sensor, momentsOf(camera, people, log.name), height);
        } catch (const FormatError& error) {
            const Diagnostic& first = error.diagnostics().front();
            if (!first.file.empty()) throw;
            camera.refusal = first.message;
            warn(task.common, "envc", camera.refusal + "; its pose stays");
            continue;
        }
        report(task, camera);
        setPose(camera, layout);
        layout.history.push_back(historyOf(camera));
    }
}

/// Adds the cameras that keep their poses.
void addRefusals(JsonWriter& json, std::span<const CalibratedCamera> cameras) {
    json.key("unplaced").beginArray();
    for (const CalibratedCamera& camera : cameras) {
        if (camera.refusal.empty()) continue;
        json.beginObject().key("id").value(camera.sensor.id);
        json.key("reason").value(camera.refusal).endObject();
    }
    json.endArray();
}

void addCameras(JsonWriter& json, std::span<const CalibratedCamera> cameras) {
    if (cameras.empty()) return;
    json.key("cameras").beginArray();
    for (const CalibratedCamera& camera : cameras) {
        if (!camera.refusal.empty()) continue;
        const CameraFit& fit = camera.fit;
        json.beginObject().key("id").value(camera.sensor.id);
        addPose(json, fit.pose);
        json.key("tilt").value(wrapped(fit.pose.tilt).degrees());
        json.key("roll").value(wrapped(fit.pose.roll).degrees());
        json.key("covariance").beginArray();
        for (const auto& row : fit.covariance) {
            json.beginArray();
            for (const double value : row) json.value(value);
            json.endArray();
        }
        json.endArray().key("pictures").value(fit.pictures).key("pixels").value(fit.pixels);
        json.key("height").value(fit.height.mean);
        json.key("height_sigma").value(fit.height.sigma).endObject();
    }
    json.endArray();
    addRefusals(json, cameras);
}

std::string folderOf(const std::string& file) {
    return isStream(file) ? "" : std::filesystem::path(file).parent_path().string();
}

class Calibration final : public OptionGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Calibration");
        line.file(
            "--calibrate", "LOG", log_,
            "correct the poses of the fixed lasers of ENV LAYOUT by their scans in a log, and of "
            "cameras by the people that both see; of the drive of a robot: its wheels and "
            "laser, without operands",
            Enters::BaseName);
        line.flag("--by-people", by_people_,
                  "without a room: how the lasers of LAYOUT stand to the first one, by the people "
                  "that they see",
                  Enters::History);
        line.meters("--by-robots", robot_radius_, 0.03, 1,
                    "the same by round robots of about this radius", Enters::History);
    }
    [[nodiscard]] bool isAsked() const override { return !log_.empty(); }
    [[nodiscard]] std::span<const std::string_view> honours() const override {
        static constexpr std::string_view kOptions[] = {"--json"};
        return kOptions;
    }
    void take(const CommandLine& line) override {
        is_json_ = line.given("--json");
        if (by_people_ && robot_radius_)
            throw UsageError("--by-people and --by-robots exclude each other");
    }

    void run(const TaskInput& task) override {
        std::error_code ignored;
        if (!isStream(log_) && !std::filesystem::is_directory(log_, ignored))
            if (const std::string bytes = readAll(log_); isDrive(bytes))
                return writeDrive(task, bytes);
        std::vector<std::string> named = task.operands;
        named.push_back(log_);
        mustReadStdinOnce(named);
        if (by_people_ || robot_radius_)
            calibrateByBodies(task);
        else
            calibrateByPlan(task);
    }

  private:
    [[nodiscard]] std::string formatFor(const TaskInput& task, const std::string& usual) const {
        const std::string format = outputFormat({}, task.common.output, {usual, "json"});
        return is_json_ ? "json" : format;
    }

    void writeDrive(const TaskInput& task, const std::string& bytes) const {
        if (!task.operands.empty() || by_people_ || robot_radius_)
            throw UsageError("--calibrate with the drive of a robot takes no operand" +
                             std::string(by_people_ || robot_radius_ ? " and no " + byWhat() : ""));
        const std::string format = formatFor(task, "txt");
        claimOutputs(task.common);
        const DriveFit fit = fitDrive(readDrive(bytes, log_), log_);
        writeAll(task.common.output, format == "json" ? driveJson(fit) : driveText(fit));
        writeDependencies(task.common, std::vector<std::string>{log_});
    }

    /// Returns the layout as the product begins.
    [[nodiscard]] static Document productOf(const TaskInput& task, Document layout,
                                            const std::string& operand) {
        rebaseFiles(layout.records, folderOf(operand), folderOf(task.common.output));
        std::erase_if(layout.records,
                      [](const Record& record) { return record.keyword() == "result"; });
        layout.history.push_back(task.history_line);
        return layout;
    }

    void calibrateByPlan(const TaskInput& task) const {
        if (task.operands.empty() || task.operands.size() > 2)
            throw UsageError("--calibrate wants ENV LAYOUT, or a LAYOUT that names its ENV");
        const std::string format = formatFor(task, "3dm");
        claimOutputs(task.common);
        SceneRequest request{task.operands, task.rules};
        request.layout_from_stdin = false;
        const SceneInput input = readScene(request);
        warnOfImport(task.common, "envc", input);
        if (!input.layout) throw UsageError("--calibrate corrects a LAYOUT, and no operand is one");
        reality::Log log = reality::readLog(log_, reality::LogPictures::Keep);
        std::vector<CalibratedLaser> lasers = LaserPairs(task, log).of(fixedLasers(input.scene));
        std::vector<CalibratedCamera> cameras = fixedCameras(task, input.scene, log);
        Document layout = productOf(task, *input.layout, input.layout_operand);
        Diagnostics findings;
        for (CalibratedLaser& laser : lasers) {
            try {
                laser.fit = fitToPlan(input.scene.environment, laser.seen.sensor, laser.seen.scans);
            } catch (const FormatError& error) {
                for (Diagnostic one : error.diagnostics()) {
                    if (one.file.empty()) one.file = displayName(log_);
                    findings.add(std::move(one));
                }
                continue;
            }
            report(task, laser);
            setPose(laser, layout);
            layout.history.push_back(historyOf(laser));
        }
        findings.throwIfAny();
        calibrateCameras(task, legLasers(lasers), {}, log, cameras, layout);
        writeAll(task.common.output,
                 format == "json" ? calibrationJson(lasers, cameras) : writeRecordText(layout));
        std::vector<std::string> files = filesOf(input);
        files.insert(files.end(), log.files.begin(), log.files.end());
        writeDependencies(task.common, files);
    }

    [[nodiscard]] std::string byWhat() const {
        return robot_radius_ ? "--by-robots" : "--by-people";
    }

    void calibrateByBodies(const TaskInput& task) const {
        const BodyTarget target{robot_radius_.value_or(0)};
        if (task.operands.size() != 1)
            throw UsageError(byWhat() + " wants one operand, a LAYOUT: it needs no room");
        const std::string format = formatFor(task, "3dm");
        claimOutputs(task.common);
        ImportOptions import;
        import.load_files = false;
        const Document read = readDocument(task.operands[0], import, sceneSchemas());
        if (read.kind != DocumentKind::Layout)
            throw UsageError(byWhat() + " wants a LAYOUT, and " + displayName(task.operands[0]) +
                             " is none");
        reality::Log log = reality::readLog(
            log_, target.isPerson() ? reality::LogPictures::Keep : reality::LogPictures::Skip);
        std::vector<CalibratedLaser> lasers = LaserPairs(task, log).of(fixedLasers(read));
        std::vector<CalibratedCamera> cameras = fixedCameras(task, read, log);
        std::vector<WatchingLaser> seen;
        seen.reserve(lasers.size());
        for (const CalibratedLaser& laser : lasers) seen.push_back(laser.seen);
        Document layout = productOf(task, read, task.operands[0]);
        const BodyFit fit = [&] {
            try {
                return fitToBodies(seen, target);
            } catch (const FormatError& error) {
                throw FormatError(
                    Diagnostic{displayName(log_), 0, 0, error.diagnostics().front().message});
            }
        }();
        takePeople(task, fit, target, lasers, layout);
        for (std::size_t i = 0; i < seen.size(); ++i) seen[i].sensor.pose = fit.poses[i];
        calibrateCameras(task, seen, {fit.height, std::max(fit.height_sigma, 0.02)}, log, cameras,
                         layout);
        writeAll(task.common.output, format == "json" ? peopleJson(lasers, fit, target, cameras)
                                                      : writeRecordText(layout));
        std::vector<std::string> files{task.operands[0]};
        files.insert(files.end(), log.files.begin(), log.files.end());
        writeDependencies(task.common, files);
    }

    /// Returns the lasers of a room that see legs, at their poses.
    [[nodiscard]] static std::vector<WatchingLaser> legLasers(
        std::span<const CalibratedLaser> lasers) {
        std::vector<WatchingLaser> seeing;
        for (const CalibratedLaser& laser : lasers) {
            if (!scansSlice(laser.seen.sensor) || laser.seen.sensor.pose.position.z > kKnees)
                continue;
            seeing.push_back(laser.seen);
            seeing.back().sensor.pose = laser.fit.pose;
        }
        return seeing;
    }

    std::string log_;
    std::optional<double> robot_radius_;
    bool is_json_ = false, by_people_ = false;
};

}  // namespace

std::unique_ptr<OptionGroup> makeCalibration() { return std::make_unique<Calibration>(); }

std::span<const Importer> calibrationImporters() {
    static constexpr Importer kRows[] = {importer<reality::isLog, readLogRoom>("")};
    return kRows;
}

}  // namespace ispace::calibration
