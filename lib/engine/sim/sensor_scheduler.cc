// SPDX-License-Identifier: GPL-3.0-or-later
// When sensors are read, and with which poses, bodies and velocities.
//
// A reading has two halves. update() fixes time, number, pose and bodies, for all due sensors,
// before the world goes on; measure() casts the rays of one, later, in any thread. Between them
// only these values are read, so that late readings equal early ones.
#include "sim/sensor_scheduler.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <unordered_map>
#include <utility>

#include "base/per_thread.h"
#include "scene/sensor/sensor.h"
#include "sense/selection.h"
#include "sense/shared_results.h"
#include "sim/world_state.h"

namespace ispace {

namespace {

/// Sensors per block: enough to gain from other threads, few enough for short waits.
constexpr std::size_t kBlock = 64, kBlockBeams = 100'000;

/// Converts a pose on a carrier to the carrier's frame.
Pose3 localPose(const Pose2& carrier, const Pose3& pose) {
    const Vec2 way = pose.position.onFloor() - carrier.position;
    const Vec2 along = unitVector(carrier.heading);
    return {{dot(way, along), cross(along, way), pose.position.z},
            pose.heading - carrier.heading,
            pose.tilt,
            pose.roll};
}

Pose3 onFloor(const Pose2& pose) {
    return {{pose.position.x, pose.position.y, 0}, pose.heading, {}, {}};
}

/// Returns the poses after a share of a step, which is a straight line between positions.
MoverPoses placesBetween(const MoverPoses& from, const MoverPoses& to, double share) {
    MoverPoses places = to;
    const auto go = [share](const std::vector<Pose2>& before, std::vector<Pose2>& now) {
        for (std::size_t i = 0; i < now.size(); ++i) {
            const auto& [position, heading] = before[i];
            now[i].position = position + share * (now[i].position - position);
            now[i].heading = heading + share * wrapped(now[i].heading - heading);
        }
    };
    go(from.robots, places.robots);
    go(from.people, places.people);
    return places;
}

/// The same seeds as in `scan`.
std::optional<std::uint64_t> noiseSeedOf(const SensorReader::Options& options) {
    return options.noise ? std::optional(options.seed) : std::nullopt;
}

}  // namespace

int SensorReader::frameOf(std::int64_t number) {
    constexpr std::int64_t kLast = std::numeric_limits<int>::max();
    return static_cast<int>(std::min(number, kLast));
}

SensorReader::SensorReader(SceneResources& setting, const Options& options)
    : scene_(setting.scene.get()),
      options_{.noise_seed = noiseSeedOf(options)},
      taking_{.noise_seed = noiseSeedOf(options), .shared = std::make_shared<SharedResults>()},
      step_(options.step),
      floor_(*scene_),
      worlds_(&setting.worlds),
      photographer_(setting.photographer.get()) {
    addSensors();
    const std::size_t count = sensors_.size();
    due_.resize(count);
    readings_.resize(count);
    durations_.resize(count);
    casters_.resize(count);
    parts_.resize(count);
    latest_.reserve(count);
    LocalBeams beams;
    for (std::size_t i = 0; i < count; ++i) {
        const Sensor& sensor = sensors_[i];
        periods_.emplace_back(periodRate(sensor));
        is_heavy_.push_back(isHeavy(sensor) ? 1 : 0);
        readings_[i].pose = sensor.pose;
        if (kindOf(sensor.model).needs_each_period) lasting_.push_back(i);
        if (sensor.is<Ranger>()) readings_[i].value = DepthFrame();
        if (sensor.is<Camera>()) readings_[i].value = Photo();
        const auto* laser = sensor.tryAs<Laser>();
        if (laser == nullptr) continue;
        durations_[i] = durationOf(*laser, step_);
        // Allocates now, so that a lack of memory is reported before a step.
        std::get<Scan>(readings_[i].value).ranges.reserve(static_cast<std::size_t>(laser->beams));
        casters_[i].emplace(*worlds_, bodies_, sensor, sensor.mount.has_value(), options_,
                            beams.of(*laser));
    }
    if (count > 0) trail_ = PoseHistory(*std::max_element(durations_.begin(), durations_.end()));
    spin_heights_ = spinHeights();
    for (const PlacedRecord& placed : scene_->placed)
        if (scene_->records[placed.record].keyword() == "human")
            people_starts_.push_back(
                {placed.pose.position.onFloor(), wrapped(placed.pose.heading)});
    for (std::size_t i = 0; i < count; ++i) {
        const Sensor& sensor = sensors_[i];
        if (!kindOf(sensor.model).integrates || (!sensor.mount && !sensor.person)) continue;
        means_.add(i, sensor.mount ? std::optional(sensor.mount->robot) : std::nullopt,
                   sensor.person, mountOf(sensor).position.onFloor());
    }
}

void SensorReader::addSensors() {
    for (const Sensor& sensor : scene_->sensors) {
        if (!kindOf(sensor.model).is_read) continue;
        sensors_.push_back(sensor);
        if (sensor.is<Receiver>()) receivers_.push_back(sensor);
        if (sensor.is<Tag>()) tags_.push_back(sensor);
    }
    for (std::size_t i = 0; i < floor_.mats().size(); ++i)
        sensors_.push_back({floor_.matIds()[i], floor_.mats()[i], onFloor(floor_.mats()[i].pose)});
    for (std::size_t i = 0; i < floor_.gates().size(); ++i)
        sensors_.push_back(
            {floor_.gateIds()[i], floor_.gates()[i], onFloor(floor_.gates()[i].pose)});
}

void SensorReader::follow(const SensorReader& before,
                          const std::unordered_set<std::string_view>& stayers, SimTime time,
                          const Movers& movers) {
    followTrail(before, stayers, movers);
    followMemories(before, time, movers);
    std::unordered_map<std::string_view, std::size_t> old;
    for (std::size_t i = 0; i < before.sensors_.size(); ++i) old.emplace(before.sensors_[i].id, i);
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
        const auto found = old.find(sensors_[i].id);
        if (found == old.end()) continue;
        if (!stayers.contains(found->first)) continue;
        const Sensor& sensor = sensors_[i];
        if (!sensor.mount && !sensor.person && sensor.pose != before.sensors_[found->second].pose)
            continue;
        readings_[i] = before.readings_[found->second];
        due_[i] = before.due_[found->second];
        means_.goOn(i, before.means_, found->second);
        // Read in every step, although the reading is of a period.
        if (sensor.is<Gate>())
            floor_.goOn(gateOf(i), before.floor_.gate(before.gateOf(found->second)));
    }
}

