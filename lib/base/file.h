// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace ispace {

/// Bytes that an input may have: a file, and what comes from a pipe or a device, which may never
/// end.
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30U,
                        kMaxStreamBytes = std::uint64_t{1} << 30U;

/// A file descriptor, closed at the end unless it is of a standard stream.
class OpenFile {
  public:
    explicit OpenFile(int fd = -1) : fd_(fd) {}
    ~OpenFile() { close(); }
    OpenFile(OpenFile&& other) noexcept;
    OpenFile& operator=(OpenFile&& other) noexcept;
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    [[nodiscard]] int fd() const { return fd_; }
    /// False, with errno set, if the system could not write all of it.
    bool close();

  private:
    int fd_;
};

/// Everything in a file, or on standard input for "-".
/// \throws std::system_error naming the file; also for a directory
/// \throws FormatError naming the file for more bytes than an input may have, and for a pipe or a
/// device that begins with 64 KiB of zeros
std::string readAll(const std::string& operand);

/// A file, or standard input for "-", read piece by piece.
class InputFile {
  public:
    /// \throws std::system_error naming the file; also for a directory
    explicit InputFile(const std::string& operand);

    /// Appends what is there, and waits only if there is nothing; false at the end.
    bool read(std::string& bytes);

  private:
    std::string name_;
    OpenFile file_;
};

/// A product on its way to its place: a regular file is written beside its target and renamed by
/// commit(), so that a reader never sees half of it; without commit() (an error, a signal) the old
/// file stays and nothing is left behind. "-" is standard output; a device, a pipe and
/// everything else that is no regular file is written directly. A symbolic link stays, its target
/// is replaced; an existing file's permissions are kept. Where a run keeps RunFiles, no input is
/// replaced.
///
/// TERM, INT and HUP leave nothing behind either; KILL may if it falls into commit(), and so may
/// any signal on a file system without O_TMPFILE. There is no fsync: the rename is safe against the
/// end of the process, not against that of the machine.
class OutputFile {
  public:
    /// \throws std::system_error if the file cannot be made there; UsageError if it is an input
    explicit OutputFile(const std::string& target);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// \throws std::system_error naming the target, a full disk included
    void write(std::string_view bytes);
    /// Puts the file in its place. Nothing can be written afterwards.
    void commit();
    /// The same for files that belong together: all are in their places, or none. The file that
    /// names the others comes last, so that it never names what is not there.
    static void commitTogether(std::span<OutputFile* const> files);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Tells early what would fail late: that a file can be made there. Leaves nothing behind; streams,
/// devices and pipes are left alone. \throws std::system_error as OutputFile
void mustBeWritable(const std::string& target);

/// OutputFile for a product that is whole in memory.
void writeAll(const std::string& target, std::string_view bytes);

struct NamedBytes {
    std::string name;
    std::string_view bytes;
};

/// Files that belong together, the one that names the others last: OutputFile::commitTogether.
void writeTogether(std::span<const NamedBytes> products);

/// `file` with this suffix (".pgm") in place of its own.
std::string withSuffix(const std::string& file, const char* suffix);

/// True if "-" and standard output is a terminal: binary data does not go there.
bool isTerminalOutput(const std::string& target);
/// True if standard input is a terminal.
bool isTerminalInput();

}  // namespace ispace
