// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading.h"

#include <fnmatch.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "base/error.h"
#include "base/number.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

bool matches(const std::string& id, const std::vector<std::string>& globs) {
    return globs.empty() || std::any_of(globs.begin(), globs.end(), [&](const std::string& glob) {
               return fnmatch(glob.c_str(), id.c_str(), 0) == 0;
           });
}

/// Copies the sensors of one kind that are wanted, and says where each is in the scene's list.
template <typename Placed>
std::vector<Placed> chosen(const std::vector<Placed>& all, const std::vector<std::string>& globs) {
    std::vector<Placed> out;
    for (const Placed& sensor : all)
        if (matches(sensor.id, globs)) out.push_back(sensor);
    return out;
}

void checkGlobs(const Scene& scene, const std::vector<std::string>& globs) {
    for (const std::string& glob : globs) {
        const bool known = std::any_of(
            scene.placed.begin(), scene.placed.end(),
            [&](const Placed& placed) { return matches(scene.ids[placed.record], {glob}); });
        if (known) continue;
        std::string ids;
        for (const Placed& placed : scene.placed) {
            const std::string& keyword = scene.records[placed.record].keyword();
            if (keyword != "laser" && keyword != "ranger" && keyword != "tag") continue;
            ids.append(ids.empty() ? "" : ", ").append(scene.ids[placed.record]);
        }
        throw UsageError("no sensor matches `" + glob + "`" +
                         (ids.empty() ? "" : " (there are " + ids + ")"));
    }
}

}  // namespace

const std::string& Sensors::id(const Entry& entry) const {
    switch (entry.kind) {
        case SensorKind::Laser:
            return lasers[entry.index].id;
        case SensorKind::Ranger:
            return rangers[entry.index].id;
        case SensorKind::Tag:
            break;
    }
    return tags[entry.index].id;
}

const Pose3& Sensors::pose(const Entry& entry) const {
    switch (entry.kind) {
        case SensorKind::Laser:
            return lasers[entry.index].pose;
        case SensorKind::Ranger:
            return rangers[entry.index].pose;
        case SensorKind::Tag:
            break;
    }
    return tags[entry.index].pose;
}

double Sensors::rate(const Entry& entry) const {
    switch (entry.kind) {
        case SensorKind::Laser: {
            const Laser& laser = lasers[entry.index].laser;
            return laser.rate / laser.scans();
        }
        case SensorKind::Ranger:
            return rangers[entry.index].ranger.rate;
        case SensorKind::Tag:
            break;
    }
    return tags[entry.index].tag.rate;
}

Sensors sensorsOf(const Scene& scene, const std::vector<std::string>& globs) {
    checkGlobs(scene, globs);
    Sensors sensors;
    sensors.lasers = chosen(scene.lasers, globs);
    sensors.rangers = chosen(scene.rangers, globs);
    sensors.tags = chosen(scene.tags, globs);
    sensors.receivers = chosen(scene.receivers, globs);
    // A choice of tags alone is not a choice of receivers.
    if (sensors.receivers.empty()) sensors.receivers = scene.receivers;
    Sensors::Entry laser{SensorKind::Laser, 0}, ranger{SensorKind::Ranger, 0},
        tag{SensorKind::Tag, 0};
    for (const Placed& placed : scene.placed) {
        if (!matches(scene.ids[placed.record], globs)) continue;
        const std::string& keyword = scene.records[placed.record].keyword();
        Sensors::Entry* const next = keyword == "laser"    ? &laser
                                     : keyword == "ranger" ? &ranger
                                     : keyword == "tag"    ? &tag
                                                           : nullptr;
        if (next == nullptr) continue;
        sensors.order.push_back(*next);
        ++next->index;
    }
    return sensors;
}

std::vector<std::size_t> sensorRecords(const Scene& scene, std::span<const std::string_view> kinds,
                                       const std::vector<std::string>& globs) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < scene.records.size(); ++i)
        if (std::find(kinds.begin(), kinds.end(), scene.records[i].keyword()) != kinds.end() &&
            matches(scene.ids[i], globs))
            found.push_back(i);
    return found;
}

namespace {

/// Strictly inside a solid, and farther from its edge than what touches it.
bool isInside(const Slice& slice, Point2 place) {
    return std::any_of(slice.solids.begin(), slice.solids.end(), [&](const Polygon& solid) {
        if (locate(solid, place) != Side::Inside) return false;
        bool deep = true;
        forEachEdge(solid, [&](const Segment2& edge) {
            deep = deep && distance(nearestPoint(edge, place), place) > kContact;
        });
        return deep;
    });
}

}  // namespace

std::vector<std::string> doubtsAbout(const Scene& scene, const Sensors& sensors) {
    std::vector<std::string> doubts;
    for (const PendingLaser& laser : scene.pending)
        doubts.push_back(laser.id +
                         " has no place and is left out: give it `at` or `on`, or let arrange "
                         "place it");
    std::map<double, Slice> slices;
    for (const Sensors::Entry& entry : sensors.order) {
        const Point3 place = sensors.pose(entry).position;
        const auto [slice, is_new] = slices.try_emplace(place.z);
        if (is_new) slice->second = scene.environment.slice(place.z);
        if (isInside(slice->second, place.onFloor()))
            doubts.push_back(sensors.id(entry) + " stands inside something solid at " +
                             formatDouble(place.x) + "," + formatDouble(place.y) + "," +
                             formatDouble(place.z) + " and sees its inner sides");
    }
    return doubts;
}

