// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace ispace {

/// What a connection still has to be sent: replies in order, and a scan that many connections
/// share.
class Outbox {
  public:
    void append(std::string_view text);
    /// \pre front() is empty
    void put(std::shared_ptr<const std::string> scan) { scan_ = std::move(scan); }
    /// What is to be sent next, in one piece; "" if there is nothing. Valid until the next call of
    /// another function.
    [[nodiscard]] std::string_view front() const;
    /// The first bytes of front() are sent.
    void pop(std::size_t bytes);
    /// Forgets all that is not sent yet. True if that cuts a line.
    bool abandon();
    /// Bytes of replies.
    [[nodiscard]] std::size_t unsent() const { return text_.size() - (scan_ ? 0 : sent_); }
    /// Bytes of the scan that is being sent.
    [[nodiscard]] std::size_t scanBytes() const { return scan_ ? scan_->size() : 0; }
    /// Memory that replies take.
    [[nodiscard]] std::size_t textMemory() const { return text_.capacity(); }

  private:
    std::shared_ptr<const std::string> scan_;  // goes before the text, which came while it was sent
    std::string text_;
    std::size_t sent_ = 0;  // of scan_, else of text_
    bool in_line_ = false;  // the last byte sent did not end a line
};

}  // namespace ispace
