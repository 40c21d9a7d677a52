// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace ispace {

/// Most bytes of an input: of a file, and of a pipe or device, which may never end.
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30U,
                        kMaxStreamBytes = std::uint64_t{1} << 30U;

/// Owns a file descriptor; those of standard streams are never closed.
class OpenFile {
  public:
    explicit OpenFile(int fd = -1) : fd_(fd) {}
    ~OpenFile() { close(); }
    OpenFile(OpenFile&& other) noexcept;
    OpenFile& operator=(OpenFile&& other) noexcept;
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    [[nodiscard]] int fd() const { return fd_; }
    /// False, with errno set, if the system could not write everything.
    bool close();

  private:
    int fd_;
};

/// A regular file, open for reading.
struct RegularFile {
    OpenFile file;
    std::size_t size = 0;
};

/// Opens a file that must be regular, without waiting for pipes. \throws FormatError for devices,
/// pipes and sockets; std::system_error if it cannot be opened, also for a folder
RegularFile openRegular(const std::string& path);

/// The files that a reader accepts. A file that the user names may be a pipe or a device; one that
/// another file names must be regular and is refused unopened otherwise.
enum class InputKind { Any, Regular };

/// The content of a file, or of standard input for "-".
/// \throws std::system_error naming the file; also for a directory
/// \throws FormatError naming the file if it is too large, is no regular file where one is wanted,
/// or is a pipe or device that begins with 64 KiB of zeros
std::string readAll(const std::string& operand, InputKind kind = InputKind::Any);

/// A file, or standard input for "-", read piece by piece.
class InputFile {
  public:
    /// \throws std::system_error naming the file; also for a directory; FormatError if it is no
    /// regular file where one is wanted
    explicit InputFile(const std::string& operand, InputKind kind = InputKind::Any);

    /// Appends what is available, waiting only if nothing is; false at the end.
    bool read(std::string& bytes);

  private:
    std::string name_;
    OpenFile file_;
};

/// Writes a file atomically: a regular file is written beside its target and renamed by commit(),
/// so a reader never sees half of it. Without commit() (an error, a signal) the old file stays and
/// nothing is left behind. "-" is standard output; devices, pipes and anything else that is not a
/// regular file are written directly. A symbolic link stays and its target is replaced; an existing
/// file keeps its permissions. While FileGuard lives, no input is replaced.
///
/// TERM, INT and HUP leave nothing behind either. KILL may, during commit(), and so may any signal
/// on a file system without O_TMPFILE. There is no fsync: the rename survives the end of the
/// process, not a crash of the machine.
class OutputFile {
  public:
    /// \throws std::system_error if the file cannot be made there; UsageError if it is an input
    explicit OutputFile(const std::string& target);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// \throws std::system_error naming the target, a full disk included
    void write(std::string_view bytes);
    /// Moves the file to its place. Nothing can be written afterwards.
    void commit();
    /// The same for files that belong together: all get to their places, or none. Pass the file
    /// that names the others last, so that it never names a missing one.
    static void commitTogether(std::span<OutputFile* const> files);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Checks early that a file can be made there, and leaves nothing behind. Streams, devices and
/// pipes pass. \throws std::system_error as OutputFile
void mustBeWritable(const std::string& target);

/// Writes a whole file from memory, as OutputFile does.
void writeAll(const std::string& target, std::string_view bytes);

struct NamedBytes {
    std::string name;
    std::string_view bytes;
};

/// Writes files that belong together, in the order that OutputFile::commitTogether wants.
void writeTogether(std::span<const NamedBytes> products);

/// `file` with this suffix (".pgm") in place of its own.
std::string withSuffix(const std::string& file, const char* suffix);

/// True if "-" and standard output is a terminal: binary data does not go there.
bool isTerminalOutput(const std::string& target);
/// True if standard input is a terminal.
bool isTerminalInput();

/// Takes bytes as they come, in order.
using ByteSink = std::function<void(std::string_view)>;

/// Appends the bytes of a number as binary formats have it, little-endian.
template <typename Number>
void appendLittle(std::string& out, Number value) {
    static_assert(std::is_arithmetic_v<Number> && std::endian::native == std::endian::little);
    out.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace ispace