double durationOf(const Sensors& sensors, const Sensors::Entry& entry) {
    if (entry.kind != SensorKind::Laser) return 0;
    const Laser& laser = sensors.lasers[entry.index].laser;
    return laser.beamTime() * (laser.beams - 1) + (laser.scans() - 1) / laser.rate;
}

namespace {

Pose3 swept(Pose3 pose, SweepAxis axis, Angle by) {
    switch (axis) {
        case SweepAxis::Heading:
            pose.heading = pose.heading + by;
            break;
        case SweepAxis::Tilt:
            pose.tilt = pose.tilt + by;
            break;
        case SweepAxis::Roll:
            pose.roll = pose.roll + by;
            break;
        case SweepAxis::None:
            break;
    }
    return pose;
}

bool staysLevelAt(const Pose3& pose, double height) {
    return pose.isLevel() && pose.position.z == height;
}

/// The scans of a job, without their ranges.
std::vector<Scan> scansOf(const Laser& laser, const ReadingJob& job) {
    const int count = laser.scans();
    const double beam_time = laser.beamTime();
    const bool sweeps = laser.sweep != SweepAxis::None;
    std::vector<Scan> scans(static_cast<std::size_t>(count));
    for (int j = 0; j < count; ++j) {
        Scan& scan = scans[static_cast<std::size_t>(j)];
        scan.time = job.time + j / laser.rate;
        scan.frame = job.frame;
        scan.number = j;
        // Where it is `k` beams later; a sweep goes on meanwhile.
        const auto pose_at = [&](int k) {
            const double later = k * beam_time;
            const Pose3 carried =
                job.way.empty() ? job.pose : poseAlong(job.way, scan.time + later);
            return swept(carried, laser.sweep, (j + later * laser.rate) * laser.sweep_step);
        };
        scan.pose = pose_at(0);
        if (beam_time == 0 || (!sweeps && job.way.empty())) continue;
        scan.beam_poses.reserve(static_cast<std::size_t>(laser.beams));
        for (int k = 0; k < laser.beams; ++k) scan.beam_poses.push_back(pose_at(k));
    }
    return scans;
}

}  // namespace

struct ReadingTaker::Data {
    const Sensors& sensors;
    Worlds& worlds;
    const MovingBodies& bodies;
    TakerOptions options;
    /// A caster a laser, made when first needed, for each thread.
    using Casters = std::vector<std::unique_ptr<LaserCaster>>;
    tbb::enumerable_thread_specific<Casters> casters;

    LaserCaster& casterOf(std::size_t laser) {
        Casters& mine = casters.local();
        mine.resize(sensors.lasers.size());
        std::unique_ptr<LaserCaster>& caster = mine[laser];
        if (!caster) {
            const PlacedLaser& sensor = sensors.lasers[laser];
            const bool turns = options.follows_poses || sensor.mount.has_value();
            caster = std::make_unique<LaserCaster>(worlds, bodies, sensor, turns,
                                                   ReadingOptions{options.noise_seed});
        }
        return *caster;
    }
};

ReadingTaker::ReadingTaker(const Sensors& sensors, Worlds& worlds, const MovingBodies& bodies,
                           const TakerOptions& options)
    : data_(std::make_unique<Data>(Data{sensors, worlds, bodies, options, {}})) {}
ReadingTaker::~ReadingTaker() = default;

void ReadingTaker::prepare(const ReadingJob& job) {
    const Sensors::Entry& entry = data_->sensors.order[job.sensor];
    if (entry.kind != SensorKind::Laser) return data_->worlds.prepareMesh();
    const Laser& laser = data_->sensors.lasers[entry.index].laser;
    if (laser.sweep == SweepAxis::Tilt || laser.sweep == SweepAxis::Roll) {
        // One of its scans may be level.
        data_->worlds.prepare({job.pose.position, {}, {}, {}});
        data_->worlds.prepareMesh();
    }
    data_->worlds.prepare(job.pose);
    const double height = job.pose.position.z;
    if (std::any_of(job.way.begin(), job.way.end(),
                    [height](const TimedPose& timed) { return !staysLevelAt(timed.pose, height); }))
        data_->worlds.prepareMesh();
}

Reading ReadingTaker::take(const ReadingJob& job) {
    Data& d = *data_;
    const Sensors::Entry& entry = d.sensors.order[job.sensor];
    switch (entry.kind) {
        case SensorKind::Laser: {
            std::vector<Scan> scans = scansOf(d.sensors.lasers[entry.index].laser, job);
            LaserCaster& caster = d.casterOf(entry.index);
            for (Scan& scan : scans) caster.cast(scan);
            return scans;
        }
        case SensorKind::Ranger: {
            const Pose3 pose = job.way.empty() ? job.pose : poseAlong(job.way, job.time);
            DepthFrame frame = castDepth(d.worlds.mesh(), d.bodies, d.sensors.rangers[entry.index],
                                         pose, job.frame, {d.options.noise_seed});
            frame.time = job.time;
            return frame;
        }
        case SensorKind::Tag:
            break;
    }
    const UltrasoundOptions options{d.options.celsius, d.options.noise_seed};
    return castBurst(d.worlds.mesh(), d.bodies, d.sensors.tags[entry.index], d.sensors.receivers,
                     job.frame, job.time, options);
}

}  // namespace ispace
