// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/outbox.h"

#include <utility>

namespace ispace {

void Outbox::append(std::string_view text) {
    // What is sent goes only when it is the greater part, so that each byte moves once or so.
    if (!scan_ && sent_ > text_.size() / 2) text_.erase(0, std::exchange(sent_, 0));
    text_ += text;
}

std::string_view Outbox::front() const {
    std::string_view piece = scan_ ? *scan_ : text_;
    piece.remove_prefix(sent_);
    return piece;
}

bool Outbox::abandon() {
    scan_.reset();
    std::string().swap(text_);
    sent_ = 0;
    return in_line_;
}

void Outbox::pop(std::size_t bytes) {
    constexpr std::size_t kKept = std::size_t{1} << 16;
    if (bytes > 0) in_line_ = front()[bytes - 1] != '\n';
    sent_ += bytes;
    if (scan_ && sent_ == scan_->size()) {
        scan_.reset();
        sent_ = 0;
    } else if (!scan_ && sent_ == text_.size()) {
        text_.clear();
        sent_ = 0;
        if (text_.capacity() > kKept) text_.shrink_to_fit();
    }
}

}  // namespace ispace
