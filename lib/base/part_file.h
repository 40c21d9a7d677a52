// SPDX-License-Identifier: GPL-3.0-or-later
// What one shard of a job has done, or a job so far: the parts of --shard and the checkpoints of
// --resume, of all tools.
//
// A text header, then records. The header is
//     #part 1
//     # scan room.glb --frames 100        the history of the product, a line each
//     tool scan 0.1.0                     and its version
//     room sha256:…                       digest of the environment
//     inputs sha256:…                     digest of all that was read
//     seed 0
//     form jsonl                          what the records hold
//     shard 3/8
//     units 100                           of the whole job; - if nobody knows
// and a blank line. A record is a line `=NAME BYTES HASH`, so many bytes and a newline; the hash is
// hashOf() the bytes, in hex. The last record of a finished part is `end`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/file.h"
#include "base/program.h"
#include "base/shard.h"

namespace ispace {

/// What all parts of a job have in common.
struct JobId {
    std::string tool;
    std::string version = std::string(ispace::version());
    History history;     ///< of the product, the job's command last: without --shard and the like
    std::string room;    ///< digest of the environment
    std::string inputs;  ///< digest of everything read
    std::uint64_t seed = 0;
    std::string form;                   ///< what the records hold: "jsonl"
    std::optional<std::int64_t> units;  ///< of the whole job; none: nobody knows

    /// In what another differs, for people: "the room", "the version of ispace (0.1.0, 0.2.0)"; ""
    /// if it is the same job.
    [[nodiscard]] std::string differenceFrom(const JobId& other) const;
};

struct PartHead {
    JobId job;
    Shard shard;
};

/// A part or a checkpoint that is read. Records stay in the file until they are asked for.
class PartFile {
  public:
    /// Reads the header and finds the records; a last record that is cut off does not count.
    /// \throws FormatError if it is no part, std::system_error as readers do
    explicit PartFile(const std::string& file);

    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] const PartHead& head() const { return head_; }
    /// False if its shard was cut short.
    [[nodiscard]] bool isFinished() const { return is_finished_; }

    /// In the order of the file, without `end`.
    [[nodiscard]] std::size_t records() const { return records_.size(); }
    [[nodiscard]] const std::string& name(std::size_t record) const {
        return records_[record].name;
    }
    /// \throws FormatError if the bytes are not those that were written
    [[nodiscard]] std::string bytes(std::size_t record) const;
    /// The last record of a name.
    [[nodiscard]] std::optional<std::string> find(const std::string& name) const;
    [[nodiscard]] bool has(const std::string& name) const { return by_name_.count(name) > 0; }

    /// Where the last whole record ends.
    [[nodiscard]] std::uint64_t end() const { return end_; }
    /// Bytes of the records that no later one of their name replaces.
    [[nodiscard]] std::uint64_t liveBytes() const { return live_; }
    [[nodiscard]] bool isLast(std::size_t record) const {
        return by_name_.at(records_[record].name) == record;
    }
    /// Drops the first record whose bytes are not what was written and all behind it. Reads all.
    void dropDamaged();
    /// A record that was written at end(), `written` bytes with its line.
    void noteAdded(std::string_view name, std::string_view bytes, std::uint64_t written);

  private:
    struct Entry {
        std::string name;
        std::uint64_t at = 0, size = 0, hash = 0;
    };
    void readHead();
    void findRecords(std::uint64_t size);
    void add(Entry entry);
    [[nodiscard]] bool readRecord(const Entry& entry, std::string& bytes) const;
    [[nodiscard]] std::string read(std::uint64_t at, std::size_t size) const;
    [[noreturn]] void refuse(const std::string& message, int line = 0) const;

    std::string file_;
    OpenFile open_;
    PartHead head_;
    std::vector<Entry> records_;
    std::unordered_map<std::string, std::size_t> by_name_;
    std::uint64_t begin_ = 0, end_ = 0, live_ = 0;
    bool is_finished_ = false;
};

/// Writes a part; it gets to its place once it is finished.
class PartWriter {
  public:
    /// \throws as OutputFile
    PartWriter(const std::string& target, const PartHead& head);
    /// \pre the name has no blank or newline and is not `end`
    void add(std::string_view name, std::string_view bytes);
    /// \throws std::system_error, a full disk included
    void finish();
    /// The same, for a file that is not finished yet.
    void leaveOpen();

  private:
    OutputFile file_;
};

/// The text of a header, and of a record.
std::string partHeadText(const PartHead& head);
std::string partRecordText(std::string_view name, std::string_view bytes);

/// Opens the parts of one whole job, in the order of their shards.
/// \throws FormatError with what is missing, doubled, unfinished, or of another job
std::vector<PartFile> openParts(std::span<const std::string> files, std::string_view tool);

}  // namespace ispace
