// SPDX-License-Identifier: GPL-3.0-or-later
// An output is an unnamed file (O_TMPFILE) in the folder of its target, which vanishes with the
// process; commit() links it to a name and renames that over the target. Where the system has no
// such files it is named from the start. A set of files keeps second links to the old ones until
// all are renamed, so that a failure restores them.
#include "base/file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/run_files.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& name, int error) {
    throw std::system_error(error, std::generic_category(), displayName(name));
}

void mustBeRegular(const struct stat& info, const std::string& path) {
    if (S_ISDIR(info.st_mode)) fail(path, EISDIR);
    if (!S_ISREG(info.st_mode))
        throw FormatError({displayName(path), 0, 0, "it is no regular file"});
}

/// \param info of the file
OpenFile openInput(const std::string& operand, InputKind kind, struct stat& info) {
    if (kind == InputKind::Regular) {
        RegularFile regular = openRegular(operand);
        if (::fstat(regular.file.fd(), &info) != 0) fail(operand, errno);
        return std::move(regular.file);
    }
    mustBeReadable(operand);
    OpenFile file(operand == "-" ? STDIN_FILENO : ::open(operand.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.fd() < 0 || ::fstat(file.fd(), &info) != 0) fail(operand, errno);
    if (S_ISDIR(info.st_mode)) fail(operand, EISDIR);
    noteInput(file.fd());
    return file;
}

/// True if the failed call should be repeated. A parent or a terminal may have left a stream
/// non-blocking; then this waits until the stream is ready.
bool isToBeRepeated(int fd, short events) {
    if (errno == EINTR) return true;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return false;
    pollfd ready{fd, events, 0};
    return ::poll(&ready, 1, -1) >= 0 || errno == EINTR;
}

void writeFully(int fd, std::string_view bytes, const std::string& name) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), bytes.size());
        if (n >= 0)
            bytes.remove_prefix(static_cast<std::size_t>(n));
        else if (!isToBeRepeated(fd, POLLOUT))
            fail(name, errno);
    }
}

std::size_t readSome(int fd, std::span<char> bytes, const std::string& name) {
    while (true) {
        const ssize_t n = ::read(fd, bytes.data(), bytes.size());
        if (n >= 0) return static_cast<std::size_t>(n);
        if (!isToBeRepeated(fd, POLLIN)) fail(name, errno);
    }
}

/// Opens a pipe or a device for writing. Opening a pipe waits for its reader; meanwhile TERM ends
/// the process, also where a tool handles or ignores it.
OpenFile openSpecial(const std::string& target) {
    struct sigaction before {};
    struct sigaction ends {};
    ends.sa_handler = SIG_DFL;
    ::sigaction(SIGTERM, &ends, &before);
    OpenFile file(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
    const int error = errno;
    ::sigaction(SIGTERM, &before, nullptr);
    if (file.fd() < 0) fail(target, error);
    return file;
}

/// Calls make(name) with unlikely names in the folder until one is free: a killed process may have
/// left its file, and process numbers are reused.
template <typename Make>
std::string makeStandIn(const std::string& folder, Make make) {
    constexpr int kMaxTries = 1000;
    const std::string stem =
        (fs::path(folder) / (".ispace.tmp." + std::to_string(::getpid()) + '.')).string();
    for (int i = 0; i < kMaxTries; ++i) {
        std::string name = stem + std::to_string(i);
        if (make(name) == 0) return name;
        if (errno != EEXIST) break;
    }
    return "";
}

std::string pathOf(const OpenFile& file) { return "/proc/self/fd/" + std::to_string(file.fd()); }

[[noreturn]] void refuseLength(const std::string& operand, bool regular) {
    const std::string file = std::to_string(kMaxFileBytes);
    throw FormatError({displayName(operand), 0, 0,
                       regular ? "more than " + file + " bytes, the most that an input may have"
                               : "more than " + std::to_string(kMaxStreamBytes) +
                                     " bytes, the most that a pipe or a device may bring; a file "
                                     "may have " +
                                     file});
}

}  // namespace

