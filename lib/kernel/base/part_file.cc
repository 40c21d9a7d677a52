// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/part_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "base/random.h"
#include "base/run_files.h"

namespace ispace {

namespace {

constexpr std::string_view kEnd = "end";
/// Bytes of replaced records at which a kept file is rewritten.
constexpr std::uint64_t kMaxReplacedBytes = std::uint64_t{16} << 20U;
/// Longest header; long histories of many commands fit.
constexpr std::size_t kMaxHead = std::size_t{1} << 24U;
constexpr std::size_t kMaxRecordLine = 200;

std::string hexText(std::uint64_t number) {
    std::string text(16, '0');
    for (std::size_t i = text.size(); i-- > 0; number >>= 4U)
        text[i] = "0123456789abcdef"[number & 15U];
    return text;
}

std::optional<std::uint64_t> parseHex(std::string_view text) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, 16);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

[[noreturn]] void failOn(const std::string& file) {
    throw std::system_error(errno, std::generic_category(), file);
}

/// Creates an unnamed file in the folder of `output`, for a stream in TMPDIR.
OpenFile namelessFileBeside(const std::string& output) {
    std::error_code ignored;
    std::filesystem::path folder(output);
    const auto status = std::filesystem::status(folder, ignored);
    if (output == "-" || (exists(status) && !is_regular_file(status) && !is_directory(status)))
        folder = std::filesystem::temp_directory_path(ignored);
    else if (!is_directory(status))
        folder = folder.parent_path();
    if (folder.empty()) folder = ".";
    constexpr mode_t kMode = S_IRUSR | S_IWUSR;
    OpenFile file(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_APPEND | O_CLOEXEC, kMode));
    if (file.fd() >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL)) return file;
    std::string name = (folder / ".ispace.tmp-XXXXXX").string();
    file = OpenFile(::mkostemp(name.data(), O_APPEND | O_CLOEXEC));
    if (file.fd() >= 0) ::unlink(name.c_str());
    return file;
}

/// Gives an unnamed file the name and the rights of an older one.
void takeName(int fd, int older, const std::string& name) {
    const std::string from = "/proc/self/fd/" + std::to_string(fd), stand_in = name + ".new";
    struct stat info {};
    if (::fstat(older, &info) == 0) static_cast<void>(::fchmod(fd, info.st_mode & 07777));
    const DeferredSignals held;
    ::unlink(stand_in.c_str());
    if (::linkat(AT_FDCWD, from.c_str(), AT_FDCWD, stand_in.c_str(), AT_SYMLINK_FOLLOW) != 0)
        failOn(stand_in);
    if (::rename(stand_in.c_str(), name.c_str()) == 0) return;
    const int error = errno;
    ::unlink(stand_in.c_str());
    throw std::system_error(error, std::generic_category(), name);
}

}  // namespace

std::string partRecordText(std::string_view key, std::string_view bytes) {
    std::string text = "=";
    text.reserve(bytes.size() + kMaxRecordLine);
    text.append(key).append(" ").append(std::to_string(bytes.size())).append(" ");
    return text.append(hexText(hashOf(bytes))).append("\n").append(bytes).append("\n");
}

void JobResults::File::openAs(int flags) {
    struct stat info {};
    const auto check = [&](bool is_found) {
        if (!is_found) failOn(name);
        if (!S_ISREG(info.st_mode)) refuse("a part is a regular file: it is read more than once");
    };
    // Checked before opening, as in openRegular().
    const bool is_there = ::stat(name.c_str(), &info) == 0;
    if (is_there || errno != ENOENT || (flags & O_CREAT) == 0) check(is_there);
    constexpr mode_t kMode = 0666;
    open = OpenFile(::open(name.c_str(), flags | O_NONBLOCK | O_CLOEXEC, kMode));
    check(open.fd() >= 0 && ::fstat(open.fd(), &info) == 0);
}

