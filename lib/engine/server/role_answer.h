// SPDX-License-Identifier: GPL-3.0-or-later
// How roles answer, those of extensions, too: errors, lists, and items for clients that may read
// slowly. For the server's thread.
//
//     unread.add("EVENT impact t=9.000 id=r1\n");            // an UnreadItems<std::string>
//     const std::string lines = takeLines(unread, "9.000");  // once the client has room
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/message.h"

namespace ispace {

/// Returns the error line of a request: "ERR 404 no volume `news`\n".
inline std::string errorText(int code, std::string_view reason) {
    std::string line = "ERR ";
    line.append(std::to_string(code)).append(" ").append(printable(reason));
    return line += '\n';
}

/// Returns the words in one text: "l1,l2".
inline std::string joined(const std::vector<std::string>& words, std::string_view separator) {
    std::string out;
    for (const std::string& word : words) {
        if (!out.empty()) out += separator;
        out += word;
    }
    return out;
}

/// The newest kMost items that a client has not read; older ones are dropped, and counted. O(1) for
/// each item.
template <typename Item>
class UnreadItems {
  public:
    static constexpr std::size_t kMost = 1000;

    void add(Item item) {
        items_.push_back(std::move(item));
        if (items_.size() <= kMost) return;
        items_.pop_front();
        ++missed_;
    }
    /// Takes the items that are left.
    [[nodiscard]] std::deque<Item> take() { return std::exchange(items_, {}); }
    /// Returns "EVENT missed t=9.000 n=12\n" if items were dropped since the last call, else "".
    [[nodiscard]] std::string missedLine(std::string_view time) {
        if (missed_ == 0) return "";
        std::string line = "EVENT missed t=";
        line.append(time).append(" n=").append(std::to_string(std::exchange(missed_, 0)));
        return line += '\n';
    }

  private:
    std::deque<Item> items_;
    std::int64_t missed_ = 0;
};

/// Takes what a client may read now: the line about missed items, and the lines that are left.
inline std::string takeLines(UnreadItems<std::string>& unread, std::string_view time) {
    std::string lines = unread.missedLine(time);
    for (const std::string& line : unread.take()) lines += line;
    return lines;
}

}  // namespace ispace