void SensorReader::jumped() {
    moved();
    floor_.forgetPlaces();
    means_.jumped();
    last_places_.reset();
}

void SensorReader::begin(SimTime time, const Movers& movers) {
    finish();
    floor_.follow(movers);
    means_.step(movers);
    if (trail_.isKept()) trail_.add(time, movers, std::exchange(trail_moved_, false));
    latest_.clear();
    catchUp(time, movers);
    for (std::size_t i = 0; i < due_.size(); ++i) {
        if (due_[i] <= time && is_heavy_[i] == 0) latest_.push_back(i);
    }
    if (latest_.empty()) return;
    update(latest_, time, movers);
    unread_ = latest_;
    unread_time_ = time;
    next_block_ = 0;
    makeBlocks();
    unread_blocks_ = block_ends_.size();
    is_read_.assign(unread_blocks_, 0);
}

void SensorReader::skip(SimTime time, const Movers& movers) {
    finish();
    latest_.clear();
    floor_.follow(movers);
    means_.step(movers);
    trail_.clear();
    catchUp(time, movers);
    std::vector<std::size_t> due;
    std::copy_if(lasting_.begin(), lasting_.end(), std::back_inserter(due),
                 [&](std::size_t i) { return due_[i] <= time; });
    if (due.empty()) return;
    update(due, time, movers);
    for (const std::size_t i : due) measure(i, time);
}

