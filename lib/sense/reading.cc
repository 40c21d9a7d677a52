// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

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

}  // namespace

struct ReadingSampler::Data {
    const Sensors& sensors;
    Worlds& worlds;
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

    // Preparations and readings of each kind of sensor.
    void prepare(const Laser& laser, const ReadingJob& job);
    void prepare(const Ranger& /*ranger*/, const ReadingJob& /*job*/) { worlds.prepareMesh(); }
    void prepare(const Tag& /*tag*/, const ReadingJob& /*job*/) {
        worlds.prepareMesh(Surfaces::Solid);
    }
    Reading take(const Laser& laser, const ReadingJob& job);
    Reading take(const Ranger& ranger, const ReadingJob& job);
    Reading take(const Tag& tag, const ReadingJob& job);
    // Receivers have no readings; they hear tags.
    void prepare(const Receiver& /*receiver*/, const ReadingJob& /*job*/) {}
    static Reading take(const Receiver& /*receiver*/, const ReadingJob& /*job*/) { return {}; }
    void prepare(const Camera& /*camera*/, const ReadingJob& /*job*/) {}
    Reading take(const Camera& camera, const ReadingJob& job);
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

Reading ReadingSampler::Data::take(const Laser& laser, const ReadingJob& job) {
    std::vector<Scan> scans = scansOf(laser, job);
    LaserCaster& caster = casterOf(job.sensor);
    for (Scan& scan : scans) caster.cast(scan);
    return scans;
}

Reading ReadingSampler::Data::take(const Ranger& /*ranger*/, const ReadingJob& job) {
    const Pose3 pose = job.way.empty() ? job.pose : poseAlong(job.way, job.time);
    DepthFrame frame = castDepth(worlds.mesh(), bodies, sensors.read[job.sensor], pose, job.frame,
                                 {options.noise_seed});
    frame.time = job.time;
    return frame;
}

Reading ReadingSampler::Data::take(const Tag& /*tag*/, const ReadingJob& job) {
    return castBurst(worlds.mesh(Surfaces::Solid), bodies, sensors.read[job.sensor],
                     sensors.receivers, job.frame, job.time, {options.celsius, options.noise_seed});
}

Reading ReadingSampler::Data::take(const Camera& /*camera*/, const ReadingJob& job) {
    const Pose3 pose = job.way.empty() ? job.pose : poseAlong(job.way, job.time);
    Photo photo = options.photographer->take(sensors.read[job.sensor], pose, job.frame);
    photo.time = job.time;
    return photo;
}

ReadingSampler::ReadingSampler(const Sensors& sensors, Worlds& worlds, const MovingBodies& bodies,
                               const TakerOptions& options)
    : data_(std::make_unique<Data>(Data{sensors, worlds, bodies, options, {}})) {}
ReadingSampler::~ReadingSampler() = default;

void ReadingSampler::prepare(const ReadingJob& job) {
    std::visit([&](const auto& model) { data_->prepare(model, job); },
               data_->sensors.read[job.sensor].model);
}

Reading ReadingSampler::take(const ReadingJob& job) {
    return std::visit([&](const auto& model) { return data_->take(model, job); },
                      data_->sensors.read[job.sensor].model);
}

}  // namespace ispace
