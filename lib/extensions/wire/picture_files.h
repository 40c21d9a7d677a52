// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures as files for all ports, captured once.
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "sim/world.h"

namespace ispace::wire {

/// A picture or a depth frame, encoded as a file.
struct PictureFile {
    std::int64_t seq = 0;  ///< period of the sensor
    SimTime time{};
    std::string_view type;  ///< "image/jpeg", or "image/png" for depths: 16 bits, millimetres
    std::string bytes;
};

/// The newest requested picture of each camera and depth frame of each ranger, captured and encoded
/// once for all clients. Uses at most half of the time, and captures each sensor at most a hundred
/// times a second.
class PictureFiles {
  public:
    using WallTime = std::chrono::steady_clock::time_point;
    /// Runs `work`, now or later in another thread, then calls `deliver` in the world's thread with
    /// the exception that was thrown, or null.
    using Doer = std::function<void(std::function<void()> work,
                                    std::function<void(const std::exception_ptr&)> deliver)>;

    /// A requested picture.
    struct PendingPicture {
        std::shared_ptr<const PictureFile> file;  ///< null until it is encoded
        std::exception_ptr failure;               ///< set if capturing or encoding failed
    };
    /// Requests the newest picture: captured now, or shared with a request that is still pending.
    /// Empty if the sensor must wait for its turn: ask again. `at_once` skips that wait. Fails with
    /// FormatError if OpenCV's imgcodecs, which write JPEG, cannot be loaded.
    std::shared_ptr<const PendingPicture> newest(World& world, std::size_t sensor, WallTime now,
                                                 bool at_once, const Doer& does);

  private:
    struct Entry {
        std::shared_ptr<PendingPicture> asked;
        std::int64_t seq = 0;      // of the sensor's period
        std::int64_t changes = 0;  // change count of the world at the request
        WallTime next{};
    };
    void make(World& world, std::size_t sensor, const Entry& entry, const Doer& does);

    std::map<std::pair<const World*, std::string>, Entry> entries_;  // by world and sensor id
    WallTime next_{};
};

}  // namespace ispace::wire
