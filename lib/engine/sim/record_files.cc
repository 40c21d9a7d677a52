// SPDX-License-Identifier: GPL-3.0-or-later
// Files that grow by whole lines, frames that appear whole, and the text of rows.
//
// Written by system calls: errors name the file, a full disk is an error of the write, and links to
// files are not followed (O_NOFOLLOW). The folder is locked by flock(2), which ends with the last
// process that holds it.
#include "sim/record_files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <new>
#include <span>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "raster/codec.h"
#include "sense/formats/camera_info.h"
#include "sense/formats/reading_text.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& name, int error) {
    throw std::system_error(error, std::generic_category(), name);
}

[[noreturn]] void refuseLink(const std::string& name, const char* to) {
    throw FormatError({name, 0, 0,
                       std::string("a symbolic link to a ") + to +
                           ", and records follow none: remove it, or record into another folder"});
}

std::string_view wholeLines(std::string_view text) {
    return text.substr(0, text.rfind('\n') + 1);  // npos + 1 is 0
}

/// Creates an empty file for writing. A file of an earlier run is removed, not overwritten: it may
/// have another name elsewhere. Links are not followed.
int openAnew(const std::string& name) {
    struct stat info {
    }, behind{};
    if (::lstat(name.c_str(), &info) == 0) {
        const bool is_link = S_ISLNK(info.st_mode);
        if (is_link && (::stat(name.c_str(), &behind) != 0 || S_ISREG(behind.st_mode)))
            refuseLink(name, "file");
        const mode_t mode = is_link ? behind.st_mode : info.st_mode;
        if (S_ISCHR(mode) || S_ISFIFO(mode))
            // Does not wait for a reader if it is a pipe.
            return ::open(name.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
        if (::unlink(name.c_str()) != 0) return -1;
    }
    return ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

}  // namespace

LineFile::LineFile(std::string name)
    : name_(std::move(name)),
      fd_(openAnew(name_)),
      packer_(name_.ends_with(kZstdSuffix) ? std::make_unique<ZstdPacker>() : nullptr) {
    if (fd_ < 0) fail(name_, errno);
    ::fcntl(fd_, F_SETFL, O_WRONLY);
}

LineFile::~LineFile() {
    if (packer_ && error_ == 0 && size_ > 0) endFrame();
    ::close(fd_);
}

/// Readers do without it: an error here loses no line.
void LineFile::endFrame() {
    try {
        const std::string bytes = packer_->end();
        if (::write(fd_, bytes.data(), bytes.size()) != std::ssize(bytes))
            static_cast<void>(!::ftruncate(fd_, packed_));
    } catch (const std::exception&) {
        error_ = ENOMEM;
    }
}

std::int64_t LineFile::wholeSteps() const {
    std::int64_t steps = 0;
    for (const StepEnd& end : ends_)
        if (end.size <= size_) steps = end.step;
    return steps;
}

const LineFile::Block* LineFile::blockEndingAt(off_t text) const {
    const auto found = std::find_if(blocks_.begin(), blocks_.end(),
                                    [text](const Block& block) { return block.text == text; });
    return found == blocks_.end() ? nullptr : &*found;
}

std::int64_t LineFile::lastCut(std::int64_t step) const {
    if (!packer_) return step;
    std::int64_t last = 0;
    for (const StepEnd& end : ends_) {
        if (end.step > step) break;
        // Steps without lines of this file end where the step before them does.
        if (blockEndingAt(end.size) != nullptr) last = end.step;
    }
    return last;
}

void LineFile::cutBehind(std::int64_t step) {
    pending.clear();
    off_t end = size_;
    for (const StepEnd& each : ends_)
        if (each.step == step && each.size <= size_) end = each.size;
    if (end >= size_) return;
    const Block* const block = packer_ ? blockEndingAt(end) : nullptr;
    if (packer_ && block == nullptr) return;
    size_ = end;
    if (block != nullptr) packed_ = block->file;
    static_cast<void>(!::ftruncate(fd_, packer_ ? packed_ : size_));
    if (packer_) error_ = ECANCELED;  // the packer is ahead of the file
}

void LineFile::rewrite(std::string_view text) {
    if (error_ == 0) {
        const ssize_t n = ::pwrite(fd_, text.data(), text.size(), 0);
        if (n != static_cast<ssize_t>(text.size())) error_ = n < 0 ? errno : ENOSPC;
        // It may have been longer.
        if (error_ == 0 && ::ftruncate(fd_, static_cast<off_t>(text.size())) != 0) error_ = errno;
    }
    if (error_ != 0) fail(name_, error_);
}

void LineFile::flush() {
    if (error_ == 0 && !pending.empty()) write();
    pending.clear();
    if (error_ != 0) fail(name_, error_);
}

void LineFile::write() {
    // An exception while a line was built may have left a part of it.
    const std::string_view lines = wholeLines(pending);
    const std::string packed = packer_ ? packer_->pack(lines) : std::string();
    const std::string_view bytes = packer_ ? std::string_view(packed) : lines;
    std::string_view rest = bytes;
    while (!rest.empty()) {
        const ssize_t n = ::write(fd_, rest.data(), rest.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            error_ = errno;
            takeBackTornLine(bytes.substr(0, bytes.size() - rest.size()));
            return;
        }
        rest.remove_prefix(static_cast<std::size_t>(n));
    }
    size_ += static_cast<off_t>(lines.size());
    if (!packer_) return;
    packed_ += static_cast<off_t>(packed.size());
    blocks_.push_back({size_, packed_});
}

/// Removes a part of the last line, or block, that a full disk may have left.
void LineFile::takeBackTornLine(std::string_view written) {
    if (packer_) {
        static_cast<void>(!::ftruncate(fd_, packed_));
        return;
    }
    size_ += static_cast<off_t>(wholeLines(written).size());
    static_cast<void>(!::ftruncate(fd_, size_));
}

void removeEarlier(const std::string& name) {
    struct stat info {};
    if (::lstat(name.c_str(), &info) != 0) return;
    if (S_ISLNK(info.st_mode)) refuseLink(name, "file");
    if (S_ISREG(info.st_mode) && ::unlink(name.c_str()) != 0) fail(name, errno);
}

const std::string& madeFolder(const std::string& folder) {
    if (::mkdir(folder.c_str(), 0777) != 0) {
        if (errno != EEXIST) fail(folder, errno);
        struct stat info {};
        if (::stat(folder.c_str(), &info) != 0) fail(folder, errno);
        if (!S_ISDIR(info.st_mode)) fail(folder, ENOTDIR);
    }
    return folder;
}

FolderLock::FolderLock(const std::string& folder)
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

FolderLock::~FolderLock() {
    if (fd_ >= 0) ::close(fd_);
}

namespace {

/// Returns true for names of frames, and for those under which frames are being written.
bool isFrameName(const std::string& name, std::string_view ending) {
    constexpr std::size_t kDigits = 6;
    std::string_view stem = name;
    if (stem.ends_with(FrameFiles::kUnfinished)) stem.remove_suffix(FrameFiles::kUnfinished.size());
    if (!stem.ends_with(ending)) return false;
    stem.remove_suffix(ending.size());
    const std::size_t dash = stem.rfind('-');
    if (dash == std::string_view::npos || stem.size() - dash - 1 < kDigits) return false;
    return stem.find_first_not_of("0123456789", dash + 1) == std::string_view::npos;
}

}  // namespace

FrameFiles::FrameFiles(std::string folder, std::string_view ending) : folder_(std::move(folder)) {
    struct stat info {};
    if (::lstat(folder_.c_str(), &info) != 0) return;
    if (S_ISLNK(info.st_mode)) refuseLink(folder_, "folder");
    if (!S_ISDIR(info.st_mode)) fail(folder_, ENOTDIR);
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
        if (isFrameName(entry.path().filename().string(), ending)) fs::remove(entry.path());
}

void FrameFiles::write(const std::string& name, std::string_view bytes, std::int64_t step) {
    if (!std::exchange(is_made_, true)) madeFolder(folder_);
    const std::string path = folder_ + "/" + name;
    const std::string unfinished = path + std::string(kUnfinished);
    const int fd = openAnew(unfinished);
    if (fd < 0) fail(unfinished, errno);
    int error = 0;
    for (std::string_view rest = bytes; !rest.empty() && error == 0;) {
        const ssize_t n = ::write(fd, rest.data(), rest.size());
        if (n >= 0)
            rest.remove_prefix(static_cast<std::size_t>(n));
        else if (errno != EINTR)
            error = errno;
    }
    if (::close(fd) != 0 && error == 0) error = errno;
    if (error == 0 && ::rename(unfinished.c_str(), path.c_str()) != 0) error = errno;
    if (error != 0) {
        ::unlink(unfinished.c_str());
        fail(path, error);
    }
    size_ += bytes.size();
    recent_.push_back({path, step});
}

void FrameFiles::cutBehind(std::int64_t step) {
    for (const Frame& frame : recent_)
        if (frame.step > step) ::unlink(frame.path.c_str());
    std::erase_if(recent_, [step](const Frame& frame) { return frame.step > step; });
}

namespace {

/// Appends a row for each mover: time, id and those of numbers(its index) whose bits are in `kept`.
template <typename Numbers>
void appendRows(std::string& out, RowTexts& known, SimTime time, const auto& movers,
                std::uint32_t kept, Numbers numbers) {
    if (movers.empty()) return;
    const std::string t = formatSimTime(time);
    constexpr std::size_t kColumns = std::tuple_size_v<decltype(numbers(0))>;
    known.resize(kColumns * movers.size());
    auto text = known.begin();
    for (std::size_t i = 0; i < movers.size(); ++i) {
        const std::string& id = movers[i].id;  // a word that requires no quotes
        TextTail tail(out, t.size() + id.size() + kColumns * (1 + kNumberRoom) + 2);
        tail.put(t);
        tail.put(',');
        tail.put(id);
        std::uint32_t rest = kept;
        for (const double value : numbers(i)) {
            NumberText& number = *text++;
            if ((std::exchange(rest, rest >> 1U) & 1U) == 0) continue;
            if (const auto bits = std::bit_cast<std::uint64_t>(value); bits != number.bits) {
                char* const begin = number.text.data();
                number.bits = bits;
                number.size = static_cast<std::size_t>(writeDouble(begin, value) - begin);
            }
            tail.put(',');
            tail.putKept(number.text.data(), number.size);
        }
        tail.put('\n');
    }
}

}  // namespace

void appendRobotRows(std::string& out, const World& world, RowTexts& known, std::uint32_t kept) {
    appendRows(out, known, world.time(), world.robots(), kept, [&world](std::size_t i) {
        const RobotStatus is = world.status(i);
        return std::array{is.pose.position.x,        is.pose.position.y,
                          is.pose.heading.degrees(), is.speed,
                          is.rotspeed.degrees(),     is.accel,
                          is.rotaccel.degrees(),     is.stall ? 1.0 : 0.0};
    });
}

void appendOdometryRows(std::string& out, const World& world, RowTexts& known) {
    appendRows(out, known, world.time(), world.robots(), ~std::uint32_t{0},
               [&world](std::size_t i) {
                   const Odometry odometry = world.odometry(i);
                   const Pose2& pose = odometry.pose;
                   const PoseCovariance& errors = odometry.covariance;
                   return std::array{pose.position.x, pose.position.y, pose.heading.degrees(),
                                     errors.xx,       errors.xy,       errors.yy,
                                     errors.xh,       errors.yh,       errors.hh};
               });
}

void appendPeopleRows(std::string& out, const World& world, RowTexts& known, std::uint32_t kept) {
    const std::size_t robots = world.robots().size();
    appendRows(out, known, world.time(), world.people(), kept, [&world, robots](std::size_t i) {
        const RobotStatus is = world.status(robots + i);
        return std::array{is.pose.position.x, is.pose.position.y,    is.pose.heading.degrees(),
                          is.speed,           is.rotspeed.degrees(), is.phase,
                          is.sidespeed,       is.stall ? 1.0 : 0.0};
    });
}

void appendSonarRows(std::string& out, World& world) {
    const std::string t = formatSimTime(world.time());
    const auto all = world.sonars();
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].empty()) continue;
        out.append(t).append(",").append(world.robots()[i].id);
        char before = ',';
        for (const float range : all[i]) {
            out += std::exchange(before, ';');
            appendFloat(out, range);
        }
        out += '\n';
    }
}

