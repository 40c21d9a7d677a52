// SPDX-License-Identifier: GPL-3.0-or-later
// Which tags are in which volumes, by the positions that a system measures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "extensions/memory/volume.h"
#include "sim/sim_time.h"
#include "trace/moving_bodies.h"

namespace ispace::memory {

/// The volumes of a run, by id, and those about a point.
class VolumeIndex {
  public:
    static constexpr std::size_t kMost = 10'000;

    /// Adds a volume, or replaces the one with its id. \returns false if there are kMost others
    bool store(Volume volume);
    /// \returns false if there is none with this id
    bool forget(std::string_view id);
    [[nodiscard]] const Volume* find(std::string_view id) const;
    /// Returns the volumes of a room that contain a point, the nearest centre first. O(volumes) at
    /// the first call after a change, then O(volumes near the point)
    [[nodiscard]] std::vector<const Volume*> about(std::size_t room, Point3 point) const;
    /// Returns all, by id.
    [[nodiscard]] const std::map<std::string, Volume, std::less<>>& all() const { return volumes_; }

  private:
    struct Room {
        std::vector<const Volume*> volumes;
        FloorGrid grid;
    };
    std::map<std::string, Volume, std::less<>> volumes_;
    mutable std::vector<Room> rooms_;  // without order, rebuilt after changes
    mutable bool is_known_ = false;
};

/// What a tag does at a volume.
struct Touch {
    enum class Kind { Touch, Dwell, Leave };

    Kind kind = Kind::Touch;
    SimTime time{};
    std::string volume, tag;
    SimTime lasted{};  ///< since the touch
};

/// Follows tags through volumes.
///
/// A touch begins at the first position inside a volume, is a stay once positions have been inside
/// for Volume::dwell, and ends when none was for kHold: positions have errors, and a volume is
/// about as small as they are.
///
///     Touches touches;
///     for (const Touch& touch : touches.moved("hand", index.about(0, position), now)) …
///     for (const Touch& touch : touches.passed(now)) …
class Touches {
  public:
    static constexpr SimTime kHold = std::chrono::milliseconds(300);

    /// Takes a position of a tag: the volumes about it. \returns touches and stays
    std::vector<Touch> moved(const std::string& tag, const std::vector<const Volume*>& inside,
                             SimTime now);
    /// Returns what has ended by now, by tag and volume.
    std::vector<Touch> passed(SimTime now);
    /// Returns the tags in a volume now, in order.
    [[nodiscard]] std::vector<std::string> tagsIn(std::string_view volume) const;

  private:
    struct Stay {
        SimTime begun{}, inside{};
        bool is_long = false;
    };
    std::map<std::pair<std::string, std::string>, Stay> stays_;  // by tag and volume
};

}  // namespace ispace::memory
