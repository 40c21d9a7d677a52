// SPDX-License-Identifier: GPL-3.0-or-later
// Reads untrusted files (meshes, archives) in a separate process without rights: no files but those
// handed over, no network, bounded memory and time, see base/module/confine.h. A parser that its
// input takes over can send wrong bytes to its parent, which must check them, and has no other way
// out.
//
// The parent alone opens files, pays for work by its Budget and turns every failure of the child,
// crashes and silence included, into one FormatError (std::bad_alloc where the user's own limit of
// memory is less than the child's). A child is given up after five times its seconds of processor
// time on the wall clock. Without seccomp reading fails unless --unconfined allows it.
//
//     ConfinedReader reader;  // one process for many files
//     const std::string triangles = reader.read(task);
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/budget.h"
#include "base/file.h"

namespace ispace {

/// Limits of a program that reads untrusted bytes.
struct ConfinedLimits {
    std::size_t memory = 0;   ///< bytes of address space
    std::size_t seconds = 0;  ///< of processor time
};

/// Messages of a confined program to its parent: a kind, the size of the rest in eight native
/// bytes, and the rest.
enum class ConfinedAnswer : char {
    WantsFile = 'F',    ///< name of a file that the input refers to; see ConfinedReply
    Work = 'W',         ///< units of work that the file took, in eight native bytes
    Result = 'P',       ///< the last message for this file
    TooMuchWork = 'B',  ///< the cause of work beyond the budget; last message
    Error = 'E',        ///< the error in the file; last message
    OutOfMemory = 'M',  ///< without further bytes; last message
};

/// The reply to WantsFile, one byte. `Handed` carries a descriptor, and the size as eight bytes.
/// After a result, `Handed` is the next file to read.
enum class ConfinedReply : char { Handed = 'Y', Missing = 'N' };

constexpr std::size_t kConfinedHead = 1 + sizeof(std::uint64_t);

/// A file that a program in lib/ispace reads for this one, without rights (base/module/confine.h).
struct ConfinedTask {
    const std::string& name;                  ///< of the file, for messages
    std::string program;                      ///< "read-mesh"
    std::vector<std::string> arguments = {};  ///< of the program; its parent's number, the size of
                                              ///< the file, the limits and the units of work follow
    int file = -1;                            ///< open for reading: standard input of the program
    std::size_t bytes = 0;                    ///< of the file
    /// Returns the limits for files of `bytes` bytes in all. \pre increases with `bytes`
    std::function<ConfinedLimits(std::size_t bytes)> limits;
    /// Opens a file that the input refers to; nullopt if it does not exist. Empty if inputs refer
    /// to no files.
    std::function<std::optional<RegularFile>(const std::string& name)> open = {};
    /// Pays for the work that the program reports, with all that is left for a file that the
    /// program does not finish. Null: unbounded.
    Budget* work = nullptr;
    // For messages.
    std::string kind;          ///< "mesh file"
    std::string reader;        ///< "assimp"
    std::string subject;       ///< "meshes are"
    std::string hint;          ///< printed if the program cannot start for lack of a library
    std::string problem = {};  ///< prefix of the errors that the program finds
};

/// Reads files with one process, which is started for the first file and again after an error: a
/// start takes some 50 ms, mostly for loading libraries. Limits apply to each file. Not
/// thread-safe; several readers may run at once, each with its process. The destructor kills the
/// process.
class ConfinedReader {
  public:
    ConfinedReader();
    ~ConfinedReader();
    ConfinedReader(const ConfinedReader&) = delete;
    ConfinedReader& operator=(const ConfinedReader&) = delete;

    /// Returns the result of the program. \pre program and arguments are those of the first task
    /// \throws FormatError for the file: the error that the program found, too much memory or time,
    /// a crash, or a program that fails to start
    std::string read(const ConfinedTask& task);
    /// Processes started so far.
    [[nodiscard]] int starts() const { return starts_; }

  private:
    class Child;
    class Reading;
    std::unique_ptr<Child> child_;  // null until the first file, and after an error
    int starts_ = 0;
};

/// Reads one file with a process of one task.
inline std::string readConfined(const ConfinedTask& task) { return ConfinedReader().read(task); }

/// Creates a file in memory that holds these bytes, for tasks. \throws std::system_error
OpenFile fileInMemory(std::string_view bytes);

}  // namespace ispace