void appendBumperRows(std::string& out, const World& world, std::vector<std::vector<bool>>& felt) {
    felt.resize(world.robots().size());
    for (std::size_t i = 0; i < felt.size(); ++i) {
        if (world.robots()[i].model.bumpers.empty()) continue;
        // All are released while the robot is free: most robots in most steps.
        const bool was_hit = std::find(felt[i].begin(), felt[i].end(), true) != felt[i].end();
        if (!felt[i].empty() && !was_hit && !world.isStalled(i)) continue;
        std::vector<bool> now = world.bumper(i);
        if (now == felt[i]) continue;
        out.append(formatSimTime(world.time())).append(",").append(world.robots()[i].id);
        char before = ',';
        for (const bool is_hit : now) {
            out += std::exchange(before, ';');
            out += is_hit ? '1' : '0';
        }
        out += '\n';
        felt[i] = std::move(now);
    }
}

void appendStateRow(std::string& out, const Event& event) {
    out.append(formatSimTime(event.time)).append(",").append(event.id);
    out.append(",").append(event.other).append(",");
    appendCsvField(out, event.text);
    out += '\n';
}

void ActivityRows::append(std::string& out, const Event& event) {
    SimTime& since = begun_[event.id];
    if (event.value == 1) {
        since = event.time;
        return;
    }
    out.append(formatSimTime(since)).append(",").append(formatSimTime(event.time));
    out.append(",").append(event.id).append(",");
    appendCsvField(out, event.other);
    out += ',';
    appendCsvField(out, event.text);
    out.append(event.value == 0 ? ",1\n" : ",0\n");
}