OpenFile::OpenFile(OpenFile&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

OpenFile& OpenFile::operator=(OpenFile&& other) noexcept {
    if (this != &other) {
        close();
        fd_ = std::exchange(other.fd_, -1);
    }
    return *this;
}

bool OpenFile::close() {
    const int fd = std::exchange(fd_, -1);
    return fd <= STDERR_FILENO || ::close(fd) == 0;
}

RegularFile openRegular(const std::string& path) {
    mustBeReadable(path);
    // Checked before opening, too: opening a device may have side effects.
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) fail(path, errno);
    mustBeRegular(info, path);
    OpenFile file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
    if (file.fd() < 0 || ::fstat(file.fd(), &info) != 0) fail(path, errno);
    mustBeRegular(info, path);
    noteInput(file.fd());
    return {std::move(file), static_cast<std::size_t>(info.st_size)};
}

std::string readAll(const std::string& operand, InputKind kind) {
    struct stat info {};
    const OpenFile file = openInput(operand, kind, info);
    const bool regular = S_ISREG(info.st_mode);
    const std::uint64_t most = regular ? kMaxFileBytes : kMaxStreamBytes;
    if (regular && static_cast<std::uint64_t>(info.st_size) > most) refuseLength(operand, regular);
    std::string bytes;
    constexpr std::size_t kChunk = 1 << 16;
    std::size_t size = 0;
    bytes.resize(regular ? static_cast<std::size_t>(info.st_size) + 1 : kChunk);
    while (true) {
        const std::size_t n = readSome(file.fd(), std::span(bytes).subspan(size), operand);
        if (n == 0) break;
        size += n;
        if (size > most) refuseLength(operand, regular);
        if (size < bytes.size()) continue;
        if (!regular && size == kChunk && bytes.find_first_not_of('\0') == std::string::npos)
            throw FormatError(
                {displayName(operand), 0, 0, "it begins with 64 KiB of zeros, as no input does"});
        bytes.resize(std::min<std::size_t>(2 * size, most + 1));
    }
    bytes.resize(size);
    return bytes;
}

InputFile::InputFile(const std::string& operand, InputKind kind) : name_(operand) {
    struct stat info {};
    file_ = openInput(operand, kind, info);
}

bool InputFile::read(std::string& bytes) {
    constexpr std::size_t kChunk = 1 << 16;
    const std::size_t size = bytes.size();
    bytes.resize(size + kChunk);
    const std::size_t n = readSome(file_.fd(), std::span(bytes).subspan(size), name_);
    bytes.resize(size + n);
    return n > 0;
}

struct OutputFile::State {
    std::string name;       // as the user wrote it, for messages
    std::string target;     // the file that is replaced, links resolved
    std::string temporary;  // temporary file; empty: written directly or not yet named
    std::string kept;       // second link to the old file until the whole set is committed
    std::optional<OpenOutput> known;
    OpenFile file;
    bool direct = false;
    bool is_first = false;   // there is no old file
    bool is_placed = false;  // the target is the new file

    ~State() {
        drop(temporary);
        drop(kept);
    }

    [[nodiscard]] std::string folder() const {
        const fs::path parent = fs::path(target).parent_path();
        return parent.empty() ? "." : parent.string();
    }
    static void drop(std::string& file) {
        if (!file.empty()) ::unlink(file.c_str());
        file.clear();
    }
    /// Opens the temporary file with these permissions.
    void openStandIn(mode_t mode);
    /// Links the written file to a name in the folder.
    void link();
    /// Stores the old file so that put() can be reverted, where the file system supports it.
    void keepOld();
    void put();
    void takeBack();
};

void OutputFile::State::openStandIn(mode_t mode) {
    // An unnamed file vanishes with the process, however that ends. It gets its name through /proc,
    // which may be missing in a chroot.
    file = OpenFile(::open(folder().c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode));
    const bool is_known =
        file.fd() < 0 && errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL;
    if (is_known || (file.fd() >= 0 && ::access(pathOf(file).c_str(), F_OK) == 0)) return;
    temporary = makeStandIn(folder(), [&](const std::string& stand_in) {
        file = OpenFile(::open(stand_in.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode));
        return file.fd() < 0 ? -1 : 0;
    });
}

