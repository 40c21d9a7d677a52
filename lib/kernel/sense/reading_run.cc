// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading_run.h"

#include <tbb/concurrent_queue.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>

#include "base/error.h"
#include "base/number.h"

namespace ispace {

namespace {

/// A longer line is not a pose.
constexpr std::size_t kMaxLineBytes = 4096;

constexpr int kLastFrame = std::numeric_limits<int>::max();

}  // namespace

std::int64_t ReadingSource::skip(std::int64_t most) {
    constexpr std::int64_t kAtOnce = 1024;
    std::vector<ReadingJob> batch;
    std::int64_t done = 0;
    while (done < most) {
        next(static_cast<std::size_t>(std::min(kAtOnce, most - done)), batch);
        if (batch.empty()) break;
        done += static_cast<std::int64_t>(batch.size());
    }
    return done;
}

void LimitedSource::next(std::size_t most, std::vector<ReadingJob>& batch) {
    batch.clear();
    if (left_ <= 0) return;
    source_->next(static_cast<std::size_t>(std::min(left_, static_cast<std::int64_t>(most))),
                  batch);
    left_ -= static_cast<std::int64_t>(batch.size());
}

std::int64_t StillSource::skip(std::int64_t most) {
    const std::int64_t skipped = std::min(most, count() - next_);
    next_ += skipped;
    return skipped;
}

std::int64_t StillSource::count() const {
    return static_cast<std::int64_t>(frames_) * static_cast<std::int64_t>(sensors_->read.size());
}

void StillSource::next(std::size_t most, std::vector<ReadingJob>& batch) {
    batch.clear();
    for (const std::int64_t all = count(); batch.size() < most && next_ < all; ++next_)
        batch.push_back(jobAt(next_));
}

ReadingJob StillSource::jobAt(std::int64_t index) const {
    std::size_t begin = 0, end = sensors_->read.size();
    for (const SensorRoom& room : rooms_) {
        const std::int64_t in_room =
            static_cast<std::int64_t>(frames_) * static_cast<std::int64_t>(room.read_end - begin);
        end = room.read_end;
        if (index < in_room) break;
        index -= in_room;
        begin = end;
    }
    const auto a_frame = static_cast<std::int64_t>(end - begin);
    const auto frame = static_cast<int>(index / a_frame);
    const std::size_t sensor = begin + static_cast<std::size_t>(index % a_frame);
    const Sensor& one = sensors_->read[sensor];
    return {.sensor = sensor,
            .frame = frame,
            .time = wholeNanoseconds(frame / readingRate(one.model)),
            .pose = one.pose,
            .way = {}};
}

void RoomParts::fill(std::size_t most) {
    if (at_ < jobs_.size()) return;
    if (failure_) std::rethrow_exception(failure_);
    jobs_.clear();
    at_ = 0;
    try {
        source_->next(most, jobs_);
    } catch (...) {
        failure_ = std::current_exception();
        if (jobs_.empty()) throw;
    }
}

std::optional<std::size_t> RoomParts::begin(std::size_t most) {
    fill(most);
    if (jobs_.empty()) return std::nullopt;
    return room_ = room_of_(jobs_[at_]);
}

void RoomParts::next(std::size_t most, std::vector<ReadingJob>& batch) {
    batch.clear();
    fill(most);
    for (; batch.size() < most && at_ < jobs_.size() && room_of_(jobs_[at_]) == room_; ++at_)
        batch.push_back(std::move(jobs_[at_]));
}

FormatError PoseLines::error(const std::string& message) const {
    return FormatError({name_, line_, 0, message});
}

std::optional<std::string_view> PoseLines::nextLine(Wait wait) {
    std::size_t end = buffer_.find('\n', begin_);
    while (end == std::string::npos && !done_) {
        if (wait == Wait::No) return std::nullopt;
        buffer_.erase(0, begin_);
        begin_ = 0;
        if (buffer_.size() > kMaxLineBytes) {
            ++line_;
            throw error("a line of more than " + std::to_string(kMaxLineBytes) +
                        " bytes; a pose is `t x y z qx qy qz qw`");
        }
        const std::size_t searched = buffer_.size();
        done_ = !read_(buffer_);
        end = buffer_.find('\n', searched);
    }
    if (end == std::string::npos) {
        if (begin_ == buffer_.size()) return std::nullopt;
        end = buffer_.size();  // the last line, without newline
    }
    std::string_view line = std::string_view(buffer_).substr(begin_, end - begin_);
    begin_ = std::min(end + 1, buffer_.size());
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (line_++ == 0 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    return line;
}

std::optional<TimedPose> PoseLines::next(Wait wait) {
    while (const auto line = nextLine(wait)) {
        try {
            if (auto pose = parseTumLine(*line)) return pose;
        } catch (const FormatError& bad) {
            Diagnostic finding = bad.diagnostics().front();
            finding.file = name_;
            finding.line = line_;
            throw FormatError(finding);
        }
    }
    return std::nullopt;
}

void PoseSource::next(std::size_t most, std::vector<ReadingJob>& batch) {
    batch.clear();
    // A program that writes a pose and waits for its scan must receive it.
    using Wait = PoseLines::Wait;
    while (batch.size() < most) {
        const auto timed = poses_.next(batch.empty() ? Wait::Yes : Wait::No);
        if (!timed) return;
        batch.push_back(
            {.sensor = 0, .frame = frame_, .time = timed->time, .pose = timed->pose, .way = {}});
        if (frame_ < kLastFrame) ++frame_;
    }
}

/// Compares the next pose with the last one.
void MotionSource::follow(const TimedPose& timed) {
    const double last = window_.back().time;
    if (timed.time <= last)
        throw poses_.error("time does not grow; a sensor in motion is at one place at a time");
    const double readings = (timed.time - last) * rate_;
    if (frames_ || readings <= kMaxBetween) return;
    throw poses_.error("from t=" + formatDouble(last) + " to t=" + formatDouble(timed.time) +
                       " are " + formatDouble(std::round(readings)) + " readings at " +
                       formatDouble(rate_) + " Hz, wanted at most " + std::to_string(kMaxBetween) +
                       " between two poses; are times in seconds? --frames N takes as many as N");
}

/// Reads until the path from `begin` reaches a time; returns false if it ends before, or more input
/// is pending.
bool MotionSource::reach(double begin, double time, PoseLines::Wait wait) {
    while (window_.empty() || window_.back().time < time) {
        const auto timed = poses_.next(wait);
        if (!timed) return false;
        if (!window_.empty()) follow(*timed);
        // Drops poses before the last one not after `begin`.
        if (window_.size() > 1 && window_[1].time <= begin) window_.pop_front();
        window_.push_back(*timed);
    }
    return true;
}

void MotionSource::next(std::size_t most, std::vector<ReadingJob>& batch) {
    batch.clear();
    if (window_.empty()) {
        const auto first = poses_.next();
        if (!first) return;
        window_.push_back(*first);
        begin_ = first->time;
    }
    using Wait = PoseLines::Wait;
    while (batch.size() < most && !(frames_ && frame_ >= *frames_)) {
        const double time = wholeNanoseconds(begin_ + frame_ / rate_);
        if (!reach(time, time + duration_, batch.empty() ? Wait::Yes : Wait::No)) return;
        // Drops poses before the last one not after `time`.
        while (window_.size() > 1 && window_[1].time <= time) window_.pop_front();
        ReadingJob job{.sensor = 0, .frame = frame_, .time = time, .pose = {}, .way = {}};
        for (const TimedPose& timed : window_) {
            job.way.push_back(timed);
            if (timed.time >= time + duration_) break;
        }
        job.pose = poseAlong(job.way, time);
        batch.push_back(std::move(job));
        if (frame_ < kLastFrame) ++frame_;
    }
}

namespace {

/// Rays per batch: enough to hide the cost of a batch, few enough for the cache.
constexpr std::size_t kBatchRays = 1 << 15;

/// Returns the maximum number of rays of a sensor.
std::size_t mostRays(const Sensors& sensors) {
    std::size_t most = 1;
    for (const Sensor& sensor : sensors.read) most = std::max(most, rayCount(sensor.model));
    return most;
}

/// Returns the number of parallel batches: enough for all cores, and few if large pictures would
/// exhaust memory.
std::size_t batchesOf(const Sensors& sensors) {
    constexpr std::size_t kMaxBytes = std::size_t{2} << 30U;
    std::size_t bytes = 1;
    for (const Sensor& sensor : sensors.read) {
        const std::size_t of_ray = sensor.is<Camera>() ? 200 : 64;
        bytes = std::max(bytes, of_ray * rayCount(sensor.model));
    }
    const auto cores = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    return std::clamp<std::size_t>(kMaxBytes / bytes, 1, 2 * std::max<std::size_t>(1, cores));
}

ReadingJob toInner(const Pose3& outer_from_inner, const ReadingJob& job) {
    ReadingJob inner = job;
    inner.pose = toInner(outer_from_inner, job.pose);
    for (TimedPose& timed : inner.way) timed.pose = toInner(outer_from_inner, timed.pose);
    return inner;
}

/// Takes the reading of a job in the frame of the site.
Reading takeFrom(const Pose3& site_from_room, ReadingSampler& taker, const ReadingJob& job) {
    Reading reading = taker.take(toInner(site_from_room, job));
    const auto move = [&](auto& value) {
        // A sensor that stands still is where the job says, without errors of rounding.
        if constexpr (requires { value.pose = job.pose; })
            value.pose = value.pose == toInner(site_from_room, job.pose)
                             ? job.pose
                             : toOuter(site_from_room, value.pose);
        if constexpr (requires { value.beam_poses; })
            for (Pose3& pose : value.beam_poses) pose = toOuter(site_from_room, pose);
    };
    std::visit(
        [&](auto& value) {
            if constexpr (requires { value.begin(); })
                for (auto& one : value) move(one);
            else
                move(value);
        },
        reading);
    return reading;
}

}  // namespace

std::size_t batchSize(const Sensors& sensors) {
    return std::max<std::size_t>(1, kBatchRays / mostRays(sensors));
}

void runReadings(ReadingSource& source, ReadingSampler& taker, const Sensors& sensors,
                 const ReadingFormat& format, Packing packing, Coordinates coordinates,
                 Progress& progress, const std::function<void(Readings&)>& write,
                 const Pose3* site_from_room) {
    using Batch = std::shared_ptr<Readings>;
    const std::size_t most = batchSize(sensors);
    // Batches are recycled, with their memory.
    tbb::concurrent_queue<Batch> spare;
    // Jobs before a bad pose are written, for any number of threads.
    std::exception_ptr failure;
    // Not thrown in the pipeline, which would cancel the loops of readings in other threads, and
    // leave them incomplete.
    std::exception_ptr write_failure;
    std::atomic<bool> is_over = false;
    const auto read = [&](tbb::flow_control& control) -> Batch {
        Batch batch;
        if (!spare.try_pop(batch)) batch = std::make_shared<Readings>();
        batch->text.clear();
        batch->files.clear();
        batch->clouds.clear();
        batch->jobs.clear();
        try {
            if (!failure && !is_over) source.next(most, batch->jobs);
        } catch (...) {
            failure = std::current_exception();
        }
        if (batch->jobs.empty()) {
            control.stop();
            return nullptr;
        }
        for (const ReadingJob& job : batch->jobs)
            taker.prepare(site_from_room == nullptr ? job : toInner(*site_from_room, job));
        return batch;
    };
    const auto take = [&](Batch batch) {
        for (const ReadingJob& job : batch->jobs) {
            const Reading reading =
                site_from_room == nullptr ? taker.take(job) : takeFrom(*site_from_room, taker, job);
            switch (packing) {
                case Packing::Stream:
                    format.append(batch->text, job.sensor, reading);
                    break;
                case Packing::Files:
                    batch->files.push_back(format.files(job.sensor, reading));
                    break;
                case Packing::Clouds:
                    batch->clouds.push_back(format.points(job.sensor, reading, coordinates));
                    break;
            }
        }
        return batch;
    };
    const auto deliver_batch = [&](const Batch& batch) {
        if (is_over) return;
        try {
            write(*batch);
            progress.advance(static_cast<std::int64_t>(batch->jobs.size()));
        } catch (...) {
            write_failure = std::current_exception();
            is_over = true;
        }
        spare.push(batch);
    };
    tbb::parallel_pipeline(
        batchesOf(sensors),
        tbb::make_filter<void, Batch>(tbb::filter_mode::serial_in_order, read) &
            tbb::make_filter<Batch, Batch>(tbb::filter_mode::parallel, take) &
            tbb::make_filter<Batch, void>(tbb::filter_mode::serial_in_order, deliver_batch));
    if (write_failure) std::rethrow_exception(write_failure);
    if (failure) std::rethrow_exception(failure);
}

}  // namespace ispace