/// Takes the readings of periods that began and ended within a step, of sensors that continue from
/// their last reading.
void SensorReader::catchUp(SimTime time, const Movers& movers) {
    if (lasting_.empty()) return;
    MoverPoses now(movers);
    if (!last_places_) {
        last_places_ = std::move(now);
        last_time_ = time;
        return;
    }
    MovingBodies bodies;
    for (const std::size_t i : lasting_) {
        const Sensor& sensor = sensors_[i];
        SensorReading& reading = readings_[i];
        while (due_[i] < time) {
            const std::int64_t period = periods_[i].newest(due_[i]);
            const SimTime next = periods_[i].begin(period + 1);
            if (next > time) break;
            const MoverPoses places = placesBetween(
                *last_places_, now, seconds(due_[i] - last_time_) / seconds(time - last_time_));
            reading.time = due_[i];
            reading.seq = period;
            if (sensor.mount || sensor.person)
                reading.pose = poseOn(sensor, carrierIn(places, sensor));
            if (rayCount(sensor.model) > 0) worlds_->prepareMesh(kindOf(sensor.model).stopped_by);
            setBodies(places, {}, bodies);
            readNow(sensor, bodies, reading);
            due_[i] = next;
        }
    }
    last_places_ = std::move(now);
    last_time_ = time;
}

/// Divides the due sensors into blocks.
void SensorReader::makeBlocks() {
    block_ends_.clear();
    std::size_t count = 0, beams = 0;
    for (std::size_t k = 0; k < unread_.size(); ++k) {
        const auto* const laser = sensors_[unread_[k]].tryAs<Laser>();
        ++count;
        beams += laser == nullptr ? 0 : static_cast<std::size_t>(laser->beams);
        if (count < kBlock && beams < kBlockBeams && k + 1 < unread_.size()) continue;
        block_ends_.push_back(k + 1);
        count = beams = 0;
    }
}

std::size_t SensorReader::blockOf(std::size_t unread) const {
    const auto end = std::upper_bound(block_ends_.begin(), block_ends_.end(), unread);
    return static_cast<std::size_t>(end - block_ends_.begin());
}

void SensorReader::readBlock(std::size_t block) {
    if (std::exchange(is_read_[block], 1) != 0) return;
    --unread_blocks_;
    tbb::parallel_for(block == 0 ? 0 : block_ends_[block - 1], block_ends_[block],
                      [&](std::size_t k) { measure(unread_[k], unread_time_); });
}

/// Reads the sensor with those of its block, which other threads then read.
void SensorReader::complete(std::size_t sensor) {
    const auto found = std::lower_bound(unread_.begin(), unread_.end(), sensor);
    if (found != unread_.end() && *found == sensor)
        readBlock(blockOf(static_cast<std::size_t>(found - unread_.begin())));
}

bool SensorReader::readSome(std::chrono::steady_clock::time_point until) {
    while (unread_blocks_ > 0) {
        readBlock(next_block_++);
        if (std::chrono::steady_clock::now() >= until) break;
    }
    return unread_blocks_ == 0;
}

void SensorReader::finish() {
    if (std::exchange(unread_blocks_, 0) == 0) return;
    // To start threads would take longer than to read a few sensors with a ray each.
    constexpr std::size_t kFewRays = 256;
    std::size_t rays = 0;
    for (const std::size_t sensor : unread_) rays += 1 + rayCount(sensors_[sensor].model);
    if (rays <= kFewRays) {
        for (std::size_t k = 0; k < unread_.size(); ++k)
            if (is_read_[blockOf(k)] == 0) measure(unread_[k], unread_time_);
        return;
    }
    tbb::parallel_for(std::size_t{0}, unread_.size(), [&](std::size_t k) {
        if (is_read_[blockOf(k)] == 0) measure(unread_[k], unread_time_);
    });
}

/// Returns the pose of a sensor on its carrier, in the carrier's frame.
Pose3 SensorReader::mountOf(const Sensor& sensor) const {
    if (sensor.mount) return sensor.mount->robot_from_sensor;
    return localPose(people_starts_[sensor.person.value()], sensor.pose);
}

Pose3 SensorReader::poseOn(const Sensor& sensor, const Pose2& carrier) const {
    if (sensor.person && carrier == people_starts_[*sensor.person]) return sensor.pose;
    return mountedPose(carrier, mountOf(sensor));
}

Pose3 SensorReader::poseOf(const Sensor& sensor, const Movers& movers) const {
    if (sensor.mount) return poseOn(sensor, movers.robots[sensor.mount->robot].pose);
    return sensor.person ? poseOn(sensor, movers.people[*sensor.person].pose) : sensor.pose;
}

