// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& name, int error) {
    throw std::system_error(error, std::generic_category(), displayName(name));
}

/// `fd` closed at the end of the scope, without a check: for reading and for clean-up.
class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() {
        if (fd_ > STDERR_FILENO) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int get() const { return fd_; }

  private:
    int fd_;
};

void writeFully(int fd, std::string_view bytes, const std::string& name) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), bytes.size());
        if (n < 0) {
            if (errno == EINTR) continue;
            fail(name, errno);
        }
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
}

/// The file that a chain of links names, which need not exist. Keeps relative paths relative.
std::string followLinks(const std::string& target) {
    constexpr int kMostLinks = 40;  // as the kernel
    fs::path path(target);
    std::error_code error;
    for (int i = 0; i < kMostLinks && fs::is_symlink(path, error); ++i) {
        const fs::path next = fs::read_symlink(path, error);
        if (error) break;
        path = path.parent_path() / next;  // an absolute one replaces the folder
    }
    return path.string();
}

/// Calls make(name) with names in the folder that nobody should have, until one is free: a killed
/// process may have left its file, and its number comes again.
template <typename Make>
std::string makeStandIn(const std::string& folder, Make make) {
    constexpr int kMostTries = 1000;
    const std::string stem =
        (fs::path(folder) / (".ispace.tmp." + std::to_string(::getpid()) + '.')).string();
    for (int i = 0; i < kMostTries; ++i) {
        std::string name = stem + std::to_string(i);
        if (make(name) == 0) return name;
        if (errno != EEXIST) break;
    }
    return "";
}

[[noreturn]] void refuseLength(const std::string& operand, bool regular) {
    const std::string file = std::to_string(kMostFileBytes);
    throw FormatError({displayName(operand), 0, 0,
                       regular ? "more than " + file + " bytes, the most that an input may have"
                               : "more than " + std::to_string(kMostStreamBytes) +
                                     " bytes, the most that a pipe or a device may bring; a file "
                                     "may have " +
                                     file});
}

}  // namespace

