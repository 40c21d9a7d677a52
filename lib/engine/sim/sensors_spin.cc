// SPDX-License-Identifier: GPL-3.0-or-later
// Scans of spinning lasers, beam after beam.
//
// Each beam has its own time. The carrier moves along an arc between stored moments of the trail,
// and the bodies that a beam meets are those of the nearer moment. Where no mover has moved since
// the scan began, and the laser does not sweep, all beams are cast at once.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/per_thread.h"
#include "sim/odometry.h"
#include "sim/sensor_scheduler.h"

namespace ispace {

namespace {

/// Returns the next step at or after a time.
SimTime atStep(SimTime time, SimTime step) { return (time + step - SimTime(1)) / step * step; }

void join(std::vector<BeamsAmong>& parts, const BeamsAmong& part) {
    if (part.begin == part.end) return;
    if (parts.empty() || parts.back().bodies != part.bodies) return parts.push_back(part);
    parts.back().begin = std::min(parts.back().begin, part.begin);
    parts.back().end = std::max(parts.back().end, part.end);
}

}  // namespace

/// Maps beams of a laser to their order of measurement: that of their bearings, or the reverse.
class SensorReader::BeamOrder {
  public:
    explicit BeamOrder(const Laser& laser)
        : count_(static_cast<std::size_t>(laser.beams)),
          forwards_(laser.spin > 0),
          seconds_(laser.step.degrees() / (360 * std::fabs(laser.spin))) {}

    /// Returns seconds from the first beam to the n-th measured one.
    [[nodiscard]] double timeOf(std::size_t n) const { return static_cast<double>(n) * seconds_; }
    /// Returns seconds from a beam to the next bearing, negative if that is measured earlier.
    [[nodiscard]] double step() const { return forwards_ ? seconds_ : -seconds_; }
    [[nodiscard]] std::size_t count() const { return count_; }
    /// Returns the beams measured as numbers begin to before end.
    [[nodiscard]] BeamsAmong beams(std::size_t begin, std::size_t end,
                                   const MovingBodies& bodies) const {
        return forwards_ ? BeamsAmong{begin, end, &bodies}
                         : BeamsAmong{count_ - end, count_ - begin, &bodies};
    }
    /// Maps a number of measurement to its beam, and the reverse.
    [[nodiscard]] std::size_t beam(std::size_t n) const { return forwards_ ? n : count_ - 1 - n; }
    [[nodiscard]] double timeOfBeam(std::size_t beam) const { return timeOf(this->beam(beam)); }

  private:
    std::size_t count_;
    bool forwards_;
    double seconds_;  // from beam to beam
};

/// Rounds up to the step at or after its last beam.
SimTime SensorReader::durationOf(const Laser& laser, SimTime step) {
    constexpr double kNanoseconds = 1e9;
    return atStep(SimTime(std::llround(laser.duration() * kNanoseconds)), step);
}

/// Returns the beginning of a sensor's completed scan; of other sensors the present time.
SimTime SensorReader::beginOf(std::size_t sensor, SimTime time) const {
    const bool is_first = due_[sensor] == SimTime(0);
    if (is_first || durations_[sensor] == SimTime(0)) return time;
    const std::int64_t period = periods_[sensor].newest(time - durations_[sensor]);
    return atStep(periods_[sensor].begin(period), step_);
}

const Pose2& SensorReader::carrierIn(const MoverPoses& places, const Sensor& sensor) {
    return sensor.mount ? places.robots[sensor.mount->robot] : places.people[sensor.person.value()];
}

Pose3 SensorReader::poseOf(const Sensor& sensor, const PoseHistory::Walk& walk,
                           double later) const {
    if (!sensor.mount && !sensor.person) return sensor.pose;
    const ArcPath way(carrierIn(walk.from(), sensor), carrierIn(walk.to(), sensor));
    return poseOn(sensor, way.at(walk.share().at(later)));
}

/// Returns an empty list if some of these lasers do not stay level.
std::vector<double> SensorReader::spinHeights() const {
    std::vector<double> heights;
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
        if (durations_[i] == SimTime(0)) continue;
        const Sensor& sensor = sensors_[i];
        if (sensor.as<Laser>().sweep != SweepAxis::None || !sensor.pose.isLevel()) return {};
        heights.push_back(sensor.pose.position.z);
    }
    std::sort(heights.begin(), heights.end());
    heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
    return heights;
}

/// Builds the bodies at the moments at which the due scans were measured.
void SensorReader::makeTrailBodies(std::span<const std::size_t> due) {
    std::optional<SimTime> since;
    for (const std::size_t i : due)
        if (durations_[i] > SimTime(0))
            since = std::min(since.value_or(SimTime::max()), readings_[i].time);
    if (!since || trail_.isStillSince(*since)) return;
    trail_.makeBodies(*since, [this](const MoverPoses& places, MovingBodies& bodies) {
        setBodies(places, spin_heights_, bodies);
    });
}