/// Updates all values that do not depend on rays: times, poses, bodies.
void SensorReader::update(std::span<const std::size_t> due, SimTime time, const Movers& movers) {
    bool has_others = false;  // than lasers
    for (const std::size_t i : due) {
        SensorReading& reading = readings_[i];
        reading.time = beginOf(i, time);
        reading.seq = periods_[i].newest(reading.time);
        const SimTime next = periods_[i].begin(reading.seq + 1);
        due_[i] = std::min(next, SimTime::max() - durations_[i]) + durations_[i];
        const Sensor& sensor = sensors_[i];
        const auto* laser = sensor.tryAs<Laser>();
        const bool sweeps = laser != nullptr && laser->sweep != SweepAxis::None;
        if (sensor.mount || sensor.person || sweeps)
            reading.pose = durations_[i] > SimTime(0)
                               ? poseOf(sensor, PoseHistory::Walk(trail_, reading.time), 0)
                               : poseOf(sensor, movers);
        if (sweeps)
            reading.pose =
                sweptPose(*laser, reading.pose, static_cast<double>(reading.seq % laser->scans()));
        if (laser != nullptr) continue;
        if (kindOf(sensor.model).integrates) means_.read(i, time);
        has_others = true;
        if (rayCount(sensor.model) > 0) worlds_->prepareMesh(kindOf(sensor.model).stopped_by);
    }
    updateBodies(movers);
    makeTrailBodies(due);
    if (!has_others) return;
    advanceMemories(due);
    updateVelocities(movers);
    std::size_t receiver = 0, tag = 0;
    for (const Sensor& sensor : sensors_) {
        if (sensor.is<Receiver>()) receivers_[receiver++].pose = poseOf(sensor, movers);
        if (sensor.is<Tag>()) tags_[tag++].pose = poseOf(sensor, movers);
    }
}

/// Advances what due sensors share with others of their kinds; their readings continue from it.
void SensorReader::advanceMemories(std::span<const std::size_t> due) {
    for (const std::size_t i : due) {
        const SensorKind& kind = kindOf(sensors_[i].model);
        if (kind.advance == nullptr) continue;
        readings_[i].value =
            kind.advance(sensors_[i], seconds(readings_[i].time), bodies_, memories_[&kind]);
    }
}

/// Advances what sensors shared in the scene before to its end.
void SensorReader::followMemories(const SensorReader& before, SimTime time, const Movers& movers) {
    memories_ = before.memories_;
    bool are_bodies_here = false;
    for (const Sensor& sensor : before.sensors_) {
        const SensorKind& kind = kindOf(sensor.model);
        if (kind.advance == nullptr) continue;
        if (!std::exchange(are_bodies_here, true)) updateBodies(movers);
        kind.advance(sensor, seconds(time), bodies_, memories_[&kind]);
    }
}

void SensorReader::updateVelocities(const Movers& movers) {
    const auto set = [](std::vector<MoverVelocity>& velocities, std::span<const Motion> motions) {
        velocities.clear();
        for (const Motion& motion : motions) {
            const Vec2 ahead = motion.forward();
            velocities.push_back(
                {motion.pose.position,
                 motion.drive.speed * ahead + motion.side.speed * Vec2{-ahead.y, ahead.x},
                 Angle::degrees(motion.turn.speed).radians()});
        }
    };
    set(taking_.velocities.robots, movers.robots);
    set(taking_.velocities.people, movers.people);
}

void SensorReader::updateBodies(const Movers& movers) {
    if (!std::exchange(moved_, false)) return;
    setBodies(MoverPoses(movers), {}, bodies_);
    kept_bodies_.reset();
}

