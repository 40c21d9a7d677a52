// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/pose.h"

namespace ispace {

/// A scan as a line of JSON has it.
struct RecordedScan {
    std::string sensor;
    double time = 0;  ///< seconds
    int frame = 0;
    int number = 0;             ///< within a sweep
    Pose3 pose;                 ///< of the sensor
    std::vector<float> ranges;  ///< metres; +infinity is no return
};

/// Reads the scans of lasers out of lines as `scan` and records of `simrun` have them
/// (ispace-scan/1), whatever the size of the file. Readings of other sensors are passed over, and a
/// last line without its end, as of a run that was killed, is left out.
class RecordedScans {
  public:
    /// Appends more bytes to a buffer; false at the end of the file.
    using Reader = std::function<bool(std::string& buffer)>;
    /// \param name of the file, for messages
    RecordedScans(Reader read, std::string name) : read_(std::move(read)), name_(std::move(name)) {}
    /// The next scan; nothing at the end. \throws FormatError with the line
    std::optional<RecordedScan> next();

  private:
    std::optional<std::string_view> nextLine();

    Reader read_;
    std::string name_, buffer_;
    std::size_t begin_ = 0;
    int line_ = 0;
};

}  // namespace ispace
