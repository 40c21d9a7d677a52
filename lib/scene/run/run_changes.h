// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/scene: tables of a record, line by line.
// Private to lib/scene: a table of a record that has a row whenever something changes.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/number.h"
#include "scene/run/run_reader.h"
#include "scene/scene.h"

namespace ispace {

/// Bytes of a line of a table.
constexpr std::size_t kLongestLine = 16384;

/// Lines of a file or a text, read piece by piece. One without its end is none.
class LineSource {
  public:
    explicit LineSource(std::optional<InputFile> file, std::string text)
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
            is_too_long_ = bytes_.size() - begin_ > kLongestLine;
            if (is_too_long_ || !file_) return std::nullopt;
            bytes_.erase(0, std::exchange(begin_, 0));
            searched_ = bytes_.size();
            if (!file_->read(bytes_)) file_.reset();
        }
    }
    [[nodiscard]] int number() const { return number_; }
    /// At the end: the last line lacks its own.
    [[nodiscard]] bool isCut() const { return begin_ < bytes_.size(); }
    [[nodiscard]] bool isTooLong() const { return is_too_long_; }

  private:
    std::optional<InputFile> file_;
    std::string bytes_;
    std::size_t begin_ = 0, searched_ = 0;  // of the rest; where no line ends before
    int number_ = 0;
    bool is_too_long_ = false;
};

/// The lines of a table of a record. \throws as InputFile, for anything but a regular file, too
inline LineSource tableOf(const std::string& file) {
    return LineSource(InputFile(file, InputKind::Regular), "");
}

/// A time of a run, in seconds: from 0 to 4e9, beyond the hundred years of the longest run.
inline std::optional<double> parseRunTime(std::string_view text) {
    constexpr double kLongest = 4e9;
    const std::optional<double> time = parseDouble(text);
    return time && *time >= 0 && *time <= kLongest ? time : std::nullopt;
}

/// Fields of a line without quotes.
inline void splitFields(std::string_view line, std::vector<std::string_view>& fields) {
    fields.clear();
    for (;;) {
        const std::size_t comma = line.find(',');
        fields.push_back(line.substr(0, comma));
        if (comma == std::string_view::npos) return;
        line.remove_prefix(comma + 1);
    }
}

/// What robots' bumpers felt in a run, t,id,hit, where hit is 0 or 1 of each, with semicolons.
class BumperFile {
  public:
    /// \throws FormatError for other columns, and as read()
    BumperFile(std::string name, LineSource lines);
    /// Appends the rows up to a time that were not read yet. \throws FormatError with the line
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

/// A change that clients made to the world of a run, a row of events.csv.
struct RunChange {
    double time = 0;         ///< seconds: of the step after which it was made
    std::string text = {};   ///< the request
    std::string scene = {};  ///< file that holds the scene after it; "" if the text says all
    int line = 0;            ///< of events.csv
};

/// All changes of a run, in order; none without events.csv. \throws FormatError if that holds no
/// events
std::vector<RunChange> recordedChanges(const std::string& folder);

/// Makes the changes of a recorded run once more. What cannot be made, as in another scene than
/// that of the record, is left out.
class RunChanges {
  public:
    /// Reads a scene of the record.
    using ReadScene = std::function<Scene(const std::string& file)>;
    /// \param start where the run begins, and where RESET leads
    RunChanges(const std::string& folder, Scene start, DeviceCatalogue devices, ReadScene read);

    /// A change as it is made.
    struct Step {
        Scene scene;                      ///< after it
        bool restarts = false;            ///< RESET and LOAD: everybody begins anew
        std::vector<std::string> placed;  ///< ids of those who were put where the scene has them
    };
    [[nodiscard]] bool empty() const { return changes_.empty(); }
    /// True if there is a change before a time.
    [[nodiscard]] bool isDue(double before) const;
    /// The next change before a time; nothing if all are made. \param now the scene before it
    std::optional<Step> next(double before, const Scene& now, const MoverPlaces& places);
    /// Begins anew.
    void rewind();
    /// The step that next() gave last cannot be made. \param why the error's text
    void refuse(const std::string& why);
    /// What became of the first that could not be made: "run/events.csv:7: …"; "" if all could.
    [[nodiscard]] const std::string& failure() const { return failure_; }

  private:
    [[nodiscard]] Step stepOf(const RunChange& change, const Scene& now, const MoverPlaces& places);

    std::string folder_;
    std::shared_ptr<const Scene> first_, start_;  // of the run; where RESET leads
    DeviceCatalogue devices_;
    ReadScene read_;
    std::vector<RunChange> changes_;
    std::size_t next_ = 0;
    std::string failure_;
};

}  // namespace ispace
