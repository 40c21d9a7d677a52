// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of readings: sources of jobs, and a pipeline that takes them on all cores and writes them in
// order. Bytes are the same for any number of threads. Two batches a core are in flight at most,
// fewer if pictures are so large that they would take more than 2 GiB.
//
//     StillSource source(sensors, 100);  // 100 frames of each sensor
//     runReadings(source, taker, sensors, *format, Packing::Stream, Coordinates::World, progress,
//                 [&](Readings& some) { out += some.text; });
#pragma once

#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <optional>
#include <span>
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

/// Jobs of placed sensors, each at its rate from time 0 on: room by room, in each frame by frame,
/// the sensors in order.
class StillSource final : public ReadingSource {
  public:
    /// \param rooms of the sensors; empty: one
    StillSource(const Sensors& sensors, int frames, std::span<const SensorRoom> rooms = {})
        : sensors_(&sensors), rooms_(rooms), frames_(frames) {}
    void next(std::size_t most, std::vector<ReadingJob>& batch) override;
    /// Skips in O(1).
    std::int64_t skip(std::int64_t most) override;
    /// Returns the number of all jobs.
    [[nodiscard]] std::int64_t count() const;

  private:
    [[nodiscard]] ReadingJob jobAt(std::int64_t index) const;

    const Sensors* sensors_;
    std::span<const SensorRoom> rooms_;
    int frames_;
    std::int64_t next_ = 0;
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

/// Splits the jobs of a source where their room changes.
class RoomParts final : public ReadingSource {
  public:
    using RoomOf = std::function<std::size_t(const ReadingJob&)>;
    RoomParts(ReadingSource& source, RoomOf room_of)
        : source_(&source), room_of_(std::move(room_of)) {}
    /// Begins the next part, which next() supplies, and returns its room; empty at the end of the
    /// source. \param most jobs to read ahead, as of next() \throws as the source
    std::optional<std::size_t> begin(std::size_t most);
    void next(std::size_t most, std::vector<ReadingJob>& batch) override;

  private:
    void fill(std::size_t most);

    ReadingSource* source_;
    RoomOf room_of_;
    std::vector<ReadingJob> jobs_;  // read ahead
    std::size_t at_ = 0;
    std::exception_ptr failure_;  // of the source, after these
    std::size_t room_ = 0;
};

/// Appends more bytes to a buffer; returns false at the end of the file.
using ByteReader = std::function<bool(std::string& buffer)>;

/// Reads the poses of a TUM trajectory, line by line; lines of more than 4096 bytes are rejected.
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

/// Returns the number of jobs that runReadings() asks for at once.
std::size_t batchSize(const Sensors& sensors);

/// Takes all readings of a source on all cores and passes them to `write` in order, from one thread
/// at a time. Memory is bounded by the number of cores, not of jobs. If the source fails, all
/// readings before the error are still written, then its exception is thrown. If `write` fails, no
/// further readings are written.
/// \param site_from_room level, the frame of the jobs and of the readings written; null: that of
/// the room, in which the taker reads
void runReadings(ReadingSource& source, ReadingSampler& taker, const Sensors& sensors,
                 const ReadingFormat& format, Packing packing, Coordinates coordinates,
                 Progress& progress, const std::function<void(Readings&)>& write,
                 const Pose3* site_from_room = nullptr);

}  // namespace ispace
