// SPDX-License-Identifier: GPL-3.0-or-later
// For the formats of readings: what they have in common, and those that have a file of their own.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sense/reading_fields.h"
#include "sense/reading_format.h"

namespace ispace {

/// The sensors of a format, and one file a reading.
class FormatBase : public ReadingFormat {
  public:
    FormatBase(const Sensors& sensors, FormatOptions options, std::string ending)
        : sensors_(sensors), options_(std::move(options)), ending_(std::move(ending)) {}

    [[nodiscard]] std::vector<ReadingFile> files(std::size_t index,
                                                 const Reading& reading) const override {
        return {{ending_, whole(index, reading)}};
    }

    [[nodiscard]] std::vector<std::string> endings() const override { return {ending_}; }

  protected:
    [[nodiscard]] const Sensor& sensor(std::size_t index) const { return sensors_.read[index]; }
    /// \throws UsageError for the first sensor that is none of these
    void accept(std::string_view format, std::string_view what,
                bool (*is_held)(const Sensor&)) const;
    [[noreturn]] static void refuse(std::string_view format, std::string_view what,
                                    const Sensor& one);
    /// A reading as a file of its own.
    [[nodiscard]] virtual std::string whole(std::size_t index, const Reading& reading) const;
    static bool hasRanges(const Sensor& one) { return readingKind(one.model).points != nullptr; }
    static bool isCamera(const Sensor& one) { return one.is<Camera>(); }

    static constexpr const char* kCameraInfo = ".yaml";

    const Sensors& sensors_;
    const FormatOptions options_;

  private:
    std::string ending_;
};

/// MCAP with messages of ROS 2.
std::unique_ptr<ReadingFormat> makeMcap(const Sensors& sensors, FormatOptions options);
/// NumPy: arrays of all sensors, or the one of a single sensor.
std::unique_ptr<ReadingFormat> makeNpz(const Sensors& sensors, FormatOptions options);
std::unique_ptr<ReadingFormat> makeNpy(const Sensors& sensors, FormatOptions options);
/// LAS 1.4: the points of all lasers and rangers.
std::unique_ptr<ReadingFormat> makeLas(const Sensors& sensors, FormatOptions options);

}  // namespace ispace
