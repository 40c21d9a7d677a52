// SPDX-License-Identifier: GPL-3.0-or-later
// The header of a file of results, see part_file.h:
//     #part 2
//     # scan room.glb --frames 100        the history of the product, a line each
//     tool scan 0.1.0                     and its version
//     room sha256:…                       digest of the environment
//     inputs sha256:…                     digest of everything read
//     seed 0
//     form jsonl                          format of the records
//     shard 3/8
//     units 100                           of the whole job; - if unknown
// and a blank line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/message.h"
#include "base/shard.h"

namespace ispace {

/// Properties that all parts of a job share.
struct JobId {
    std::string tool;
    std::string version = std::string(ispace::version());
    History history;     ///< of the product, the job's command last: without --shard and the like
    std::string room;    ///< digest of the environment
    std::string inputs;  ///< digest of everything read
    std::uint64_t seed = 0;
    std::string form;                   ///< format of the records: "jsonl"
    std::optional<std::int64_t> units;  ///< of the whole job, if they can be counted

    /// Returns the property in which another job differs, for messages: "the room", "the version of
    /// ispace (0.1.0, 0.2.0)"; "" if the jobs are equal.
    [[nodiscard]] std::string differenceFrom(const JobId& other) const;
};

/// The header: the job, and which share of it the file holds.
struct PartHead {
    JobId job;
    Shard shard;
};

/// First line of a header.
inline constexpr std::string_view kPartMagic = "#part 2\n";

/// Formats a header; parsePartHead() reads it back as the same values.
std::string partHeadText(const PartHead& head);
/// Parses a header with its blank line. \throws FormatError with the line and this name of the file
PartHead parsePartHead(std::string_view text, const std::string& file);

/// Removes the text before `separator`, and the separator, and returns that text.
std::string_view takeUpTo(std::string_view& text, char separator);

}  // namespace ispace
