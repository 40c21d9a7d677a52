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

/// Supplies the jobs of a run, in order, in batches.
class ReadingSource {
  public:
    virtual ~ReadingSource() = default;
    /// Stores the next jobs in `batch`, at most about `most`, as soon as some are available; an
    /// empty batch ends the source. Memory is bounded. On an exception, `batch` holds the jobs
    /// before the error.
    virtual void next(std::size_t most, std::vector<ReadingJob>& batch) = 0;
    /// Skips the next jobs, at most `most`, and returns their number. O(jobs)
    virtual std::int64_t skip(std::int64_t most);
};

/// Jobs of placed sensors, each at its rate from time 0 on: frame by frame, the sensors in order.
class StillSource final : public ReadingSource {
  public:
    StillSource(const Sensors& sensors, int frames) : sensors_(&sensors), frames_(frames) {}
    void next(std::size_t most, std::vector<ReadingJob>& batch) override;
    /// Skips in O(1).
    std::int64_t skip(std::int64_t most) override;
    /// Returns the number of all jobs.
    [[nodiscard]] std::int64_t count() const;

  private:
    const Sensors* sensors_;
    int frames_;
    int frame_ = 0;
    std::size_t sensor_ = 0;
};

/// Limits a source to a number of jobs.
class LimitedSource final : public ReadingSource {
  public:
    LimitedSource(ReadingSource& source, std::int64_t most) : source_(&source), left_(most) {}
    void next(std::size_t most, std::vector<ReadingJob>& batch) override;

  private:
    ReadingSource* source_;
    std::int64_t left_;
};

/// Appends more bytes to a buffer; returns false at the end of the file.
using ByteReader = std::function<bool(std::string& buffer)>;

/// Reads the poses of a TUM trajectory, line by line.
class PoseLines {
  public:
    /// `name` is the file's name in messages.
    PoseLines(ByteReader read, std::string name) : read_(std::move(read)), name_(std::move(name)) {}
    enum class Wait { Yes, No };
    /// Returns the next pose; empty at the end, or if it may not wait and no pose has arrived yet.
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

/// Jobs of one sensor, one at each pose of a trajectory: frame k at pose k and its time.
class PoseSource final : public ReadingSource {
  public:
    explicit PoseSource(PoseLines poses) : poses_(std::move(poses)) {}
    void next(std::size_t most, std::vector<ReadingJob>& batch) override;

  private:
    PoseLines poses_;
    int frame_ = 0;
};

/// Jobs of one sensor that moves along a trajectory: frame k begins at the first pose's time + k /
/// rate and must end before the last pose. Stops after `frames` frames if set; else at most
/// kMaxBetween frames may lie between two poses, since a mistyped time would produce millions.
/// \throws FormatError if times do not increase or poses are too far apart
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
    std::vector<std::vector<ReadingFile>> files;  ///< of each job, for formats with separate files
    std::vector<PointCloud> clouds;               ///< of each job, if they are joined
};

/// The output form of readings.
enum class Packing { Stream, Files, Clouds };

/// Takes all readings of a source on all cores and passes them to `write` in order, from one thread
/// at a time. Memory is bounded by the number of cores, not of jobs. If the source fails, all
/// readings before the error are still written.
void runReadings(ReadingSource& source, ReadingSampler& taker, const Sensors& sensors,
                 const ReadingFormat& format, Packing packing, Coordinates coordinates,
                 Progress& progress, const std::function<void(Readings&)>& write);

}  // namespace ispace
