// SPDX-License-Identifier: GPL-3.0-or-later
// The work of a world for its time, as measured.
//
// Counts the processor time of the thread that steps the world, not of the others that help it. The
// figure varies from run to run; it decides about requests of clients alone, never about the course
// of the world.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/sensor/sensor.h"
#include "sim/sim_time.h"

namespace ispace {

class World;

/// Returns the processor time of this thread.
[[nodiscard]] std::chrono::nanoseconds threadTime();

/// Work of a world for a second of its time, so that clients cannot load it beyond its pace: counts
/// of records tell little about it, as some sensors measure all others.
///
/// Measured over windows of a simulated second, or of some wall time in a world that is far behind.
/// Sensors that were added since the beginning of the last whole window, e.g. in a pause, count by
/// the time of their first readings, twice: the others may have to read them as well.
class Pace {
  public:
    using Nanoseconds = std::chrono::nanoseconds;
    using Moment = std::chrono::steady_clock::time_point;

    /// Seconds of work for a second that still leave time to serve clients.
    static constexpr double kMost = 0.8;

    /// Work of the thread that steps the world, and the simulated time that it took.
    struct Work {
        Nanoseconds all{};
        Nanoseconds reading{};  ///< of sensors, part of it
        SimTime simulated{};
    };
    /// Seconds of work for a simulated second.
    struct Load {
        double all = 0;
        double reading = 0;  ///< of sensors, part of it
    };

    void worked(const Work& work, Moment now);
    /// Adds first readings of sensors. \param work for all of them \param world that has them, of
    /// several that step together: their ids may be equal
    void added(const std::vector<const Sensor*>& sensors, Nanoseconds work,
               const World* world = nullptr);
    /// The sensors have this many times as many readings from now on.
    void rescaled(double times);
    /// The world has restarted.
    void restarted();
    /// Returns the load of all worlds. \param exists false for sensors that were removed before
    /// they were measured; asked about those of this world
    [[nodiscard]] Load load(const std::function<bool(const std::string& id)>& exists,
                            const World* world = nullptr) const;

  private:
    /// A share of the load that no whole window has measured yet.
    struct Unmeasured {
        double load = 0;
        bool is_old = false;  ///< older than the present window
    };

    Work window_;
    Moment begun_{};
    Load measured_;
    std::map<std::pair<const World*, std::string>, Unmeasured> unmeasured_;  // by sensor
};

}  // namespace ispace
