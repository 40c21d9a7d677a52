// SPDX-License-Identifier: GPL-3.0-or-later
// Results of a job by key. A shard (--shard) writes them as a part, --resume stores them beside the
// output, --merge reads them.
//
// A file of results is a header, see part_head.h, then records. A record is a line `=KEY BYTES
// HASH`, BYTES bytes and a newline; HASH is hashOf() the bytes, in hex. A later record replaces an
// earlier one of its key. The last record of a finished part is `end`.
//
// After a crash or a full disk only complete records remain: a record that cannot be appended whole
// is cut off, kept results end before the first damaged record, and damage in a part of a merge is
// an error. The hash detects damage, not malice. Parts have the same bytes in whatever order
// results were stored. Results stay on disk: a key takes some 100 bytes of memory, find() one read.
//
//     JobResults results("plan.json", job, shard, true);       // --resume
//     auto tree = results.find("tree1");
//     if (!tree) results.store("tree1", tree.emplace(grow()));
//     results.finish();
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"
#include "base/part_head.h"
#include "base/shard.h"

namespace ispace {

/// Results of a job by key. They are stored in files and read on request; find() and store() may be
/// called from any thread.
class JobResults {
  public:
    /// Opens the results of one shard of a job. With `is_kept` they are stored in keptFile() and
    /// outlive the process; results of an earlier run are read from there, up to the first
    /// truncated or damaged record. Otherwise they are stored in an unnamed file in the folder of
    /// `output`, or in TMPDIR if that is a stream.
    /// \throws FormatError if the kept file belongs to another job, in which case it is unchanged,
    /// or if another process has it open; std::system_error
    JobResults(const std::string& output, const JobId& job, Shard shard, bool is_kept);

    /// Opens the results that an earlier run of this job wrote by writePart(); empty without the
    /// file, and if they are of another job of this tool. Damaged ones, and all after them, are
    /// missing. \throws FormatError if the file holds results of another tool or form, or none
    static std::optional<JobResults> earlier(const std::string& file, const JobId& job);

    /// Name of the file beside an output that stores results: OUTPUT.resume, in a folder `.resume`
    /// or, for one of several shards, `.resume-2of3`.
    static std::string keptFile(const std::string& output, const Shard& shard);

    /// Header; of a merge, that of the first part.
    [[nodiscard]] const PartHead& head() const { return files_.front().head; }
    [[nodiscard]] const std::string& file() const { return files_.front().name; }
    /// All keys, sorted bytewise.
    [[nodiscard]] std::vector<std::string> keys() const;
    /// Returns the result of a key. \throws FormatError if its bytes are damaged
    [[nodiscard]] std::optional<std::string> find(const std::string& key) const;
    /// Inserts a result, or replaces that of the same key; a merge does not store results. The kept
    /// file is rewritten once most of it is replaced results, or grows if that fails.
    /// \pre the key has no blank or newline and is not `end`
    /// \throws std::system_error if the disk is full; the file is then unchanged
    void store(const std::string& key, std::string_view bytes);
    /// Writes the results as a finished part, sorted by key.
    /// \param prefixes of the keys to write; if empty, all keys
    void writePart(const std::string& target,
                   std::span<const std::string_view> prefixes = {}) const;
    /// Removes the kept file once the job is done.
    void finish();

    /// From now on results are dropped if the disk is full, without an error; trouble() reports it.
    void dropWithoutRoom() { is_optional_ = true; }
    [[nodiscard]] const std::string& trouble() const { return trouble_; }

    /// Counts the steps of one kind: returns 1, 2, … Call it from one thread, in the same order in
    /// each run.
    int numberOf(const std::string& step) { return ++steps_[step]; }
    /// Returns a key with that number: "tree1", "tree2", …
    std::string keyFor(const std::string& step) { return step + std::to_string(numberOf(step)); }
    /// True if results are kept and storing the state in the middle of a step pays: since the last
    /// store() the interval has passed, and 20 times the time that it took.
    [[nodiscard]] bool isDue();
    void setInterval(double seconds);

  private:
    friend JobResults mergeParts(std::span<const std::string> files, std::string_view tool,
                                 std::string_view common, bool is_equal);
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
        std::uint64_t begin = 0, end = 0;  // of its complete records
        bool is_finished = false;
        std::string doubled = {};  // of a merge: why its records collide with another part's

        /// \param flags of open(2); with O_CREAT a missing file is created
        void openAs(int flags);
        /// Locks the file against other processes; false if its name no longer leads to it.
        [[nodiscard]] bool lock() const;
        /// Writes the header if the file is empty or, after a crash, ends within it.
        void start(const PartHead& job) const;
        [[nodiscard]] std::string read(std::uint64_t at, std::size_t size) const;
        /// \throws std::system_error if the disk is full; the file then ends at `end`
        void append(std::string_view bytes) const;
        [[noreturn]] void refuse(const std::string& message, int line = 0) const;
        void readHead();
    };

    JobResults() = default;
    void addFile(const std::string& name);
    void addFile(File file);
    void readRecords(File& file, std::uint64_t size);
    void keep(const std::string& key, const Record& record);
    [[nodiscard]] bool readRecord(const Record& record, std::string& bytes) const;
    [[nodiscard]] std::string bytesOf(const std::string& key, const Record& record) const;
    void openKept(const std::string& name, const PartHead& head);
    void rewriteKept();
    void rewriteIfDue();
    void writeRecords(const std::function<void(std::string_view)>& write,
                      std::span<const std::string_view> prefixes) const;

    std::vector<File> files_;
    std::map<std::string, Record, std::less<>> records_;
    std::uint64_t live_ = 0;          // bytes of the records
    std::uint64_t next_rewrite_ = 0;  // size of the kept file from which it is rewritten
    bool is_kept_ = false, is_merge_ = false, is_optional_ = false;
    std::string common_;  // of a merge
    bool is_common_equal_ = true;
    std::string trouble_;
    std::map<std::string, int> steps_;
    Clock::duration interval_{};
    Clock::time_point next_ = Clock::now();
    std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();  // for moves
};

/// Merges the parts of all shards of one job.
/// \param common key of the record that all parts have \param is_equal false: its bytes may differ
/// \throws FormatError if a part is missing, duplicate, unfinished, of another job or tool, or
/// written by a version of ispace with another format, and if two parts have the same other record
JobResults mergeParts(std::span<const std::string> files, std::string_view tool,
                      std::string_view common, bool is_equal = true);

/// True if `file` is a finished and undamaged part of this shard of this job.
bool isPartOf(const std::string& file, const PartHead& head);

/// Reads the header of a part or of kept results. \throws FormatError, std::system_error
PartHead partHeadOf(const std::string& file);

/// Formats a record.
std::string partRecordText(std::string_view key, std::string_view bytes);

}  // namespace ispace