bool JobResults::File::lock() const {
    // Without locks in the file system two processes may write.
    if (::flock(open.fd(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        refuse("another process works on this job: wait for it, or end it");
    struct stat own {};
    struct stat named {};
    return ::fstat(open.fd(), &own) == 0 && ::stat(name.c_str(), &named) == 0 &&
           own.st_dev == named.st_dev && own.st_ino == named.st_ino;
}

void JobResults::File::append(std::string_view bytes) const {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = ::write(open.fd(), bytes.data() + done, bytes.size() - done);
        if (n >= 0) {
            done += static_cast<std::size_t>(n);
        } else if (errno != EINTR) {
            const int error = errno;
            // A reader would skip the half record, but the next record requires its space.
            static_cast<void>(::ftruncate(open.fd(), static_cast<off_t>(end)) == 0);
            throw std::system_error(error, std::generic_category(), name);
        }
    }
}

std::string JobResults::File::read(std::uint64_t at, std::size_t size) const {
    std::string bytes(size, '\0');
    std::size_t done = 0;
    while (done < size) {
        const ssize_t n =
            ::pread(open.fd(), bytes.data() + done, size - done, static_cast<off_t>(at + done));
        if (n < 0 && errno != EINTR) failOn(name);
        if (n == 0) break;
        if (n > 0) done += static_cast<std::size_t>(n);
    }
    bytes.resize(done);
    return bytes;
}

void JobResults::File::refuse(const std::string& message, int line) const {
    throw FormatError({displayName(name), line, 0, message});
}

void JobResults::File::readHead() {
    constexpr std::size_t kChunk = 1 << 12;
    std::string text = read(0, kChunk);
    std::size_t mark = text.find("\n\n");
    while (mark == std::string::npos && text.starts_with(kPartMagic) && text.size() < kMaxHead) {
        const std::string more = read(text.size(), text.size());
        if (more.empty()) break;
        text += more;
        mark = text.find("\n\n");
    }
    if (mark != std::string::npos) text.resize(mark + 2);
    head = parsePartHead(text, displayName(name));
    begin = end = text.size();
}

void JobResults::addFile(const std::string& name) {
    File file{.name = name};
    file.openAs(O_RDONLY);
    addFile(std::move(file));
}

void JobResults::addFile(File file) {
    file.readHead();
    struct stat info {};
    if (::fstat(file.open.fd(), &info) != 0) failOn(file.name);
    files_.push_back(std::move(file));
    readRecords(files_.back(), static_cast<std::uint64_t>(info.st_size));
}

void JobResults::keep(const std::string& key, const Record& record) {
    files_[record.file].end = record.at + record.size + 1;
    const auto [at, is_new] = records_.try_emplace(key, record);
    if (!is_new && is_merge_) {
        const Record& other = at->second;
        const bool is_equal = other.size == record.size && other.hash == record.hash;
        if (key != common_ || (is_common_equal_ && !is_equal))
            files_[record.file].doubled = "its record " + excerpt(key) + " is in " +
                                          displayName(files_[other.file].name) + ", too";
        return;
    }
    if (!is_new) live_ -= std::exchange(at->second, record).size;
    live_ += record.size;
}

void JobResults::readRecords(File& file, std::uint64_t size) {
    while (file.end < size) {
        const std::string line = file.read(file.end, kMaxRecordLine);
        const std::size_t newline = line.find('\n');
        std::string_view words = std::string_view(line).substr(0, newline);
        if (newline == std::string::npos || !words.starts_with("=")) return;
        words.remove_prefix(1);
        const std::string key(takeUpTo(words, ' '));
        const auto bytes = parseInteger(takeUpTo(words, ' '));
        const auto hash = parseHex(words);
        if (key.empty() || !bytes || *bytes < 0 || !hash) return;
        const Record record{files_.size() - 1, file.end + newline + 1,
                            static_cast<std::uint64_t>(*bytes), *hash};
        if (record.size >= size - record.at || file.read(record.at + record.size, 1) != "\n")
            return;
        std::string found;
        if (key == kEnd) {
            file.is_finished = true;
            return;
        }
        // After a crash of the machine any bytes may be in the file.
        if (is_kept_ && !readRecord(record, found)) return;
        keep(key, record);
    }
}

bool JobResults::readRecord(const Record& record, std::string& bytes) const {
    bytes = files_[record.file].read(record.at, static_cast<std::size_t>(record.size));
    return bytes.size() == record.size && hashOf(bytes) == record.hash;
}

std::string JobResults::bytesOf(const std::string& key, const Record& record) const {
    std::string bytes;
    const File& file = files_[record.file];
    if (!readRecord(record, bytes))
        file.refuse("damaged: record " + excerpt(key) + " at byte " + std::to_string(record.at) +
                    " is not what was written; delete it and run shard " + file.head.shard.text() +
                    " again");
    return bytes;
}

std::string JobResults::keptFile(const std::string& output, const Shard& shard) {
    std::error_code ignored;
    if (!output.ends_with('/') && !std::filesystem::is_directory(output, ignored))
        return output + ".resume";
    std::string name = (std::filesystem::path(output) / ".resume").string();
    if (shard.count == 1) return name;
    return name + '-' + std::to_string(shard.index) + "of" + std::to_string(shard.count);
}

JobResults::JobResults(const std::string& output, const JobId& job, Shard shard, bool is_kept)
    : is_kept_(is_kept) {
    if (is_kept) {
        openKept(keptFile(output, shard), {job, shard});
        return;
    }
    File file{.name = output, .open = namelessFileBeside(output), .head = {job, shard}};
    if (file.open.fd() < 0) failOn(output);
    files_.push_back(std::move(file));
}

std::optional<JobResults> JobResults::earlier(const std::string& file, const JobId& job) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return std::nullopt;
    JobResults results;
    results.is_kept_ = true;  // checks each record
    std::string found;
    try {
        results.addFile(file);
        found = results.head().job.tool + ' ' + results.head().job.form;
    } catch (const FormatError&) {
        found.clear();
    }
    if (found != job.tool + ' ' + job.form)
        File{.name = file}.refuse("not a " + job.form + " of " + job.tool +
                                  ": delete it or name another file");
    if (!results.head().job.differenceFrom(job).empty()) return std::nullopt;
    return results;
}

void JobResults::File::start(const PartHead& job) const {
    const std::string text = partHeadText(job), found = read(0, text.size());
    if (found.size() == text.size() || !text.starts_with(found)) return;
    try {
        if (::ftruncate(open.fd(), 0) != 0) failOn(name);
        append(text);
    } catch (const std::system_error&) {
        ::unlink(name.c_str());
        throw;
    }
}

void JobResults::openKept(const std::string& name, const PartHead& head) {
    File file{.name = name};
    do file.openAs(O_RDWR | O_APPEND | O_CREAT);
    while (!file.lock());
    file.start(head);
    addFile(std::move(file));
    const File& kept = files_.front();
    std::string difference = kept.head.job.differenceFrom(head.job);
    if (difference.empty() && kept.head.shard != head.shard)
        difference = "the shard (" + kept.head.shard.text() + ", " + head.shard.text() + ")";
    if (!difference.empty())
        kept.refuse("what a job left, and not this one: " + difference +
                    " differs; delete the file, or write to another");
    if (::ftruncate(kept.open.fd(), static_cast<off_t>(kept.end)) != 0) failOn(name);
}

void JobResults::rewriteKept() {
    File anew{.name = file(), .open = namelessFileBeside(file())};
    if (anew.open.fd() < 0) failOn(file());
    anew.append(partHeadText(head()));
    writeRecords([&](std::string_view bytes) { anew.append(bytes); }, {});
    // Locked and read before it takes the name: from then on it is as good as the old one.
    static_cast<void>(::flock(anew.open.fd(), LOCK_EX | LOCK_NB));
    const int fd = anew.open.fd();
    JobResults rewritten;
    rewritten.is_kept_ = true;
    rewritten.addFile(std::move(anew));
    takeName(fd, files_.front().open.fd(), std::filesystem::canonical(file()).string());
    files_ = std::move(rewritten.files_);
    records_ = std::move(rewritten.records_);
    live_ = rewritten.live_;
}

void JobResults::rewriteIfDue() {
    const std::uint64_t end = files_.front().end;
    if (!is_kept_ || end <= std::max(next_rewrite_, 2 * live_ + kMaxReplacedBytes)) return;
    try {
        rewriteKept();
        next_rewrite_ = 0;
    } catch (const std::system_error&) {
        next_rewrite_ = end + kMaxReplacedBytes;  // no room for a second file
    }
}

std::vector<std::string> JobResults::keys() const {
    const std::lock_guard lock(*mutex_);
    std::vector<std::string> keys;
    keys.reserve(records_.size());
    for (const auto& [key, record] : records_) keys.push_back(key);
    return keys;
}

std::optional<std::string> JobResults::find(const std::string& key) const {
    const std::lock_guard lock(*mutex_);
    const auto at = records_.find(key);
    if (at == records_.end()) return std::nullopt;
    return bytesOf(key, at->second);
}

void JobResults::store(const std::string& key, std::string_view bytes) {
    if (is_merge_) return;
    const std::lock_guard lock(*mutex_);
    const Clock::time_point begin = Clock::now();
    const std::string record = partRecordText(key, bytes);
    try {
        files_.front().append(record);
        const std::uint64_t start = files_.front().end + record.size() - bytes.size() - 1;
        keep(key, {0, start, bytes.size(), hashOf(bytes)});
        rewriteIfDue();
    } catch (const std::system_error& error) {
        if (!is_optional_) throw;
        trouble_ = error.what();
    }
    // Storing takes only a small share of the time.
    constexpr int kStoringShare = 20;
    const Clock::time_point end = Clock::now();
    next_ = end + std::max(interval_, kStoringShare * (end - begin));
}

void JobResults::writeRecords(const std::function<void(std::string_view)>& write,
                              std::span<const std::string_view> prefixes) const {
    for (const auto& [key, record] : records_) {
        const auto begins = [&key = key](std::string_view prefix) {
            return key.starts_with(prefix);
        };
        if (prefixes.empty() || std::any_of(prefixes.begin(), prefixes.end(), begins))
            write(partRecordText(key, bytesOf(key, record)));
    }
}

void JobResults::writePart(const std::string& target,
                           std::span<const std::string_view> prefixes) const {
    const std::lock_guard lock(*mutex_);
    OutputFile part(target);
    part.write(partHeadText(head()));
    writeRecords([&](std::string_view bytes) { part.write(bytes); }, prefixes);
    part.write(partRecordText(kEnd, ""));
    part.commit();
}

void JobResults::finish() {
    std::error_code ignored;
    if (is_kept_) std::filesystem::remove(file(), ignored);
    files_.front().open.close();
}

void JobResults::setInterval(double seconds) {
    interval_ = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    next_ = Clock::now() + interval_;
}

bool JobResults::isDue() {
    const std::lock_guard lock(*mutex_);
    return is_kept_ && Clock::now() >= next_;
}

}  // namespace ispace
