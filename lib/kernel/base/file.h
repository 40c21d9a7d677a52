// SPDX-License-Identifier: GPL-3.0-or-later
// Files as whole inputs and as atomic outputs. "-" is standard input or output.
//
// Errors of the system are std::system_error that name the file as the user did; interrupted and
// non-blocking calls are repeated. Inputs and outputs pass FileGuard and InputSandbox, see
// run_files.h. Objects are not thread-safe; different ones may be used at once.
//
//     const std::string text = readAll("room.env");
//     OutputFile file("room.3dm");
//     file.write(compiled);
//     file.commit();  // without it, as after an exception, the old room.3dm stays
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

/// Most bytes that are read from one input; pipes and devices may be endless.
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30U,
                        kMaxStreamBytes = std::uint64_t{1} << 30U;

/// Owns a file descriptor. Descriptors of standard streams are never closed.
class OpenFile {
  public:
    explicit OpenFile(int fd = -1) : fd_(fd) {}
    ~OpenFile() { close(); }
    OpenFile(OpenFile&& other) noexcept;
    OpenFile& operator=(OpenFile&& other) noexcept;
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    [[nodiscard]] int fd() const { return fd_; }
    /// Closes the file; returns false, with errno set, if the system failed to write everything.
    bool close();

  private:
    int fd_;
};

/// A regular file, open for reading.
struct RegularFile {
    OpenFile file;
    std::size_t size = 0;
};

/// Opens a regular file without waiting for pipes. \throws FormatError for devices, pipes and
/// sockets; std::system_error if it cannot be opened, also for a folder
RegularFile openRegular(const std::string& path);

/// The files that a reader accepts. A file that the user names may be a pipe or a device; a file
/// named by another file must be regular, else it is rejected without being opened.
enum class InputKind { Any, Regular };

/// Reads a whole file, or standard input for "-", with one allocation for a regular file that does
/// not grow; at most kMaxFileBytes, or kMaxStreamBytes of a pipe or device.
/// \throws std::system_error naming the file; also for a directory
/// \throws FormatError naming the file if it is too large, is not regular where a regular file is
/// required, or is a pipe or device that begins with 64 KiB of zeros
std::string readAll(const std::string& operand, InputKind kind = InputKind::Any);

/// Reads a file, or standard input for "-", piece by piece.
class InputFile {
  public:
    /// \throws std::system_error naming the file; also for a directory; FormatError if it is not
    /// regular where a regular file is required
    explicit InputFile(const std::string& operand, InputKind kind = InputKind::Any);

    /// Appends the available bytes, up to 64 KiB, and waits until there are some; false at the end.
    /// A file that has grown since can be read further.
    bool read(std::string& bytes);

  private:
    std::string name_;
    OpenFile file_;
};

/// Writes a file atomically: a regular file is written beside its target and renamed by commit(),
/// so a reader never sees half of it. Without commit() (an error, a signal) the old file stays and
/// the new one is removed. "-" is standard output; devices, pipes and other special files are
/// written directly. A symbolic link stays and its target is replaced; an existing file keeps its
/// permissions. While FileGuard lives, inputs cannot be replaced.
///
/// TERM, INT and HUP leave no temporary file either. KILL may leave one during commit(), and any
/// signal may on a file system without O_TMPFILE. There is no fsync: the rename survives the end of
/// the process, not a crash of the machine.
class OutputFile {
  public:
    /// \throws std::system_error if the file cannot be created; UsageError if it is an input
    explicit OutputFile(const std::string& target);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// \throws std::system_error naming the target, a full disk included
    void write(std::string_view bytes);
    /// Renames the file to its target. No further writes are allowed. \throws std::system_error,
    /// also for errors of earlier writes that the system reports late; UsageError if the target has
    /// become an input
    void commit();
    /// Commits files that belong together: all replace their targets or all are discarded. Pass the
    /// file that refers to the others last, so that it never refers to a missing one.
    static void commitTogether(std::span<OutputFile* const> files);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Checks early that a file can be created there, and removes it again. Streams, devices and pipes
/// pass. \throws std::system_error as OutputFile
void mustBeWritable(const std::string& target);

/// Writes a whole file from memory, as OutputFile does.
void writeAll(const std::string& target, std::string_view bytes);

/// The bytes of one file of a set.
struct NamedBytes {
    std::string name;
    std::string_view bytes;
};

/// Writes files that belong together; OutputFile::commitTogether requires their order.
void writeTogether(std::span<const NamedBytes> products);

/// Replaces the suffix of `file` by this one (".pgm").
std::string withSuffix(const std::string& file, const char* suffix);

/// True if `name` is "-" and standard output is a terminal, to which binary data are not written.
bool isTerminalOutput(const std::string& target);
/// True if standard input is a terminal.
bool isTerminalInput();

/// Receives bytes piece by piece, in order.
using ByteSink = std::function<void(std::string_view)>;

/// Appends the bytes of a number in little-endian order, as binary formats require.
template <typename Number>
void appendLittle(std::string& out, Number value) {
    static_assert(std::is_arithmetic_v<Number> && std::endian::native == std::endian::little);
    out.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace ispace
