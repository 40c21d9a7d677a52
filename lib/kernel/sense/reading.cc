// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <type_traits>

#include "sense/shared_results.h"

namespace ispace {

namespace {

bool staysLevelAt(const Pose3& pose, double height) {
    return pose.isLevel() && pose.position.z == height;
}

/// Returns the scans of a job, without their ranges.
std::vector<Scan> scansOf(const Laser& laser, const ReadingJob& job) {
    const int count = laser.scans();
    const bool sweeps = laser.sweep != SweepAxis::None;
    std::vector<Scan> scans(static_cast<std::size_t>(count));
    for (int j = 0; j < count; ++j) {
        Scan& scan = scans[static_cast<std::size_t>(j)];
        scan.time = j == 0 ? job.time : wholeNanoseconds(job.time + j / laser.rate);
        scan.frame = job.frame;
        scan.number = j;
        // Returns the pose some seconds later; a sweep continues meanwhile.
        const auto pose_at = [&](double later) {
            const Pose3 carried =
                job.way.empty() ? job.pose : poseAlong(job.way, scan.time + later);
            return sweptPose(laser, carried, j + later * laser.rate);
        };
        scan.pose = pose_at(0);
        if (laser.spin == 0 || (!sweeps && job.way.empty())) continue;
        scan.beam_poses.reserve(static_cast<std::size_t>(laser.beams));
        for (int k = 0; k < laser.beams; ++k) scan.beam_poses.push_back(pose_at(laser.timeOf(k)));
    }
    return scans;
}

DepthFrame readingOf(const Ranger& /*ranger*/, const Moment& now) {
    DepthFrame depths = castDepth(now.mesh(), now.bodies, now.sensor, now.pose, now.frame,
                                  {now.options.noise_seed});
    depths.time = now.time;
    return depths;
}

Burst readingOf(const Tag& /*tag*/, const Moment& now) {
    Sensor tag = now.sensor;
    tag.pose = now.pose;
    return castBurst(now.mesh(), now.bodies, tag, now.receivers, now.frame, now.time,
                     {now.options.celsius, now.options.noise_seed});
}

}  // namespace

ReadingValue valueOf(Reading reading) {
    return std::visit(
        [](auto& value) -> ReadingValue {
            if constexpr (std::is_same_v<decltype(value), std::vector<Scan>&>)
                return std::move(value.front());
            else
                return std::move(value);
        },
        reading);
}

void carryOn(const ReadingValue& before, ReadingValue& now) {
    std::visit(
        [&before](auto& value) {
            const auto* const last = std::get_if<std::remove_reference_t<decltype(value)>>(&before);
            if constexpr (requires { follow(value, value); })
                if (last != nullptr) follow(*last, value);
        },
        now);
}

bool isReadAtOnce(const SensorModel& model) {
    return rayCount(model) > 0 && !std::holds_alternative<Laser>(model) &&
           !std::holds_alternative<Camera>(model) && !std::holds_alternative<Receiver>(model);
}

Reading readAtOnce(const Moment& moment) {
    return std::visit(
        [&moment](const auto& model) -> Reading {
            // Lasers take time, cameras need light, receivers hear tags, movers press mats.
            if constexpr (requires { readingOf(model, moment); })
                return readingOf(model, moment);
            else
                return {};
        },
        moment.sensor.model);
}

struct ReadingSampler::Data {
    const Sensors& sensors;
    RayScenes& worlds;
    const MovingBodies& bodies;
    TakerOptions options;
    /// A caster per laser, created on first use, for each thread.
    using Casters = std::vector<std::unique_ptr<LaserCaster>>;
    tbb::enumerable_thread_specific<Casters> casters;

    LaserCaster& casterOf(std::size_t index) {
        Casters& mine = casters.local();
        mine.resize(sensors.read.size());
        std::unique_ptr<LaserCaster>& caster = mine[index];
        if (!caster) {
            const Sensor& sensor = sensors.read[index];
            const bool turns = options.follows_poses || sensor.mount.has_value();
            caster = std::make_unique<LaserCaster>(worlds, bodies, sensor, turns,
                                                   ReadingOptions{options.noise_seed});
        }
        return *caster;
    }

    void prepare(const Laser& laser, const ReadingJob& job);
};

void ReadingSampler::Data::prepare(const Laser& laser, const ReadingJob& job) {
    if (laser.sweep == SweepAxis::Tilt || laser.sweep == SweepAxis::Roll) {
        // One of its scans may be level.
        worlds.prepare({job.pose.position, {}, {}, {}});
        worlds.prepareMesh();
    }
    worlds.prepare(job.pose);
    const double height = job.pose.position.z;
    if (std::any_of(job.way.begin(), job.way.end(),
                    [height](const TimedPose& timed) { return !staysLevelAt(timed.pose, height); }))
        worlds.prepareMesh();
}

ReadingSampler::ReadingSampler(const Sensors& sensors, RayScenes& worlds,
                               const MovingBodies& bodies, const TakerOptions& options)
    : data_(std::make_unique<Data>(Data{sensors, worlds, bodies, options, {}})) {
    data_->options.shared = std::make_shared<SharedResults>();
}
ReadingSampler::~ReadingSampler() = default;

void ReadingSampler::prepare(const ReadingJob& job) {
    const SensorModel& model = data_->sensors.read[job.sensor].model;
    if (const auto* const laser = std::get_if<Laser>(&model)) data_->prepare(*laser, job);
    if (isReadAtOnce(model)) data_->worlds.prepareMesh(kindOf(model).stopped_by);
}

Reading ReadingSampler::take(const ReadingJob& job) {
    const Sensor& sensor = data_->sensors.read[job.sensor];
    const TakerOptions& options = data_->options;
    if (const auto* const laser = sensor.tryAs<Laser>()) {
        std::vector<Scan> scans = scansOf(*laser, job);
        LaserCaster& caster = data_->casterOf(job.sensor);
        for (Scan& scan : scans) caster.cast(scan);
        return scans;
    }
    const Pose3 pose = job.way.empty() ? job.pose : poseAlong(job.way, job.time);
    if (sensor.is<Camera>()) {
        Photo photo = options.photographer->take(sensor, pose, job.frame);
        photo.time = job.time;
        return photo;
    }
    return readAtOnce({sensor, pose, job.frame, job.time, data_->worlds, data_->bodies,
                       data_->sensors.receivers, options});
}

}  // namespace ispace
