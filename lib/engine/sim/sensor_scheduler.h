// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/sim: reads the sensors of a running world.
//
// Periods are exact (Periods): a sensor of 30 Hz is read 30 times in every second of a run, in the
// steps at or after the beginnings, if steps are shorter than that. All values that rays need are
// fixed when a step ends; the rays themselves may be cast later, in blocks, by several threads, and
// in any order.
//
// Sensors that continue from their last reading (temperatures, motion detectors) are read in each
// of their periods, also those that end within a step or in skipped steps of a replay.
#pragma once

#include <any>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "scene/scene.h"
#include "sense/photo.h"
#include "sense/scan.h"
#include "sim/mean_motions.h"
#include "sim/motion.h"
#include "sim/mover.h"
#include "sim/sensor_reading.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace {

struct SceneResources;

/// Reads the sensors of a world when they are due: in the first step at or after the beginning of a
/// period, all at the time of that step. The beams of a spinning laser follow one another from that
/// time on: each has its own time, and the scan is read with the last one. Its first scan is
/// instantaneous.
class SensorReader {
  public:
    struct Options {
        std::uint64_t seed = 0;  ///< of noise, and of the light of pictures
        bool noise = false;
        SimTime step = SimTime(1);  ///< of the world
    };
    /// \param setting must outlive the reader and belong to it alone
    SensorReader(SceneResources& setting, const Options& options);

    /// Call it after each step: updates the poses of carried sensors, and reads due sensors in
    /// parallel. Heavy sensors are skipped.
    void read(SimTime time, const Movers& movers) {
        begin(time, movers);
        finish();
    }
    /// Likewise, but due sensors are read later: by readSome(), or when reading() is called. The
    /// readings are the same, however movers go on until then.
    void begin(SimTime time, const Movers& movers);
    /// Reads due sensors until all are read, or about until then. \returns true if all are read
    bool readSome(std::chrono::steady_clock::time_point until);
    void finish();
    /// Call it after a skipped step: due sensors are read after a later one, but those that
    /// continue from their last reading now.
    void skip(SimTime time, const Movers& movers);
    /// Call it before the first reading in another scene: unchanged sensors keep their last
    /// reading, gates their counts, and kinds what their sensors share; scans that have begun go
    /// on. \param movers of this scene \pre all of `before` is read
    void follow(const SensorReader& before, const std::unordered_set<std::string_view>& stayers,
                SimTime time, const Movers& movers);
    /// Records that robots or people have moved.
    void moved() { moved_ = trail_moved_ = pictures_moved_ = true; }
    /// Records that movers were set to other poses, so that no gate counts a passage.
    void jumped();

    /// Returns sensors in the order of the scene, at their starts; then mats, then gates.
    [[nodiscard]] const std::vector<Sensor>& sensors() const { return sensors_; }
    [[nodiscard]] const SensorReading& reading(std::size_t sensor) {
        if (unread_blocks_ > 0) complete(sensor);
        return readings_[sensor];
    }
    /// Returns the sensors read last, ascending.
    [[nodiscard]] std::span<const std::size_t> latest() const { return latest_; }
    /// Returns the newest period; readings of heavy sensors may be of earlier ones.
    [[nodiscard]] std::int64_t period(std::size_t sensor, SimTime time) const {
        return is_heavy_[sensor] == 0 ? readings_[sensor].seq : periods_[sensor].newest(time);
    }
    /// Returns true unless it is heavy and was not read in its newest period.
    [[nodiscard]] bool isCaptured(std::size_t sensor, SimTime time) const {
        return due_[sensor] > time || is_heavy_[sensor] == 0;
    }
    /// Reads a heavy sensor now unless it is captured.
    void captureNow(std::size_t sensor, SimTime time, const Movers& movers);
    /// Likewise in two parts: see World::captureLater.
    std::function<SensorReading()> captureLater(std::size_t sensor, SimTime time,
                                                const Movers& movers);
    void storeCapture(std::size_t sensor, SensorReading reading);