void appendReadingLine(std::string& out, const Sensor& sensor, const SensorReading& reading,
                       std::span<const Sensor> receivers, const std::string& file) {
    appendLine(out, viewOf(sensor, reading, receivers), file);
}

std::string frameName(const std::string& id, std::int64_t seq, std::string_view ending) {
    constexpr std::size_t kDigits = 6;
    std::string name;
    for (const char c : id) {
        // The only character of a word that a file's name cannot hold; % is not part of words.
        if (c == '/')
            name += "%2F";
        else
            name += c;
    }
    const std::string number = std::to_string(seq);
    name.append("-").append(kDigits - std::min(kDigits, number.size()), '0');
    return name.append(number).append(ending);
}

std::string frameBytes(const Sensor& sensor, const SensorReading& reading) {
    constexpr double kMillimetres = 1000;
    if (const auto* photo = std::get_if<Photo>(&reading.value)) {
        const Camera& camera = *sensor.tryAs<Camera>();
        return pngOfRgb(camera.columns, camera.rows, photo->rgb);
    }
    const Ranger& ranger = *sensor.tryAs<Ranger>();
    return depthPng(ranger.columns, ranger.rows, std::get<DepthFrame>(reading.value).depths,
                    kMillimetres);
}

void RecordedFrame::make(const SensorReading& reading) {
    name = frameName(sensor.id, reading.seq);
    bytes = frameBytes(sensor, reading);
    const std::string file = std::string(is_picture ? kPictures : kDepths) + "/" + name;
    appendReadingLine(line, sensor, reading, {}, file);
}

void RecordedFrame::finish(const std::exception_ptr& failure) {
    is_made = true;
    try {
        if (failure) std::rethrow_exception(failure);
    } catch (const std::bad_alloc&) {
        line.clear();
    }
}

}  // namespace ispace
