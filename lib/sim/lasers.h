// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "layout/scene.h"
#include "sim/motion.h"
#include "sim/world.h"

namespace ispace {

/// When the periods of a sensor begin: period k at k / rate seconds, in exact arithmetic. A rate
/// with up to nine decimals counts as written, any other as the double it is.
class Periods {
  public:
    /// \pre rate > 0
    explicit Periods(double rate);
    /// The latest period that has begun.
    [[nodiscard]] std::int64_t newest(SimTime time) const;
    /// The first nanosecond of period k; a time beyond any run if that is after a hundred years.
    [[nodiscard]] SimTime begin(std::int64_t k) const;

  private:
    // Periods a nanosecond, as a fraction; a numerator of 0: never again.
    __int128 numerator_ = 0, denominator_ = 1;
};

/// Reads the lasers of a world when they are due.
class LaserReader {
  public:
    /// The scene must outlive it.
    explicit LaserReader(const Scene& scene);

    /// Reads the lasers whose next period has begun, in parallel. \pre robots are the scene's
    void read(SimTime time, std::span<const Motion> robots);
    /// Before the first reading in another scene: those that stay as they are keep their last
    /// reading.
    void follow(const LaserReader& before, const std::unordered_set<std::string_view>& stayers);
    /// Says that robots have moved.
    void robotsMoved() { moved_ = true; }

    /// In the order of the scene, where they start.
    [[nodiscard]] const std::vector<Sensor>& lasers() const { return lasers_; }
    [[nodiscard]] const SensorReading& reading(std::size_t laser) const { return readings_[laser]; }
    /// Those read last, ascending.
    [[nodiscard]] std::span<const std::size_t> latest() const { return latest_; }

  private:
    void update(SimTime time, std::span<const Motion> robots);

    const Scene* scene_;
    std::vector<Sensor> lasers_;  // as they start
    Worlds worlds_;
    std::vector<Periods> periods_;
    std::vector<SimTime> due_;
    std::vector<SensorReading> readings_;
    std::vector<LaserCaster> casters_;
    std::vector<std::size_t> latest_;
    bool moved_ = true;  // since the bodies were made
    std::vector<MovingBody> places_;
    MovingBodies bodies_;
};

}  // namespace ispace
