// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/checkpoint.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace ispace {

namespace {

/// Bytes of replaced records that a file may hold before it is written anew.
constexpr std::uint64_t kMaxDead = std::uint64_t{16} << 20U;

}  // namespace

Checkpoint::Checkpoint(const std::string& file, const PartHead& head) : file_(file), head_(head) {
    std::error_code error;
    if (!std::filesystem::exists(file_, error)) {
        PartWriter begun(file_, head_);
        begun.leaveOpen();
    }
    open();
}

Checkpoint::~Checkpoint() = default;

void Checkpoint::open() {
    const auto refuse = [this](const std::string& message) {
        throw FormatError({file_, 0, 0, message});
    };
    out_ = OpenFile(::open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
    if (out_.fd() < 0) throw std::system_error(errno, std::generic_category(), file_);
    // Where a file system has no locks, nobody is told.
    if (::flock(out_.fd(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        refuse("another process works on this job: wait for it, or end it");
    part_ = std::make_unique<PartFile>(file_);
    std::string difference = part_->head().job.differenceFrom(head_.job);
    if (difference.empty() && part_->head().shard != head_.shard)
        difference = "the shard (" + part_->head().shard.text() + ", " + head_.shard.text() + ")";
    if (!difference.empty())
        refuse("what a job left, and not this one: " + difference +
               " differs; delete the file, or write to another");
    // What a machine that went down left may be anything.
    part_->dropDamaged();
    if (::ftruncate(out_.fd(), static_cast<off_t>(part_->end())) != 0)
        throw std::system_error(errno, std::generic_category(), file_);
}

void Checkpoint::append(std::string_view bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = ::write(out_.fd(), bytes.data() + done, bytes.size() - done);
        if (n >= 0) {
            done += static_cast<std::size_t>(n);
        } else if (errno != EINTR) {
            const int error = errno;
            // Half a record would be cut off by whoever reads it; but what comes next needs room.
            static_cast<void>(::ftruncate(out_.fd(), static_cast<off_t>(part_->end())) == 0);
            throw std::system_error(error, std::generic_category(), file_);
        }
    }
}

void Checkpoint::add(std::string_view name, std::string_view bytes) {
    const std::string record = partRecordText(name, bytes);
    append(record);
    part_->noteAdded(name, bytes, record.size());
    if (part_->end() > 2 * part_->liveBytes() + kMaxDead) rewrite();
}

void Checkpoint::rewrite() {
    PartWriter anew(file_, head_);
    for (std::size_t i = 0; i < part_->records(); ++i)
        if (part_->isLast(i)) anew.add(part_->name(i), part_->bytes(i));
    anew.leaveOpen();
    open();
}

void Checkpoint::remove() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
    out_.close();
}

}  // namespace ispace
