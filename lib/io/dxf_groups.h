// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/io only.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace {

inline std::string_view trimmedGroup(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r";
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

/// A group code and its value.
struct Group {
    int code = 0;
    std::string_view value;
    int line = 0;  // of the value
};

/// Takes a file apart into groups, two lines each.
class GroupReader {
  public:
    GroupReader(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

    /// Nothing at the end of the file.
    std::optional<Group> next() {
        if (rest_.find_first_not_of(" \t\r\n") == std::string_view::npos) return std::nullopt;
        const std::string_view code = nextLine();
        const auto number = parseInteger(code);
        if (!number || *number < -5 || *number > 1071)
            fail(line_, "found " + excerpt(code) + ", wanted a group code");
        if (rest_.empty())
            fail(line_, "truncated: group code " + std::string(code) + " without value");
        const std::string_view value = nextLine();
        return Group{static_cast<int>(*number), value, line_};
    }

    [[noreturn]] void fail(int line, const std::string& message) const {
        throw FormatError(Diagnostic{displayName(name_), line, line == 0 ? 0 : 1, message});
    }
    [[nodiscard]] int line() const { return line_; }

  private:
    std::string_view nextLine() {
        ++line_;
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        const std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        return trimmedGroup(line);
    }

    std::string_view rest_;
    const std::string& name_;
    int line_ = 0;
};

}  // namespace ispace
