// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/file_stream.h"

namespace ispace {

namespace {
constexpr std::size_t kBuffer = 1U << 20U;
}

FileStream::FileStream(const std::string& target)
    : file_(target), buffer_(kBuffer, '\0'), stream_(this) {
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    stream_.exceptions(std::ios::badbit);  // what writing throws reaches the caller
}

int FileStream::overflow(int c) {
    sync();
    if (c != traits_type::eof()) sputc(static_cast<char>(c));
    return traits_type::not_eof(c);
}

int FileStream::sync() {
    file_.write({pbase(), static_cast<std::size_t>(pptr() - pbase())});
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return 0;
}

void FileStream::commit() {
    sync();
    file_.commit();
}

}  // namespace ispace
