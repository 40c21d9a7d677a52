// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "layout/scene.h"

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
/// matches no sensor
Sensors sensorsOf(const Scene& scene, const std::vector<std::string>& globs);

/// Indices in Scene::records of the sensors of these keywords whose ids match one of the globs, or
/// of all without globs, placed or not.
std::vector<std::size_t> sensorRecords(const Scene& scene, std::span<const std::string_view> kinds,
                                       const std::vector<std::string>& globs);

/// True if an id matches one of the globs (* ? [a-z]), or there are none.
bool isSelected(const std::string& id, const std::vector<std::string>& globs);
/// True for the keywords of what is read or heard: laser, ranger, tag, ultrasound.
bool isReadable(std::string_view keyword);

/// A time in seconds as the nearest whole nanosecond, which prints as short as it should.
double wholeNanoseconds(double seconds);

/// How long a sensor takes for one reading, in seconds; 0 for all at once.
double durationOf(const Sensors& sensors, const Sensors::Entry& entry);

}  // namespace ispace
