// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "sense/formats/reading_format.h"
#include "sense/reading.h"

namespace ispace {

/// Supplies the readings to be taken, in order, a batch at a time.
class ReadingSource {
  public:
    virtual ~ReadingSource() = default;
    /// Puts the next jobs into `batch`, some `most` at most, as soon as there are any; none at the
    /// end. Memory stays bounded. If it throws, `batch` holds the jobs before the error.
    virtual void next(std::size_t most, std::vector<ReadingJob>& batch) = 0;
    /// Leaves out the next jobs, `most` at most; returns how many there were. O(jobs)
    virtual std::int64_t skip(std::int64_t most);
};

/// Placed sensors, each at its rate from time 0 on: frame by frame, the sensors in order.
class StillSource final : public ReadingSource {
  public:
    StillSource(const Sensors& sensors, int frames) : sensors_(&sensors), frames_(frames) {}
    void next(std::size_t most, std::vector<ReadingJob>& batch) override;
    /// O(1)
    std::int64_t skip(std::int64_t most) override;
    /// All jobs.
    [[nodiscard]] std::int64_t count() const;

  private:
    const Sensors* sensors_;
    int frames_;
    int frame_ = 0;
    std::size_t sensor_ = 0;
};

/// The next jobs of a source, so many at most.
class LimitedSource final : public ReadingSource {
  public:
    LimitedSource(ReadingSource& source, std::int64_t most) : source_(&source), left_(most) {}
    void next(std::size_t most, std::vector<ReadingJob>& batch) override;

  private:
    ReadingSource* source_;
    std::int64_t left_;
};

/// Reads more bytes to the end of a buffer; false at the end of the file.
using ByteReader = std::function<bool(std::string& buffer)>;

/// The poses of a TUM trajectory, line by line.
class PoseLines {
  public:
    /// `name` is that of the file, for messages.
    PoseLines(ByteReader read, std::string name) : read_(std::move(read)), name_(std::move(name)) {}
    enum class Wait { Yes, No };
    /// The next pose; nothing at the end, or if it may not wait and none has arrived yet.
    /// \throws FormatError with file and line
    std::optional<TimedPose> next(Wait wait = Wait::Yes);
    [[nodiscard]] int line() const { return line_; }
    [[nodiscard]] FormatError error(const std::string& message) const;

  private:
    std::optional<std::string_view> nextLine(Wait wait);

    ByteReader read_;
    std::string name_;
    std::string buffer_;
    std::size_t begin_ = 0;
    int line_ = 0;
    bool done_ = false;
};

/// One sensor, at each pose of a trajectory once: frame k at pose k and its time.
class PoseSource final : public ReadingSource {
  public:
    explicit PoseSource(PoseLines poses) : poses_(std::move(poses)) {}
    void next(std::size_t most, std::vector<ReadingJob>& batch) override;

  private:
    PoseLines poses_;
    int frame_ = 0;
};

/// One sensor that drives along a trajectory: frame k begins at the first pose's time + k / rate
/// and must end before the last pose. It stops after `frames` frames if given; else there may be at
/// most kMaxBetween frames between two poses, since a mistyped time would mean millions. \throws
/// FormatError if times do not grow or poses are too far apart
class MotionSource final : public ReadingSource {
  public:
    static constexpr int kMaxBetween = 100'000;

    MotionSource(PoseLines poses, double rate, double duration, std::optional<int> frames = {})
        : poses_(std::move(poses)), rate_(rate), duration_(duration), frames_(frames) {}
    void next(std::size_t most, std::vector<ReadingJob>& batch) override;

  private:
    bool reach(double begin, double time, PoseLines::Wait wait);
    void follow(const TimedPose& timed);

    PoseLines poses_;
    double rate_, duration_;
    std::optional<int> frames_;
    double begin_ = 0;
    std::deque<TimedPose> window_;
    int frame_ = 0;
};

/// Readings ready to be written, in the order of their jobs.
struct Readings {
    std::vector<ReadingJob> jobs;
    std::string text;                             ///< of a stream
    std::vector<std::vector<ReadingFile>> files;  ///< of each job, where each has files of its own
    std::vector<PointCloud> clouds;               ///< of each job, where they are joined
};

/// What a reading is turned into.
enum class Packing { Stream, Files, Clouds };

/// Takes all readings of a source on all cores and hands them to `write` in order, from one thread
/// at a time. Memory is bounded by the number of cores, not of jobs. If the source fails,
/// everything before the error is still written.
void runReadings(ReadingSource& source, ReadingSampler& taker, const Sensors& sensors,
                 const ReadingFormat& format, Packing packing, Coordinates coordinates,
                 Progress& progress, const std::function<void(Readings&)>& write);

}  // namespace ispace