std::string readAll(const std::string& operand) {
    const bool standard = operand == "-";
    const Descriptor file(standard ? STDIN_FILENO : ::open(operand.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.get() < 0) fail(operand, errno);
    struct stat info {};
    if (::fstat(file.get(), &info) != 0) fail(operand, errno);
    if (S_ISDIR(info.st_mode)) fail(operand, EISDIR);
    const bool regular = S_ISREG(info.st_mode);
    const std::uint64_t most = regular ? kMostFileBytes : kMostStreamBytes;
    if (regular && static_cast<std::uint64_t>(info.st_size) > most) refuseLength(operand, regular);
    std::string bytes;
    constexpr std::size_t kChunk = 1 << 16;
    std::size_t size = 0;
    bytes.resize(regular ? static_cast<std::size_t>(info.st_size) + 1 : kChunk);
    while (true) {
        const ssize_t n = ::read(file.get(), bytes.data() + size, bytes.size() - size);
        if (n < 0) {
            if (errno == EINTR) continue;
            fail(operand, errno);
        }
        if (n == 0) break;
        size += static_cast<std::size_t>(n);
        if (size > most) refuseLength(operand, regular);
        if (size < bytes.size()) continue;
        if (!regular && size == kChunk && bytes.find_first_not_of('\0') == std::string::npos)
            throw FormatError({displayName(operand), 0, 0, "it has nothing but zeros"});
        bytes.resize(std::min<std::size_t>(2 * size, most + 1));
    }
    bytes.resize(size);
    return bytes;
}

InputFile::InputFile(const std::string& operand)
    : name_(operand),
      fd_(operand == "-" ? STDIN_FILENO : ::open(operand.c_str(), O_RDONLY | O_CLOEXEC)) {
    struct stat info {};
    if (fd_ < 0 || ::fstat(fd_, &info) != 0) fail(operand, errno);
    if (!S_ISDIR(info.st_mode)) return;
    if (fd_ > STDERR_FILENO) ::close(fd_);
    fail(operand, EISDIR);
}

InputFile::~InputFile() {
    if (fd_ > STDERR_FILENO) ::close(fd_);
}

bool InputFile::read(std::string& bytes) {
    constexpr std::size_t kChunk = 1 << 16;
    const std::size_t size = bytes.size();
    bytes.resize(size + kChunk);
    ssize_t n = 0;
    do {
        n = ::read(fd_, bytes.data() + size, kChunk);
    } while (n < 0 && errno == EINTR);
    if (n < 0) fail(name_, errno);
    bytes.resize(size + static_cast<std::size_t>(n));
    return n > 0;
}

struct OutputFile::State {
    std::string name;       // as the user wrote it, for messages
    std::string target;     // the file that is replaced, links resolved
    std::string temporary;  // its stand-in; empty: written directly or not yet named
    int fd = -1;
    bool direct = false;

    [[nodiscard]] std::string folder() const {
        const fs::path parent = fs::path(target).parent_path();
        return parent.empty() ? "." : parent.string();
    }
    ~State() {
        if (fd > STDERR_FILENO) ::close(fd);
        if (!temporary.empty()) ::unlink(temporary.c_str());
    }
};

OutputFile::OutputFile(const std::string& target) : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.name = target;
    if (target == "-") {
        s.direct = true;
        s.fd = STDOUT_FILENO;
        s.name = "stdout";
        return;
    }
    if (target.empty()) fail(target, ENOENT);
    if (target.ends_with('/')) fail(target, EISDIR);
    struct stat info {};
    const bool exists = ::stat(target.c_str(), &info) == 0;
    if (exists && !S_ISREG(info.st_mode)) {
        s.direct = true;
        s.fd = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
        if (s.fd < 0) fail(target, errno);
        return;
    }
    s.target = followLinks(target);
    if (exists && ::access(s.target.c_str(), W_OK) != 0) fail(target, errno);
    const std::string folder = s.folder();
    const mode_t mode = exists ? (info.st_mode & 07777) : 0666;
    // An unnamed file vanishes with the process, however that ends.
    s.fd = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode);
    if (s.fd < 0 && (errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL)) {
        s.temporary = makeStandIn(folder, [&](const std::string& name) {
            s.fd = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
            return s.fd < 0 ? -1 : 0;
        });
    }
    if (s.fd < 0) fail(target, errno);
    if (exists) (void)::fchmod(s.fd, mode);
}

OutputFile::~OutputFile() = default;

void OutputFile::write(std::string_view bytes) { writeFully(state_->fd, bytes, state_->name); }

void OutputFile::commit() {
    State& s = *state_;
    if (s.direct) {
        if (s.fd > STDERR_FILENO && ::close(std::exchange(s.fd, -1)) != 0) fail(s.name, errno);
        return;
    }
    if (s.temporary.empty()) {
        const std::string from = "/proc/self/fd/" + std::to_string(s.fd);
        s.temporary = makeStandIn(s.folder(), [&](const std::string& name) {
            return ::linkat(AT_FDCWD, from.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW);
        });
        if (s.temporary.empty()) fail(s.name, errno);
    }
    if (::close(std::exchange(s.fd, -1)) != 0) fail(s.name, errno);
    if (::rename(s.temporary.c_str(), s.target.c_str()) != 0) fail(s.name, errno);
    s.temporary.clear();
}

void mustBeWritable(const std::string& target) {
    struct stat info {};
    const bool is_special =
        target == "-" || target.empty() ||
        (::stat(target.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode));
    if (!is_special) static_cast<void>(OutputFile(target));
}

void writeAll(const std::string& target, std::string_view bytes) {
    OutputFile file(target);
    file.write(bytes);
    file.commit();
}

void writeBoth(const std::string& first, std::string_view first_bytes, const std::string& second,
               std::string_view second_bytes) {
    OutputFile one(first), two(second);
    one.write(first_bytes);
    two.write(second_bytes);
    one.commit();
    two.commit();
}

std::string withSuffix(const std::string& file, const char* suffix) {
    return std::filesystem::path(file).replace_extension(suffix).string();
}

bool isTerminalInput() { return ::isatty(STDIN_FILENO) != 0; }

bool isTerminalOutput(const std::string& target) {
    return target == "-" && ::isatty(STDOUT_FILENO) != 0;
}

}  // namespace ispace
