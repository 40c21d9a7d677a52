// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace ispace {

/// Cuts a stream of bytes into lines that end in LF or CRLF. Never holds more than a line of the
/// greatest length and one block, if lines are taken before more is appended.
class LineBuffer {
  public:
    /// `limit`: bytes of a line without its end.
    explicit LineBuffer(std::size_t limit) : limit_(limit) {}

    /// Drops the lines taken so far.
    void append(std::string_view bytes);
    /// True if there is a whole line.
    [[nodiscard]] bool ready() const { return end_ != std::string::npos; }
    /// True if the next line is longer than the limit, whole or not.
    [[nodiscard]] bool tooLong() const;
    [[nodiscard]] std::size_t memory() const { return bytes_.capacity(); }
    /// The next line without its end; valid until append(). \pre ready()
    std::string_view take();

  private:
    std::size_t limit_;
    std::string bytes_;
    std::size_t begin_ = 0;                // of the next line
    std::size_t end_ = std::string::npos;  // its LF
};

}  // namespace ispace
