// SPDX-License-Identifier: GPL-3.0-or-later
// Results of a job by key: what a shard writes as a part (--shard), what --resume keeps beside the
// output, and what --merge reads.
//
// A file of results is a text header, then records. The header is
//     #part 2
//     # scan room.glb --frames 100        the history of the product, a line each
//     tool scan 0.1.0                     and its version
//     room sha256:…                       digest of the environment
//     inputs sha256:…                     digest of all that was read
//     seed 0
//     form jsonl                          what the records hold
//     shard 3/8
//     units 100                           of the whole job; - where that is not known
// and a blank line. A record is a line `=KEY BYTES HASH`, so many bytes and a newline; the hash is
// hashOf() the bytes, in hex. A later record replaces an earlier one of its key. The last record of
// a finished part is `end`.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"
#include "base/message.h"
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
    std::optional<std::int64_t> units;  ///< of the whole job, where they can be counted

    /// The property in which another job differs, for messages: "the room", "the version of ispace
    /// (0.1.0, 0.2.0)"; "" if it is the same job.
    [[nodiscard]] std::string differenceFrom(const JobId& other) const;
};

struct PartHead {
    JobId job;
    Shard shard;
};

/// Results of a job by key. They stay in files until they are asked for; find() and store() may be
/// called from any thread.
class JobResults {
  public:
    /// The results of one shard of a job. With `is_kept` they go into keptFile() and outlive the
    /// process, and those that an earlier run left there are found: a record that was cut off or
    /// damaged is dropped, with all behind it. Otherwise they go into a file without a name in the
    /// folder of `output`, or in TMPDIR if that is a stream.
    /// \throws FormatError if the kept file is of another job, which is left alone, or if another
    /// process has it open; std::system_error
    JobResults(const std::string& output, const JobId& job, Shard shard, bool is_kept);

    /// The file beside an output that keeps results: OUTPUT.resume, in a folder its file `.resume`
    /// or, of one shard of many, `.resume-2of3`.
    static std::string keptFile(const std::string& output, const Shard& shard);

    /// Of a merge that of the first part.
    [[nodiscard]] const PartHead& head() const { return files_.front().head; }
    [[nodiscard]] const std::string& file() const { return files_.front().name; }
    /// In the order of their bytes.
    [[nodiscard]] std::vector<std::string> keys() const;
    /// \throws FormatError if the bytes are not those that were stored
    [[nodiscard]] std::optional<std::string> find(const std::string& key) const;
    /// Adds a result, or replaces that of the same key; a merge keeps none. The kept file is
    /// written anew once it is mostly made of replaced results.
    /// \pre the key has no blank or newline and is not `end`
    /// \throws std::system_error if the disk is full: the file is then as it was
    void store(const std::string& key, std::string_view bytes);
    /// Writes the results as a finished part, in the order of their keys. \param prefixes of the
    /// keys that the part has; none: all
    void writePart(const std::string& target,
                   std::span<const std::string_view> prefixes = {}) const;
    /// The job is done: the kept file is removed.
    void finish();

    /// From now on a full disk drops results in place of being an error; trouble() says so.
    void dropWithoutRoom() { is_optional_ = true; }
    [[nodiscard]] const std::string& trouble() const { return trouble_; }

    /// 1, 2, … each time that this kind of step is taken. From one thread, in the same order in
    /// each run.
    int numberOf(const std::string& step) { return ++steps_[step]; }
    /// A key with that number: "tree1", "tree2", …
    std::string keyFor(const std::string& step) { return step + std::to_string(numberOf(step)); }
    /// True once results are kept and the interval has passed since the last store(), or the time
    /// that makes storing a twentieth of all: state in the middle of a step is then worth storing.
    [[nodiscard]] bool isDue();
    void setInterval(double seconds);

  private:
    friend JobResults mergeParts(std::span<const std::string> files, std::string_view tool);
    friend PartHead partHeadOf(const std::string& file);
    friend bool isPartOf(const std::string& file, const PartHead& head);
    using Clock = std::chrono::steady_clock;

    struct Record {
        std::size_t file = 0;
        std::uint64_t at = 0, size = 0, hash = 0;
    };
    struct File {
        std::string name;
        OpenFile open = OpenFile();
        PartHead head = {};
        std::uint64_t begin = 0, end = 0;  // of its whole records
        bool is_finished = false;

        [[nodiscard]] std::string read(std::uint64_t at, std::size_t size) const;
        [[noreturn]] void refuse(const std::string& message, int line = 0) const;
        void readHead();
    };

    JobResults() = default;
    void addFile(const std::string& name);
    void readRecords(File& file, std::uint64_t size);
    void keep(const std::string& key, const Record& record);
    [[nodiscard]] bool readRecord(const Record& record, std::string& bytes) const;
    [[nodiscard]] std::string bytesOf(const std::string& key, const Record& record) const;
    void openKept(const PartHead& head);
    void append(std::string_view bytes);
    void writeRecords(OutputFile& to, std::span<const std::string_view> prefixes) const;

    std::vector<File> files_;
    std::map<std::string, Record, std::less<>> records_;
    std::uint64_t live_ = 0;  // bytes of the records
    bool is_kept_ = false, is_merge_ = false, is_optional_ = false;
    std::string trouble_;
    std::map<std::string, int> steps_;
    Clock::duration interval_{};
    Clock::time_point next_ = Clock::now();
    std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();  // it can be moved
};

/// The results in the parts of all shards of one job.
/// \throws FormatError with what is missing, doubled, unfinished, of another job or tool, or
/// written by an ispace whose parts had another form
JobResults mergeParts(std::span<const std::string> files, std::string_view tool);

/// True if `file` is a finished and undamaged part of this shard of this job.
bool isPartOf(const std::string& file, const PartHead& head);

/// The header of a part or of kept results. \throws FormatError, std::system_error
PartHead partHeadOf(const std::string& file);

/// The text of a header, and of a record.
std::string partHeadText(const PartHead& head);
std::string partRecordText(std::string_view key, std::string_view bytes);

}  // namespace ispace
