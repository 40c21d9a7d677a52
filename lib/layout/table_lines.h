// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/layout: tables of a record, line by line.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/number.h"

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

}  // namespace ispace
