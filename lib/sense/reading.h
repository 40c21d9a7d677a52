// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "layout/scene.h"
#include "sense/depth.h"
#include "sense/scan.h"
#include "sense/trajectory.h"
#include "sense/ultrasound.h"

namespace ispace {

/// What gives readings: a laser, a ranger, or a tag that receivers hear.
enum class SensorKind { Laser, Ranger, Tag };

/// The sensors of a run.
struct Sensors {
    struct Entry {
        SensorKind kind = SensorKind::Laser;
        std::size_t index = 0;  ///< in the list of its kind
    };

    std::vector<PlacedLaser> lasers;
    std::vector<PlacedRanger> rangers;
    std::vector<PlacedTag> tags;
    std::vector<PlacedReceiver> receivers;
    std::vector<Entry> order;  ///< in the order of their records

    [[nodiscard]] const std::string& id(const Entry& entry) const;
    [[nodiscard]] const Pose3& pose(const Entry& entry) const;
    /// Readings a second: of a swept laser, whole sweeps.
    [[nodiscard]] double rate(const Entry& entry) const;
};

/// The placed sensors of a scene whose ids match one of the globs, or all without globs; receivers
/// as far as tags are among them, all or those that match. \throws UsageError for a glob that
/// matches none
Sensors sensorsOf(const Scene& scene, const std::vector<std::string>& globs);

/// Indices in Scene::records of the sensors of these keywords whose ids match one of the globs, or
/// of all without globs, placed or not.
std::vector<std::size_t> sensorRecords(const Scene& scene, std::span<const std::string_view> kinds,
                                       const std::vector<std::string>& globs);

/// What a user may not have meant, a phrase each: sensors without a place, which are left out, and
/// sensors that stand inside something solid.
std::vector<std::string> doubtsAbout(const Scene& scene, const Sensors& sensors);

/// A reading to be taken.
struct ReadingJob {
    std::size_t sensor = 0;  ///< in Sensors::order
    int frame = 0;
    double time = 0;  ///< seconds
    Pose3 pose;
    /// Where the sensor is from `time` on, until it is done; empty if it stands still. In order of
    /// time, the first not after `time`.
    std::vector<TimedPose> way;
};

/// A scan, or those of a sweep; a picture; a burst.
using Reading = std::variant<std::vector<Scan>, DepthFrame, Burst>;

struct TakerOptions {
    std::optional<std::uint64_t> noise_seed = {};  ///< empty: no noise
    double celsius = 20;                           ///< of the air, for sound
    /// Sensors are where jobs say, not where they are placed: beams are turned as a whole.
    bool follows_poses = false;
};

/// Takes readings in any order on any thread; each depends on its job alone.
class ReadingTaker {
  public:
    /// \pre all outlive it
    ReadingTaker(const Sensors& sensors, Worlds& worlds, const MovingBodies& bodies,
                 const TakerOptions& options);
    ~ReadingTaker();
    ReadingTaker(const ReadingTaker&) = delete;
    ReadingTaker& operator=(const ReadingTaker&) = delete;

    /// Makes ready what a job needs. By one thread, in the order of jobs; others may take readings
    /// meanwhile.
    void prepare(const ReadingJob& job);
    /// \pre the job is prepared
    [[nodiscard]] Reading take(const ReadingJob& job);

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// How long a sensor takes for one reading, in seconds; 0 for all at once.
double durationOf(const Sensors& sensors, const Sensors::Entry& entry);

}  // namespace ispace
