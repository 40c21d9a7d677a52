// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/spool.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace ispace {

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
    // A file system that knows no files without a name.
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
