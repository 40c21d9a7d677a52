// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/file.h"

namespace ispace {

/// Limits of a program that reads untrusted bytes.
struct ConfinedLimits {
    std::size_t memory = 0;   ///< bytes of address space
    std::size_t seconds = 0;  ///< of processor time
};

/// Messages of a confined program to the one that started it: a kind, the size of the rest in eight
/// native bytes, and the rest.
enum class ConfinedAnswer : char {
    WantsFile = 'F',    ///< the name of a file that the one read names; see ConfinedReply
    Result = 'P',       ///< the last
    Error = 'E',        ///< the error in the file; the last
    OutOfMemory = 'M',  ///< nothing follows; the last
};

/// The reply to WantsFile, one byte. `Handed` carries a descriptor, and the size as eight bytes.
enum class ConfinedReply : char { Handed = 'Y', Missing = 'N' };

constexpr std::size_t kConfinedHead = 1 + sizeof(std::uint64_t);

/// A file that a program in lib/ispace reads for this one, without rights (base/module/confine.h).
struct ConfinedTask {
    const std::string& name;             ///< of the file, for messages
    std::string program;                 ///< "read-mesh"
    std::vector<std::string> arguments;  ///< of the program; its parent's number, the size of the
                                         ///< file and the limits follow
    int file = -1;                       ///< open for reading: standard input of the program
    std::size_t bytes = 0;               ///< of the file
    /// For files of so many bytes in all, \pre grows with it.
    std::function<ConfinedLimits(std::size_t bytes)> limits;
    /// Opens a file that the one read names; nothing if there is none. Empty: it names none.
    std::function<std::optional<RegularFile>(const std::string& name)> open = {};
    // For messages.
    std::string kind;     ///< "mesh file"
    std::string reader;   ///< "assimp"
    std::string subject;  ///< "meshes are"
    std::string hint;     ///< where the program cannot be started for want of a library
};

/// The result of the program. \throws FormatError for the file: the error that the program found,
/// too much memory or time, a crash, or a program that cannot be started
std::string readConfined(const ConfinedTask& task);

/// A file in memory with these bytes, for tasks. \throws std::system_error
OpenFile fileInMemory(std::string_view bytes);

}  // namespace ispace