void OutputFile::State::link() {
    if (!direct && temporary.empty()) {
        const std::string from = pathOf(file);
        temporary = makeStandIn(folder(), [&](const std::string& stand_in) {
            return ::linkat(AT_FDCWD, from.c_str(), AT_FDCWD, stand_in.c_str(), AT_SYMLINK_FOLLOW);
        });
        if (temporary.empty()) fail(name, errno);
    }
    if (!file.close()) fail(name, errno);
}

void OutputFile::State::keepOld() {
    if (direct) return;
    kept = makeStandIn(folder(), [&](const std::string& stand_in) {
        return ::link(target.c_str(), stand_in.c_str());
    });
    is_first = kept.empty() && errno == ENOENT;
}

void OutputFile::State::put() {
    if (direct) return;
    known->check();
    if (::rename(temporary.c_str(), target.c_str()) != 0) fail(name, errno);
    temporary.clear();
    is_placed = true;
}

void OutputFile::State::takeBack() {
    if (std::exchange(is_placed, false)) {
        if (is_first)
            ::unlink(target.c_str());
        else if (!kept.empty() && ::rename(kept.c_str(), target.c_str()) == 0)
            kept.clear();
    }
    drop(kept);
    drop(temporary);
}

OutputFile::OutputFile(const std::string& target) : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.name = target;
    if (target == "-") {
        s.direct = true;
        s.file = OpenFile(STDOUT_FILENO);
        s.name = "stdout";
        s.known.emplace("-", s.name);
        return;
    }
    if (target.empty()) fail(target, ENOENT);
    if (target.ends_with('/')) fail(target, EISDIR);
    struct stat info {};
    const bool exists = ::stat(target.c_str(), &info) == 0;
    if (exists && !S_ISREG(info.st_mode)) {
        s.direct = true;
        s.file = openSpecial(target);
        return;
    }
    s.target = followLinks(target);
    s.known.emplace(s.target, target);
    if (exists && ::access(s.target.c_str(), W_OK) != 0) fail(target, errno);
    const mode_t mode = exists ? (info.st_mode & 07777) : 0666;
    s.openStandIn(mode);
    if (s.file.fd() < 0) fail(target, errno);
    if (exists) (void)::fchmod(s.file.fd(), mode);
}

OutputFile::~OutputFile() = default;

void OutputFile::write(std::string_view bytes) {
    writeFully(state_->file.fd(), bytes, state_->name);
}

void OutputFile::commit() {
    OutputFile* const alone = this;
    commitTogether({&alone, 1});
}

void OutputFile::commitTogether(std::span<OutputFile* const> files) {
    // Signals are delayed from the first name to the last rename.
    const DeferredSignals held;
    try {
        for (const OutputFile* file : files) file->state_->link();
        // Only a set of files can fail after its first rename.
        if (files.size() > 1)
            for (const OutputFile* file : files) file->state_->keepOld();
        for (const OutputFile* file : files) file->state_->put();
    } catch (...) {
        for (const OutputFile* file : files) file->state_->takeBack();
        throw;
    }
    for (const OutputFile* file : files) {
        State::drop(file->state_->kept);
        if (file->state_->known) file->state_->known->done();
    }
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

void writeTogether(std::span<const NamedBytes> products) {
    std::vector<std::unique_ptr<OutputFile>> files;
    std::vector<OutputFile*> in_order;
    for (const NamedBytes& product : products)
        in_order.push_back(files.emplace_back(std::make_unique<OutputFile>(product.name)).get());
    for (std::size_t i = 0; i < products.size(); ++i) files[i]->write(products[i].bytes);
    OutputFile::commitTogether(in_order);
}

std::string withSuffix(const std::string& file, const char* suffix) {
    return std::filesystem::path(file).replace_extension(suffix).string();
}

bool isTerminalInput() { return ::isatty(STDIN_FILENO) != 0; }

bool isTerminalOutput(const std::string& target) {
    return target == "-" && ::isatty(STDOUT_FILENO) != 0;
}

}  // namespace ispace
