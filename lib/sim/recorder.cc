// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/recorder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <filesystem>
#include <limits>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "sense/reading_text.h"

namespace ispace {

namespace {

using std::chrono::steady_clock;

constexpr auto kFlushEvery = std::chrono::milliseconds(100);
constexpr std::size_t kMaxPending = std::size_t{1} << 20;  // bytes of a file

[[noreturn]] void fail(const std::string& name, int error) {
    throw std::system_error(error, std::generic_category(), name);
}

std::string_view wholeLines(std::string_view text) {
    return text.substr(0, text.rfind('\n') + 1);  // npos + 1 is 0
}

/// An empty file for writing. What an earlier run left is removed, not overwritten: it may have
/// another name elsewhere. Links are not followed.
int openAnew(const std::string& name) {
    struct stat info {
    }, behind{};
    if (::lstat(name.c_str(), &info) == 0) {
        const bool is_link = S_ISLNK(info.st_mode);
        if (is_link && (::stat(name.c_str(), &behind) != 0 || S_ISREG(behind.st_mode)))
            throw FormatError({name, 0, 0,
                               "a symbolic link to a file, and records follow none: remove it, or "
                               "record into another folder"});
        const mode_t mode = is_link ? behind.st_mode : info.st_mode;
        if (S_ISCHR(mode) || S_ISFIFO(mode))
            // Not to wait for a reader, should it be a pipe.
            return ::open(name.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
        if (::unlink(name.c_str()) != 0) return -1;
    }
    return ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

/// A file that grows by whole lines, those of a step after those of the step before.
class LineFile {
  public:
    explicit LineFile(std::string name) : name_(std::move(name)), fd_(openAnew(name_)) {
        if (fd_ < 0) fail(name_, errno);
        ::fcntl(fd_, F_SETFL, O_WRONLY);
    }
    ~LineFile() { ::close(fd_); }
    LineFile(const LineFile&) = delete;
    LineFile& operator=(const LineFile&) = delete;

    /// What the next flush writes, up to the last newline.
    std::string pending;

    /// What is pending ends with the lines of this step.
    void endStep(std::int64_t step) {
        ends_.push_back({step, size_ + static_cast<off_t>(pending.size())});
    }
    /// The last step whose lines are all in the file, of those since the last forget().
    [[nodiscard]] std::int64_t wholeSteps() const {
        std::int64_t steps = 0;
        for (const StepEnd& end : ends_)
            if (end.size <= size_) steps = end.step;
        return steps;
    }
    /// Cuts the file behind this step. Devices and pipes refuse to be cut and have nothing to
    /// keep.
    void cutBehind(std::int64_t step) {
        pending.clear();
        off_t end = size_;
        for (const StepEnd& each : ends_)
            if (each.step == step && each.size <= size_) end = each.size;
        if (end < size_) static_cast<void>(!::ftruncate(fd_, size_ = end));
    }
    /// All ends of steps but the last may go: nothing will be cut there.
    void forget() {
        if (ends_.size() > 1) ends_.erase(ends_.begin(), ends_.end() - 1);
    }

    /// Puts `text` in place of the whole content, which must not have been longer. Of less than a
    /// page, it is written whole or not at all.
    void rewrite(std::string_view text) {
        if (error_ == 0) {
            const ssize_t n = ::pwrite(fd_, text.data(), text.size(), 0);
            if (n != static_cast<ssize_t>(text.size())) error_ = n < 0 ? errno : ENOSPC;
        }
        if (error_ != 0) fail(name_, error_);
    }

    /// After an error nothing more is written and each call throws it again: lines behind a gap
    /// would pass for the whole.
    void flush() {
        if (error_ == 0 && !pending.empty()) write();
        pending.clear();
        if (error_ != 0) fail(name_, error_);
    }

    [[nodiscard]] std::uint64_t size() const { return static_cast<std::uint64_t>(size_); }

  private:
    struct StepEnd {
        std::int64_t step;
        off_t size;  // of the file with it
    };

    void write() {
        // An exception while a line was put together may have left a piece of one.
        const std::string_view lines = wholeLines(pending);
        std::string_view rest = lines;
        while (!rest.empty()) {
            const ssize_t n = ::write(fd_, rest.data(), rest.size());
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) {
                error_ = errno;
                takeBackTornLine(lines.substr(0, lines.size() - rest.size()));
                return;
            }
            rest.remove_prefix(static_cast<std::size_t>(n));
        }
        size_ += static_cast<off_t>(lines.size());
    }

    /// A full disk may have taken a piece of the last line.
    void takeBackTornLine(std::string_view written) {
        size_ += static_cast<off_t>(wholeLines(written).size());
        static_cast<void>(!::ftruncate(fd_, size_));
    }

    std::string name_;
    int fd_;
    int error_ = 0;
    off_t size_ = 0;  // bytes of whole lines in the file
    std::vector<StepEnd> ends_;
};

/// `folder`, made if it is missing.
const std::string& madeFolder(const std::string& folder) {
    if (::mkdir(folder.c_str(), 0777) != 0) {
        if (errno != EEXIST) fail(folder, errno);
        struct stat info {};
        if (::stat(folder.c_str(), &info) != 0) fail(folder, errno);
        if (!S_ISDIR(info.st_mode)) fail(folder, ENOTDIR);
    }
    return folder;
}

/// The lock of a folder that is recorded into.
class FolderLock {
  public:
    /// Waits a moment for a run that is just ending. \throws FormatError if another run goes on
    /// there
    explicit FolderLock(const std::string& folder)
        : fd_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        constexpr int kTries = 100;
        // File systems without locks do without.
        for (int tries = 0; fd_ >= 0 && ::flock(fd_, LOCK_EX | LOCK_NB) != 0; ++tries) {
            if (errno != EWOULDBLOCK) return;
            if (tries == kTries) {
                ::close(fd_);
                throw FormatError({folder, 0, 0, "another run is being recorded here"});
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    }
    ~FolderLock() {
        if (fd_ >= 0) ::close(fd_);
    }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    [[nodiscard]] int descriptor() const { return fd_; }

  private:
    int fd_;
};

/// In the order of Recorder::filesIn.
enum File { kRobots, kScans, kTiming, kInfo };

}  // namespace

struct Recorder::Data {
    explicit Data(const std::string& name)
        : folder(name),
          lock(madeFolder(folder)),
          names(filesIn(folder)),
          robots(names[kRobots]),
          scans(names[kScans]),
          timing(names[kTiming]),
          info(names[kInfo]) {}

    std::string folder;
    FolderLock lock;
    std::vector<std::string> names;
    LineFile robots, scans, timing, info;
    steady_clock::time_point started = steady_clock::now(), flushed = started;
    // As of the last record, for what the destructor writes.
    SimTime time{}, step_length{};
    std::int64_t steps = 0;
    std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max();
    bool flushed_all = false;  // nothing was recorded since the last flush
    std::exception_ptr ended;  // what ended the record early

    void remember(const World& world);
    void appendRobots(const World& world);
    void appendScans(const World& world);
    void writeLines();
    void writeInfo();
    void endEarly();
    void flush();
};

void Recorder::Data::remember(const World& world) {
    time = world.time();
    step_length = world.stepLength();
    steps = world.steps();
    flushed_all = false;
}

void Recorder::Data::appendRobots(const World& world) {
    const std::string t = formatSimTime(world.time());
    std::string& out = robots.pending;
    for (std::size_t i = 0; i < world.robots().size(); ++i) {
        const RobotStatus status = world.status(i);
        out += t;
        out += ',';
        out += world.robots()[i].id;  // a word: nothing to quote
        for (const double value :
             {status.pose.position.x, status.pose.position.y, status.pose.heading.degrees(),
              status.speed, status.rotspeed.degrees(), status.accel, status.rotaccel.degrees()}) {
            out += ',';
            appendDouble(out, value);
        }
        out += status.stall ? ",1\n" : ",0\n";
    }
    robots.endStep(world.steps());
}

void Recorder::Data::appendScans(const World& world) {
    for (const std::size_t i : world.read()) {
        const SensorReading& reading = world.reading(i);
        if (const auto* scan = std::get_if<Scan>(&reading.value))
            appendScanLine(scans.pending, *world.sensors()[i].sensor(), *scan);
        // One step of many lasers may be more than should be held.
        if (scans.pending.size() > kMaxPending) scans.flush();
    }
    scans.endStep(world.steps());
}

void Recorder::Data::writeInfo() {
    const std::string dt = formatSimTime(step_length);
    // Commands take effect at every step: the control interval is that of the steps.
    std::string text = "dt,control_interval,steps\n";
    text.append(dt).append(",").append(dt).append(",").append(std::to_string(steps)).append("\n");
    info.rewrite(text);
}

void Recorder::Data::writeLines() {
    robots.flush();
    scans.flush();
    robots.forget();
    scans.forget();
    writeInfo();
    const std::chrono::duration<double> wall = flushed - started;
    timing.pending.append(formatSimTime(time)).append(",").append(formatFixed(wall.count(), 6));
    timing.pending.append(",").append(std::to_string(steps)).append("\n");
    timing.flush();
    flushed_all = true;
    if (const std::uint64_t bytes = robots.size() + scans.size(); bytes > max_bytes)
        throw FormatError({folder, 0, 0,
                           "the record has " + std::to_string(bytes) +
                               " bytes at t=" + formatSimTime(time) + ", wanted at most " +
                               std::to_string(max_bytes) + " (--record-limit)"});
}

/// A file cannot be written: the record ends with the last step that is whole in all.
void Recorder::Data::endEarly() {
    ended = std::current_exception();
    steps = std::min(robots.wholeSteps(), scans.wholeSteps());
    robots.cutBehind(steps);
    scans.cutBehind(steps);
    flushed_all = true;
    try {
        writeInfo();
    } catch (const std::system_error&) {
        // The first error is the one to tell.
    }
}

void Recorder::Data::flush() {
    if (ended) std::rethrow_exception(ended);
    flushed = steady_clock::now();
    try {
        writeLines();
    } catch (const std::system_error&) {
        endEarly();
        throw;
    }
}

std::vector<std::string> Recorder::filesIn(const std::string& folder) {
    std::vector<std::string> files;
    for (const char* name : {"robots.csv", "scans.jsonl", "timing.csv", "info.csv"})
        files.push_back((std::filesystem::path(folder) / name).string());
    return files;
}

Recorder::Recorder(const std::string& folder, const World& world, const History& history,
                   std::uint64_t seed)
    : data_(std::make_unique<Data>(folder)) {
    data_->robots.pending = "t,id,x,y,heading_deg,speed,rotspeed_deg,accel,rotaccel_deg,stall\n";
    data_->scans.pending = scanHeaderLine(history, seed);
    data_->timing.pending = "t,wall,steps\n";
    record(world);
    // What cannot be written should be known before the run.
    flush(world);
}

Recorder::~Recorder() {
    try {
        if (!data_->flushed_all) data_->flush();
    } catch (const std::exception&) {
        // flush() tells those who ask.
    }
}

void Recorder::record(const World& world) {
    Data& data = *data_;
    if (data.ended) std::rethrow_exception(data.ended);
    data.remember(world);
    data.appendRobots(world);
    try {
        data.appendScans(world);
    } catch (const std::system_error&) {
        data.endEarly();
        throw;
    }
    const bool much = data.robots.pending.size() > kMaxPending;
    if (much || steady_clock::now() - data.flushed >= kFlushEvery) data.flush();
}

void Recorder::limit(std::uint64_t bytes) { data_->max_bytes = bytes; }

int Recorder::lock() const { return data_->lock.descriptor(); }

void Recorder::flush(const World& world) {
    if (!data_->ended) data_->remember(world);
    data_->flush();
}

std::optional<steady_clock::time_point> Recorder::flushDue(steady_clock::time_point now) {
    if (data_->flushed_all) return std::nullopt;
    const auto due = data_->flushed + kFlushEvery;
    if (now < due) return due;
    data_->flush();
    return std::nullopt;
}

}  // namespace ispace
