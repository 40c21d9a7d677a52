// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/line_buffer.h"

namespace ispace {

namespace {

std::string_view withoutReturn(std::string_view line) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

}  // namespace

void LineBuffer::append(std::string_view bytes) {
    bytes_.erase(0, begin_);
    begin_ = 0;
    const std::size_t old = ready() ? 0 : bytes_.size();  // no LF before
    bytes_ += bytes;
    end_ = bytes_.find('\n', old);
}

bool LineBuffer::tooLong() const {
    const std::size_t end = ready() ? end_ : bytes_.size();
    return withoutReturn(std::string_view(bytes_).substr(begin_, end - begin_)).size() > limit_;
}

std::string_view LineBuffer::take() {
    const auto line = withoutReturn(std::string_view(bytes_).substr(begin_, end_ - begin_));
    begin_ = end_ + 1;
    end_ = bytes_.find('\n', begin_);
    return line;
}

}  // namespace ispace
