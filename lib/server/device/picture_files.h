// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "sim/world.h"

namespace ispace {

/// A picture or a depth frame as a file.
struct PictureFile {
    std::int64_t seq = 0;  ///< of the sensor's period
    SimTime time{};
    std::string_view type;  ///< "image/jpeg", or "image/png" of depths: 16 bits, millimetres
    std::string bytes;
};

/// The newest picture of every camera and depth frame of every ranger that somebody asks for, taken
/// and encoded once for all of them. That takes half of the time at most, and each sensor's turn
/// comes a hundred times a second at most.
class PictureFiles {
  public:
    using WallTime = std::chrono::steady_clock::time_point;
    /// Does `work`, now or later in another thread, and then calls `deliver` in that of the world
    /// with what it threw, or null.
    using Doer = std::function<void(std::function<void()> work,
                                    std::function<void(const std::exception_ptr&)> deliver)>;

    /// One that was asked for.
    struct Asked {
        std::shared_ptr<const PictureFile> file;  ///< null until it is made
        std::exception_ptr failure;               ///< of making it
    };
    /// The newest picture, as the sensor sees the world now or saw it when others asked for one
    /// that is still being made. Nothing if it has to wait for its turn: ask again. With `at_once`
    /// none has to wait. It fails with FormatError where OpenCV's imgcodecs, which write JPEG,
    /// cannot be opened.
    std::shared_ptr<const Asked> newest(World& world, std::size_t sensor, WallTime now,
                                        bool at_once, const Doer& does);

  private:
    struct Entry {
        std::shared_ptr<Asked> asked;
        std::int64_t seq = 0;      // of its period
        std::int64_t changes = 0;  // of the world, when it was asked for
        WallTime next{};
    };
    void make(World& world, std::size_t sensor, const Entry& entry, const Doer& does);

    std::map<std::string, Entry, std::less<>> entries_;  // by the sensor's id
    WallTime next_{};
};

}  // namespace ispace
