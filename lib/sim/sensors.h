// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "layout/scene.h"
#include "sense/photo.h"
#include "sense/scan.h"
#include "sim/motion.h"
#include "sim/periods.h"
#include "sim/sensor_reading.h"
#include "sim/trail.h"
#include "trace/moving_bodies.h"
#include "trace/worlds.h"

namespace ispace {

/// Reads the sensors of a world when they are due: in the first step at or after the beginning of
/// a period, all at the moment of that step. The beams of a laser that spins follow one another
/// from that moment on: each is of its own time, and the scan is read with the last one. Its first
/// scan is of one moment.
class SensorReader {
  public:
    struct Options {
        std::uint64_t seed = 0;  ///< of noise, and of the light of pictures
        bool noise = false;
        SimTime step = SimTime(1);  ///< of the world
    };
    /// The scene must outlive it. \throws FormatError for a texture that cannot be read, if there
    /// are cameras
    SensorReader(const Scene& scene, const Options& options);

    /// After each step: follows those who move, and reads what is due, in parallel. Heavy
    /// sensors are left out.
    void read(SimTime time, const Movers& movers);
    /// After a step that nobody looks at: what is due is read after a later one.
    void pass(const Movers& movers) {
        latest_.clear();
        floor_.follow(movers);
        trail_.clear();
    }
    /// Before the first reading in another scene: those that stay as they are keep their last
    /// reading, and gates their counts; scans that have begun go on. \param movers of this scene
    void follow(const SensorReader& before, const std::unordered_set<std::string_view>& stayers,
                const Movers& movers);
    /// Says that robots or people have moved.
    void moved() { moved_ = trail_moved_ = pictures_moved_ = true; }
    /// They were put elsewhere, so nobody passed a gate on the way.
    void jumped();

    /// Sensors in the order of the scene, as they start; then mats, then gates.
    [[nodiscard]] const std::vector<RunSensor>& sensors() const { return sensors_; }
    [[nodiscard]] const SensorReading& reading(std::size_t sensor) const {
        return readings_[sensor];
    }
    /// Those read last, ascending.
    [[nodiscard]] std::span<const std::size_t> latest() const { return latest_; }
    /// The newest period; readings of heavy sensors may be of earlier ones.
    [[nodiscard]] std::int64_t period(std::size_t sensor, SimTime time) const {
        return is_heavy_[sensor] == 0 ? readings_[sensor].seq : periods_[sensor].newest(time);
    }
    /// Reads a heavy sensor now if it was not read in its newest period.
    void take(std::size_t sensor, SimTime time, const Movers& movers);

    [[nodiscard]] const FloorSensors& floor() const { return floor_; }
    /// The bodies of robots and people where they are.
    const MovingBodies& bodies(const Movers& movers);
    /// What a laser on a robot would measure now, see World::look.
    Scan look(const Sensor& laser, const Movers& movers);
    /// What surrounds them, as light or sound meets it.
    const RayWorld& mesh(Surfaces surfaces);

  private:
    void addSensors();
    // Gates come last, mats before them.
    [[nodiscard]] std::size_t gateOf(std::size_t sensor) const {
        return sensor + floor_.gates().size() - sensors_.size();
    }
    [[nodiscard]] std::size_t matOf(std::size_t sensor) const {
        return gateOf(sensor) + floor_.mats().size();
    }
    void readLatest(SimTime time, const Movers& movers);
    void update(SimTime time, const Movers& movers);
    void updateBodies(const Movers& movers);
    void movePictures(const Movers& movers);
    [[nodiscard]] std::vector<double> spinHeights() const;
    void makeTrailBodies();
    /// \param heights those of all level rays that will meet them; empty: rays go everywhere
    void setBodies(const Places& places, std::span<const double> heights,
                   MovingBodies& bodies) const;
    void followTrail(const SensorReader& before,
                     const std::unordered_set<std::string_view>& stayers, const Movers& movers);
    static SimTime durationOf(const Laser& laser, SimTime step);
    [[nodiscard]] SimTime beginOf(std::size_t sensor, SimTime time) const;
    [[nodiscard]] Pose3 poseOf(const Sensor& sensor, const Movers& movers) const;
    [[nodiscard]] Pose3 poseOf(const Sensor& sensor, const Trail::Walk& walk, double later) const;
    [[nodiscard]] Pose3 poseOn(const Sensor& sensor, const Pose2& carrier) const;
    [[nodiscard]] Pose3 mountOf(const Sensor& sensor) const;
    static const Pose2& carrierIn(const Places& places, const Sensor& sensor);
    class BeamOrder;
    void sweep(const Laser& laser, std::size_t sensor);
    template <typename Visit>
    void forEachLeg(const BeamOrder& order, std::size_t sensor, Visit visit);
    void sweepInSpace(const Laser& laser, std::size_t sensor);
    bool sweepLevel(const Laser& laser, std::size_t sensor, BeamFrames& frames);
    void measure(std::size_t sensor, SimTime time);
    void measure(const Laser& laser, std::size_t sensor, SimTime time);
    void measure(const Ranger& ranger, std::size_t sensor, SimTime time);
    void measure(const Camera& camera, std::size_t sensor, SimTime time);
    void measure(const Tag& tag, std::size_t sensor, SimTime time);
    void measure(const Receiver& receiver, std::size_t sensor, SimTime time);

    const Scene* scene_;
    ReadingOptions options_;
    UltrasoundOptions sound_;
    SimTime step_;
    FloorSensors floor_;
    std::vector<RunSensor> sensors_;  // as they start
    Worlds worlds_;
    std::vector<Periods> periods_;
    std::vector<SimTime> due_;
    std::vector<SimTime> durations_;  // of scans, in whole steps
    std::vector<char> is_heavy_;
    std::vector<SensorReading> readings_;
    std::vector<std::optional<LaserCaster>> casters_;  // of lasers
    std::vector<std::size_t> latest_;
    // Those that hear, and those that are heard, where they are; made when one of them is read.
    std::vector<Sensor> receivers_, tags_;
    std::vector<Pose2> people_starts_;
    std::unique_ptr<Photographer> photographer_;  // if there are cameras
    bool moved_ = true;                           // since the bodies were made
    bool pictures_moved_ = true;                  // since those of pictures were
    bool trail_moved_ = true;                     // since the trail's last moment
    MovingBodies bodies_;
    Trail trail_;                                 // for scans that take a while
    std::vector<double> spin_heights_;            // of their rays, if all are level; else empty
    std::vector<std::vector<BeamsAmong>> parts_;  // of each laser's last scan; kept for the memory
};

}  // namespace ispace