/// Builds the bodies that stop rays, of those that may meet rays at these heights (all, if empty).
void SensorReader::setBodies(const MoverPoses& places, std::span<const double> heights,
                             MovingBodies& bodies) const {
    // Kept for its memory.
    auto& list = perThread<std::vector<MovingBody>, struct BodiesOfReader>();
    list.clear();
    for (std::size_t i = 0; i < places.robots.size(); ++i) {
        const MovingBody robot =
            robotBody(scene_->robots[i].model, places.robots[i], static_cast<std::uint32_t>(i));
        if (isAtSome(robot, heights)) list.push_back(robot);
    }
    for (std::size_t i = 0; i < places.people.size(); ++i)
        addHumanBodies(scene_->people[i].height, places.people[i],
                       kFirstPerson + static_cast<std::uint32_t>(i), places.swings[i], heights,
                       list, scene_->people[i].figure.get());
    bodies.rebuild(list);
}

void SensorReader::measure(std::size_t sensor, SimTime time) {
    const Sensor& placed = sensors_[sensor];
    SensorReading& reading = readings_[sensor];
    if (const auto* const laser = placed.tryAs<Laser>())
        measure(*laser, sensor, time);
    else if (placed.is<Receiver>())
        hear(sensor, time);
    else if (placed.is<Gate>())
        reading.value = floor_.gate(gateOf(sensor));
    else if (placed.is<Mat>())
        reading.value = floor_.mat(matOf(sensor));
    else if (kindOf(placed.model).integrates)
        integrate(sensor);
    else if (!isHeavy(placed))
        readNow(placed, bodies_, reading);
}

/// Reads a sensor with rays, all at once. Depths may be read while the world moves on: they require
/// neither velocities nor receivers.
void SensorReader::readNow(const Sensor& sensor, const MovingBodies& bodies,
                           SensorReading& reading) const {
    ReadingValue value =
        valueOf(readAtOnce({sensor, reading.pose, frameOf(reading.seq), seconds(reading.time),
                            *worlds_, bodies, receivers_, taking_}));
    carryOn(reading.value, value);
    reading.value = std::move(value);
}

/// Reads a sensor that reports the mean motion of its carrier since its last reading.
void SensorReader::integrate(std::size_t sensor) {
    SensorReading& reading = readings_[sensor];
    reading.value = valueOf(
        readAtOnce({sensors_[sensor], reading.pose, frameOf(reading.seq), seconds(reading.time),
                    *worlds_, bodies_, receivers_, taking_, means_.of(sensor)}));
}

/// An instantaneous scan is cast at once; one that takes time follows its beams.
void SensorReader::measure(const Laser& laser, std::size_t sensor, SimTime /*time*/) {
    SensorReading& reading = readings_[sensor];
    Scan& scan = std::get<Scan>(reading.value);
    const std::int64_t scans = laser.scans();
    scan.number = static_cast<int>(reading.seq % scans);
    scan.frame = frameOf(reading.seq / scans);
    scan.pose = reading.pose;
    scan.time = seconds(reading.time);
    if (durations_[sensor] == SimTime(0)) return casters_[sensor]->cast(scan);
    sweep(laser, sensor);
}

/// Each tag bursts for this receiver alone: it hears the same, however many others listen.
void SensorReader::hear(std::size_t sensor, SimTime time) {
    SensorReading& reading = readings_[sensor];
    Sensor receiver = sensors_[sensor];
    receiver.pose = reading.pose;
    Hearings hearings;
    for (const Sensor& tag : tags_) {
        const Burst burst =
            castBurst(worlds_->mesh(Surfaces::Solid), bodies_, tag, std::span(&receiver, 1),
                      frameOf(reading.seq), seconds(time), {.noise_seed = taking_.noise_seed});
        hearings.tags.push_back(
            {tag.id, burst.heard.empty() ? std::nullopt : std::optional(burst.heard.front().time)});
    }
    reading.value = std::move(hearings);
}

Scan SensorReader::look(const Sensor& laser, const Movers& movers) {
    Scan scan;
    scan.pose = poseOf(laser, movers);
    worlds_->prepare(scan.pose);
    updateBodies(movers);
    LaserCaster(*worlds_, bodies_, laser, true, ReadingOptions()).cast(scan);
    return scan;
}

const MovingBodies& SensorReader::bodies(const Movers& movers) {
    updateBodies(movers);
    return bodies_;
}

const RayWorld& SensorReader::mesh(Surfaces surfaces) {
    worlds_->prepareMesh(surfaces);
    return worlds_->mesh(surfaces);
}

}  // namespace ispace