void SensorReader::followTrail(const SensorReader& before,
                               const std::unordered_set<std::string_view>& stayers,
                               const Movers& movers) {
    if (!trail_.isKept()) return;
    using Indices = std::vector<std::optional<std::size_t>>;
    const auto indices = [&stayers](const auto& here, const auto& there) {
        std::unordered_map<std::string_view, std::size_t> old;
        for (std::size_t i = 0; i < there.size(); ++i) old.emplace(there[i].id, i);
        Indices found(here.size());
        for (std::size_t i = 0; i < here.size(); ++i) {
            const auto index = old.find(here[i].id);
            if (index != old.end() && stayers.contains(here[i].id)) found[i] = index->second;
        }
        return found;
    };
    trail_.goOn(before.trail_, indices(scene_->robots, before.scene_->robots),
                indices(scene_->people, before.scene_->people), MoverPoses(movers));
}

/// Computes a scan beam by beam.
void SensorReader::sweep(const Laser& laser, std::size_t sensor) {
    SensorReading& reading = readings_[sensor];
    Scan& scan = std::get<Scan>(reading.value);
    LaserCaster& caster = *casters_[sensor];
    std::vector<BeamsAmong>& parts = parts_[sensor];
    scan.beam_poses.clear();
    const bool sweeps = laser.sweep != SweepAxis::None;
    if (!sweeps && trail_.isStillSince(reading.time)) {
        parts.assign({{0, static_cast<std::size_t>(laser.beams), &bodies_}});
        return caster.cast(scan, parts);
    }
    if (sweeps || !scan.pose.isLevel()) {
        sweepInSpace(laser, sensor);
        return caster.cast(scan, parts);
    }
    // Kept for its memory: threads read many scans.
    auto& frames = perThread<BeamFrames, struct FramesOfSpin>();
    if (sweepLevel(laser, sensor, frames))
        caster.cast(scan, frames, parts);
    else
        caster.cast(scan, parts);
}

/// Calls visit(walk, begin, end) for each leg and its beams, and stores the bodies for these beams.
template <typename Visit>
void SensorReader::forEachLeg(const BeamOrder& order, std::size_t sensor, Visit visit) {
    std::vector<BeamsAmong>& parts = parts_[sensor];
    parts.clear();
    PoseHistory::Walk walk(trail_, readings_[sensor].time);
    constexpr double kHalf = 0.5;
    for (std::size_t begin = 0; begin < order.count();) {
        walk.to(order.timeOf(begin));
        const auto share = walk.share();
        const double end_time = walk.end();
        std::size_t middle = begin;
        while (middle < order.count() && order.timeOf(middle) <= end_time &&
               share.at(order.timeOf(middle)) <= kHalf)
            ++middle;
        std::size_t end = middle;
        while (end < order.count() && order.timeOf(end) <= end_time) ++end;
        join(parts, order.beams(begin, middle, walk.bodies(0)));
        join(parts, order.beams(middle, end, walk.bodies(1)));
        visit(walk, begin, end);
        begin = end;
    }
}

/// Sets the pose of each beam, if they differ.
void SensorReader::sweepInSpace(const Laser& laser, std::size_t sensor) {
    Scan& scan = std::get<Scan>(readings_[sensor].value);
    const BeamOrder order(laser);
    scan.beam_poses.resize(order.count());
    bool moves = false;
    forEachLeg(order, sensor,
               [&](const PoseHistory::Walk& walk, std::size_t begin, std::size_t end) {
                   for (std::size_t n = begin; n < end; ++n) {
                       const double later = order.timeOf(n);
                       const Pose3 pose = sweptPose(laser, poseOf(sensors_[sensor], walk, later),
                                                    scan.number + later * laser.rate);
                       moves = moves || pose != scan.pose;
                       scan.beam_poses[order.beam(n)] = pose;
                   }
               });
    if (!moves) scan.beam_poses.clear();
}

/// Computes the origins of level beams; returns false if they have a common origin, and leaves
/// `frames` unset.
bool SensorReader::sweepLevel(const Laser& laser, std::size_t sensor, BeamFrames& frames) {
    const Sensor& placed = sensors_[sensor];
    const bool is_carried = placed.mount || placed.person;
    const BeamOrder order(laser);
    if (is_carried) frames.resize(order.count());
    const Pose3 on = is_carried ? mountOf(placed) : Pose3();
    const Pose2 mount{on.position.onFloor(), on.heading};
    bool moves = false;
    forEachLeg(
        order, sensor, [&](const PoseHistory::Walk& walk, std::size_t begin, std::size_t end) {
            if (!is_carried) return;
            const Pose2& from = carrierIn(walk.from(), placed);
            const Pose2& to = carrierIn(walk.to(), placed);
            moves = moves || from != to;
            const auto share = walk.share();
            const BeamsAmong beams = order.beams(begin, end, bodies_);
            ArcPath(from, to).carry(mount, share.at(order.timeOfBeam(beams.begin)),
                                    order.step() * share.rate, beams.begin, beams.end, frames);
        });
    return moves;
}

}  // namespace ispace
