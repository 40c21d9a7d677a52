// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/numpy_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <system_error>

namespace ispace {

std::string npyHeader(std::string_view type, std::span<const std::uint64_t> shape) {
    constexpr std::size_t kAlignment = 64, kBefore = 10;
    std::string text = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (";
    for (std::size_t i = 0; i < shape.size(); ++i)
        text += (i > 0 ? ", " : "") + std::to_string(shape[i]);
    text += shape.size() == 1 ? ",), }" : "), }";
    text.append(kAlignment - (kBefore + text.size() + 1) % kAlignment, ' ');
    std::string out("\x93NUMPY\1\0", 8);
    appendLittle(out, static_cast<std::uint16_t>(text.size() + 1));
    return out.append(text).append("\n");
}

std::uint32_t crcOf(std::string_view bytes) {
    return static_cast<std::uint32_t>(
        ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::uint32_t crcOfBoth(std::uint32_t first, std::uint32_t second, std::uint64_t second_size) {
    return static_cast<std::uint32_t>(
        ::crc32_combine(first, second, static_cast<z_off_t>(second_size)));
}

namespace {

constexpr std::uint32_t kLocalHead = 0x04034b50, kCentralHead = 0x02014b50,
                        kDirectoryEnd = 0x06054b50, kEnd64 = 0x06064b50, kEnd64Locator = 0x07064b50;
constexpr std::uint16_t kVersion = 20, kVersion64 = 45, kUtf8Names = 1U << 11U;
constexpr std::uint16_t kFirstDay = 1U << 5U | 1U;  // the first of January 1980, as ZIP counts
constexpr std::uint64_t kMax32 = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t kMax16 = std::numeric_limits<std::uint16_t>::max();

std::uint32_t atMost32(std::uint64_t value) {
    return static_cast<std::uint32_t>(std::min(value, kMax32));
}

/// Fields that local and central headers share, from the version needed to the length of the name.
void appendMiddle(std::string& out, std::uint16_t version, std::uint32_t crc, std::uint64_t size,
                  const std::string& name) {
    appendLittle(out, version);
    appendLittle(out, kUtf8Names);
    appendLittle(out, std::uint16_t{0});  // not compressed
    appendLittle(out, std::uint16_t{0});  // midnight
    appendLittle(out, kFirstDay);
    appendLittle(out, crc);
    appendLittle(out, atMost32(size));
    appendLittle(out, atMost32(size));
    appendLittle(out, static_cast<std::uint16_t>(name.size()));
}

/// The extra field for sizes of 64 bits.
std::string extra64(std::span<const std::uint64_t> values) {
    std::string out;
    if (values.empty()) return out;
    appendLittle(out, std::uint16_t{1});
    appendLittle(out, static_cast<std::uint16_t>(sizeof(std::uint64_t) * values.size()));
    for (const std::uint64_t value : values) appendLittle(out, value);
    return out;
}

}  // namespace

void ZipWriter::put(std::string_view bytes) {
    write_(bytes);
    at_ += bytes.size();
}

void ZipWriter::begin(const std::string& name, std::uint64_t size, std::uint32_t crc) {
    entries_.push_back({name, size, at_, crc});
    std::vector<std::uint64_t> large;
    if (size >= kMax32) large = {size, size};
    const std::string extra = extra64(large);
    std::string head;
    appendLittle(head, kLocalHead);
    appendMiddle(head, large.empty() ? kVersion : kVersion64, crc, size, name);
    appendLittle(head, static_cast<std::uint16_t>(extra.size()));
    put(head.append(name).append(extra));
}

void ZipWriter::add(const std::string& name, std::string_view bytes) {
    begin(name, bytes.size(), crcOf(bytes));
    data(bytes);
}

void ZipWriter::finish() {
    const std::uint64_t begin = at_;
    for (const Entry& entry : entries_) {
        std::vector<std::uint64_t> large;
        if (entry.size >= kMax32) large = {entry.size, entry.size};
        if (entry.offset >= kMax32) large.push_back(entry.offset);
        const std::string extra = extra64(large);
        const std::uint16_t version = large.empty() ? kVersion : kVersion64;
        std::string head;
        appendLittle(head, kCentralHead);
        appendLittle(head, version);
        appendMiddle(head, version, entry.crc, entry.size, entry.name);
        appendLittle(head, static_cast<std::uint16_t>(extra.size()));
        appendLittle(head, std::uint16_t{0});  // no comment
        appendLittle(head, std::uint16_t{0});  // the first and only disk
        appendLittle(head, std::uint16_t{0});
        appendLittle(head, std::uint32_t{0});
        appendLittle(head, atMost32(entry.offset));
        put(head.append(entry.name).append(extra));
    }
    const std::uint64_t size = at_ - begin, count = entries_.size();
    std::string end;
    if (begin >= kMax32 || size >= kMax32 || count >= kMax16) {
        constexpr std::uint64_t kRest = 44;
        const std::uint64_t at = at_;
        appendLittle(end, kEnd64);
        appendLittle(end, kRest);
        appendLittle(end, kVersion64);
        appendLittle(end, kVersion64);
        appendLittle(end, std::uint64_t{0});  // both disks
        for (const std::uint64_t value : {count, count, size, begin}) appendLittle(end, value);
        appendLittle(end, kEnd64Locator);
        appendLittle(end, std::uint32_t{0});
        appendLittle(end, at);
        appendLittle(end, std::uint32_t{1});
    }
    const auto files = static_cast<std::uint16_t>(std::min(count, kMax16));
    appendLittle(end, kDirectoryEnd);
    appendLittle(end, std::uint32_t{0});  // both disks
    appendLittle(end, files);
    appendLittle(end, files);
    appendLittle(end, atMost32(size));
    appendLittle(end, atMost32(begin));
    appendLittle(end, std::uint16_t{0});
    put(end);
}

namespace {

constexpr std::size_t kInMemory = 1U << 20U;

std::string temporaryFolder() {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
    if (error) throw std::system_error(error, "the folder TMPDIR");
    return folder.string();
}

[[noreturn]] void fail(int error) {
    throw std::system_error(error, std::generic_category(),
                            "temporary file in " + temporaryFolder());
}

OpenFile namelessFile() {
    const std::string folder = temporaryFolder();
    constexpr mode_t kMode = S_IRUSR | S_IWUSR;
    const int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kMode);
    if (fd >= 0) return OpenFile(fd);
    if (errno != EOPNOTSUPP && errno != EISDIR) fail(errno);
    // The file system does not support unnamed files.
    std::string name = folder + "/ispace-XXXXXX";
    OpenFile file(::mkostemp(name.data(), O_CLOEXEC));
    if (file.fd() < 0) fail(errno);
    ::unlink(name.c_str());
    return file;
}

}  // namespace

void Spool::append(std::string_view bytes) {
    crc_ = static_cast<std::uint32_t>(
        ::crc32_z(crc_, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
    recent_ += bytes;
    if (recent_.size() > kInMemory) spill();
}

void Spool::spill() {
    if (file_.fd() < 0) file_ = namelessFile();
    for (std::size_t done = 0; done < recent_.size();) {
        const ssize_t count = ::write(file_.fd(), recent_.data() + done, recent_.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(errno);
        done += static_cast<std::size_t>(count);
    }
    spilled_ += recent_.size();
    recent_.clear();
}

void Spool::copyTo(const ByteSink& write) const {
    std::string piece(kInMemory, '\0');
    for (std::uint64_t done = 0; done < spilled_;) {
        const ssize_t count =
            ::pread(file_.fd(), piece.data(), piece.size(), static_cast<off_t>(done));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail(count < 0 ? errno : EIO);
        write(std::string_view(piece).substr(0, static_cast<std::size_t>(count)));
        done += static_cast<std::uint64_t>(count);
    }
    if (!recent_.empty()) write(recent_);
}

}  // namespace ispace