    [[nodiscard]] const FloorSensors& floor() const { return floor_; }
    /// Returns the bodies of robots and people at their poses.
    const MovingBodies& bodies(const Movers& movers);
    /// Computes the scan of a laser on a robot, see World::look.
    Scan look(const Sensor& laser, const Movers& movers);
    /// Returns the surfaces around, as light or sound meets them.
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
    void makeBlocks();
    [[nodiscard]] std::size_t blockOf(std::size_t unread) const;
    void complete(std::size_t sensor);
    void readBlock(std::size_t block);
    void update(std::span<const std::size_t> due, SimTime time, const Movers& movers);
    void catchUp(SimTime time, const Movers& movers);
    void updateBodies(const Movers& movers);
    struct Stage;
    std::shared_ptr<const Stage> stage(const Movers& movers);
    [[nodiscard]] SensorReading begun(std::size_t sensor, SimTime time, const Movers& movers) const;
    void photograph(const Sensor& camera, const std::shared_ptr<const Stage>& stage,
                    SensorReading& reading);
    void readNow(const Sensor& sensor, const MovingBodies& bodies, SensorReading& reading) const;
    static int frameOf(std::int64_t number);
    [[nodiscard]] std::vector<double> spinHeights() const;
    void makeTrailBodies(std::span<const std::size_t> due);
    /// \param heights of all level rays that will meet the bodies; empty: rays in any direction
    void updateVelocities(const Movers& movers);
    void setBodies(const MoverPoses& places, std::span<const double> heights,
                   MovingBodies& bodies) const;
    void advanceMemories(std::span<const std::size_t> due);
    void followMemories(const SensorReader& before, SimTime time, const Movers& movers);
    void followTrail(const SensorReader& before,
                     const std::unordered_set<std::string_view>& stayers, const Movers& movers);
    static SimTime durationOf(const Laser& laser, SimTime step);
    [[nodiscard]] SimTime beginOf(std::size_t sensor, SimTime time) const;
    [[nodiscard]] Pose3 poseOf(const Sensor& sensor, const Movers& movers) const;
    [[nodiscard]] Pose3 poseOf(const Sensor& sensor, const PoseHistory::Walk& walk,
                               double later) const;
    [[nodiscard]] Pose3 poseOn(const Sensor& sensor, const Pose2& carrier) const;
    [[nodiscard]] Pose3 mountOf(const Sensor& sensor) const;
    static const Pose2& carrierIn(const MoverPoses& places, const Sensor& sensor);
    class BeamOrder;
    void sweep(const Laser& laser, std::size_t sensor);
    template <typename Visit>
    void forEachLeg(const BeamOrder& order, std::size_t sensor, Visit visit);
    void sweepInSpace(const Laser& laser, std::size_t sensor);
    bool sweepLevel(const Laser& laser, std::size_t sensor, BeamFrames& frames);
    void measure(std::size_t sensor, SimTime time);
    void measure(const Laser& laser, std::size_t sensor, SimTime time);
    void hear(std::size_t sensor, SimTime time);
    void integrate(std::size_t sensor);

    const Scene* scene_;
    ReadingOptions options_;
    TakerOptions taking_;
    SimTime step_;
    FloorSensors floor_;
    std::map<const SensorKind*, std::any> memories_;  // of kinds with SensorKind::advance
    MeanMotions means_;
    std::vector<Sensor> sensors_;  // at their starts
    RayScenes* worlds_;
    std::vector<Periods> periods_;
    std::vector<SimTime> due_;
    std::vector<SimTime> durations_;  // of scans, rounded up to steps
    std::vector<char> is_heavy_;
    std::vector<SensorReading> readings_;
    std::vector<std::size_t> lasting_;       // sensors that continue from their last reading
    std::optional<MoverPoses> last_places_;  // after the last step, kept for these
    SimTime last_time_{};                    // of that step
    std::vector<std::optional<LaserCaster>> casters_;  // of lasers
    std::vector<std::size_t> latest_;
    // Due sensors still to be read, ascending, at the time of the step; in blocks, some of which
    // are read already.
    std::vector<std::size_t> unread_;
    std::vector<std::size_t> block_ends_;
    std::vector<char> is_read_;  // of blocks
    std::size_t unread_blocks_ = 0, next_block_ = 0;
    SimTime unread_time_{};
    // Receivers and tags at their poses when a sensor other than a laser was read last.
    std::vector<Sensor> receivers_, tags_;
    std::vector<Pose2> people_starts_;
    Photographer* photographer_;                       // if there are cameras
    std::mutex photographing_;                         // guards it
    std::shared_ptr<const Stage> photographed_;        // at the poses of the last picture
    std::shared_ptr<const Stage> stage_;               // at current poses, once requested
    std::shared_ptr<const MovingBodies> kept_bodies_;  // at current poses, likewise
    bool moved_ = true;                                // since the bodies were built
    bool pictures_moved_ = true;                       // since the stage was built
    bool trail_moved_ = true;                          // since the trail's last moment
    MovingBodies bodies_;
    PoseHistory trail_;                           // for scans that last several steps
    std::vector<double> spin_heights_;            // of their rays, if all are level; else empty
    std::vector<std::vector<BeamsAmong>> parts_;  // of each laser's last scan; kept for the memory
};

}  // namespace ispace
