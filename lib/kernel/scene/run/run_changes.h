// SPDX-License-Identifier: GPL-3.0-or-later
// The changes of a recorded run, and readers of the tables beside those of RunReader.
//
//     RunChanges changes(folder, start, devices, read);
//     while (const auto step = changes.next(time, now, places)) now = step->scene;
//     if (!changes.failure().empty()) warn(changes.failure());
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/budget.h"
#include "base/file.h"
#include "base/number.h"
#include "base/zstd_text.h"
#include "scene/run/run_reader.h"
#include "scene/scene.h"

namespace ispace {

/// Longest line of a table in bytes.
constexpr std::size_t kMaxLineBytes = 16384;

/// Reads the lines of a file or a text in blocks. A line without its end is not returned.
class LineSource {
  public:
    explicit LineSource(std::optional<TextFile> file, std::string text)
        : file_(std::move(file)), bytes_(std::move(text)) {}

    std::optional<std::string_view> next() {
        for (;;) {
            const std::size_t end = bytes_.find('\n', searched_);
            if (end != std::string::npos) {
                std::string_view line(bytes_.data() + begin_, end - begin_);
                if (line.ends_with('\r')) line.remove_suffix(1);
                begin_ = searched_ = end + 1;
                ++number_;
                return line;
            }
            is_too_long_ = bytes_.size() - begin_ > kMaxLineBytes;
            if (is_too_long_ || !file_) return std::nullopt;
            bytes_.erase(0, std::exchange(begin_, 0));
            searched_ = bytes_.size();
            if (!file_->read(bytes_)) file_.reset();
        }
    }
    [[nodiscard]] int number() const { return number_; }
    /// At the end: true if the last line lacks its line break.
    [[nodiscard]] bool isCut() const { return begin_ < bytes_.size(); }
    [[nodiscard]] bool isTooLong() const { return is_too_long_; }

  private:
    std::optional<TextFile> file_;
    std::string bytes_;
    std::size_t begin_ = 0, searched_ = 0;  // of the rest; no line ends before
    int number_ = 0;
    bool is_too_long_ = false;
};

/// Opens a table of a record, also a compressed one. \throws as InputFile, also for anything but a
/// regular file
inline LineSource tableOf(const std::string& file) {
    return LineSource(TextFile(file, InputKind::Regular), "");
}

/// Seconds that a record may last: beyond the hundred years of the longest run, and few enough for
/// 64 bits of nanoseconds.
constexpr double kLongestRecord = 4e9;

/// Parses a time of a run, in seconds: from 0 to kLongestRecord.
inline std::optional<double> parseRunTime(std::string_view text) {
    const std::optional<double> time = parseDouble(text);
    return time && *time >= 0 && *time <= kLongestRecord ? time : std::nullopt;
}

/// Splits a line without quotes into its fields.
inline void splitFields(std::string_view line, std::vector<std::string_view>& fields) {
    fields.clear();
    for (;;) {
        const std::size_t comma = line.find(',');
        fields.push_back(line.substr(0, comma));
        if (comma == std::string_view::npos) return;
        line.remove_prefix(comma + 1);
    }
}

/// Reads the bumper contacts of a run: t,id,hit, where hit has 0 or 1 for each bumper, with
/// semicolons.
class BumperFile {
  public:
    /// \throws FormatError for other columns, and as read()
    BumperFile(std::string name, LineSource lines);
    /// Appends the unread rows up to a time. \throws FormatError with the line
    void read(double time, std::vector<RunBumpers>& bumpers);

  private:
    void readLine();
    [[noreturn]] void fail(const std::string& what) const;

    std::string name_;
    LineSource lines_;
    std::vector<std::string_view> fields_;
    double time_ = 0;                // of the row
    std::optional<RunBumpers> row_;  // read ahead
};

/// Removes the next field, which may be quoted, from the rest of a CSV line.
std::string takeField(std::string_view& rest);

/// A change of a run's world by a client, a row of events.csv.
struct RunChange {
    double time = 0;         ///< seconds: of the step after which it was made
    std::string text = {};   ///< the request
    std::string scene = {};  ///< file that holds the scene after it; "" if the text is sufficient
    int line = 0;            ///< of events.csv
};

/// Reads all changes of a run, in order; empty without events.csv. \throws FormatError if that
/// holds no events
std::vector<RunChange> recordedChanges(const std::string& folder);

/// Repeats the changes of a recorded run. A change that fails, as in a scene other than the
/// recorded one, is skipped; so are all changes beyond a bound of work: 1 unit for each change and
/// record of its scene, Budget::kMaxWork and Budget::kPerByte for each byte of the record in all.
class RunChanges {
  public:
    /// Reads a scene of the record.
    using ReadScene = std::function<Scene(const std::string& file)>;
    /// \param start the scene at the start of the run, which RESET restores
    /// \param max_work of --max-work, replaces the bound
    RunChanges(const std::string& folder, Scene start, DeviceCatalogue devices, ReadScene read,
               std::optional<std::uint64_t> max_work = {});

    /// A repeated change.
    struct Step {
        Scene scene;                      ///< after it
        bool restarts = false;            ///< RESET and LOAD: all movers restart
        std::vector<std::string> placed;  ///< ids of the movers that take the scene's poses
        RunChange change = {};            ///< the recorded one
    };
    [[nodiscard]] bool empty() const { return changes_.empty(); }
    /// Returns true if there is a change before a time.
    [[nodiscard]] bool isDue(double before) const;
    /// Returns the next change before a time; empty after the last. \param now the scene before it
    std::optional<Step> next(double before, const Scene& now, const MoverPlaces& places);
    /// Restarts at the first change, with all of the work.
    void rewind();
    /// Reports that the step which next() returned last failed. \param why the error's text
    void refuse(const std::string& why);
    /// Returns the message of the first failed change, "run/events.csv:7: …"; "" if all succeeded.
    [[nodiscard]] const std::string& failure() const { return failure_; }

  private:
    [[nodiscard]] Step stepOf(const RunChange& change, const Scene& now, const MoverPlaces& places);

    std::string folder_;
    std::shared_ptr<const Scene> first_, start_;  // of the run; restored by RESET
    DeviceCatalogue devices_;
    ReadScene read_;
    std::vector<RunChange> changes_;
    std::size_t next_ = 0;
    Budget whole_, budget_;  // before the first change, and now
    std::string failure_;
};

}  // namespace ispace
